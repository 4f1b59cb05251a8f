//! Changes of a site while vehicles drive: closures and breakdowns.

use super::records::Record;
use super::{LARGEST, LATEST, MissionFileError, MissionSource, PlacedName, RecordKind, all_records, edge, node};
use crate::import::Layout;

/// Least speed to which a closure may limit vehicles \[m/s\].
const SLOWEST: f64 = 1e-3;

/// The element of a layout that is closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClosedElement {
    /// An edge of the layout, by its index: nobody enters it, in either direction.
    Edge(usize),
    /// A node of the layout, by its index: nobody comes to it.
    Node(usize),
    /// A zone of the layout, by its index: all its edges and nodes.
    Zone(usize),
}

/// An edge, a node or a zone that is closed for some time, or where vehicles are slower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closure {
    /// What is closed.
    pub element: ClosedElement,
    /// The largest speed there \[m/s\], if it is open and limited; `None`: nobody may enter.
    pub speed: Option<f64>,
    /// Time from which on it is closed \[s\].
    pub at: f64,
    /// Time until which it is closed \[s\]; `None`: for ever.
    pub until: Option<f64>,
}

/// A vehicle that stands still from a time on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Breakdown {
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Time at which it begins to brake \[s\].
    pub at: f64,
    /// Time at which it can drive again \[s\]; `None`: never.
    pub until: Option<f64>,
}

/// What changes on a site.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SiteChanges {
    /// The closures, in the order of the files.
    pub closures: Vec<Closure>,
    /// The breakdowns, in the order of the files.
    pub breakdowns: Vec<Breakdown>,
}

impl SiteChanges {
    /// Reads files of closures and breakdowns on a layout, of vehicles with these names.
    ///
    /// # Errors
    /// Those of [`FleetMissions::read`](super::FleetMissions::read), and a vehicle or a mission.
    pub fn read(
        sources: &[MissionSource<'_>],
        layout: &Layout,
        vehicles: &[String],
    ) -> Result<Self, (usize, MissionFileError)> {
        let mut changes = Self::default();
        for (file, kind, record) in all_records(sources)? {
            changes.add(kind, &record, layout, vehicles).map_err(|error| (file, error))?;
        }
        Ok(changes)
    }

    /// Whether nothing changes.
    pub fn is_empty(&self) -> bool {
        self.closures.is_empty() && self.breakdowns.is_empty()
    }

    /// Adds what a record says.
    pub(super) fn add(
        &mut self,
        kind: RecordKind,
        record: &Record<'_>,
        layout: &Layout,
        vehicles: &[String],
    ) -> Result<(), MissionFileError> {
        match kind {
            RecordKind::Closure => self.closures.push(closure(record, layout)?),
            RecordKind::Breakdown => {
                let vehicle = vehicle(vehicles, &record.required("vehicle")?)?;
                let (at, until) = times(record)?;
                self.breakdowns.push(Breakdown { vehicle, at, until });
            }
            RecordKind::Vehicle | RecordKind::Mission => {
                let problem = format!("a {}; only closures and breakdowns are read here", kind.name());
                return Err(MissionFileError { position: record.position, problem });
            }
        }
        Ok(())
    }
}

fn closure(record: &Record<'_>, layout: &Layout) -> Result<Closure, MissionFileError> {
    let element = match (record.text("edge")?, record.text("node")?, record.text("zone")?) {
        (Some(name), None, None) => ClosedElement::Edge(edge(layout, &name)?),
        (None, Some(name), None) => ClosedElement::Node(node(layout, &name)?),
        (None, None, Some(name)) => ClosedElement::Zone(zone(layout, &name)?),
        _ => {
            let problem = "a closure is of an edge, of a node or of a zone";
            return Err(MissionFileError { position: record.position, problem: problem.into() });
        }
    };
    let speed = record.number("speed", SLOWEST, LARGEST)?;
    let has_edges = match element {
        ClosedElement::Edge(_) => true,
        ClosedElement::Node(_) => false,
        ClosedElement::Zone(zone) => !layout.zones[zone].edges.is_empty(),
    };
    if speed.is_some() && !has_edges {
        return Err(record.wrong("speed", "a limit is of an edge, or of a zone with edges".into()));
    }
    let (at, until) = times(record)?;
    Ok(Closure { element, speed, at, until })
}

/// The zone of a name, some of which has to be on the level of the fleet.
fn zone(layout: &Layout, (name, position): &PlacedName) -> Result<usize, MissionFileError> {
    let wrong = |problem: String| MissionFileError { position: *position, problem };
    let found = layout.zones.iter().position(|zone| zone.id == *name);
    let place = found.ok_or_else(|| {
        wrong(format!(
            "there is no zone {name} in the layout; zones are blocks of openTCS and mutex groups of Open-RMF"
        ))
    })?;
    let zone = &layout.zones[place];
    let level = layout.largest_level();
    let is_there = zone.nodes.iter().any(|&node| layout.level_of(node) == level)
        || zone.edges.iter().any(|&edge| layout.is_on(&layout.edges[edge], level));
    is_there.then_some(place).ok_or_else(|| wrong(format!("nothing of zone {name} is on the level of the missions")))
}

/// The times of a closure or breakdown.
fn times(record: &Record<'_>) -> Result<(f64, Option<f64>), MissionFileError> {
    let at = record.number("at", 0.0, LATEST)?;
    let at = at.ok_or_else(|| record.missing("at"))?;
    let until = record.number("until", 0.0, LATEST)?;
    if until.is_some_and(|until| until <= at) {
        return Err(record.wrong("until", "it ends before it begins".into()));
    }
    Ok((at, until))
}

/// The vehicle of a name.
pub(super) fn vehicle(vehicles: &[String], (name, position): &PlacedName) -> Result<usize, MissionFileError> {
    let found = vehicles.iter().position(|vehicle| vehicle == name);
    found.ok_or_else(|| MissionFileError { position: *position, problem: format!("there is no vehicle {name}") })
}
