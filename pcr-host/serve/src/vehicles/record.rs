//! A file with the true positions of vehicles, and the proof that they never touched.
//!
//! The first line names the vehicles: `{"format":"pcr-record","version":2,"vehicles":[{"name":"sim/1","radius":0.4}]}`.
//! Each line after it is `[vehicle, time, x, y]`; vehicles are counted from 0, and the times \[s\] of a vehicle increase.
//! Between two of its lines a vehicle moves straight at a constant speed; before the first and after the last one it
//! stands. The last line of the file is `{"lines":N,"crc32":C}`, with the number of these lines and the checksum (as in
//! PNG) of all that is before it. A record without it, or with other numbers, is not as it was written, and proves
//! nothing.

use crc32fast::Hasher;
use pcr_certify::data::{Agent, Angle, Path, Phase, Segment, Travel};
use pcr_certify::motion::{Mover, meetings};
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use std::io::{self, BufRead, Write};

/// A vehicle of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recorded {
    /// Name of the vehicle.
    pub name: String,
    /// Radius of its disc \[m\].
    pub radius: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    format: String,
    version: u32,
    vehicles: Vec<Recorded>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct End {
    lines: u64,
    /// Optional, so that other programs can write records without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    crc32: Option<u32>,
}

/// A record in the making.
#[derive(Debug)]
pub struct Record<W: Write> {
    out: W,
    last: Vec<Option<[f64; 3]>>,
    /// For each vehicle whether its last position repeats an earlier one and is not written yet.
    waits: Vec<bool>,
    lines: u64,
    sum: Hasher,
}

impl<W: Write> Record<W> {
    /// A record of these vehicles.
    ///
    /// # Errors
    /// As the writer.
    pub fn new(out: W, vehicles: &[Recorded]) -> io::Result<Self> {
        let head = Head { format: "pcr-record".into(), version: VERSION, vehicles: vehicles.to_vec() };
        let (last, waits) = (vec![None; vehicles.len()], vec![false; vehicles.len()]);
        let mut own = Self { out, last, waits, lines: 0, sum: Hasher::new() };
        own.line(serde_json::to_string(&head)?)?;
        Ok(own)
    }

    /// Adds the position of a vehicle at a time \[s, m\].
    ///
    /// # Errors
    /// As the writer.
    pub fn push(&mut self, vehicle: usize, time: f64, [x, y]: [f64; 2]) -> io::Result<()> {
        let (Some(last), Some(waits)) = (self.last.get_mut(vehicle), self.waits.get_mut(vehicle)) else {
            return Ok(());
        };
        if let Some([_, x0, y0]) = *last
            && [x0, y0] == [x, y]
        {
            (*last, *waits) = (Some([time, x, y]), true);
            return Ok(());
        }
        let waited = last.filter(|_| std::mem::take(waits));
        *last = Some([time, x, y]);
        waited.into_iter().chain([[time, x, y]]).try_for_each(|point| self.write(vehicle, point))
    }

    fn write(&mut self, vehicle: usize, [time, x, y]: [f64; 3]) -> io::Result<()> {
        self.lines += 1;
        self.line(format!("[{vehicle},{time:?},{x:?},{y:?}]"))
    }

    fn line(&mut self, mut text: String) -> io::Result<()> {
        text.push('\n');
        self.sum.update(text.as_bytes());
        self.out.write_all(text.as_bytes())
    }

    /// Writes what is left and the last line, which has a checksum.
    ///
    /// # Errors
    /// As the writer.
    pub fn finish(mut self) -> io::Result<W> {
        let standing = std::mem::take(&mut self.last).into_iter().zip(std::mem::take(&mut self.waits));
        for (vehicle, point) in
            standing.enumerate().filter_map(|(vehicle, (last, waits))| Some((vehicle, last.filter(|_| waits)?)))
        {
            self.write(vehicle, point)?;
        }
        let end = End { lines: self.lines, crc32: Some(self.sum.clone().finalize()) };
        self.line(serde_json::to_string(&end)?)?;
        self.out.flush()?;
        Ok(self.out)
    }
}

