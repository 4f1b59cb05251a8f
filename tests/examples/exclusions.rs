//! Vehicles that obey nothing but a written file, any number of missions:
//! `cargo run --profile checked -p pcr-tests --example exclusions -- LAYOUT TARGET RADIUS MISSIONS [SEED [SPLIT]]`, for instance
//! `tests/data/real/nav2/warehouse_graph.geojson nav2 0.4 100000`. Targets: `nav2`, `rmf`, `opentcs`, `envelopes`, `vda5050`, `pcr`.
//! Exit status 1 if any two touch, or it is not decided.

use pcr_exclusions::{Settings, Target, read, write};
use pcr_formats::import::{Format, Options, Warnings, layout};
use pcr_tests::rules::run;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, target, radius, missions, rest @ ..] = &arguments[..] else {
        eprintln!("LAYOUT TARGET RADIUS MISSIONS [SEED [SPLIT]]");
        return ExitCode::from(2);
    };
    let (envelopes, target) = match target.as_str() {
        "nav2" => (None, Target::Nav2),
        "rmf" => (None, Target::Rmf),
        "opentcs" => (None, Target::OpenTcs),
        "envelopes" => (Some("pcr".to_owned()), Target::OpenTcs),
        "vda5050" => (None, Target::Vda5050),
        "pcr" => (None, Target::Pcr),
        other => panic!("{other}: no target"),
    };
    let radius: f64 = radius.parse().expect("a radius");
    let missions: usize = missions.parse().expect("a number of missions");
    let seed = rest.first().map_or(1, |seed| seed.parse().expect("a seed"));
    let split = rest.get(1).map(|split| split.parse().expect("a length"));
    let text = std::fs::read_to_string(file).expect("a layout");
    let format = Format::of(Path::new(file), &text).expect("a format");
    let options = Options { radius: Some(radius), ..Options::default() };
    let settings = Settings { target, split, envelopes };
    let (written, report, _) = write(format, &text, &options, "site", &settings).expect("what can be written");
    let geometry = if target.layout().is_some() { &written } else { &text };
    let mut imported = layout(format, geometry, &options, &mut Warnings::default()).expect("what was written");
    if imported.layout.name.is_empty() {
        imported.layout.name = "site".into();
    }
    let rules = read(target, &written, &imported).expect("what was written");
    let start = Instant::now();
    let run = run(&imported, &rules, missions, seed);
    println!(
        "{file}, {target}: {} groups, {} pairs that can touch; {} missions, {} edges, refused {} times, {} taken out; \
         {} pairs proved, {} contacts; {:.1} s",
        report.groups,
        report.can_touch,
        run.missions,
        run.edges,
        run.refused,
        run.taken_out,
        run.pairs,
        run.contacts.len(),
        start.elapsed().as_secs_f64()
    );
    for contact in run.contacts.iter().take(10) {
        println!("  {contact:?}");
    }
    if run.contacts.is_empty() && run.missions >= missions { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
