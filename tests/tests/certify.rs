//! Tables proved by the independent checker, and wrong ones refuted by it (`docs/theory/certificates.md`).
//!
//! The long command is `cargo run --release -p pcr-tests --example certify -- --pairs 10000000 --seed 1`.

use pcr_certify::arc_length_motion;
use pcr_certify::error::CertifyError;
use pcr_certify::pair::Findings;
use pcr_certify::raw::{RawPair, RawTable};
use pcr_certify::table::{Checker, CoverageMargin};
use pcr_core::scalar::Micro;
use pcr_core::{Limits, Motion, Path as CorePath, Point, Pose, Profile};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::import::{self, ImportOptions, Warnings};
use pcr_formats::scenario::Scenario;
use pcr_planning::certify::{CertificateTable, CertifyInput, CertifyReport};
use pcr_planning::check::CheckReport;
use pcr_planning::checker_input;
use pcr_planning::exclusion_table;
use pcr_planning::fleet::HostScalar;
use pcr_planning::plan::{self, PlanMethod, PlanReport};
use pcr_planning::regions::table_of;
use pcr_planning::regions::{RegionOptions, RegionsReport};
use pcr_tests::case_ranges::run_on_all_processors;
use pcr_tests::certified::{discs_of, run, table};
use pcr_tests::disc::Drive;
use pcr_tests::generators::{Dice, behind};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// Layouts that there are in the test data, at least.
const LAYOUTS: usize = 15;

/// Pairs of a format that are certified: 20,000 in an optimized run.
const PAIRS: u64 = if cfg!(optimized) { 10_000 } else { 1_000 };

fn holds<S: HostScalar>(held: f64) {
    let proofs = run_on_all_processors(run::<S>, 0, PAIRS, |_, _| ());
    println!("{}: {proofs}", S::NAME);
    assert_eq!(proofs.refuted, Vec::<String>::new(), "{}", S::NAME);
    assert_eq!(proofs.undecided, Vec::<String>::new(), "{}", S::NAME);
    assert_eq!(proofs.cases(), PAIRS);
    // What refuses nearly all, or has next to nothing to prove, proves as much.
    assert!(proofs.proved as f64 > held * PAIRS as f64, "{proofs}");
    assert!(proofs.pieces > proofs.proved && proofs.shared * 20 > proofs.proved, "{proofs}");
}

#[test]
fn tables_of_random_pairs_are_proved_in_f64() {
    holds::<f64>(0.95);
}

#[test]
fn tables_of_random_pairs_are_proved_in_f32() {
    holds::<f32>(0.9);
}

#[test]
fn tables_of_random_pairs_are_proved_in_micro() {
    holds::<Micro>(0.9);
}

#[test]
fn tables_of_random_pairs_are_proved_in_q20() {
    holds::<Q20>(0.5);
}

#[test]
fn tables_of_random_pairs_are_proved_in_q16() {
    holds::<Q16>(0.5);
}

#[test]
fn tables_of_random_pairs_are_proved_in_q12() {
    holds::<Q12>(0.5);
}

/// Pairs of which one passes an arc as large as the disc behind its centre, where one end is left for the other. What is told of them
/// once was 1.3 mm from any contact in `f32`, 38 ε.
fn behind_the_centre<S: HostScalar>() {
    let (mut proved, mut refused) = (0, 0);
    for seed in 0..PAIRS / 5 {
        let size = [1.0, 10.0][(seed % 2) as usize];
        // The slack of a pair like it, which is larger than the disc by as much.
        let of = |slack: f64| {
            let (first, second) = behind(size, slack, &mut Dice::seeded(seed));
            table::<S>(&(first.rounded::<S>(), second.rounded::<S>()), &[(Drive::Unit, 0.0), (Drive::Unit, 0.0)])
        };
        let slack = of(1e-6 * size).and_then(|table| table.pairs.first().map(|pair| 0.5 * pair.excess));
        let Some(table) = slack.and_then(of) else {
            refused += 1;
            continue;
        };
        let found = findings(&table);
        assert!(found.refuted.is_empty() && found.undecided.is_empty(), "{seed} in {}: {found:?}", S::NAME);
        proved += 1;
    }
    assert!(refused < proved, "{refused} are refused in {}", S::NAME);
}

