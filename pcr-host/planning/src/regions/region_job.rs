//! The regions of a fleet of any size, one agent at a time, sorted by id. A grid finds the agents that come near each
//! other, and rows are computed on all cores. Each row is freed after it has been passed on.

use super::certificate_tables::table_of;
use super::entries::RegionBuilder;
use super::{AgentBodies, RegionEntry, RegionOptions, RegionsReport, body_regions};
use crate::agent_regions::{self, AgentRegions, BoxGrid, ProgressFn};
use crate::bodies::BodyFleet;
use crate::failure::ComputationError;
use crate::fleet::HostScalar;
use crate::memory_budget::MemoryBudget;
use crate::parallel;
use pcr_core::Motion;
use pcr_formats::scenario::{Labels, Scenario};
use std::ops::Range;

/// Pairs of bodies whose regions are held at once: enough for all cores, and some megabytes.
const STRETCH: u64 = 1 << 15;

/// The agents that are asked for, one or all, by their numbers.
fn asked_for(ids: &[u64], agent: Option<u64>) -> Vec<usize> {
    let mut egos: Vec<usize> = (0..ids.len()).filter(|&ego| agent.is_none_or(|it| ids[ego] == it)).collect();
    egos.sort_by_key(|&ego| ids[ego]);
    egos
}

/// All that the regions of a scenario are computed from.
pub struct RegionJob<'s, S: HostScalar> {
    pub(super) scenario: &'s Scenario,
    pub(super) request: RegionOptions,
    pub(super) labels: Labels,
    bodies: BodyFleet<S>,
    ids: Vec<u64>,
    /// For each agent the places of its bodies.
    places: Vec<Range<usize>>,
    /// The agents that are asked for, by their numbers.
    egos: Vec<usize>,
}

impl<'s, S: HostScalar> RegionJob<'s, S> {
    /// The scenario in the format `S`.
    ///
    /// # Errors
    /// [`ComputationError`] where a value does not fit the format, or the agent asked for is not there.
    pub fn new(scenario: &'s Scenario, request: RegionOptions) -> Result<Self, ComputationError> {
        let ids: Vec<u64> = scenario.agents.iter().map(|agent| agent.id).collect();
        if let Some(asked) = request.agent.filter(|asked| !ids.contains(asked)) {
            return Err(ComputationError::NoSuchAgent(asked, ids));
        }
        let bodies = BodyFleet::<S>::new(scenario)?;
        let mut places = vec![0..0; ids.len()];
        for (place, body) in bodies.bodies.iter().enumerate() {
            if let Some(own) = places.get_mut(body.agent) {
                *own = if own.start < own.end { own.start..place + 1 } else { place..place + 1 };
            }
        }
        let egos = asked_for(&ids, request.agent);
        Ok(Self { scenario, request, labels: Labels::from_scenario(scenario), bodies, ids, places, egos })
    }

    /// Pairs of bodies that come near one another, each counted from both sides: what a pass looks at.
    pub fn near(&self) -> usize {
        agent_regions::grid(&self.bodies.fleet.motions()).counts().iter().map(|&count| count as usize).sum()
    }

    /// Whether any agent has a margin.
    pub(crate) fn has_margins(&self) -> bool {
        self.bodies.fleet.motions().iter().any(|motion| motion.margin() > S::ZERO)
    }