/// The result of the check of a record.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Certificate {
    /// `pcr-contacts`
    pub format: &'static str,
    /// 1
    pub version: u32,
    /// `proved`: no contact at any time. `contact`: there is one. `undecided`: so near that rounding does not tell, or not checked.
    pub verdict: &'static str,
    /// Number of vehicles.
    pub vehicles: usize,
    /// Time from the first to the last line \[s\].
    pub time: f64,
    /// Length travelled by all vehicles together \[m\].
    pub travelled: f64,
    /// The first contact of each pair of vehicles in each window of time.
    pub contacts: Vec<Contact>,
    /// Number of pairs and windows without a decision.
    pub undecided: usize,
    /// Why there is no verdict.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// A contact of two vehicles.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contact {
    /// Names of the two vehicles.
    pub vehicles: [String; 2],
    /// Time of the contact \[s\].
    pub time: f64,
    /// Distance of the centres less the radii \[m\].
    pub clearance: f64,
}

/// Version of the format of records. Records of version 1 had no last line.
const VERSION: u32 = 2;

/// Largest coordinate \[m\], speed \[m/s\] and time before or after 0 \[s\]: beyond them rounding hides contacts.
const FARTHEST: f64 = 1e7;
const FASTEST: f64 = 1e3;
const LATEST: f64 = 1e10;

/// Windows in which motions are checked \[s\]; one that would have no line in it lasts until the next line.
const WINDOW: f64 = 20.0;

/// Proves that the vehicles of a record never touched, or shows where.
///
/// # Errors
/// A line that is not part of a record, or fewer than two vehicles, of which nothing could be proved. A record that ends within a line
/// after the first one was cut off there: this is no error, and the verdict is `undecided`.
pub fn certify(mut text: impl BufRead) -> io::Result<Certificate> {
    let wrong = |line: usize, why: String| io::Error::new(io::ErrorKind::InvalidData, format!("line {line}: {why}"));
    let mut lines = std::iter::from_fn(|| next(&mut text).transpose()).enumerate();
    let (_, first) = lines.next().ok_or_else(|| wrong(1, "missing".into()))?;
    let (first, _) = first?;
    let head: Head = serde_json::from_str(&first).map_err(|error| wrong(1, error.to_string()))?;
    if (head.format.as_str(), head.version) != ("pcr-record", VERSION) {
        return Err(wrong(1, format!("a record of version {VERSION} is expected")));
    }
    if head.vehicles.is_empty() {
        return Err(wrong(1, "no vehicles".into()));
    }
    if head.vehicles.len() == 1 {
        return Err(wrong(1, "there are no two vehicles, of which contacts could be certified".into()));
    }
    // Discs of radius 0 would never overlap, wherever they are.
    if let Some(none) = head.vehicles.iter().find(|vehicle| vehicle.radius <= 0.0) {
        return Err(wrong(1, format!("a radius above 0 is expected, not {} of {}", none.radius, none.name)));
    }
    let mut tracks: Vec<Vec<[f64; 3]>> = vec![Vec::new(); head.vehicles.len()];
    let (mut end, mut count): (Option<End>, u64) = (None, 0);
    let mut sum = Hasher::new();
    sum.update(first.as_bytes());
    sum.update(b"\n");
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
        sum.update(text.as_bytes());
        sum.update(b"\n");
        let mut point = |text: &str| {
            let (vehicle, time, x, y): (usize, f64, f64, f64) =
                serde_json::from_str(text).map_err(|it| it.to_string())?;
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
        };
        point(&text).map_err(|why| wrong(line + 1, why))?;
    }
    let cut = match end {
        None => Some("the record is cut: its last line is missing".to_owned()),
        Some(end) if end.lines != count => Some(format!("the record is cut: it has {count} lines of {}", end.lines)),
        Some(End { crc32: Some(told), .. }) if told != sum.finalize() => {
            Some("the record is not as it was written: its checksum is another one".to_owned())
        }
        Some(_) => None,
    };
    if let Some(none) = tracks.iter().position(Vec::is_empty).filter(|_| cut.is_none()) {
        return Err(wrong(1, format!("nothing about {}", head.vehicles[none].name)));
    }
    let vehicles = head.vehicles.len();
    // In a record that was cut, some vehicles may have no line yet.
    let there = head.vehicles.into_iter().zip(tracks).filter(|(_, track)| !track.is_empty());
    let (there, tracks): (Vec<_>, Vec<_>) = there.unzip();
    Ok(Certificate { vehicles, ..checked(&there, &tracks, cut) })
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

