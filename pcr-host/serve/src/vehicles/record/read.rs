//! Reads a record, line by line, and finds out whether it is as it was written.

use super::{RecordHeader, RecordTrailer, RecordVehicle, VERSION};
use crc32fast::Hasher;
use serde::de::IgnoredAny;
use std::io::{self, BufRead};

/// Largest coordinate \[m\], speed \[m/s\] and time before or after 0 \[s\]: beyond them rounding hides contacts.
const FARTHEST: f64 = 1e7;
const FASTEST: f64 = 1e3;
const LATEST: f64 = 1e10;

/// Positions of a vehicle: time \[s\], x and y \[m\].
type RecordedTrack = Vec<[f64; 3]>;

/// The contents of a record.
pub(super) struct RecordContents {
    pub(super) vehicles: Vec<RecordVehicle>,
    /// The track of each vehicle.
    pub(super) tracks: Vec<RecordedTrack>,
    /// Why the record is not as it was written, if it is not.
    pub(super) cut: Option<String>,
}

/// Reads a record.
///
/// # Errors
/// As [`certify`](super::certify).
pub(super) fn read(mut text: impl BufRead) -> io::Result<RecordContents> {
    let wrong = |line: usize, why: String| io::Error::new(io::ErrorKind::InvalidData, format!("line {line}: {why}"));
    let mut lines = std::iter::from_fn(|| next(&mut text).transpose()).enumerate();
    let (_, first) = lines.next().ok_or_else(|| wrong(1, "missing".into()))?;
    let (first, _) = first?;
    let vehicles = head(&first).map_err(|why| wrong(1, why))?;
    let mut tracks: Vec<RecordedTrack> = vec![Vec::new(); vehicles.len()];
    let (mut end, mut count, mut sum): (Option<RecordTrailer>, u64, _) = (None, 0, Hasher::new());
    let add = |sum: &mut Hasher, text: &str| [text, "\n"].iter().for_each(|part| sum.update(part.as_bytes()));
    add(&mut sum, &first);
    for (line, text) in lines {
        let (text, is_whole) = text?;
        // No line of a record is JSON before its last character.
        if !is_whole && serde_json::from_str::<IgnoredAny>(&text).is_err() {
            break;
        }
        if end.is_some() {
            return Err(wrong(line + 1, "it comes after the last line of a record".into()));
        }
        if text.starts_with('{') {
            end = Some(serde_json::from_str(&text).map_err(|error| wrong(line + 1, error.to_string()))?);
            continue;
        }
        count += 1;
        add(&mut sum, &text);
        point(&text, &mut tracks).map_err(|why| wrong(line + 1, why))?;
    }
    let cut = cut(end, count, sum);
    if let Some(none) = tracks.iter().position(Vec::is_empty).filter(|_| cut.is_none()) {
        return Err(wrong(1, format!("nothing about {}", vehicles[none].name)));
    }
    Ok(RecordContents { vehicles, tracks, cut })
}

/// The vehicles that the first line names.
fn head(text: &str) -> Result<Vec<RecordVehicle>, String> {
    let RecordHeader { format, version, vehicles } = serde_json::from_str(text).map_err(|error| error.to_string())?;
    if (format.as_str(), version) != ("pcr-record", VERSION) {
        return Err(format!("a record of version {VERSION} is expected"));
    }
    match vehicles.len() {
        0 => return Err("no vehicles".into()),
        1 => return Err("there are no two vehicles, of which contacts could be certified".into()),
        _ => {}
    }
    // Discs of radius 0 would never overlap, wherever they are.
    match vehicles.iter().find(|vehicle| vehicle.radius <= 0.0) {
        Some(none) => Err(format!("a radius above 0 is expected, not {} of {}", none.radius, none.name)),
        None => Ok(vehicles),
    }
}

/// Adds a position to its track.
fn point(text: &str, tracks: &mut [RecordedTrack]) -> Result<(), String> {
    let (vehicle, time, x, y): (usize, f64, f64, f64) = serde_json::from_str(text).map_err(|it| it.to_string())?;
    let track = tracks.get_mut(vehicle).ok_or("no such vehicle")?;
    if let Some(far) = [x, y].into_iter().find(|it| it.abs() > FARTHEST) {
        return Err(format!("coordinates up to {FARTHEST:e} m are expected, not {far:e}"));
    }
    if time.abs() > LATEST {
        return Err(format!("times up to {LATEST:e} s are expected, not {time:e}"));
    }
    if let Some([before, x0, y0]) = track.last() {
        if *before >= time {
            return Err("not later than the line before of this vehicle".to_owned());
        }
        let speed = (x - x0).hypot(y - y0) / (time - before);
        if speed > FASTEST {
            return Err(format!("speeds up to {FASTEST:e} m/s are expected, not {speed:e}"));
        }
    }
    track.push([time, x, y]);
    Ok(())
}

/// Why a record with so many lines and this checksum is not as it was written, if it is not.
fn cut(end: Option<RecordTrailer>, count: u64, sum: Hasher) -> Option<String> {
    match end {
        None => Some("the record is cut: its last line is missing".to_owned()),
        Some(end) if end.lines != count => Some(format!("the record is cut: it has {count} lines of {}", end.lines)),
        Some(RecordTrailer { crc32: Some(told), .. }) if told != sum.finalize() => {
            Some("the record is not as it was written: its checksum is another one".to_owned())
        }
        Some(_) => None,
    }
}

/// The next line, and whether it ends with a line feed.
fn next(text: &mut impl BufRead) -> io::Result<Option<(String, bool)>> {
    let mut line = String::new();
    if text.read_line(&mut line)? == 0 {
        return Ok(None);
    }
    let ends = ["\r\n", "\n"].iter().find_map(|end| line.strip_suffix(end));
    Ok(Some(ends.map(|whole| (whole.to_owned(), true)).unwrap_or((line.clone(), false))))
}
