//! Tables of poses: a header, and a line `id,t,x,y` for each pose, with further columns `theta`, `radius`, `map`.

use super::super::json_access::is_open;
use super::super::{ImportError, WarningCode, Warnings};
use super::pose_log::{PoseLogBuilder, PoseTime, RawPose};
use crate::scenario::LIMIT;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PoseColumn {
    Id,
    Time,
    X,
    Y,
    Heading,
    Radius,
    Map,
    Other,
}

impl PoseColumn {
    fn of(name: &str) -> Self {
        match name.trim().to_ascii_lowercase().as_str() {
            "id" | "agent" | "robot" | "name" => Self::Id,
            "t" | "time" | "timestamp" => Self::Time,
            "x" => Self::X,
            "y" => Self::Y,
            "theta" | "yaw" | "heading" => Self::Heading,
            "radius" => Self::Radius,
            "map" => Self::Map,
            _ => Self::Other,
        }
    }
}

/// Columns that are there.
const NEEDED: [PoseColumn; 4] = [PoseColumn::Id, PoseColumn::Time, PoseColumn::X, PoseColumn::Y];

/// Whether a line is the header of such a table.
pub(super) fn is_header(line: &str) -> bool {
    let columns: Vec<PoseColumn> = line.split(',').map(PoseColumn::of).collect();
    NEEDED.iter().all(|needed| columns.contains(needed))
}

/// Reads the poses in a table.
pub(super) fn read(text: &str, log: &mut PoseLogBuilder<'_>, warnings: &mut Warnings) -> Result<(), ImportError> {
    if is_open(text) {
        let problem = "it does not end; if the file was cut there, digits may be missing";
        warnings.add(WarningCode::MayBeCut, "last line", problem);
    }
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line));
    let mut lines = lines.by_ref().filter(|(_, line)| !line.trim().is_empty());
    let Some((first, header)) = lines.next() else { return Err(ImportError::new("empty")) };
    let columns: Vec<PoseColumn> = header.split(',').map(PoseColumn::of).collect();
    for (k, (column, name)) in columns.iter().zip(header.split(',')).enumerate() {
        if *column == PoseColumn::Other {
            warnings.add(WarningCode::UnknownKey, format_args!("column {}", name.trim()), "not known, and not read");
        } else if columns.get(..k).is_some_and(|before| before.contains(column)) {
            return Err(ImportError::at(first, None, format!("column {}: there are two of it", name.trim())));
        }
    }
    let mut are_stamps = None;
    for (number, line) in lines {
        read_row(&columns, line, number, &mut are_stamps, log)?;
    }
    Ok(())
}

fn read_row(
    columns: &[PoseColumn],
    line: &str,
    number: usize,
    are_stamps: &mut Option<bool>,
    log: &mut PoseLogBuilder<'_>,
) -> Result<(), ImportError> {
    let mut at = 0;
    let mut fields = Vec::with_capacity(columns.len());
    for field in line.split(',') {
        fields.push((field.trim(), at + field.len() - field.trim_start().len()));
        at += field.len() + 1;
    }
    let place = |byte: usize| line.get(..byte).map(|before| before.chars().count() + 1);
    if fields.len() != columns.len() {
        let problem = format!("{} fields, and the header has {}", fields.len(), columns.len());
        return Err(ImportError::at(number, Some(line.chars().count() + 1), problem));
    }
    let field = |column: PoseColumn| {
        columns.iter().position(|other| *other == column).and_then(|k| fields.get(k)).copied().unwrap_or(("", 0))
    };
    let wrong = |(text, byte): (&str, usize), expected: &str| {
        ImportError::at(number, place(byte), format!("{text:?} where {expected} is expected"))
    };
    let value = |column: PoseColumn| {
        let (text, byte) = field(column);
        let value = text.parse::<f64>().ok().filter(|value| value.abs() <= LIMIT);
        value.ok_or_else(|| wrong((text, byte), "a number"))
    };
    let id = field(PoseColumn::Id);
    if id.0.is_empty() || id.0.contains('"') {
        return Err(wrong(id, "a name without quotes"));
    }
    let (text, byte) = field(PoseColumn::Time);
    let time = PoseTime::number(text).or_else(|| PoseTime::stamp(text));
    let time = time.ok_or_else(|| wrong((text, byte), "seconds or a time stamp"))?;
    if *are_stamps.get_or_insert(time.is_stamp()) != time.is_stamp() {
        return Err(ImportError::at(number, place(byte), "seconds among time stamps, or the other way round"));
    }
    let point = [value(PoseColumn::X)?, value(PoseColumn::Y)?];
    let heading = columns.contains(&PoseColumn::Heading).then(|| value(PoseColumn::Heading)).transpose()?;
    let agent = log.agent(id.0);
    if columns.contains(&PoseColumn::Radius) {
        let (text, byte) = field(PoseColumn::Radius);
        let radius = value(PoseColumn::Radius)?;
        if radius <= 0.0 {
            return Err(wrong((text, byte), "a number above 0"));
        }
        log.set_radius(agent, radius).map_err(|before| {
            let problem = format!("{}: radius {radius}, and {before} before", log.name(agent));
            ImportError::at(number, place(byte), problem)
        })?;
    }
    let map = log.map(field(PoseColumn::Map).0);
    log.add(agent, RawPose { time, point, heading, error: 0.0, map, is_joined: true, place: (number, Some(1)) })
}