fn checked(vehicles: &[Recorded], tracks: &[Vec<[f64; 3]>], error: Option<String>) -> Certificate {
    let mut times: Vec<f64> = tracks.iter().flatten().map(|point| point[0]).collect();
    times.sort_by(f64::total_cmp);
    let (begin, end) = (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(0.0));
    let legs = tracks.iter().flat_map(|track| track.windows(2));
    let travelled = legs.map(|leg| (leg[1][1] - leg[0][1]).hypot(leg[1][2] - leg[0][2])).sum();
    let (format, version) = ("pcr-contacts", 1);
    let (count, time) = (vehicles.len(), end - begin);
    let mut found = Certificate { format, version, vehicles: count, time, travelled, error, ..Certificate::default() };
    let far = |track: &Vec<[f64; 3]>| track.iter().flat_map(|[_, x, y]| [x.abs(), y.abs()]).fold(1.0, f64::max);
    let far: Vec<f64> = tracks.iter().map(far).collect();
    for [from, to] in windows(&times) {
        let movers = vehicles.iter().zip(tracks).zip(&far).enumerate();
        let movers = movers.map(|(id, ((vehicle, track), &far))| {
            Mover::new(&agent(id as u64, vehicle.radius, &within(track, from, to), far), [from, to])
        });
        match movers.collect::<Result<Vec<_>, _>>() {
            Ok(movers) => {
                let met = meetings(&movers);
                found.undecided += met.undecided.len();
                let name = |id: u64| vehicles.get(id as usize).map_or_else(String::new, |vehicle| vehicle.name.clone());
                found.contacts.extend(met.contacts.iter().map(|meeting| Contact {
                    vehicles: meeting.agents.map(name),
                    time: meeting.time,
                    clearance: meeting.clearance,
                }));
            }
            Err(why) => {
                found.error.get_or_insert(why);
            }
        }
    }
    found.verdict = match (found.contacts.is_empty(), found.undecided, &found.error) {
        (false, ..) => "contact",
        (true, 0, None) => "proved",
        _ => "undecided",
    };
    found
}

/// The windows from the first of these times to the last one, at most one a time: times are in order.
fn windows(times: &[f64]) -> Vec<[f64; 2]> {
    let (Some(&begin), Some(&end)) = (times.first(), times.last()) else { return Vec::new() };
    let (mut windows, mut from, mut next) = (Vec::new(), begin, 0);
    loop {
        next += times[next..].partition_point(|&time| time <= from);
        let to = times.get(next).map_or(end, |&time| time.max(from + WINDOW)).min(end);
        windows.push([from, to]);
        if to >= end {
            return windows;
        }
        from = to;
    }
}

/// The part of a track between two times.
fn within(track: &[[f64; 3]], from: f64, to: f64) -> Vec<[f64; 3]> {
    let at = |time: f64| {
        let next = track.partition_point(|point| point[0] <= time);
        match (next.checked_sub(1).and_then(|last| track.get(last)), track.get(next)) {
            (Some(a), Some(b)) => {
                let part = (time - a[0]) / (b[0] - a[0]);
                [time, a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])]
            }
            (Some(only), None) | (None, Some(only)) => [time, only[1], only[2]],
            (None, None) => [time, 0.0, 0.0],
        }
    };
    let [first, last] = [track.partition_point(|point| point[0] <= from), track.partition_point(|point| point[0] < to)];
    let inside = track.get(first..last).unwrap_or_default().iter().copied();
    std::iter::once(at(from)).chain(inside).chain(std::iter::once(at(to))).collect()
}

