//! `pcr evaluate`.

#[cfg(feature = "peers")]
mod run;

use super::{Stop, folder, statuses};
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

/// Measure docs/evaluation.md anew on this machine (takes minutes)
#[derive(Args)]
#[command(after_help = statuses("wrong arguments, or fleets or a document that cannot be read"))]
#[cfg_attr(not(feature = "peers"), allow(dead_code))]
pub(super) struct Arguments {
    /// Directory for the document and its pictures
    #[arg(short, long, value_name = "DIR", value_parser = folder(), default_value = "docs")]
    output: PathBuf,
    /// Directory with the fleets of the paper's Table VI
    #[arg(long, value_name = "DIR", default_value = "tests/data")]
    data: PathBuf,
    /// Write only this part of the document anew; may be given several times
    #[arg(long, value_name = "PART")]
    #[cfg_attr(feature = "peers", arg(value_parser = run::parts()))]
    only: Vec<String>,
    /// Small fleets only, without the slowest methods, to try it out
    #[arg(long)]
    quick: bool,
}

impl Arguments {
    #[cfg(not(feature = "peers"))]
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        Err(Stop::without("the evaluation", "peers"))
    }

    #[cfg(feature = "peers")]
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        run::run(self)
    }
}