    /// Calls `make` for the regions of each agent, on all cores, and passes its values to `take` in the order of the agents'
    /// numbers. With `margin`, the regions are those of the bodies with margins.
    ///
    /// # Errors
    /// Errors of `take`, and [`ComputationError`] for a pair that does not fit in a table.
    pub fn each<T: Send, E: From<ComputationError>>(
        &self,
        margin: bool,
        told: ProgressFn<'_>,
        make: impl Fn(Vec<RegionEntry>) -> T + Sync,
        mut take: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut motions = self.bodies.fleet.motions();
        if margin {
            motions.iter_mut().for_each(|motion| *motion = motion.inflated());
        }
        let grid = agent_regions::grid(&motions);
        let counts = grid.counts();
        let work = |ego: usize| self.places[ego].clone().map(|body| u64::from(counts[body])).sum::<u64>();
        let total = self.egos.iter().map(|&ego| work(ego) as usize).sum();
        let (mut rest, mut done) = (&self.egos[..], 0);
        while !rest.is_empty() {
            let mut held = 0;
            let more = |&&ego: &&usize| {
                let before = held;
                held += work(ego) + 1;
                before < STRETCH
            };
            let (stretch, after) = rest.split_at(rest.iter().take_while(more).count());
            for row in
                parallel::map_parallel(0..stretch.len(), &|k| self.regions(&motions, &grid, stretch[k]).map(&make))
            {
                take(row?)?;
            }
            done += stretch.iter().map(|&ego| work(ego) as usize).sum::<usize>();
            told(done, total);
            rest = after;
        }
        Ok(())
    }

    /// The regions of one agent.
    fn regions(
        &self,
        motions: &[Motion<'_, S>],
        grid: &BoxGrid,
        ego: usize,
    ) -> Result<Vec<RegionEntry>, ComputationError> {
        let mut near = Vec::new();
        let rows = self.places[ego].clone().map(|body| {
            grid.around(body, &mut near);
            AgentRegions::new(motions, body, &near)
        });
        let rows = rows
            .collect::<Result<Vec<_>, _>>()
            .map_err(|full| ComputationError::Full(full).named(&self.bodies.scenario))?;
        let works = rows.iter().map(|row| {
            let (fleet, slices) = (&self.bodies.fleet, self.request.slices);
            let (agents, motions, ecm) = (row.agents(), row.motions(), row.table());
            (RegionBuilder { fleet, agents, motions, ecm, slices }, row.agent_index())
        });
        let works: Vec<(RegionBuilder<'_, S>, usize)> = works.collect();
        let mut regions = body_regions::regions(&works, &self.bodies.bodies, &self.ids);
        regions.sort_by(RegionEntry::by_other);
        Ok(regions)
    }

    /// The answer without its regions.
    ///
    /// # Errors
    /// [`ComputationError`] where a value does not fit the format.
    pub fn head(&self) -> Result<RegionsReport, ComputationError> {
        let certificate = || table_of::<S>(self.scenario);
        Ok(RegionsReport {
            name: self.scenario.name.clone(),
            labels: self.labels.clone(),
            scalar: S::NAME,
            agent: self.request.agent,
            regions: Vec::new(),
            margin_regions: self.has_margins().then(Vec::new),
            bodies: AgentBodies::all(self.scenario, &self.bodies.bodies, &self.bodies.scenario),
            warnings: self.scenario.warnings.clone(),
            certificate: self.request.certificate.then(certificate).transpose()?,
            error: None,
        })
    }

    /// All regions at once.
    ///
    /// # Errors
    /// As [`RegionJob::each`]; [`ComputationError::TooLarge`] where memory does not hold them.
    pub fn answer(&self, told: ProgressFn<'_>) -> Result<RegionsReport, ComputationError> {
        let regions = self.all(false, told)?;
        let head = self.head()?;
        let margin_regions = head.margin_regions.is_some().then(|| self.all(true, told)).transpose()?;
        Ok(RegionsReport { regions, margin_regions, ..head })
    }

    fn all(&self, margin: bool, told: ProgressFn<'_>) -> Result<Vec<RegionEntry>, ComputationError> {
        let (mut all, mut held) = (Vec::new(), MemoryBudget::default());
        self.each(
            margin,
            told,
            |row| row,
            |row| {
                let beside = row.iter().map(RegionEntry::bytes).sum();
                Ok::<(), ComputationError>(held.extend(&mut all, row, beside, "regions")?)
            },
        )?;
        Ok(all)
    }
}