#[test]
fn what_lies_opposite_a_centre_is_not_told() {
    behind_the_centre::<f64>();
    behind_the_centre::<f32>();
    behind_the_centre::<Micro>();
    behind_the_centre::<Q20>();
    behind_the_centre::<Q16>();
    behind_the_centre::<Q12>();
}

/// Profiles from rest to rest and stretched ones, twice over: what is rounded most often.
fn motions_pass<S: HostScalar>() {
    let number = |x: f64| S::from_f64(x);
    let mut dice = Dice::seeded(7);
    let mut passed = 0;
    for _ in 0..PAIRS {
        let (length, limits) = (number(dice.magnitude(0.01, 100.0)), [0.05, 0.05].map(|lo| dice.magnitude(lo, 5.0)));
        let limits = Limits { speed: number(limits[0]), acceleration: number(limits[1]) };
        let start = Pose { position: Point::new(S::ZERO, S::ZERO), heading: S::angle(0.0).expect("an angle") };
        let path = CorePath::<S, 1>::starting_at(start).and_then(|path| path.line(length)).unwrap();
        let Ok(mut profile) = Profile::<S, 3>::rest_to_rest(length, limits) else { continue };
        for _ in 0..3 {
            let motion = Motion::new(path.as_path(), profile.as_profile(), number(0.5), S::ZERO).unwrap();
            let agent = checker_input::agent(1, &motion, S::angle(0.0).expect("an angle"), &[]);
            assert_eq!(
                arc_length_motion::checked(&agent).and_then(|()| arc_length_motion::arrives(&agent)),
                Ok(()),
                "{}: {agent:?}",
                S::NAME
            );
            passed += 1;
            let duration = number(profile.as_profile().duration().to_f64() * dice.magnitude(0.9, 1.7));
            let Ok(next) = Profile::stretched(profile.as_profile(), duration) else { break };
            profile = next;
        }
    }
    assert!(passed > PAIRS, "{}: {passed}", S::NAME);
}

#[test]
fn motions_are_those_of_their_phases_in_every_format() {
    motions_pass::<f64>();
    motions_pass::<f32>();
    motions_pass::<Micro>();
    motions_pass::<Q20>();
    motions_pass::<Q16>();
    motions_pass::<Q12>();
}

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name)
}

fn fleet(name: &str) -> Scenario {
    Scenario::from_json(&std::fs::read_to_string(data(name)).unwrap()).unwrap()
}

fn findings(table: &RawTable) -> Findings {
    Checker::new(table).unwrap().check(CoverageMargin::Needed).unwrap()
}

fn is_proved<S: HostScalar>(name: &str, scenario: &Scenario) {
    for table in table_of::<S>(scenario).unwrap_or_else(|refused| panic!("{name}: {refused}")) {
        let certified = CertifyReport::prove(name, &table, false);
        assert_eq!(certified.verdict, Some("proved"), "{name} in {}: {certified:?}", S::NAME);
        let regions: usize = match &table {
            CertificateTable::Discs(table) => table.pairs.iter().map(|pair| pair.regions.len()).sum(),
            CertificateTable::Outlines(table) => table.pairs.iter().map(|pair| pair.regions.len()).sum(),
        };
        assert_eq!(certified.times, regions, "{name} in {}", S::NAME);
    }
}

fn is_proved_in_all_formats(name: &str, scenario: &Scenario) {
    is_proved::<f64>(name, scenario);
    is_proved::<f32>(name, scenario);
    is_proved::<Micro>(name, scenario);
    is_proved::<Q20>(name, scenario);
    is_proved::<Q16>(name, scenario);
    is_proved::<Q12>(name, scenario);
}

#[test]
fn tables_of_all_fleets_are_proved_in_all_formats() {
    for name in ["paper12.json", "table6-5.json", "table6-12.json", "table6-30.json", "table6-50.json"] {
        is_proved_in_all_formats(name, &fleet(name));
    }
    if cfg!(optimized) {
        is_proved_in_all_formats("table6-100.json", &fleet("table6-100.json"));
    }
    is_proved_in_all_formats("outlines.json", &fleet("small/outlines.json"));
}

/// Contact nearly tangent from inside an arc, with which tables were wrong once.
#[test]
fn tables_of_inner_tangencies_are_proved() {
    for name in ["inner-tangent-q16.json", "inner-tangent-arcs-q16.json", "inner-tangent-line-q16.json"] {
        is_proved_in_all_formats(name, &fleet(&format!("cases/{name}")));
    }
}

