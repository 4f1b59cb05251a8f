//! How far planning is, for those who wait for it.

/// A part of planning. The parts take their time one after the other; some plans skip some of them, or come back to one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanStage {
    /// The regions of all agents: agents, or discs of their outlines.
    Regions,
    /// Whether all agents can have a plan, and which ones cannot. How long this takes is not known.
    LeftOut,
    /// The search for start delays: steps of the searches that are allowed. Without a limit their number is not known.
    Delays,
    /// The search for speeds: plans of single agents at most.
    Speeds,
    /// Checks of the plan: agents, or discs of their outlines.
    Check,
}

impl PlanStage {
    /// Returns what is counted, for a line about the progress.
    pub fn name(self) -> &'static str {
        match self {
            Self::Regions => "regions of agents",
            Self::LeftOut => "searches for agents to leave out",
            Self::Delays => "searches for start delays",
            Self::Speeds => "searches for speeds",
            Self::Check => "checks of the plan",
        }
    }
}

/// Is told the part of planning, how much of it is done, and how much there is; 0 if that is not known.
pub type PlanProgressFn<'t> = &'t (dyn Fn(PlanStage, usize, usize) + Sync);