/// A disc that goes from point to point; `far` is the largest coordinate of those that they were taken from \[m\].
fn agent(id: u64, radius: f64, points: &[[f64; 3]], far: f64) -> Agent {
    let [first, last] = [points.first(), points.last()].map(|end| end.copied().unwrap_or_default());
    let (mut segments, mut phases): (Vec<Segment>, Vec<Phase>) = (Vec::new(), Vec::new());
    let (mut length, mut fastest, mut heading, mut initial) = (0.0, 0.0_f64, 0.0, None);
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let (time, way) = (b[0] - a[0], (b[1] - a[1]).hypot(b[2] - a[2]));
        if time <= 0.0 {
            continue;
        }
        if way > 0.0 {
            let direction = (b[2] - a[2]).atan2(b[1] - a[1]);
            let turn = direction - *initial.get_or_insert(direction) - heading;
            let turns = if turn == 0.0 { Vec::new() } else { vec![Angle::Radians(turn)] };
            heading += turn;
            segments.push(Segment { length: way, radius: None, turns, from: length, to: length + way });
        }
        let speed = way / time;
        fastest = fastest.max(speed);
        let [begin, end] = [a[0] - first[0], b[0] - first[0]];
        phases.push(Phase { time: [begin, end], length: [length, length + way], speed: [speed, speed] });
        length += way;
    }
    if segments.is_empty() {
        segments.push(Segment { length: 0.0, radius: None, turns: Vec::new(), from: 0.0, to: 0.0 });
        phases.clear();
    }
    // Each direction and each sum is rounded, along all of the way; and so are the coordinates and the times.
    let late = fastest * (last[0] - first[0]);
    let rounding = f64::EPSILON * (length + late + far) * (64.0 + 4.0 * segments.len() as f64);
    let start = [first[1], first[2]];
    let path = Path { start, heading: Angle::Radians(initial.unwrap_or(0.0)), segments, rounding, step: 0.0 };
    // Discs that are nearer than that are taken for discs that touch.
    let radius = radius + rounding;
    Agent { id, radius, path, travel: Some(Travel { start: first[0], phases, lag: 0.0, time_excess: 0.0 }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(apart: f64) -> String {
        let vehicles = ["a", "b"].map(|name| Recorded { name: name.into(), radius: 0.5 });
        let mut record = Record::new(Vec::new(), &vehicles).unwrap();
        // Past one another with a distance of `apart`, there and back.
        for k in 0..=600 {
            let time = f64::from(k) * 0.1;
            let x = if k <= 300 { time } else { 60.0 - time };
            record.push(0, time, [x, 0.0]).unwrap();
            record.push(1, time, [20.0 - x.min(20.0), apart]).unwrap();
        }
        String::from_utf8(record.finish().unwrap()).unwrap()
    }

    #[test]
    fn contacts_are_found_and_their_absence_is_proved() {
        let free = certify(record(1.001).as_bytes()).unwrap();
        assert_eq!((free.verdict, free.contacts.len(), free.undecided), ("proved", 0, 0), "{free:?}");
        assert!((free.travelled - 100.0).abs() < 1e-6 && (free.time - 60.0).abs() < 1e-9);
        let touched = certify(record(0.999).as_bytes()).unwrap();
        assert_eq!(touched.verdict, "contact");
        assert!(touched.contacts.len() >= 2 && touched.contacts[0].clearance < 0.0);
    }

    #[test]
    fn a_record_that_was_cut_proves_nothing() {
        let whole = record(1.001);
        let lines: Vec<&str> = whole.lines().collect();
        for kept in (3..lines.len()).step_by(97).chain([lines.len() - 1]) {
            let cut = certify(lines[..kept].join("\n").as_bytes()).unwrap();
            assert_eq!((cut.verdict, cut.contacts.len()), ("undecided", 0), "{kept} lines");
            assert_eq!(cut.error.unwrap(), "the record is cut: its last line is missing");
        }
        let mut gap = lines.clone();
        gap.drain(100..300);
        let gap = certify(gap.join("\n").as_bytes()).unwrap();
        assert_eq!(gap.verdict, "undecided");
        assert!(gap.error.unwrap().starts_with("the record is cut: it has "));
        let other = certify(whole.replacen("\"radius\":0.5", "\"radius\":0.4", 1).as_bytes()).unwrap();
        assert_eq!(other.error.unwrap(), "the record is not as it was written: its checksum is another one");
        assert_eq!(other.verdict, "undecided");
        // Records written by hand need no checksum.
        let end = whole.rfind(",\"crc32\"").unwrap();
        assert_eq!(certify(format!("{}}}", &whole[..end]).as_bytes()).unwrap().verdict, "proved");
        let twice = certify(format!("{whole}{whole}").as_bytes()).unwrap_err();
        assert_eq!(twice.to_string(), format!("line {}: it comes after the last line of a record", lines.len() + 1));
        // A contact is one, whatever comes after it.
        let touched = record(0.999);
        let most = touched.rsplit_once("\n{").unwrap().0;
        assert_eq!(certify(most.as_bytes()).unwrap().verdict, "contact");
    }

    /// Within a line it was refused as one that is no record.
    #[test]
    fn a_record_that_was_cut_at_any_byte_proves_nothing() {
        let whole = record(1.001);
        let head = whole.find('\n').unwrap() + 1;
        for end in
            (head..head + 200).chain((head + 200..whole.len()).step_by(1009)).chain(whole.len() - 40..whole.len() - 1)
        {
            let cut = certify(&whole.as_bytes()[..end]).unwrap();
            assert_eq!((cut.verdict, cut.contacts.len(), cut.vehicles), ("undecided", 0, 2), "{end}");
            assert_eq!(cut.error.unwrap(), "the record is cut: its last line is missing");
        }
        assert_eq!(certify(&whole.as_bytes()[..whole.len() - 1]).unwrap().verdict, "proved");
        // A contact that is in the record remains a contact.
        let touched = record(0.999);
        assert_eq!(certify(&touched.as_bytes()[..touched.len() - 50]).unwrap().verdict, "contact");
        // A record with further lines was not cut, nor one without the names of its vehicles.
        let broken = whole.replacen("]\n", "\n", 1);
        assert!(certify(broken.as_bytes()).unwrap_err().to_string().starts_with("line 2: "));
        assert!(certify(&whole.as_bytes()[..head - 5]).unwrap_err().to_string().starts_with("line 1: "));
    }

    /// With ways of 10 million kilometres, rounding would hide contacts of a millionth of a metre.
    #[test]
    fn what_rounding_would_hide_is_refused() {
        let record = |points: &str| {
            let head = r#"{"format":"pcr-record","version":2,"vehicles":[{"name":"a","radius":0.5},{"name":"b","radius":0.5}]}"#;
            let text = format!("{head}\n{points}\n{{\"lines\":{}}}", points.lines().count());
            certify(text.as_bytes())
        };
        let far = record("[0,0.0,0.0,0.0]\n[0,1.0,1e8,0.0]\n[1,0.0,0.0,5.0]").unwrap_err().to_string();
        assert_eq!(far, "line 3: coordinates up to 1e7 m are expected, not 1e8");
        let fast = record("[0,0.0,0.0,0.0]\n[0,1.0,5000.0,0.0]\n[1,0.0,0.0,5.0]").unwrap_err().to_string();
        assert_eq!(fast, "line 3: speeds up to 1e3 m/s are expected, not 5e3");
        let again = record("[0,0.0,0.0,0.0]\n[0,0.0,0.0,0.0]\n[1,0.0,0.0,5.0]").unwrap_err().to_string();
        assert_eq!(again, "line 3: not later than the line before of this vehicle");
        for (time, told) in [("1e300", "1e300"), ("-1e12", "-1e12"), ("10000000001.0", "1.0000000001e10")] {
            let late = record(&format!("[1,{time},0.0,5.0]\n[0,0.0,0.0,0.0]")).unwrap_err().to_string();
            assert_eq!(late, format!("line 2: times up to 1e10 s are expected, not {told}"));
        }
        // As far as is allowed, on ways with many turns, discs that overlap by less than a micrometre.
        for k in 0..50 {
            let (mut points, base) = (String::new(), 9.9e6);
            for step in 0..=200 {
                let (time, side) = (f64::from(step) * 0.1, f64::from((step * 7 + k) % 11) * 5.0);
                let last = step == 200;
                let [x, y] = if last { [base, -base] } else { [base - 60.0 + side, -base + 40.0 - side] };
                points += &format!("[0,{time:?},{x:?},{y:?}]\n");
            }
            points += &format!("[1,0.0,{:?},{:?}]", base + 1.0 - 1e-6, -base);
            assert_eq!(record(&points).unwrap().verdict, "contact", "{k}");
        }
    }

    /// From time to time a line, for three hundred years.
    #[test]
    fn times_without_lines_take_no_time() {
        let head =
            r#"{"format":"pcr-record","version":2,"vehicles":[{"name":"a","radius":0.5},{"name":"b","radius":0.5}]}"#;
        let found = |points: &str| {
            let text = format!("{head}\n{points}\n{{\"lines\":{}}}", points.lines().count());
            certify(text.as_bytes()).unwrap()
        };
        let free = found("[0,-1e10,0,0]\n[0,1e10,100,0]\n[1,0,50,1.001]");
        assert_eq!((free.verdict, free.time, free.travelled), ("proved", 2e10, 100.0), "{free:?}");
        let touched = found("[0,-1e10,0,0]\n[0,1e10,100,0]\n[1,0,50,0.999]");
        assert_eq!((touched.verdict, touched.undecided), ("contact", 0), "{touched:?}");
        // A second at full speed in between.
        let fast =
            |side: f64| format!("[0,0,0,0]\n[0,1e9,0,0]\n[0,1000000001,900,0]\n[0,1e10,900,0]\n[1,5e9,450,{side}]");
        assert_eq!(found(&fast(1.001)).verdict, "proved");
        let touched = found(&fast(0.999));
        assert_eq!((touched.verdict, touched.contacts.len()), ("contact", 1), "{touched:?}");
        assert!((touched.contacts[0].time - 1e9 - 0.5).abs() < 0.01, "{touched:?}");
    }

    #[test]
    fn windows_are_few_and_leave_nothing_out() {
        assert_eq!(windows(&[3.0]), [[3.0, 3.0]]);
        assert_eq!(windows(&[0.0, 1.0, 30.0, 40.0]), [[0.0, 20.0], [20.0, 40.0]]);
        assert_eq!(windows(&[0.0, 0.0, 1e9, 1e9 + 5.0]), [[0.0, 1e9], [1e9, 1e9 + 5.0]]);
        assert_eq!(windows(&[0.0, 10.0, 100.0]), [[0.0, 20.0], [20.0, 100.0]]);
    }

    #[test]
    fn what_is_no_record_is_refused() {
        let text = record(2.0);
        for (from, to) in [("pcr-record", "pcr-plan"), ("[1,", "[2,"), ("[0,0.1,", "[0,99.0,")] {
            assert!(certify(text.replacen(from, to, 1).as_bytes()).is_err(), "{to}");
        }
        for radius in ["0.0", "-0.0", "-0.5"] {
            let error =
                certify(text.replacen("\"radius\":0.5", &format!("\"radius\":{radius}"), 1).as_bytes()).unwrap_err();
            assert!(error.to_string().starts_with("line 1: a radius above 0 is expected"), "{error}");
        }
        let nobody = certify(&br#"{"format":"pcr-record","version":2,"vehicles":[]}"#[..]).unwrap_err();
        assert_eq!(nobody.to_string(), "line 1: no vehicles");
        let one = "{\"format\":\"pcr-record\",\"version\":2,\"vehicles\":[{\"name\":\"a\",\"radius\":0.5}]}\n[0,0,0,0]\n{\"lines\":1}";
        let alone = certify(one.as_bytes()).unwrap_err();
        assert_eq!(alone.to_string(), "line 1: there are no two vehicles, of which contacts could be certified");
        assert!(certify(&b""[..]).is_err());
        let nowhere = certify(format!("{}\n{{\"lines\":0}}", text.lines().next().unwrap()).as_bytes()).unwrap_err();
        assert_eq!(nowhere.to_string(), "line 1: nothing about a");
    }
}