/// All layouts in the test data.
fn layouts() -> Vec<(PathBuf, import::InputFormat, String)> {
    let (mut found, mut folders) = (Vec::new(), vec![data("")]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let file = entry.unwrap().path();
            if file.is_dir() {
                folders.push(file);
            } else if let Ok(text) = std::fs::read_to_string(&file)
                && let Some(format) = import::InputFormat::detect(&file, &text)
            {
                found.push((file, format, text));
            }
        }
    }
    found.sort_by(|a, b| a.0.cmp(&b.0));
    found
}

/// What has come of the layouts in one format.
#[derive(Debug, Default)]
struct Layouts {
    proved: Vec<String>,
    refused: Vec<String>,
}

fn are_proved<S: HostScalar>(layouts: &[(String, Vec<Scenario>)]) -> Layouts {
    let mut found = Layouts::default();
    for (name, levels) in layouts {
        let tables = levels.iter().map(|level| table_of::<S>(level)).collect::<Result<Vec<_>, _>>();
        match tables {
            Ok(tables) => {
                for table in tables.iter().flatten() {
                    let certified = CertifyReport::prove(name, table, false);
                    assert_eq!(certified.verdict, Some("proved"), "{name} in {}: {certified:?}", S::NAME);
                }
                found.proved.push(name.clone());
            }
            // Coordinates or sizes that a format cannot hold, by name.
            Err(refused) => found.refused.push(format!("{name}: {refused}")),
        }
    }
    println!("{}: {} proved, refused {:#?}", S::NAME, found.proved.len(), found.refused);
    found
}

#[test]
fn locks_of_all_layouts_are_proved_in_all_formats() {
    let mut layouts = self::layouts().into_iter().filter_map(|(file, format, text)| {
        let options = ImportOptions { radius: Some(0.4), ..ImportOptions::default() };
        // Routes and plans have no layout in them.
        let imported = import::layout(format, &text, &options, &mut Warnings::default()).ok()?;
        Some((
            file.strip_prefix(data("")).unwrap().display().to_string(),
            exclusion_table::scenarios(&imported).unwrap(),
        ))
    });
    let mut layouts: Vec<(String, Vec<Scenario>)> = layouts.by_ref().collect();
    assert!(layouts.len() >= LAYOUTS, "{} layouts", layouts.len());
    if !cfg!(optimized) {
        // Quadratic in the discs, whatever is in reach of what.
        layouts.retain(|(_, levels)| levels.iter().all(|level| level.agents.len() <= 150));
    }
    for found in [are_proved::<f64>(&layouts), are_proved::<f32>(&layouts), are_proved::<Micro>(&layouts)] {
        assert_eq!(found.refused, Vec::<String>::new());
    }
    // 400 m and an arc of 300 m are more than Q20 holds; a line of 17 µm and a phase of 1e-16 s are less than a digit.
    let [town01, town02] = ["real/opendrive/Town01.planview.xodr", "real/opendrive/Town02.planview.xodr"];
    let demo = "real/opentcs/Demo-01.xml";
    let beyond = [
        (are_proved::<Q20>(&layouts), vec![town01, town02, demo]),
        (are_proved::<Q16>(&layouts), vec![demo]),
        (are_proved::<Q12>(&layouts), vec![town02, demo]),
    ];
    for (found, beyond) in beyond {
        for why in &found.refused {
            let expected = beyond.iter().any(|file| why.starts_with(file)) && why.contains("is out of range");
            assert!(expected, "{why}");
        }
        assert!(!cfg!(optimized) || found.refused.len() == beyond.len(), "{found:#?}");
        assert_eq!(found.proved.len() + found.refused.len(), layouts.len());
    }
}

#[test]
fn a_dump_reads_back_exactly() {
    for name in ["paper12.json", "small/outlines.json"] {
        let request = RegionOptions { certificate: true, ..RegionOptions::default() };
        let answer = RegionsReport::compute::<Q16>(&fleet(name), request).unwrap();
        let text = serde_json::to_string(&answer).unwrap();
        let dump = CertifyInput::of_json(&text).unwrap();
        assert_eq!(Some(&dump.certificate), answer.certificate.as_ref());
        let certified = CertifyReport::prove(name, &dump.certificate[0], false);
        assert!(certified.error.is_none() && certified.refuted.is_empty(), "{certified:?}");
    }
}

