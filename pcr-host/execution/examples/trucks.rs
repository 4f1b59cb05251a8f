//! Pallet trucks of 1.2 by 0.8 m as they are, and as the discs around them: `trucks [HOURS [AISLES [LAYOUT]]]`, on a warehouse of two-lane
//! aisles and on a route graph of nav2 if one is given.

use pcr_execution::lifelong::{CoordinationMethod, DelayModel, LifelongOptions, aisles, run};
use pcr_formats::footprint::Footprint;
use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Warnings, layout};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut next = |usual: f64| arguments.next().map_or(Ok(usual), |it| it.parse::<f64>());
    let (hours, count) = (next(0.5)?, next(4.0)? as usize);
    let mut sites = vec![aisles(count)];
    if let Some(path) = arguments.next() {
        let options = ImportOptions { radius: Some(0.4), ..ImportOptions::default() };
        sites.push(layout(InputFormat::Nav2, &std::fs::read_to_string(path)?, &options, &mut Warnings::default())?);
    }
    for site in sites {
        println!("{}: {} nodes, {hours} h", site.layout.name, site.layout.nodes.len());
        for agents in [2, 4, 8, 12, 16] {
            let [exact, disc] = [true, false].map(|exact| fleet(&site, agents, hours, exact));
            let ([exact, disc], [own, other]) = {
                let (a, b) = (exact?, disc?);
                ([a.0, b.0], [a.1, b.1])
            };
            println!(
                "{agents} trucks: {exact:.0} missions an hour as they are ({own}), {disc:.0} as discs ({other}), {:.2} times",
                exact / disc
            );
        }
    }
    Ok(())
}

/// Missions an hour, and what became of the run.
fn fleet(site: &ImportedLayout, agents: usize, hours: f64, exact: bool) -> Result<(f64, String), Box<dyn Error>> {
    let mut imported = site.clone();
    let corners = vec![[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]];
    imported.vehicle.radius = 0.52_f64.sqrt();
    imported.vehicle.footprint = if exact { Some(Footprint::new(corners)?) } else { None };
    let (delays, method) = (DelayModel::default(), CoordinationMethod::Orders);
    let request = LifelongOptions { agents, duration: 3600.0 * hours, delays, seed: 1, method };
    let report = run(&imported, request)?;
    let it = &report.outcome;
    let told = format!(
        "{} placed, {}, {} stuck, {} starved, {} safe ends, computed in {:.1} s",
        it.robots,
        it.certificate.verdict,
        it.stuck,
        it.starved,
        report.layout.safe_ends.len(),
        report.time.as_secs_f64()
    );
    Ok((it.missions_per_hour, told))
}
