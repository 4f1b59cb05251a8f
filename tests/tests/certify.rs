//! Tables proved by the independent checker, and wrong ones refuted by it (`docs/certificates.md`).
//!
//! The long command is `cargo run --release -p pcr-tests --example certify -- --pairs 10000000 --seed 1`.

use pcr_certify::data::{Pair, Share, Table};
use pcr_certify::pair::Findings;
use pcr_certify::table::{Checker, Margin};
use pcr_core::scalar::Micro;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::import::{self, Options, Warnings};
use pcr_formats::scenario::Scenario;
use pcr_planning::certify::{Certified, Dump};
use pcr_planning::check::Verdict;
use pcr_planning::fleet::Format;
use pcr_planning::locks;
use pcr_planning::plan::{Method, Plan, Priority};
use pcr_planning::regions::table_of;
use pcr_planning::regions::{Answer, Request};
use pcr_tests::certified::{run, table};
use pcr_tests::disc::Disc;
use pcr_tests::exact::{Route, Twofold};
use pcr_tests::generators::certifiable;
use pcr_tests::outward::run_on_all_processors;
use std::path::{Path, PathBuf};

/// Pairs of a format that are certified: 100,000 in an optimized run.
const PAIRS: u64 = if cfg!(optimized) { 100_000 } else { 1_000 };

fn holds<S: Format>(held: f64) {
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

fn is_proved_of<S: Format>(seeds: &[u64]) {
    for &seed in seeds {
        let proofs = run::<S>(seed, 1);
        assert_eq!(proofs.proved, 1, "{} of {}: {proofs:?}", seed, S::NAME);
    }
}

/// A disc as large as the circle but for rounding, arcs of half a turn, and paths of hundreds of segments.
#[test]
fn tables_that_were_not_proved_once_are() {
    is_proved_of::<f64>(&[6, 1362]);
    is_proved_of::<f32>(&[6, 16, 53, 68, 188, 6825, 12872, 25920]);
    is_proved_of::<Q20>(&[16, 68, 188, 4698, 59166]);
    is_proved_of::<Q16>(&[35497, 65178, 86630]);
    is_proved_of::<Q12>(&[3285, 13525, 27854, 52685, 66637, 89197]);
}

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name)
}

fn fleet(name: &str) -> Scenario {
    Scenario::from_json(&std::fs::read_to_string(data(name)).unwrap()).unwrap()
}

fn findings(table: &Table) -> Findings {
    Checker::new(table).unwrap().check(Margin::Needed).unwrap()
}