/// What the firmware has printed (`firmware/supervisor/tests/dump.rs` compares it with what it prints) is the table of the tool.
#[test]
fn a_table_that_a_microcontroller_printed_is_that_of_the_tool() {
    fn is_the_same<S: HostScalar>(file: &str) {
        let dump = CertifyInput::of(&std::fs::read_to_string(data(file)).unwrap(), file).unwrap();
        let mut table = discs_of::<S>(&fleet("paper12.json"));
        // The firmware numbers them from 0.
        (0..).zip(&mut table.agents).for_each(|(place, agent)| agent.id = place);
        // The firmware prints all pairs; those that the tool leaves out have no region.
        let [CertificateTable::Discs(whole)] = dump.certificate.as_slice() else { panic!("{file}: one table") };
        let is_there = |pair: &RawPair| table.pairs.iter().any(|there| there.agents == pair.agents);
        let (pairs, far): (Vec<RawPair>, Vec<RawPair>) = whole.pairs.iter().cloned().partition(is_there);
        assert!(far.iter().all(|pair| pair.regions.is_empty() && pair.pieces.is_empty()), "{file}");
        assert_eq!(RawTable { agents: whole.agents.clone(), pairs, apart: table.apart }, table, "{file}");
        assert_eq!(CertifyReport::prove(file, &dump.certificate[0], true).verdict, Some("proved"));
    }
    is_the_same::<f32>("dumps/paper12-f32.txt");
    is_the_same::<Q16>("dumps/paper12-q16.txt");
}

/// A fleet of pairs that cross, of which only neighbours come near one another.
fn scattered(pairs: usize) -> Scenario {
    let agent = |k: usize| {
        let (x, y) = ((k / 2 % 10) as f64 * 8.0, (k / 20) as f64 * 8.0);
        let [x, y, heading] = if k.is_multiple_of(2) { [x - 2.0, y, 0.0] } else { [x, y - 2.0, TAU / 4.0] };
        serde_json::json!({ "id": k + 1, "radius": 0.3, "v_max": 1, "a_max": 1, "path": [{ "kind": "line", "length": 4 }],
            "start": { "x": x, "y": y, "heading": heading } })
    };
    Scenario::from_value(&serde_json::json!({ "agents": (0..2 * pairs).map(agent).collect::<Vec<_>>() })).unwrap()
}

fn pairs_that_are_far_apart_are_left_out<S: HostScalar>() {
    let table = discs_of::<S>(&scattered(50));
    let named: Vec<[usize; 2]> = table.pairs.iter().map(|pair| pair.agents).collect();
    assert_eq!(named, (0..50).map(|k| [2 * k, 2 * k + 1]).collect::<Vec<_>>(), "{}", S::NAME);
    let found = Checker::new(&table).unwrap().check(CoverageMargin::Needed).unwrap();
    assert!(found.refuted.is_empty() && found.undecided.is_empty(), "{}", S::NAME);
    let refused = |change: &dyn Fn(&mut RawTable)| {
        let mut other = table.clone();
        change(&mut other);
        Checker::new(&other).map(drop).unwrap_err().to_string()
    };
    // One that comes near may not be left out, and nobody where the table does not say so.
    assert!(refused(&|table| drop(table.pairs.remove(7))).contains("places 14 and 15 is missing, and they come near"));
    assert!(refused(&|table| table.apart = None).contains("missing"));
    // Two that come near because one of them is larger, or somewhere else, than when the pairs were told.
    assert!(refused(&|table| table.agents[0].radius = 4.5).contains("places 0 and 2 is missing"));
    assert!(refused(&|table| table.agents[40].path.start = [0.0, 0.0]).contains("and 40 is missing"));
    // An ε that reaches the neighbours; and what is none.
    assert!(refused(&|table| table.apart = Some(2.0)).contains("missing"));
    for none in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(refused(&|table| table.apart = Some(none)).contains("out of range"), "{none}");
    }
}

#[test]
fn far_pairs_are_left_out_in_every_format() {
    pairs_that_are_far_apart_are_left_out::<f64>();
    pairs_that_are_far_apart_are_left_out::<f32>();
    pairs_that_are_far_apart_are_left_out::<Q20>();
    pairs_that_are_far_apart_are_left_out::<Q16>();
    pairs_that_are_far_apart_are_left_out::<Q12>();
}

