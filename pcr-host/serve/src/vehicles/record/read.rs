//! Reads a record, line by line, and finds out whether it is as it was written.

use super::{RecordHeader, RecordTrailer, RecordVehicle, VERSIONS};
use crc32fast::Hasher;
use serde::de::IgnoredAny;
use std::io::{self, BufRead};

/// Largest coordinate \[m\], speed \[m/s\] and time before or after 0 \[s\]: beyond them rounding hides contacts.
const FARTHEST: f64 = 1e7;
const FASTEST: f64 = 1e3;
const LATEST: f64 = 1e10;

/// Largest heading \[rad\].
const MOST_TURNED: f64 = 1e4;

/// Positions of a vehicle: time \[s\], x and y \[m\], and heading \[rad\], which is 0 for a disc.
type RecordedTrack = Vec<[f64; 4]>;

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
        point(&text, &vehicles, &mut tracks).map_err(|why| wrong(line + 1, why))?;
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
    if format != "pcr-record" || !VERSIONS.contains(&version) {
        return Err(format!("a record of version {} or {} is expected", VERSIONS[0], VERSIONS[1]));
    }
    if let Some(early) = vehicles.iter().find(|it| it.footprint.is_some() && version == VERSIONS[0]) {
        return Err(format!("a footprint of {} in a record of version {version}", early.name));
    }
    if let Some(both) = vehicles.iter().find(|it| it.footprint.is_some() == it.radius.is_some()) {
        return Err(format!("a radius or a footprint of {} is expected", both.name));
    }
    match vehicles.len() {
        0 => return Err("no vehicles".into()),
        1 => return Err("there are no two vehicles, of which contacts could be certified".into()),
        _ => {}
    }
    // Discs of radius 0 would never overlap, wherever they are.
    let none = vehicles.iter().find_map(|it| Some((it.radius.filter(|radius| *radius <= 0.0)?, &it.name)));
    match none {
        Some((radius, name)) => Err(format!("a radius above 0 is expected, not {radius} of {name}")),
        None => Ok(vehicles),
    }
}

/// Adds a position to its track.
fn point(text: &str, vehicles: &[RecordVehicle], tracks: &mut [RecordedTrack]) -> Result<(), String> {
    let plain =
        serde_json::from_str::<(usize, f64, f64, f64)>(text).map(|(vehicle, time, x, y)| (vehicle, time, x, y, None));
    let posed = || serde_json::from_str::<(usize, f64, f64, f64, f64)>(text).ok();
    let posed = |why: serde_json::Error| match posed() {
        Some((vehicle, time, x, y, heading)) => Ok((vehicle, time, x, y, Some(heading))),
        None => Err(why.to_string()),
    };
    let (vehicle, time, x, y, heading) = plain.or_else(posed)?;
    let (track, is_posed) =
        tracks.get_mut(vehicle).zip(vehicles.get(vehicle).map(|it| it.footprint.is_some())).ok_or("no such vehicle")?;
    if heading.is_some() != is_posed {
        return Err(if is_posed { "the heading is missing" } else { "a disc has no heading" }.to_owned());
    }
    let heading = heading.unwrap_or(0.0);
    if heading.abs() > MOST_TURNED {
        return Err(format!("headings up to {MOST_TURNED:e} rad are expected, not {heading:e}"));
    }
    if let Some(far) = [x, y].into_iter().find(|it| it.abs() > FARTHEST) {
        return Err(format!("coordinates up to {FARTHEST:e} m are expected, not {far:e}"));
    }
    if time.abs() > LATEST {
        return Err(format!("times up to {LATEST:e} s are expected, not {time:e}"));
    }
    if let Some([before, x0, y0, _]) = track.last() {
        if *before >= time {
            return Err("not later than the line before of this vehicle".to_owned());
        }
        let speed = (x - x0).hypot(y - y0) / (time - before);
        if speed > FASTEST {
            return Err(format!("speeds up to {FASTEST:e} m/s are expected, not {speed:e}"));
        }
    }
    track.push([time, x, y, heading]);
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
