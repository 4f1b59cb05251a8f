//! Time and memory for all regions of fleets of one size.

use super::super::machine::line;
use super::super::{EvaluationError, Thoroughness};
use pcr_comparing::compare::stopwatch::Stopwatch;
use pcr_core::{CapacityError, Motion};
use pcr_formats::scenario::Scenario;
use pcr_planning::agent_regions::{self, AgentRegionsWalk};
use pcr_planning::fleet::{Fleet, build_ecm};
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What is done with a fleet.
type RegionPass<'w> = dyn Fn(&[Motion<'_, f64>]) -> Result<(), CapacityError> + 'w;

/// The largest fleet of which one table is made.
pub(super) const TABLE: usize = 10_000;

/// Fleets of one size; all numbers are for one of them.
pub(super) struct ScaleMeasurement {
    pub(super) agents: usize,
    pub(super) regions: f64,
    /// On one core, on all, and of the table of all pairs \[ms\].
    pub(super) rows: f64,
    pub(super) all_cores: f64,
    pub(super) table: Option<f64>,
}

impl ScaleMeasurement {
    /// Of the fleets that `make` makes by their size and a seed. Small ones are as many different ones as the extent wants agents:
    /// of one that is repeated the processor would know all branches by heart.
    pub(super) fn run(
        make: &dyn Fn(usize, u64) -> Scenario,
        agents: usize,
        extent: Thoroughness,
    ) -> Result<Self, EvaluationError> {
        let together = match extent {
            Thoroughness::Full => 10_000,
            Thoroughness::Quick => 300,
        };
        let count = (together / agents).max(1);
        let fleets = (0..count as u64).map(|seed| Fleet::<f64>::new(&make(agents, seed)));
        let fleets = fleets.collect::<Result<Vec<_>, _>>()?;
        let fleets: Vec<Vec<Motion<'_, f64>>> = fleets.iter().map(Fleet::motions).collect();
        let regions = AtomicUsize::new(0);
        let each = |motions: &[Motion<'_, f64>]| {
            agent_regions::each(motions, |row| {
                regions.fetch_add(2 * row.table().len(), Ordering::Relaxed);
            })
        };
        let table = |motions: &[Motion<'_, f64>]| build_ecm(motions).map(drop);
        let time = |clock: fn(&Stopwatch) -> f64, work: &RegionPass<'_>| {
            let watch = Stopwatch::start();
            fleets.iter().try_for_each(|motions| work(motions))?;
            Ok::<f64, CapacityError>(1e3 * clock(&watch) / count as f64)
        };
        let all_cores = time(Stopwatch::wall, &each)?;
        Ok(Self {
            agents,
            regions: regions.into_inner() as f64 / count as f64,
            rows: time(Stopwatch::elapsed, &in_turn)?,
            all_cores,
            table: (agents <= TABLE).then(|| time(Stopwatch::elapsed, &table)).transpose()?,
        })
    }
}

/// All rows on one core.
fn in_turn(motions: &[Motion<'_, f64>]) -> Result<(), CapacityError> {
    let grid = agent_regions::grid(motions);
    let mut walk = AgentRegionsWalk::new(motions, &grid);
    grid.order().into_iter().try_for_each(|ego| walk.row(ego as usize).map(drop))
}

/// Most memory that the process has from here on while it makes and streams a fleet \[MB\], where the system tells: all that it
/// has kept from before included.
pub(super) fn memory(make: &dyn Fn(usize, u64) -> Scenario, agents: usize) -> Result<Option<f64>, EvaluationError> {
    // From here on the peak counts anew.
    let _ = fs::write("/proc/self/clear_refs", "5");
    let fleet = Fleet::<f64>::new(&make(agents, 0))?;
    agent_regions::each(&fleet.motions(), |_| {})?;
    let peak = || line("/proc/self/status", "VmHWM")?.split(' ').next()?.parse::<f64>().ok();
    Ok(peak().map(|kilobytes| kilobytes / 1e3))
}
