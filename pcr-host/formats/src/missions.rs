//! Missions of one's own: files of vehicles, missions, closures and breakdowns, as JSON Lines or CSV.
//!
//! Each line is one record, whose `kind` says what it is. A CSV file has the names of the fields in its first line; an empty cell is a
//! field that is left out, and lists have `;` between their elements. Names are those of a layout, so whatever does not exist there is
//! an error with its line and column.

mod records;
mod site_changes;

pub use site_changes::{Breakdown, ClosedElement, Closure, SiteChanges};

use crate::footprint::Footprint;
use crate::import::{Layout, SizeSource, VehicleTraits};
use crate::json::Position;
use records::Record;
use site_changes::vehicle;
use std::fmt;

/// Latest time in a file \[s\].
const LATEST: f64 = 1e7;

/// Largest size, speed or acceleration.
const LARGEST: f64 = 1e6;

/// What a record is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordKind {
    /// A vehicle of the fleet.
    Vehicle,
    /// A mission.
    Mission,
    /// An edge, a node or a zone that is closed for some time, or where vehicles are slower.
    Closure,
    /// A vehicle that stands still from a time on.
    Breakdown,
}

impl RecordKind {
    const ALL: [(Self, &'static str); 4] = [
        (Self::Vehicle, "vehicle"),
        (Self::Mission, "mission"),
        (Self::Closure, "closure"),
        (Self::Breakdown, "breakdown"),
    ];

    fn fields(self) -> &'static [&'static str] {
        match self {
            Self::Vehicle => &[
                "kind",
                "id",
                "start",
                "radius",
                "length",
                "width",
                "footprint",
                "margin",
                "speed",
                "acceleration",
                "rotation",
                "rotation_acceleration",
                "forbidden",
            ],
            Self::Mission => &["kind", "id", "from", "via", "to", "release", "due", "priority", "vehicle"],
            Self::Closure => &["kind", "edge", "node", "zone", "speed", "at", "until"],
            Self::Breakdown => &["kind", "vehicle", "at", "until"],
        }
    }

    fn name(self) -> &'static str {
        Self::ALL.iter().find(|kind| kind.0 == self).map_or("", |kind| kind.1)
    }
}

/// A vehicle of a fleet.
#[derive(Clone, Debug, PartialEq)]
pub struct FleetVehicle {
    /// Its name.
    pub id: String,
    /// Index of the node of the layout where it stands at the beginning.
    pub start: usize,
    /// Its size and limits.
    pub traits: VehicleTraits,
    /// Indices of edges of the layout that it must not use.
    pub forbidden: Vec<usize>,
}

/// A mission.
#[derive(Clone, Debug, PartialEq)]
pub struct MissionRequest {
    /// Its name.
    pub id: String,
    /// Nodes of the layout to visit, in this order; the last one is the goal.
    pub stops: Vec<usize>,
    /// Whether the first of these is where it begins (`from`).
    pub has_origin: bool,
    /// Time from which on it may begin \[s\].
    pub release: f64,
    /// Time at which it ought to be done \[s\].
    pub due: Option<f64>,
    /// Missions of a higher priority go first.
    pub priority: i64,
    /// Index of its vehicle; `None`: any.
    pub vehicle: Option<usize>,
}

/// A fleet and its missions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FleetMissions {
    /// The vehicles.
    pub vehicles: Vec<FleetVehicle>,
    /// The missions, in the order of the files.
    pub missions: Vec<MissionRequest>,
    /// What changes while they drive.
    pub changes: SiteChanges,
}

/// Why a file of missions is refused.
#[derive(Clone, Debug, PartialEq)]
pub struct MissionFileError {
    /// Where in its text.
    pub position: Position,
    /// What is wrong there.
    pub problem: String,
}

impl fmt::Display for MissionFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.position.line, self.position.column, self.problem)
    }
}

impl std::error::Error for MissionFileError {}

