//! Reverses orders while robots are late: a robot that has not reached a region yet may let the other one go first, if
//! all can still finish and arrive sooner then.
//!
//! Every order belongs to a collision region, so robots do not touch; after each reversal all robots can still finish,
//! so none waits for ever (`docs/theory/precedence.md`, Theorem 6). Forecasts only decide which orders are better.

use super::fixed_precedences::FixedPrecedences;
use super::{ExecutionRule, LEAST, SPEED};
use pcr_execution::lifelong::{Gate, gates};

/// Largest step of the first robot between two gates \[m\]. Holds are those of the last gate that it has opened, so they are rounded
/// down.
const PITCH: f64 = 0.5;

/// Number of orders that are tried at each look, and number of further orders that may be reversed with one.
const TRIES: usize = 12;
const WITH: usize = 4;

/// Least gain of all robots together \[s\].
const GAIN: f64 = 0.5;

/// A gate of a region, at which a robot waits if it is second there.
#[derive(Clone, Copy, Debug)]
struct SwitchableWait {
    gate: Gate,
    first: usize,
    region: usize,
    /// Which of the two robots of the region it is.
    side: usize,
}

/// Orders that may be reversed.
pub(super) struct SwitchablePrecedences<'a> {
    kept: FixedPrecedences<'a>,
    /// For each region its two robots, and the gates of each of them.
    regions: Vec<([usize; 2], [Vec<Gate>; 2])>,
    /// For each region which robot is second; neither if it is over.
    second: Vec<usize>,
    /// For each robot the gates ahead, the nearest first.
    rows: Vec<Vec<SwitchableWait>>,
    ends: Vec<f64>,
}

/// Sum of the times until arrival, and the regions at which robots would wait, with the waits.
struct SwitchForecast {
    cost: f64,
    waits: Vec<(usize, f64)>,
}

/// The timeline of a robot in a forecast, with its delays beyond certain lengths.
struct ForecastTimeline {
    /// Time at which it would be at length 0 without waits \[s\].
    start: f64,
    delays: Vec<[f64; 2]>,
    next: usize,
}

impl ForecastTimeline {
    fn time(&self, length: f64) -> f64 {
        let late = self.delays.partition_point(|delay| delay[0] < length).checked_sub(1);
        self.start + length / SPEED + late.map_or(0.0, |last| self.delays[last][1])
    }
}

impl<'a> SwitchablePrecedences<'a> {
    pub(super) fn new(kept: FixedPrecedences<'a>, ends: Vec<f64>) -> Self {
        let mut rows: Vec<Vec<SwitchableWait>> = vec![Vec::new(); ends.len()];
        let mut regions = Vec::new();
        for (region, pair) in kept.pairs.iter().enumerate() {
            let both = [0, 1].map(|side| gates(&[pair.seen(side)], PITCH));
            for side in 0..2 {
                let wait = |&gate: &Gate| SwitchableWait { gate, first: pair.robots[1 - side], region, side };
                rows[pair.robots[side]].extend(both[side].iter().map(wait));
            }
            regions.push((pair.robots, both));
        }
        rows.iter_mut().for_each(|row| row.sort_by(|a, b| a.gate.wait_position.total_cmp(&b.gate.wait_position)));
        let second = kept.pairs.iter().map(|pair| pair.second).collect();
        Self { kept, regions, second, rows, ends }
    }

