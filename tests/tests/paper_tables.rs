//! Tables V, VI and VII of the paper, from the scenarios that were rebuilt from them.
//!
//! The paper prints no coordinates. `data/paper12.json` is one scenario of 12 agents for which everything in Tables V
//! and VII comes out as printed (`docs/theory/equations.md#table-vii` tells how it was found and which sign in row 17 is a
//! misprint); `data/table6-*.json` do the same for the rows of Table VI.
//!
//! The paper counts *crossings* of paths, each once for either agent. The library finds *connected regions*: paths
//! that only come near each other have one as well (paper Fig. 14a), and two crossings may share one (Fig. 14b).

use pcr_core::{Crossing, Curve, Motion, PieceType, Radians, TurnSide, crossings};
use pcr_formats::scenario::{MotionSpec, Scenario};
use pcr_planning::fleet::{Fleet, build_ecm};

/// Sums of radii such as 0.13 + 0.22 are ties of the decimal rounding but not of the binary one \[1e-1 units\].
const TIE: f64 = 1e-9;

/// A value as the tables print it, in tenths: rounded to nearest, halves up.
fn tenths(value: f64) -> i64 {
    (10.0 * value + 0.5 + TIE).floor() as i64
}

fn load(name: &str) -> (Scenario, Fleet<f64>) {
    let path = format!("{}/data/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect(&path);
    let scenario = Scenario::from_json(&text).expect("a valid scenario");
    let fleet = Fleet::new(&scenario).expect("a valid fleet");
    (scenario, fleet)
}

/// Crossings of every ordered pair of agents: `[ego][other]`.
fn crossing_counts(motions: &[Motion<'_, f64>]) -> Vec<Vec<usize>> {
    let count = |ego: usize, other: usize| match ego == other {
        true => 0,
        false => crossings(&motions[ego], &motions[other]).count(),
    };
    (0..motions.len()).map(|ego| (0..motions.len()).map(|other| count(ego, other)).collect()).collect()
}

/// Connected regions of every ordered pair of agents: `[ego][other]`.
fn region_counts(motions: &[Motion<'_, f64>]) -> Vec<Vec<usize>> {
    let ecm = build_ecm(motions).expect("a fleet of less than 65536 agents");
    let mut counts = vec![vec![0; motions.len()]; motions.len()];
    for region in ecm.regions(motions).expect("the table of the fleet") {
        counts[region.ego()][region.other()] += 1;
    }
    counts
}

fn sum(counts: &[Vec<usize>]) -> usize {
    counts.iter().flatten().sum()
}

/// Ordered pairs `(ego, other)` of agent numbers (from 1) whose counts differ, with crossings and regions.
fn differences(crossings: &[Vec<usize>], regions: &[Vec<usize>]) -> Vec<(usize, usize, usize, usize)> {
    let pairs = (0..crossings.len()).flat_map(|ego| (0..crossings.len()).map(move |other| (ego, other)));
    let counts = pairs.map(|(ego, other)| (ego + 1, other + 1, crossings[ego][other], regions[ego][other]));
    counts.filter(|&(_, _, crossings, regions)| crossings != regions).collect()
}

/// Table V: radius \[m\], largest speed \[m/s\], path structure, number of crossings.
const TABLE_V: [(f64, f64, &str, usize); 12] = [
    (0.11, 0.58, "SAS", 14),
    (0.12, 0.56, "SASA", 10),
    (0.13, 0.54, "SAS", 18),
    (0.14, 0.52, "AS", 9),
    (0.15, 0.50, "SAS", 15),
    (0.16, 0.48, "A", 10),
    (0.17, 0.46, "AAA", 8),
    (0.18, 0.44, "A", 6),
    (0.19, 0.42, "SASAS", 12),
    (0.20, 0.40, "AAS", 9),
    (0.21, 0.38, "SASAS", 10),
    (0.22, 0.36, "SAS", 5),
];

/// Largest acceleration of every agent in Table V \[m/s²\].
const TABLE_V_ACCELERATION: f64 = 0.30;

#[test]
fn table_v_radii_limits_and_path_structures() {
    let (scenario, _) = load("paper12");
    assert_eq!(scenario.agents.len(), TABLE_V.len());
    for ((number, agent), (radius, speed, structure, _)) in (1..).zip(&scenario.agents).zip(TABLE_V) {
        assert_eq!(agent.id, number);
        assert_eq!(agent.radius, radius, "agent {number}");
        assert_eq!(agent.structure(), structure, "agent {number}");
        assert_eq!(
            agent.motion,
            MotionSpec::RestToRest { v_max: speed, a_max: TABLE_V_ACCELERATION },
            "agent {number}"
        );
    }
}

#[test]
fn table_v_counts_crossings_per_agent() {
    let (_, fleet) = load("paper12");
    let counts = crossing_counts(&fleet.motions());
    let per_agent: Vec<usize> = counts.iter().map(|row| row.iter().sum()).collect();
    assert_eq!(per_agent, TABLE_V.map(|(.., count)| count));
    assert_eq!(sum(&counts), 126);
}

#[test]
fn paper12_has_136_connected_regions_and_every_difference_to_126_has_its_reason() {
    let (_, fleet) = load("paper12");
    let motions = fleet.motions();
    let (crossings, regions) = (crossing_counts(&motions), region_counts(&motions));
    assert_eq!(sum(&regions), 136);
    // (a, b, crossings, regions): Fig. 14a, paths that come near each other without (another) crossing, ...
    let near =
        [(4, 12, 0, 1), (5, 10, 1, 2), (6, 12, 0, 1), (7, 11, 0, 1), (9, 10, 0, 1), (9, 11, 0, 1), (10, 11, 0, 1)];
    // ... and Fig. 14b, two crossings in one region.
    let merged = [(6, 11, 2, 1), (7, 10, 2, 1)];
    let either_way = near.into_iter().chain(merged).flat_map(|(a, b, c, r)| [(a, b, c, r), (b, a, c, r)]);
    let mut expected: Vec<_> = either_way.collect();
    expected.sort();
    assert_eq!(differences(&crossings, &regions), expected);
}

#[test]
fn every_crossing_of_paper12_lies_in_exactly_one_region() {
    let (_, fleet) = load("paper12");
    let motions = fleet.motions();
    let ecm = build_ecm(&motions).expect("a small fleet");
    for (ego, other) in (0..12).flat_map(|ego| (0..12).map(move |other| (ego, other))).filter(|(a, b)| a != b) {
        for crossing in crossings(&motions[ego], &motions[other]) {
            let holding = ecm.pair(&motions, ego, other).expect("the table of the fleet");
            let holding = holding.filter(|region| region.contains(crossing.time, crossing.length)).count();
            assert_eq!(holding, 1, "agents {} and {}: {crossing:?}", ego + 1, other + 1);
        }
    }
}

/// A row of Table VII as printed: type, other agent, k, and the numbers in tenths.
struct Row {
    piece_type: PieceType,
    other: usize,
    k: usize,
    time: i64,
    length: i64,
    combined_radius: i64,
    speed: i64,
    theta: i64,
    /// ς₃ and, where the other is on an arc, (ς_j, dir).
    own_radius: Option<i64>,
    other_arc: Option<(i64, i64)>,
}

/// The columns before the radii: type, j, k, T, L, r̂, v, θ.
type Columns = (PieceType, usize, usize, i64, i64, i64, i64, i64);

fn row(columns: Columns, own_radius: Option<i64>, other_arc: Option<(i64, i64)>) -> Row {
    let (piece_type, other, k, time, length, combined_radius, speed, theta) = columns;
    Row { piece_type, other, k, time, length, combined_radius, speed, theta, own_radius, other_arc }
}

/// Table VII with numbers in tenths.
fn table_vii() -> [Row; 18] {
    use PieceType::{AA, AS, SA, SS};
    [
        row((SS, 10, 1, 193, 9, 3, 4, -9), None, None),
        row((SS, 9, 1, 74, 15, 3, 4, -10), None, None),
        row((SS, 1, 1, 188, 21, 2, 6, -11), None, None),
        row((SA, 7, 1, 59, 23, 3, 5, 23), None, Some((15, 1))),
        row((SA, 9, 2, 104, 25, 3, 4, 12), None, Some((5, 1))),
        row((SA, 4, 1, 42, 32, 3, 5, 21), None, Some((40, -1))),
        row((AS, 12, 1, 140, 42, 4, 4, -12), Some(11), None),
        row((AA, 8, 1, 104, 47, 3, 4, -17), Some(12), Some((22, 1))),
        row((AS, 5, 1, 118, 56, 3, 5, -17), Some(11), None),
        row((SS, 12, 2, 55, 64, 4, 4, -52), None, None),
        row((SA, 6, 1, 121, 68, 3, 5, -19), None, Some((27, 1))),
        row((SA, 8, 2, 51, 71, 3, 4, -41), None, Some((22, 1))),
        row((SA, 9, 3, 183, 82, 3, 4, -15), None, Some((23, -1))),
        row((SS, 4, 2, 111, 87, 3, 5, -7), None, None),
        row((SS, 2, 1, 76, 90, 3, 6, -50), None, None),
        row((SS, 11, 1, 68, 92, 3, 4, -42), None, None),
        row((SA, 10, 2, 63, 100, 3, 4, -43), None, Some((16, 1))),
        row((SA, 1, 2, 96, 108, 2, 6, -50), None, Some((8, 1))),
    ]
}

/// The row (from 1) whose `dir` is printed as 1 and is -1.
const MISPRINTED_DIRECTION: usize = 17;

/// Radius of the arc of agent 3 \[m\]: rows 7 and 9 print it as 1.1, row 8 as 1.2, hence the tie between them.
const OWN_RADIUS: f64 = 1.15;

/// Radius \[m\] and dir of an arc.
fn arc(curve: Curve<f64>) -> Option<(f64, i64)> {
    match curve {
        Curve::Line | Curve::Pivot { .. } => None,
        Curve::Arc { radius, turn } => Some((radius, if turn == TurnSide::Left { 1 } else { -1 })),
    }
}

/// The crossings of agent 3 in the order of the table, each with j and k.
fn crossings_of_agent_3(motions: &[Motion<'_, f64>]) -> Vec<(usize, usize, Crossing<f64>)> {
    let others = (1..=motions.len()).filter(|&other| other != 3);
    let found = others.flat_map(|other| crossings(&motions[2], &motions[other - 1]).map(move |it| (other, it)));
    let mut found: Vec<_> = found.collect();
    found.sort_by(|a, b| a.1.length.total_cmp(&b.1.length));
    let rank = |place: usize| found[..=place].iter().filter(|(other, _)| *other == found[place].0).count();
    (0..found.len()).map(|place| (found[place].0, rank(place), found[place].1)).collect()
}

#[test]
fn table_vii_comes_out_to_the_printed_digit() {
    let (_, fleet) = load("paper12");
    let motions = fleet.motions();
    let found = crossings_of_agent_3(&motions);
    let printed = table_vii();
    assert_eq!(found.len(), printed.len());
    for ((number, row), (other, k, crossing)) in (1..).zip(&printed).zip(found) {
        assert_eq!((crossing.piece_type, other, k), (row.piece_type, row.other, row.k), "row {number}");
        let Radians(theta) = crossing.theta;
        let values = [crossing.time, crossing.length, crossing.combined_radius, crossing.speed, theta].map(tenths);
        assert_eq!(values, [row.time, row.length, row.combined_radius, row.speed, row.theta], "row {number}");
        let (own, others) = (arc(crossing.ego_curve), arc(crossing.other_curve));
        assert_eq!(own.map(|(radius, _)| radius), row.own_radius.map(|_| OWN_RADIUS), "row {number}");
        if let Some(own_radius) = row.own_radius {
            assert!((0.1 * own_radius as f64 - OWN_RADIUS).abs() < 0.05 + TIE, "row {number}");
        }
        let dir = |dir: i64| if number == MISPRINTED_DIRECTION { -dir } else { dir };
        let expected = row.other_arc.map(|(radius, printed)| (radius, dir(printed)));
        assert_eq!(others.map(|(radius, dir)| (tenths(radius), dir)), expected, "row {number}");
    }
}

#[test]
fn table_vii_has_one_region_a_row() {
    let (_, fleet) = load("paper12");
    let motions = fleet.motions();
    let ecm = build_ecm(&motions).expect("a small fleet");
    assert_eq!(ecm.row(&motions, 2).expect("the table of the fleet").count(), 18);
}

/// Table VI: file, agents, crossings, longest travel time in tenths of a second; and the connected regions, which the
/// paper does not give.
const TABLE_VI: [(&str, usize, usize, i64, usize); 6] = [
    ("table6-5", 5, 16, 244, 16),
    ("table6-12", 12, 16, 244, 18),
    ("paper12", 12, 126, 244, 136),
    ("table6-30", 30, 218, 223, 288),
    ("table6-50", 50, 718, 239, 908),
    ("table6-100", 100, 2478, 268, 3182),
];

#[test]
fn table_vi_crossings_travel_times_and_regions() {
    for (name, agents, crossings, longest, regions) in TABLE_VI {
        let (_, fleet) = load(name);
        let motions = fleet.motions();
        let times = motions.iter().map(|motion| motion.time().length());
        assert_eq!(motions.len(), agents, "{name}");
        assert_eq!(sum(&crossing_counts(&motions)), crossings, "{name}");
        assert_eq!(tenths(times.fold(0.0, f64::max)), longest, "{name}");
        assert_eq!(sum(&region_counts(&motions)), regions, "{name}");
    }
}
