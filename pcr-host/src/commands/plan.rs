//! `pcr plan`.

use super::map::draw;
use super::{CONFLICTS, Form, Stop, scenario, write_to};
use clap::{Args, ValueEnum};
use pcr_host::import::Options;
use pcr_host::plan::{Method, Plan, Priority};
use pcr_host::regions::Failure;
use pcr_host::report;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::process::ExitCode;

const STATUSES: &str = "\
Exit status:
  0  a plan, checked as by pcr check
  1  no plan
  2  wrong arguments, or a scenario that cannot be read or was refused
  3  the output could not be written";

const EXAMPLES: &str = "\
Examples:
  pcr plan fleet.json -o plan.json                    the scenario with start delays, without conflicts
  pcr plan fleet.json --pictures maps                 every agent's map before and after
  pcr plan fleet.json --method speed -o plan.json     with waits and other speeds on the way instead
  pcr plan fleet.json --priority 7,3 --format json    agents 7 and 3 first, then the others as in the file";

/// Resolve the conflicts of a scenario: later starts or other speeds, by priorities
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct Arguments {
    /// Scenario (JSON); `-` reads it from standard input; the paper's 12 agents if left out
    file: Option<PathBuf>,
    /// The scenario with the plan; none is written where there is no plan
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draw the extended collision maps to DIR/before, and those of the plan to DIR/after
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// How conflicts are avoided
    #[arg(long, value_enum, default_value_t = Means::Delay)]
    method: Means,
    /// Who goes first: agent numbers with commas between them, `longest`, `crowded` or `best`
    #[arg(long, value_name = "ORDER", default_value = "best", value_parser = priority)]
    priority: Priority,
    /// Form of the output
    #[arg(long, value_enum, default_value_t = Form::Table)]
    format: Form,
    #[command(flatten)]
    import: Options,
}

#[derive(Clone, Copy, ValueEnum)]
enum Means {
    /// Agents start later and then move as the scenario says
    Delay,
    /// Agents wait and change their speed on the way, under the limits that the scenario gives them
    Speed,
}

impl From<Means> for Method {
    fn from(means: Means) -> Self {
        match means {
            Means::Delay => Self::Delay,
            Means::Speed => Self::Speed,
        }
    }
}

/// An order of priority from the command line.
fn priority(text: &str) -> Result<Priority, String> {
    match text {
        "longest" => return Ok(Priority::Longest),
        "crowded" => return Ok(Priority::Crowded),
        "best" => return Ok(Priority::Best),
        _ => {}
    }
    let mut ids: Vec<u64> = Vec::new();
    for part in text.split(',') {
        let id = part.trim().parse().map_err(|_| format!("{part:?} is no number of an agent"))?;
        if ids.contains(&id) {
            return Err(format!("agent {id} is there twice"));
        }
        ids.push(id);
    }
    Ok(Priority::Given(ids))
}

impl Arguments {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let file = self.file.as_deref();
        let scenario = scenario(file, &self.import)?;
        let (plan, solved) = Plan::of(&scenario, self.method.into(), &self.priority)
            .map_err(|failure: Failure| Stop::wrong(file, failure))?;
        if let (Some(output), Some(solved)) = (&self.output, &solved) {
            write_to(output, solved)?;
        }
        let mut out = BufWriter::new(io::stdout().lock());
        match self.format {
            Form::Table => report::plan_table(&plan, &mut out)?,
            Form::Json => report::json(&plan, &mut out)?,
            Form::Csv => {
                out.write_all(report::PLAN_CSV_HEADER.as_bytes())?;
                report::plan_csv(&plan, &mut out)?;
            }
        }
        out.flush()?;
        if let Some(directory) = &self.pictures {
            // Beside the report, which may be for a machine.
            let told = &mut io::stderr().lock();
            draw(&scenario, None, &directory.join("before"), told)?;
            if let Some(solved) = &solved {
                draw(solved, None, &directory.join("after"), told)?;
            }
        }
        Ok(if solved.is_some() { ExitCode::SUCCESS } else { ExitCode::from(CONFLICTS) })
    }
}