    /// The forecast if all go on as they can and stops last as long as expected; an error if a robot waits for ever.
    fn forecast(&self, at: &[f64], stopped: &[f64]) -> Result<SwitchForecast, Vec<usize>> {
        let count = at.len();
        let line =
            |robot: usize| ForecastTimeline { start: stopped[robot] - at[robot] / SPEED, delays: Vec::new(), next: 0 };
        let mut lines: Vec<ForecastTimeline> = (0..count).map(line).collect();
        let mut known: Vec<f64> = vec![f64::NEG_INFINITY; count];
        let mut waiting: Vec<Vec<usize>> = vec![Vec::new(); count];
        let mut open: Vec<usize> = (0..count).rev().collect();
        let (mut waits, mut done) = (Vec::new(), 0);
        let mut held: Vec<Option<usize>> = vec![None; count];
        while let Some(robot) = open.pop() {
            held[robot] = None;
            let before = known[robot];
            known[robot] = self.ends[robot];
            while let Some(&SwitchableWait { gate, first, region, side }) = self.rows[robot].get(lines[robot].next) {
                if gate.wait_position >= self.ends[robot] {
                    break;
                }
                if self.second[region] == side && gate.required_position > at[first] {
                    if gate.required_position > known[first] {
                        known[robot] = gate.wait_position - 2.0 * super::ROOM;
                        held[robot] = Some(region);
                        waiting[first].push(robot);
                        break;
                    }
                    let opens = lines[first].time(gate.required_position);
                    let late = lines[robot].delays.last().map_or(0.0, |delay| delay[1]);
                    let wait = opens - (lines[robot].start + gate.wait_position / SPEED + late);
                    if wait > LEAST {
                        lines[robot].delays.push([gate.wait_position, late + wait]);
                        waits.push((region, wait));
                    }
                }
                lines[robot].next += 1;
            }
            done += usize::from(known[robot] >= self.ends[robot] && before < self.ends[robot]);
            if known[robot] > before {
                open.append(&mut waiting[robot]);
            }
        }
        if done < count {
            return Err(held.into_iter().flatten().collect());
        }
        let cost = lines.iter().zip(&self.ends).map(|(line, &end)| line.time(end).max(0.0)).sum();
        Ok(SwitchForecast { cost, waits })
    }

    /// Whether the first of a region can be second from now on: it has not used its right.
    fn can_switch(&self, region: usize, at: &[f64]) -> bool {
        let (robots, gates) = &self.regions[region];
        let first = 1 - self.second[region];
        let passed = gates[first].partition_point(|gate| gate.required_position <= at[robots[1 - first]]);
        let hold = gates[first].get(passed).map_or(f64::INFINITY, |gate| gate.wait_position);
        at[robots[first]] <= hold - super::ROOM
    }

    /// Reverses the order at a region, and those that would keep a robot waiting for ever then; `None` if that is impossible.
    fn turned(&mut self, region: usize, at: &[f64], stopped: &[f64]) -> (Vec<usize>, Option<SwitchForecast>) {
        let mut turned = vec![region];
        self.second[region] = 1 - self.second[region];
        loop {
            let stuck = match self.forecast(at, stopped) {
                Ok(forecast) => return (turned, Some(forecast)),
                Err(stuck) => stuck,
            };
            let other = stuck.into_iter().find(|other| !turned.contains(other) && self.can_switch(*other, at));
            match other.filter(|_| turned.len() <= WITH) {
                Some(other) => {
                    turned.push(other);
                    self.second[other] = 1 - self.second[other];
                }
                None => return (turned, None),
            }
        }
    }
}

impl ExecutionRule for SwitchablePrecedences<'_> {
    fn authority(&mut self, robot: usize, at: &[f64], wanted: f64) -> f64 {
        self.kept.authority(robot, at, wanted)
    }

    fn on_tick(&mut self, at: &[f64], stopped: &[f64]) {
        for (robot, row) in self.rows.iter_mut().enumerate() {
            // A robot beyond a gate has used its right there.
            let counts =
                |wait: &SwitchableWait| wait.gate.wait_position >= at[robot] || self.second[wait.region] == wait.side;
            row.retain(|wait| wait.gate.required_position > at[wait.first] && counts(wait));
        }
        let Ok(mut forecast) = self.forecast(at, stopped) else { return };
        let mut tried = Vec::new();
        while tried.len() < TRIES {
            let fresh = |wait: &&(usize, f64)| !tried.contains(&wait.0) && self.can_switch(wait.0, at);
            let longest = forecast.waits.iter().filter(fresh).max_by(|a, b| a.1.total_cmp(&b.1));
            let Some(&(region, _)) = longest else { return };
            tried.push(region);
            match self.turned(region, at, stopped) {
                (turned, Some(other)) if other.cost + GAIN < forecast.cost => {
                    forecast = other;
                    turned.into_iter().for_each(|region| self.kept.switch(region));
                }
                (turned, _) => turned.into_iter().for_each(|region| self.second[region] = 1 - self.second[region]),
            }
        }
    }
}