/// A file of a fleet, and what its records are if they do not say it.
#[derive(Clone, Copy, Debug)]
pub struct MissionSource<'t> {
    /// The text.
    pub text: &'t str,
    /// Kind of a record without `kind`.
    pub kind: RecordKind,
}

impl FleetMissions {
    /// Reads the files of a fleet on a layout. What a vehicle does not say is as in `vehicle`.
    ///
    /// # Errors
    /// The index of a file, and what is wrong in it: a syntax error, an unknown key or name, a value out of range, a missing field,
    /// a name given twice.
    pub fn read(
        sources: &[MissionSource<'_>],
        layout: &Layout,
        vehicle: &VehicleTraits,
    ) -> Result<Self, (usize, MissionFileError)> {
        let all = all_records(sources)?;
        let mut fleet = Self::default();
        // Vehicles first: the others name them.
        for (file, kind, record) in &all {
            if *kind == RecordKind::Vehicle {
                fleet.add_vehicle(record, layout, vehicle).map_err(|error| (*file, error))?;
            }
        }
        let names: Vec<String> = fleet.vehicles.iter().map(|vehicle| vehicle.id.clone()).collect();
        for (file, kind, record) in &all {
            let added = match kind {
                RecordKind::Vehicle => Ok(()),
                RecordKind::Mission => fleet.add_mission(record, layout, &names),
                RecordKind::Closure | RecordKind::Breakdown => fleet.changes.add(*kind, record, layout, &names),
            };
            added.map_err(|error| (*file, error))?;
        }
        Ok(fleet)
    }

    fn add_vehicle(
        &mut self,
        record: &Record<'_>,
        layout: &Layout,
        usual: &VehicleTraits,
    ) -> Result<(), MissionFileError> {
        let id = record.name("id")?;
        if self.vehicles.iter().any(|other| other.id == id) {
            return Err(record.wrong("id", format!("there is a vehicle {id} already")));
        }
        let start = record.required("start")?;
        let start = node(layout, &start)?;
        let mut traits = usual.clone();
        let size = |name: &str| record.number(name, 1e-6, LARGEST);
        let [radius, length, width] = [size("radius")?, size("length")?, size("width")?];
        let polygon = record.polygon("footprint")?;
        let given = [radius.is_some(), length.is_some() || width.is_some(), polygon.is_some()];
        if given.iter().filter(|&&is_given| is_given).count() > 1 {
            let problem = "there is a radius, a length and a width, or a footprint; give one of them";
            return Err(MissionFileError { position: record.position, problem: problem.into() });
        }
        if given.contains(&true) {
            traits.size = SizeSource::File;
        }
        if let Some(radius) = radius {
            (traits.radius, traits.footprint) = (radius, None);
        }
        let rectangle = match (length, width) {
            (Some(length), Some(width)) => {
                let [ahead, left] = [0.5 * length, 0.5 * width];
                Some(("length", vec![[-ahead, -left], [ahead, -left], [ahead, left], [-ahead, left]]))
            }
            (None, None) => None,
            (Some(_), None) => return Err(record.wrong("length", "a length needs a width".into())),
            (None, Some(_)) => return Err(record.wrong("width", "a width needs a length".into())),
        };
        if let Some((field, corners)) = rectangle.or(polygon.map(|corners| ("footprint", corners))) {
            let footprint = Footprint::new(corners).map_err(|problem| record.wrong(field, problem.to_string()))?;
            (traits.radius, traits.footprint) = (footprint.circumscribed_radius(), Some(footprint));
        }
        traits.margin = record.number("margin", 0.0, LARGEST)?.unwrap_or(traits.margin);
        traits.speed = size("speed")?.unwrap_or(traits.speed);
        traits.acceleration = size("acceleration")?.unwrap_or(traits.acceleration);
        traits.rotation = size("rotation")?.unwrap_or(traits.rotation);
        traits.rotation_acceleration = size("rotation_acceleration")?.unwrap_or(traits.rotation_acceleration);
        let forbidden = record.list("forbidden")?;
        let forbidden = forbidden.iter().map(|name| edge(layout, name)).collect::<Result<_, _>>()?;
        self.vehicles.push(FleetVehicle { id, start, traits, forbidden });
        Ok(())
    }

    fn add_mission(
        &mut self,
        record: &Record<'_>,
        layout: &Layout,
        vehicles: &[String],
    ) -> Result<(), MissionFileError> {
        let id = record.name("id")?;
        if self.missions.iter().any(|other| other.id == id) {
            return Err(record.wrong("id", format!("there is a mission {id} already")));
        }
        let from = record.text("from")?;
        let (via, to) = (record.list("via")?, record.required("to")?);
        let stops = from.iter().chain(&via).chain([&to]);
        let stops = stops.map(|name| node(layout, name)).collect::<Result<_, _>>()?;
        let release = record.number("release", 0.0, LATEST)?.unwrap_or(0.0);
        let due = record.number("due", 0.0, LATEST)?;
        if due.is_some_and(|due| due < release) {
            return Err(record.wrong("due", "it is due before it is released".into()));
        }
        let priority = record.integer("priority")?.unwrap_or(0);
        let vehicle = record.text("vehicle")?.map(|name| vehicle(vehicles, &name)).transpose()?;
        self.missions.push(MissionRequest { id, stops, has_origin: from.is_some(), release, due, priority, vehicle });
        Ok(())
    }
}

/// The kind of a record.
fn kind_of(record: &Record<'_>, usual: RecordKind) -> Result<RecordKind, MissionFileError> {
    let Some((name, position)) = record.text("kind")? else { return Ok(usual) };
    let found = RecordKind::ALL.iter().find(|kind| kind.1 == name).map(|kind| kind.0);
    let problem = || format!("the kind {name} is none of vehicle, mission, closure and breakdown");
    found.ok_or_else(|| MissionFileError { position, problem: problem() })
}

/// The index of a file, and a record of it with its kind.
type FileRecord<'t> = (usize, RecordKind, Record<'t>);

