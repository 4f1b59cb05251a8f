//! Who goes first, and how far everybody may go then.
//!
//! Two robots that keep apart at the times of their paths pass in the order that these have. Of two that do not, the one goes first that stands
//! where they would meet; then the one that gets there earlier; then the one that is configured first. If each of them stands where the other one
//! passes, neither may go. Nobody is taken to be further than at the beginning of his path, so that an authority holds wherever the others are.

use pcr_core::{
    AdmissionError, CheckState, CheckTolerances, EcmEntry, MismatchError, Motion, MovementAuthority, PassingState,
    Piece, PrecedenceTable, Progress, RegionPrecedence, RegionRef,
};

/// How far a robot may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Place {
    End,
    /// Up to this length of its path, before a place that another robot passes first.
    Before {
        length: f64,
        other: usize,
    },
    /// It stands where another robot passes first.
    Nowhere {
        other: usize,
    },
}

/// The places of all robots.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Order {
    pub(crate) places: Vec<Place>,
    /// If some would wait for ever: one that waits, and for whom.
    pub(crate) stuck: Vec<usize>,
}

type Table = PrecedenceTable<f64, Vec<EcmEntry>, Vec<Piece<f64>>, Vec<RegionPrecedence<f64>>>;

/// A gain that does not count as one \[m\].
const GAIN: f64 = 1e-3;

/// The order of a fleet, or why there is none.
pub(crate) fn of(fleet: &[Motion<'_, f64>]) -> Result<Order, String> {
    let mut table = Table::grown(fleet).map_err(|full| full.to_string())?;
    decide(&mut table, fleet).map_err(|problem| problem.to_string())?;
    let progress = vec![Progress::at_rest(0.0); fleet.len()];
    let mut places = Vec::with_capacity(fleet.len());
    for agent in 0..fleet.len() {
        let (authority, other) = table.wait(fleet, agent, &progress).map_err(|problem| problem.to_string())?;
        let other = other.ok_or("a robot waits for nobody");
        places.push(match authority {
            MovementAuthority::Free => Place::End,
            MovementAuthority::At(length) => Place::Before { length, other: other? },
            MovementAuthority::Inside => Place::Nowhere { other: other? },
        });
    }
    let mut reaches = vec![CheckState::EMPTY; fleet.len()];
    let tolerances = CheckTolerances { width: 0.0, gain: GAIN };
    let stuck = match table.check(fleet, &progress, tolerances, &mut reaches) {
        Ok(()) => Vec::new(),
        Err(AdmissionError::Stuck { agent, by, .. } | AdmissionError::Late { agent, by, .. }) => vec![agent, by],
        Err(problem) => return Err(problem.to_string()),
    };
    Ok(Order { places, stuck })
}

/// Decides the order in all regions.
fn decide(table: &mut Table, fleet: &[Motion<'_, f64>]) -> Result<(), MismatchError> {
    let mut decided = Vec::new();
    for agent in 0..fleet.len() {
        let own = table.row(fleet, agent)?.filter(|(_, region, _)| region.other() > agent);
        decided.extend(own.map(|(place, region, _)| (place, agent, earlier(&region))));
    }
    for (place, agent, state) in decided.into_iter().filter(|(.., state)| *state != PassingState::Undecided) {
        table.decide_at(fleet, place, agent, state, 0.0)?;
    }
    Ok(())
}

/// Whether the ego of a region goes first. Undecided, neither may go there.
fn earlier(region: &RegionRef<'_, f64>) -> PassingState {
    let swapped = region.clone().swapped();
    let stands = [region, &swapped].map(|region| region.hold(0.0, 0.0) == MovementAuthority::Inside);
    match stands {
        [true, true] => return PassingState::Undecided,
        [true, false] => return PassingState::First,
        [false, true] => return PassingState::Second,
        [false, false] => {}
    }
    // If it would meet the other one by being late, it is before it.
    let late = region.forbidden_delays();
    let entry = |region: &RegionRef<'_, f64>| region.ego_motion().time_in(region.length()).lo;
    let is_first = late.lo > 0.0 || (late.hi >= 0.0 && entry(region) <= entry(&swapped));
    if is_first { PassingState::First } else { PassingState::Second }
}
