//! The sampled collision map: both paths are sampled at even times, and every pair of samples within the sum of the
//! radii is a point of a region. This is the computational method that the paper compares with (its reference 34),
//! here optimized: single precision, sixteen distances at a time, runs of points instead of single points.

use super::disc_track::{DiscTrack, EMPTY, hull, near};
use super::{CollisionMethod, ComparisonFleet, MethodAnswer, MethodQuestion, MethodResult, RegionSet};
use pcr_drawing::BlockedBar;

/// Distances that are computed together before any of them is looked at.
const LANES: usize = 16;

/// With a time between samples \[s\], and with boxes around paths and runs of samples or without.
struct SampledMethod {
    step: f64,
    boxes: bool,
}

pub(super) fn methods() -> Vec<Box<dyn CollisionMethod>> {
    let all = [(0.01, false), (0.01, true), (0.1, false), (0.1, true)];
    all.into_iter().map(|(step, boxes)| Box::new(SampledMethod { step, boxes }) as Box<dyn CollisionMethod>).collect()
}

impl CollisionMethod for SampledMethod {
    fn name(&self) -> String {
        format!("sampled map {} s{}", self.step, if self.boxes { ", boxes" } else { "" })
    }

    fn question(&self) -> MethodQuestion {
        MethodQuestion::Regions
    }

    fn output_description(&self) -> &'static str {
        "points of regions"
    }

    fn answer<'f>(&self, field: &'f ComparisonFleet<'_>) -> MethodResult<'f> {
        Ok(MethodAnswer::Regions(Box::new(self.map(field))))
    }
}

/// What the map of an agent says at all samples.
pub fn bars(field: &ComparisonFleet<'_>, step: f64, ego: usize) -> Vec<BlockedBar> {
    let map = SampledMethod { step, boxes: true }.map(field);
    let mut bars = Vec::new();
    for (other, samples) in map.samples.iter().enumerate().filter(|(other, _)| *other != ego) {
        for time in (0..samples.lengths.len()).map(|k| samples.begin + step * k as f64) {
            bars.extend(map.slice(ego, other, time).into_iter().map(|part| BlockedBar { other, time, part }));
        }
    }
    bars
}

impl SampledMethod {
    fn map(&self, field: &ComparisonFleet<'_>) -> SampledCollisionMap {
        let samples: Vec<TrackSamples> = field.tracks.iter().map(|track| TrackSamples::new(track, self.step)).collect();
        let mut pairs = Vec::new();
        for (first, a) in samples.iter().enumerate() {
            for (second, b) in samples.iter().enumerate().skip(first + 1) {
                let runs = a.runs(b, self.boxes);
                if !runs.is_empty() {
                    pairs.push(SampledPair { agents: [first, second], runs });
                }
            }
        }
        SampledCollisionMap { samples, pairs }
    }
}

/// The samples of a track.
struct TrackSamples {
    radius: f32,
    begin: f64,
    step: f64,
    /// \[m\]
    lengths: Vec<f64>,
    /// Filled up with points that are near nothing.
    x: Vec<f32>,
    y: Vec<f32>,
    bounds: [f64; 4],
    /// Of each [`LANES`] samples.
    boxes: Vec<[f64; 4]>,
}

/// Samples `from..=to` of the first path are near the sample `at` of the second one.
struct SampleRun {
    at: u32,
    from: u32,
    to: u32,
}

struct SampledPair {
    agents: [usize; 2],
    /// By `at`.
    runs: Vec<SampleRun>,
}

struct SampledCollisionMap {
    samples: Vec<TrackSamples>,
    pairs: Vec<SampledPair>,
}

impl TrackSamples {
    fn new(track: &DiscTrack, step: f64) -> Self {
        let [begin, end] = track.time;
        let count = ((end - begin) / step).ceil() as usize;
        let lengths: Vec<f64> = (0..=count).map(|k| track.length_at(begin + step * k as f64)).collect();
        let points: Vec<[f64; 2]> = lengths.iter().map(|&length| track.at(length)).collect();
        let boxes = points.chunks(LANES).map(|run| run.iter().fold(EMPTY, |b, &point| hull(b, point, 0.0)));
        let filled = lengths.len().next_multiple_of(LANES);
        let axis = |axis: usize| {
            let mut values: Vec<f32> = points.iter().map(|point| point[axis] as f32).collect();
            values.resize(filled, f32::INFINITY);
            values
        };
        let (x, y) = (axis(0), axis(1));
        Self { radius: track.radius as f32, begin, step, x, y, bounds: track.bounds(), boxes: boxes.collect(), lengths }
    }

