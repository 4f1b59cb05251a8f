//! Start delays for as many agents as possible: many orders of priority are tried.
//!
//! Agents that cannot start because of others go first in the next order that is tried; if all can start, the one that
//! waits longest goes first.

use pcr_formats::splitmix64::SplitMix64;
use pcr_planning::plan::{DelaySchedule, ForbiddenDelays};

/// Orders from which the search sets out at random, beside that of the fleet and the longest motion first.
const RANDOM: usize = 8;

/// Orders that follow from each of them.
const ROUNDS: usize = 200;

/// The schedule of the most agents, and of those the one with the least sum of delays, of all orders that are tried.
pub(super) fn best(forbidden: &ForbiddenDelays, longest_first: Vec<usize>, seed: u64) -> DelaySchedule {
    let file: Vec<usize> = (0..forbidden.len()).collect();
    let mut orders = SplitMix64(seed);
    let random: Vec<_> = (0..RANDOM).map(|_| orders.shuffled(&file)).collect();
    let tried = [file, longest_first].into_iter().chain(random).flat_map(|order| {
        let first = forbidden.plan_in_order(forbidden.respecting(&order));
        std::iter::successors(Some(first), |before| reprioritize(forbidden, before)).take(ROUNDS)
    });
    let waits = |schedule: &DelaySchedule| schedule.delays.iter().flatten().sum::<f64>();
    let better =
        |a: &DelaySchedule, b: &DelaySchedule| a.out.len().cmp(&b.out.len()).then(waits(a).total_cmp(&waits(b)));
    tried.min_by(better).unwrap_or_default()
}

/// The schedule for the order in which agents without a delay, or the agent with the longest delay, come first.
fn reprioritize(forbidden: &ForbiddenDelays, before: &DelaySchedule) -> Option<DelaySchedule> {
    let longest = before.delays.iter().flatten().fold(0.0_f64, |longest, delay| longest.max(*delay));
    let moves_up = |agent: usize| match before.delays.get(agent).copied().flatten() {
        None => true,
        Some(delay) => before.out.is_empty() && delay > 0.0 && delay >= longest,
    };
    let (mut order, mut later): (Vec<usize>, Vec<usize>) = before.order.iter().partition(|&&agent| moves_up(agent));
    order.append(&mut later);
    // Agents without a delay are tried before all others, even if that cannot succeed for all.
    let order = if before.out.is_empty() { forbidden.respecting(&order) } else { order };
    (order != before.order).then(|| forbidden.plan_in_order(order))
}