/// The records of some files, each with the index of its file.
fn all_records<'t>(sources: &[MissionSource<'t>]) -> Result<Vec<FileRecord<'t>>, (usize, MissionFileError)> {
    let mut all = Vec::new();
    for (file, source) in sources.iter().enumerate() {
        let records = records::parse(source.text).map_err(|error| (file, error))?;
        for record in records {
            let kind = kind_of(&record, source.kind).map_err(|error| (file, error))?;
            record.refuse_unknown(kind.fields(), kind.name()).map_err(|error| (file, error))?;
            all.push((file, kind, record));
        }
    }
    Ok(all)
}

/// A name in a file, and where it is.
type PlacedName = (String, Position);

/// The node of a name, which has to be on the level of the fleet.
fn node(layout: &Layout, (name, position): &PlacedName) -> Result<usize, MissionFileError> {
    let wrong = |problem: String| MissionFileError { position: *position, problem };
    match layout.nodes_called(name)[..] {
        [only] if layout.level_of(only) == layout.largest_level() => Ok(only),
        [only] => {
            let level = |level: usize| layout.levels.get(level).map_or("", String::as_str).to_owned();
            let [its, fleet] = [level(layout.level_of(only)), level(layout.largest_level())];
            Err(wrong(format!("node {name} is on level {its}; missions are on level {fleet}, which has most nodes")))
        }
        [] => Err(wrong(format!("there is no node {name} in the layout"))),
        ref several => Err(wrong(format!("{} nodes have the name {name}; give an id", several.len()))),
    }
}

/// The edge of a name.
fn edge(layout: &Layout, (name, position): &PlacedName) -> Result<usize, MissionFileError> {
    let found = layout.edges.iter().position(|edge| edge.id.to_string() == *name);
    let problem = || format!("there is no edge {name} in the layout");
    found.ok_or_else(|| MissionFileError { position: *position, problem: problem() })
}