    /// The samples of this path that are near those of another one.
    fn runs(&self, other: &Self, boxes: bool) -> Vec<SampleRun> {
        let reach = self.radius + other.radius;
        let mut runs = Vec::new();
        if boxes && !near(self.bounds, other.bounds, f64::from(reach)) {
            return runs;
        }
        for (at, (&x, &y)) in other.x.iter().zip(&other.y).enumerate().take(other.lengths.len()) {
            let point = [f64::from(x), f64::from(y), f64::from(x), f64::from(y)];
            if boxes && !near(self.bounds, point, f64::from(reach)) {
                continue;
            }
            let chunks = self.x.chunks_exact(LANES).zip(self.y.chunks_exact(LANES)).zip(&self.boxes);
            for (chunk, ((xs, ys), around)) in chunks.enumerate() {
                if boxes && !near(*around, point, f64::from(reach)) {
                    continue;
                }
                let mut within = [false; LANES];
                for ((within, other_x), other_y) in within.iter_mut().zip(xs).zip(ys) {
                    let (dx, dy) = (other_x - x, other_y - y);
                    *within = dx * dx + dy * dy <= reach * reach;
                }
                if within.iter().fold(false, |any, within| any | within) {
                    add(&mut runs, at as u32, (chunk * LANES) as u32, &within);
                }
            }
        }
        runs
    }

    /// The part of the path that the samples `from..=to` stand for: half way to the next ones \[m\].
    fn part(&self, from: usize, to: usize) -> [f64; 2] {
        let at = |k: usize| self.lengths[k.min(self.lengths.len() - 1)];
        [0.5 * (at(from.saturating_sub(1)) + at(from)), 0.5 * (at(to) + at(to + 1))]
    }

    fn nearest(&self, time: f64) -> usize {
        (((time - self.begin) / self.step).round().max(0.0) as usize).min(self.lengths.len() - 1)
    }
}

/// Adds those of some samples that are near, to the run before where they go on.
fn add(runs: &mut Vec<SampleRun>, at: u32, first: u32, within: &[bool]) {
    for (sample, _) in (first..).zip(within).filter(|(_, within)| **within) {
        match runs.last_mut() {
            Some(run) if run.at == at && run.to + 1 == sample => run.to = sample,
            _ => runs.push(SampleRun { at, from: sample, to: sample }),
        }
    }
}

impl SampledCollisionMap {
    fn pair(&self, agents: [usize; 2]) -> &[SampleRun] {
        let place = self.pairs.binary_search_by_key(&agents, |pair| pair.agents);
        place.map_or(&[], |place| &self.pairs[place].runs)
    }
}

impl RegionSet for SampledCollisionMap {
    /// Pairs with any: what belongs together is not known.
    fn count(&self) -> usize {
        2 * self.pairs.len()
    }

    /// The paper's way: a point is a time and a length, and there is one in each direction.
    fn bytes(&self) -> usize {
        let points = self.pairs.iter().flat_map(|pair| &pair.runs).map(|run| (run.to - run.from + 1) as usize);
        2 * points.sum::<usize>() * size_of::<[f32; 2]>()
    }

    fn slice(&self, ego: usize, other: usize, time: f64) -> Vec<[f64; 2]> {
        let at = self.samples[other].nearest(time);
        let path = &self.samples[ego];
        if ego < other {
            let runs = self.pair([ego, other]);
            let begin = runs.partition_point(|run| (run.at as usize) < at);
            let runs = runs[begin..].iter().take_while(|run| run.at as usize == at);
            return runs.map(|run| path.part(run.from as usize, run.to as usize)).collect();
        }
        let holds = |run: &&SampleRun| (run.from..=run.to).contains(&(at as u32));
        let mut slices: Vec<[f64; 2]> = Vec::new();
        for run in self.pair([other, ego]).iter().filter(holds) {
            let [from, to] = path.part(run.at as usize, run.at as usize);
            match slices.last_mut() {
                Some(last) if last[1] >= from => last[1] = to,
                _ => slices.push([from, to]),
            }
        }
        slices
    }
}