#[test]
fn what_is_no_table_is_refused() {
    let table = discs_of::<f64>(&fleet("paper12.json"));
    let wrong = |change: &dyn Fn(&mut RawTable)| {
        let mut other = table.clone();
        change(&mut other);
        Checker::new(&other).and_then(|checker| checker.check(CoverageMargin::Needed)).unwrap_err().to_string()
    };
    let with = table.pairs.iter().position(|pair| !pair.pieces.is_empty()).unwrap();
    assert!(wrong(&|table| drop(table.pairs.pop())).contains("missing"));
    assert!(wrong(&|table| table.pairs.push(table.pairs[0].clone())).contains("twice"));
    assert!(wrong(&|table| table.agents[0].radius = f64::NAN).contains("out of range"));
    assert!(wrong(&|table| table.agents[0].path.start[0] = f64::INFINITY).contains("out of range"));
    assert!(wrong(&|table| table.agents[0].path.segments[0].to += 1e-6).contains("segment"));
    // More than one turn, by more than rounding: three laps of it could be covered at once.
    let turns = |by: f64| {
        let mut other = table.clone();
        let mut segments = other.agents.iter_mut().flat_map(|agent| &mut agent.path.segments);
        let arc = segments.find(|segment| segment.radius.is_some()).expect("an arc");
        arc.radius = Some(arc.length / (TAU * by));
        Checker::new(&other).map(drop)
    };
    assert!(turns(1.0 + 1e-16).is_ok() && turns(0.99).is_ok());
    for by in [1.0 + 1e-12, 1.05] {
        assert!(matches!(turns(by), Err(CertifyError::ArcTooLong(_))), "{by}");
    }
    assert!(wrong(&|table| table.pairs[with].excess = 0.0).contains("excess"));
    assert!(wrong(&|table| table.pairs[with].regions.clear()).contains("region"));
    assert!(wrong(&|table| table.pairs[with].regions.extend_from_within(..1)).contains("lengths"));
    assert!(wrong(&|table| table.pairs[with].regions[0].lengths[0][1] -= 0.1).contains("lengths"));
    assert!(wrong(&|table| table.pairs[with].regions[0].times = None).contains("time"));
    assert!(wrong(&|table| table.agents[0].travel = None).contains("time"));
    assert!(wrong(&|table| table.pairs[with].regions[0].times = Some([[0.0, f64::NAN]; 2])).contains("time"));
    assert!(wrong(&|table| table.agents[0].travel.as_mut().unwrap().lag = f64::NAN).contains("out of range"));
    assert!(wrong(&|table| table.agents[0].travel.as_mut().unwrap().phases[1].time[0] = 0.0).contains("phase"));
    assert!(wrong(&|table| table.pairs[with].agents = [0, usize::MAX]).contains("none"));
    assert!(wrong(&|table| table.pairs[with].pieces[0].segments[0] = 99).contains("segment"));
    assert!(wrong(&|table| table.pairs[with].pieces[0].lengths[1] = [1e6, 1e6]).contains("not on its segment"));
}

#[test]
fn the_margin_is_where_a_proof_ends() {
    let table = discs_of::<f64>(&fleet("paper12.json"));
    let checker = Checker::new(&table).unwrap();
    let (margin, place) = checker.margin().unwrap().unwrap();
    // An exact table with a slack of half the bound would have 0.5.
    assert!((0.3..0.52).contains(&margin), "{margin}");
    assert!(checker.check(CoverageMargin::Epsilons(margin)).unwrap().refuted.is_empty());
    let beyond = checker.check(CoverageMargin::Epsilons(margin + 0.001)).unwrap();
    let agents = table.pairs[place].agents;
    let there = beyond.refuted.iter().chain(&beyond.undecided).any(|witness| witness.agents == agents);
    assert!(there, "{beyond:?}");
}

#[test]
fn plans_are_proved_to_be_without_contact() {
    for (name, method) in [("paper12.json", PlanMethod::Delay), ("paper12.json", PlanMethod::Speed)] {
        let (plan, solved) = PlanReport::compute(&fleet(name), &plan::PlanOptions::new(method)).unwrap();
        let proof = plan.certificate.expect("a plan");
        assert_eq!((proof.verdict, solved.is_some()), ("proved", true), "{name}: {proof:?}");
        assert!(proof.pairs > 0 && proof.steps >= proof.pairs);
    }
}