fn is_proved<S: Format>(name: &str, scenario: &Scenario) {
    match table_of::<S>(scenario) {
        Ok(tables) => {
            for table in tables {
                let certified = Certified::of(name, &table, false);
                assert_eq!(certified.verdict, Some("proved"), "{name} in {}: {certified:?}", S::NAME);
            }
        }
        // Coordinates or sizes that a format cannot hold.
        Err(refused) => assert_ne!(S::NAME, "f64", "{name}: {refused}"),
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

fn layouts() -> Vec<(PathBuf, import::Format, String)> {
    let mut found = Vec::new();
    for folder in ["real/nav2", "real/lif", "real/rmf", "real/opendrive", "real/opentcs"] {
        for file in std::fs::read_dir(data(folder)).unwrap() {
            let file = file.unwrap().path();
            let Ok(text) = std::fs::read_to_string(&file) else { continue };
            if let Some(format) = import::Format::of(&file, &text) {
                found.push((file, format, text));
            }
        }
    }
    found.sort_by(|a, b| a.0.cmp(&b.0));
    found
}

#[test]
fn locks_of_all_layouts_are_proved() {
    let mut read = 0;
    for (file, format, text) in layouts() {
        let options = Options { radius: Some(0.4), ..Options::default() };
        let Ok(imported) = import::layout(format, &text, &options, &mut Warnings::default()) else { continue };
        read += 1;
        // Quadratic in the edges, whatever is in reach of what.
        let few = if cfg!(optimized) { 1500 } else { 150 };
        if imported.layout.edges.len() > few {
            continue;
        }
        for scenario in locks::scenarios(&imported).unwrap() {
            is_proved::<f64>(&file.display().to_string(), &scenario);
        }
    }
    assert!(read >= 15, "{read} layouts");
}

#[test]
fn a_dump_reads_back_exactly() {
    for name in ["paper12.json", "small/outlines.json"] {
        let request = Request { certificate: true, ..Request::default() };
        let answer = Answer::of::<Q16>(&fleet(name), request).unwrap();
        let text = serde_json::to_string(&answer).unwrap();
        let dump: Dump = serde_json::from_str(&text).unwrap();
        assert_eq!(Some(&dump.certificate), answer.certificate.as_ref());
        assert!(findings(&dump.certificate[0]).refuted.is_empty());
    }
}

/// Whether there is a contact at these lengths, by points on the paths alone: where the checker says that a changed
/// table is none the worse.
fn touches(routes: &[Route; 2], lengths: [[f64; 2]; 2], radius: f64, steps: u32) -> bool {
    let at = |[lo, hi]: [f64; 2], k: u32| lo + (hi - lo) * f64::from(k) / f64::from(steps);
    (0..=steps).any(|i| {
        (0..=steps).any(|j| {
            let [p, q] = [routes[0].at(at(lengths[0], i).into()), routes[1].at(at(lengths[1], j).into())];
            let [x, y] = [p[0] - q[0], p[1] - q[1]];
            (x * x + y * y).sqrt() <= Twofold::from(radius)
        })
    })
}

/// What came of changes of single pieces.
#[derive(Debug, Default)]
struct Changes {
    refuted: usize,
    undecided: usize,
    harmless: usize,
}

impl Changes {
    /// Certifies the changed pair alone. Where it is proved, `lost` has no contact.
    fn look(&mut self, table: &Table, changed: Pair, lost: impl FnOnce() -> bool) {
        let mut agents = table.agents.clone();
        for (place, agent) in agents.iter_mut().enumerate() {
            // One body, but for the two.
            agent.id = if changed.agents.contains(&place) { place as u64 } else { u64::MAX };
        }
        let pairs = changed.agents;
        let others = (0..agents.len()).filter(|place| !pairs.contains(place));
        let far: Vec<Pair> = others
            .flat_map(|other| pairs.map(|one| [one.min(other), one.max(other)]))
            .map(|pair| table.pairs.iter().find(|there| there.agents == pair).unwrap().clone())
            .collect();
        let small = Table { agents, pairs: far.into_iter().chain([changed]).collect() };
        let found = findings(&small);
        if !found.refuted.is_empty() {
            self.refuted += 1;
        } else if !found.undecided.is_empty() {
            self.undecided += 1;
        } else {
            self.harmless += 1;
            assert!(!lost());
        }
    }
}

fn changed_tables_are_refuted<S: Format>(scenario: &Scenario) {
    let table = table_of::<S>(scenario).unwrap().remove(0);
    let routes: Vec<Route> =
        scenario.agents.iter().map(|agent| Route::new::<S>(&Disc::of_agent(agent).rounded::<S>())).collect();
    let [mut removed, mut shortened, mut enlarged] = [(); 3].map(|()| Changes::default());
    let mut pieces = 0;
    for pair in table.pairs.iter().filter(|pair| !pair.pieces.is_empty()) {
        let own = pair.agents.map(|place| routes[place].clone());
        let radius: f64 = pair.agents.iter().map(|&place| table.agents[place].radius).sum();
        for place in 0..pair.pieces.len() {
            pieces += 1;
            let piece = pair.pieces[place];
            let mut without = pair.clone();
            without.pieces.remove(place);
            removed.look(&table, without, || true);
            for (path, end) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let by = if end == 0 { 2.0 } else { -2.0 } * pair.excess;
                let segment = &table.agents[pair.agents[path]].path.segments[piece.segments[path]];
                for (out, changes) in [(false, &mut shortened), (true, &mut enlarged)] {
                    let mut other = pair.clone();
                    let before = piece.lengths[path][end];
                    let after = before + if out { -by } else { by };
                    let [lo, hi] = [0, 1].map(|k| if k == end { after } else { piece.lengths[path][k] });
                    if lo > hi || after < segment.from || after > segment.to {
                        continue;
                    }
                    other.pieces[place].lengths[path] = [lo, hi];
                    let mut strip = piece.lengths;
                    strip[path] = [before.min(after), before.max(after)];
                    changes.look(&table, other, || !out && touches(&own, strip, radius, 30));
                }
            }
        }
    }
    println!("{}: {pieces} pieces; removed {removed:?}, shortened {shortened:?}, enlarged {enlarged:?}", S::NAME);
    assert_eq!((removed.refuted, removed.undecided + removed.harmless), (pieces, 0));
    for changes in [shortened, enlarged] {
        let all = changes.refuted + changes.undecided + changes.harmless;
        assert!(all > 3 * pieces, "{changes:?}");
        // The paths meet at so small an angle now and then that 2ε of length are less than ε of distance.
        assert!(10 * changes.refuted > 9 * all, "{changes:?}");
    }
}

#[test]
fn changed_tables_are_refuted_unless_they_are_right() {
    let scenario = fleet("paper12.json");
    changed_tables_are_refuted::<f64>(&scenario);
    changed_tables_are_refuted::<Q16>(&scenario);
}

fn exchanged_shares_are_not_proved<S: Format>() {
    let (mut exchanged, mut refuted, mut proved) = (0, 0, 0);
    for seed in 0..if cfg!(optimized) { 4_000 } else { 400 } {
        let (pair, drives) = certifiable::<S>(seed);
        let Some(mut table) = table::<S>(&pair, &drives) else { continue };
        // One interval each at every length: else each may hold all there is of the other.
        let pieces = &mut table.pairs[0].pieces;
        if pieces.len() > 12 || !pieces.iter().any(|piece| piece.share != Share::Only) {
            continue;
        }
        for piece in pieces {
            piece.share = match piece.share {
                Share::Only => Share::Only,
                Share::Start => Share::End,
                Share::End => Share::Start,
            };
        }
        exchanged += 1;
        let found = findings(&table);
        refuted += usize::from(!found.refuted.is_empty());
        proved += usize::from(found.refuted.is_empty() && found.undecided.is_empty());
    }
    println!("{}: {exchanged} tables with shares exchanged, {refuted} refuted, {proved} proved", S::NAME);
    assert!(exchanged > 20 && 10 * refuted > 9 * exchanged, "{exchanged} {refuted} {proved}");
}

#[test]
fn tables_with_their_shares_exchanged_are_refuted() {
    exchanged_shares_are_not_proved::<f64>();
    exchanged_shares_are_not_proved::<Q16>();
}

#[test]
fn what_is_no_table_is_refused() {
    let table = table_of::<f64>(&fleet("paper12.json")).unwrap().remove(0);
    let wrong = |change: &dyn Fn(&mut Table)| {
        let mut other = table.clone();
        change(&mut other);
        Checker::new(&other).and_then(|checker| checker.check(Margin::Needed)).unwrap_err()
    };
    let with = table.pairs.iter().position(|pair| !pair.pieces.is_empty()).unwrap();
    assert!(wrong(&|table| drop(table.pairs.pop())).contains("missing"));
    assert!(wrong(&|table| table.pairs.push(table.pairs[0].clone())).contains("twice"));
    assert!(wrong(&|table| table.agents[0].radius = f64::NAN).contains("out of range"));
    assert!(wrong(&|table| table.agents[0].path.start[0] = f64::INFINITY).contains("out of range"));
    assert!(wrong(&|table| table.agents[0].path.segments[0].to += 1e-6).contains("segment"));
    assert!(wrong(&|table| table.pairs[with].excess = 0.0).contains("excess"));
    assert!(wrong(&|table| table.pairs[with].pieces[0].segments[0] = 99).contains("segment"));
    assert!(wrong(&|table| table.pairs[with].pieces[0].lengths[1] = [1e6, 1e6]).contains("not on its segment"));
}

#[test]
fn the_margin_is_where_a_proof_ends() {
    let table = table_of::<f64>(&fleet("paper12.json")).unwrap().remove(0);
    let checker = Checker::new(&table).unwrap();
    let (margin, place) = checker.margin().unwrap().unwrap();
    // An exact table with a slack of half the bound would have 0.5.
    assert!((0.3..0.52).contains(&margin), "{margin}");
    assert!(checker.check(Margin::Epsilons(margin)).unwrap().refuted.is_empty());
    let beyond = checker.check(Margin::Epsilons(margin + 0.001)).unwrap();
    let agents = table.pairs[place].agents;
    let there = beyond.refuted.iter().chain(&beyond.undecided).any(|witness| witness.agents == agents);
    assert!(there, "{beyond:?}");
}

#[test]
fn plans_are_proved_to_be_without_contact() {
    for (name, method) in [("paper12.json", Method::Delay), ("paper12.json", Method::Speed)] {
        let (plan, solved) = Plan::of(&fleet(name), method, &Priority::Best).unwrap();
        let proof = plan.certificate.expect("a plan");
        assert_eq!((proof.verdict, solved.is_some()), ("proved", true), "{name}: {proof:?}");
        assert!(proof.pairs > 0 && proof.steps >= proof.pairs);
    }
}

#[test]
fn motions_are_proved_or_refuted_as_conflicts_say() {
    // All set off as the file says: some collide.
    let scenario = fleet("paper12.json");
    let verdict = Verdict::certified::<f64>(&scenario, true).unwrap();
    let proof = verdict.certificate.unwrap();
    let pairs = |those: Vec<[u64; 2]>| those.into_iter().collect::<std::collections::BTreeSet<_>>();
    let deep = verdict.conflicts.iter().filter(|conflict| !conflict.touching).map(|conflict| [conflict.i, conflict.j]);
    let contacts = proof.contacts.iter().map(|contact| [contact.i.min(contact.j), contact.i.max(contact.j)]);
    assert_eq!(pairs(deep.collect()), pairs(contacts.collect()));
    assert!(proof.verdict == "contact" && proof.undecided.is_empty(), "{proof:?}");
    for contact in &proof.contacts {
        assert!(contact.clearance < 0.0);
    }
}
