//! Fleets and tables that the benchmarks share.

use pcr_core::{Aabb, Ecm, EcmEntry, Motion, Piece, Scalar};
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::{Fleet, HostScalar, build_ecm};
use std::path::Path;

/// A fleet of the test data, by the name of its file.
///
/// # Panics
/// If the file is not there or is refused.
pub fn fleet<S: HostScalar>(name: &str) -> Fleet<S> {
    from_json(&text(name))
}

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data").join(name).with_extension("json");
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// 100 agents on lanes that cross, 50 to the east and 50 to the north, so many times, out of reach of each other: all start
/// and end beside the lanes of the others, so that start delays solve it.
///
/// # Panics
/// Never: the scenario is valid.
pub fn lanes(blocks: u32) -> Fleet<f64> {
    let agents = (0..100 * blocks).map(|id| {
        let (block, lane) = (f64::from(id / 100), f64::from(id % 50));
        let (along, across) = (200.0 * block - 1.0, 0.8 * lane);
        let (x, y, heading) =
            if id % 100 < 50 { (along, across, 0.0) } else { (along + 1.0 + across, -1.0, std::f64::consts::FRAC_PI_2) };
        format!(
            r#"{{"id":{id},"radius":0.11,"v_max":0.58,"a_max":0.3,"start":{{"x":{x},"y":{y},"heading":{heading}}},"path":[{{"kind":"line","length":42}}]}}"#
        )
    });
    from_json(&format!(r#"{{"agents":[{}]}}"#, agents.collect::<Vec<_>>().join(",")))
}

/// A fleet from a scenario.
///
/// # Panics
/// If it is refused.
pub fn from_json<S: HostScalar>(json: &str) -> Fleet<S> {
    Fleet::new(&scenario(json)).unwrap_or_else(|error| panic!("{error}"))
}

fn scenario(json: &str) -> Scenario {
    Scenario::from_json(json).unwrap_or_else(|error| panic!("{error}"))
}

/// `columns` by `columns` agents on short lines so far apart that none can meet another.
///
/// # Panics
/// Never: the scenario is valid.
pub fn scattered<S: HostScalar>(columns: u32) -> Fleet<S> {
    let agents = (0..columns * columns).map(|k| {
        let (x, y) = (10 * (k % columns), 10 * (k / columns));
        format!(
            r#"{{"id":{k},"radius":0.2,"v_max":1,"a_max":1,"start":{{"x":{x},"y":{y},"heading":0.5}},"path":[{{"kind":"line","length":3}}]}}"#
        )
    });
    from_json(&format!(r#"{{"agents":[{}]}}"#, agents.collect::<Vec<_>>().join(",")))
}

/// A path of 4000 lines and half circles, to and fro, and one straight path that crosses each line.
///
/// # Panics
/// Never: the scenario is valid.
pub fn serpentine() -> Fleet<f64> {
    let bends = (0..2000).map(|k| {
        let sweep = if k % 2 == 0 { -std::f64::consts::PI } else { std::f64::consts::PI };
        format!(r#"{{"kind":"line","length":10}},{{"kind":"arc","radius":0.5,"sweep":{sweep}}}"#)
    });
    let up = std::f64::consts::FRAC_PI_2;
    from_json(&format!(
        r#"{{"agents":[
            {{"id":1,"radius":0.1,"v_max":1,"a_max":1,"start":{{"x":0,"y":-5,"heading":{up}}},"path":[{}]}},
            {{"id":2,"radius":0.1,"v_max":1,"a_max":1,"start":{{"x":-1,"y":0,"heading":0}},"path":[{{"kind":"line","length":2002}}]}}]}}"#,
        bends.collect::<Vec<_>>().join(",")
    ))
}

/// Room for a broad phase of 16 parts.
pub fn boxes<S: Scalar>(fleet: &[Motion<'_, S>]) -> Vec<Aabb<S>> {
    vec![Aabb::default(); fleet.len() * (1 + 16)]
}

/// Storage that holds exactly the table of a fleet.
#[derive(Clone, Debug)]
pub struct Storage<S: Scalar> {
    /// Entries.
    pub regions: Vec<EcmEntry>,
    /// Pieces.
    pub pieces: Vec<Piece<S>>,
}

impl<S: HostScalar> Storage<S> {
    /// As large as the table of this fleet.
    ///
    /// # Panics
    /// If the fleet has more than 65536 agents.
    pub fn of(fleet: &[Motion<'_, S>]) -> Self {
        let ecm = build_ecm(fleet).unwrap_or_else(|full| panic!("{full}"));
        Self { regions: vec![EcmEntry::EMPTY; ecm.len()], pieces: vec![Piece::EMPTY; ecm.pieces()] }
    }

    /// The table of the fleet, in this storage.
    ///
    /// # Panics
    /// If the storage is that of a smaller table.
    pub fn table(&mut self, fleet: &[Motion<'_, S>]) -> Ecm<S, &mut [EcmEntry], &mut [Piece<S>]> {
        Ecm::build(&mut self.regions[..], &mut self.pieces[..], fleet).unwrap_or_else(|full| panic!("{full}"))
    }
}