#[test]
fn motions_are_proved_or_refuted_as_conflicts_say() {
    // All set off as the file says: some collide.
    let scenario = fleet("paper12.json");
    let verdict = CheckReport::certified::<f64>(&scenario, true, &|_, _| {}).unwrap();
    let proof = verdict.certificate.unwrap();
    let pairs = |those: Vec<[u64; 2]>| those.into_iter().collect::<std::collections::BTreeSet<_>>();
    let deep = verdict.conflicts.iter().filter(|conflict| !conflict.touching).map(|conflict| [conflict.i, conflict.j]);
    let contacts = proof.contacts.iter().map(|contact| [contact.i.min(contact.j), contact.i.max(contact.j)]);
    assert_eq!(pairs(deep.collect()), pairs(contacts.collect()));
    assert!(proof.verdict == "contact" && proof.undecided.is_empty(), "{proof:?}");
    for contact in &proof.contacts {
        assert!(contact.clearance < 0.0);
    }
    // Nothing is proved of one agent, or of none.
    let mut few = scenario;
    for left in [1, 0] {
        few.agents.truncate(left);
        let refused = CheckReport::certified::<f64>(&few, false, &|_, _| {}).unwrap_err();
        assert!(refused.to_string().contains("no two agents of which contacts"), "{refused}");
    }
}

#[test]
fn regions_of_an_agent_that_is_not_there_are_none() {
    let answer = RegionsReport::compute::<f64>(
        &fleet("paper12.json"),
        RegionOptions { certificate: true, ..RegionOptions::default() },
    )
    .unwrap();
    let text = serde_json::to_value(&answer).unwrap();
    let read = |agent: u64, regions: serde_json::Value| {
        let mut other = text.clone();
        (other["agent"], other["regions"]) = (agent.into(), regions);
        CertifyInput::of_json(&other.to_string()).map(drop).map_err(|problem| problem.to_string())
    };
    let own = text["regions"].as_array().unwrap().iter().filter(|region| region["i"] == 3).cloned();
    assert_eq!(read(3, own.collect()), Ok(()));
    assert!(read(3, serde_json::json!([])).unwrap_err().contains("of agents 3"));
    assert_eq!(read(77, serde_json::json!([])), Err("agent: 77 is none of the certificate".into()));
}

/// A field that is not there is not taken for one that says none, nor is one that nobody knows passed over.
#[test]
fn what_is_left_out_of_a_file_is_an_error() {
    let table = discs_of::<Q16>(&fleet("paper12.json"));
    let text = serde_json::to_string(&table).unwrap();
    let read = |text: &str| serde_json::from_str::<RawTable>(text).map_err(|error| error.to_string());
    assert_eq!(read(&text), Ok(table));
    let without = |field: &str| {
        let begin = text.find(field).unwrap_or_else(|| panic!("{field}"));
        let value = &text[begin + field.len()..];
        let rest = &value[value.find([',', '}']).unwrap()..];
        // The last one has its comma before it.
        let before = if rest.starts_with('}') { text[..begin].trim_end_matches(',') } else { &text[..begin] };
        read(&format!("{before}{}", rest.trim_start_matches(','))).unwrap_err()
    };
    for field in ["\"radius\":", "\"from\":", "\"lag\":", "\"time_excess\":", "\"excess\":", "\"rounding\":", "\"id\":"]
    {
        assert!(without(field).contains("missing field"), "{field}: {}", without(field));
    }
    // Of a line, too: an arc whose radius is lost would be one.
    let of_a_segment = text.replacen("\"radius\":null,", "", 1);
    assert!(of_a_segment != text && read(&of_a_segment).unwrap_err().contains("missing field `radius`"));
    for (good, bad) in [
        ("\"times\":", "\"hours\":"),
        ("\"phases\":", "\"turns\":[],\"phases\":"),
        ("\"share\":\"only\"", "\"share\":\"both\""),
        ("\"lag\":", "\"lag\":1,\"lag\":"),
        ("\"excess\":", "\"excess\":1e999,\"x\":"),
        ("\"excess\":", "\"excess\":null,\"x\":"),
    ] {
        assert!(text.contains(good) && read(&text.replacen(good, bad, 1)).is_err(), "{bad}");
    }
}
