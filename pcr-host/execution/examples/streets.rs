//! A fleet on a generated site: `streets [ROBOTS [HOURS [STREETS]]]`, 1000 robots for 0.1 h on 40 streets each way if left out.

use pcr_execution::lifelong::{CoordinationMethod, DelayModel, LifelongOptions, run, streets};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut next = |usual: f64| arguments.next().map_or(Ok(usual), |it| it.parse::<f64>());
    let (agents, hours, count) = (next(1000.0)? as usize, next(0.1)?, next(40.0)? as usize);
    let imported = streets(count);
    let request = LifelongOptions {
        agents,
        duration: 3600.0 * hours,
        delays: DelayModel::default(),
        seed: 1,
        method: CoordinationMethod::Orders,
    };
    let report = run(&imported, request)?;
    let it = &report.outcome;
    println!(
        "{} nodes, {} safe ends, {} robots, {hours} h",
        report.layout.nodes,
        report.layout.safe_ends.len(),
        it.robots
    );
    println!(
        "{} missions, {:.0} an hour, travel {:.2}",
        it.missions,
        it.missions_per_hour,
        it.travel_over_unimpeded.unwrap_or(0.0)
    );
    println!(
        "refused {}, longest wait {:.1} s, stuck {}, breaches {}",
        it.refused, it.longest_wait, it.stuck, it.authority_overruns
    );
    let [half, most, worst] = [0.5, 0.99, 1.0].map(|part| 1e3 * report.decided_within(part));
    println!(
        "{} decisions: half within {half:.2} ms, 99 of 100 within {most:.2} ms, all within {worst:.2} ms",
        report.decisions.len()
    );
    println!(
        "computed in {:.1} s, the last one done at {:.0} s; {:?}",
        report.time.as_secs_f64(),
        report.last_arrival,
        it.time
    );
    println!("{:?}", it.certificate);
    Ok(())
}
