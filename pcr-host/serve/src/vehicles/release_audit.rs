//! Checks from the data of the vehicles that no two of them hold the same place at the same time: their released ways
//! ahead may come as near to one another as vehicles may, and no nearer.

use super::edge_reservations::distance;
use super::vehicle::SimulatedVehicle;
use serde::Serialize;

/// The result of an audit.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ReleaseAudit {
    /// Number of looks at all vehicles.
    pub looks: u64,
    /// Number of pairs of vehicles, at all looks, whose released ways came too near.
    pub twice: u64,
    /// Time \[s\] and names of the first such pair.
    pub first: Option<(f64, [String; 2])>,
    /// Time of the last look \[s\].
    #[serde(skip)]
    last: Option<f64>,
}

/// Time between two looks \[s\].
const PAUSE: f64 = 1.0;

/// Allowance for rounding \[m\].
const ROUNDING: f64 = 1e-6;

impl ReleaseAudit {
    /// Looks at all vehicles, once a second of their time.
    pub fn observe<'a>(&mut self, time: f64, vehicles: impl Iterator<Item = &'a SimulatedVehicle>) {
        if self.last.is_some_and(|last| time < last + PAUSE) {
            return;
        }
        (self.last, self.looks) = (Some(time), self.looks + 1);
        let ways: Vec<_> = vehicles.map(ReleasedPath::of).collect();
        for (k, a) in ways.iter().enumerate() {
            for b in ways.iter().skip(k + 1).filter(|b| a.meets(b)) {
                self.twice += 1;
                self.first.get_or_insert_with(|| (time, [a, b].map(|way| way.vehicle.key().to_string())));
            }
        }
    }
}

struct ReleasedPath<'a> {
    vehicle: &'a SimulatedVehicle,
    points: Vec<[f64; 2]>,
    /// Least and largest value of each coordinate.
    span: [[f64; 2]; 2],
}

impl<'a> ReleasedPath<'a> {
    fn of(vehicle: &'a SimulatedVehicle) -> Self {
        let points = vehicle.released();
        let least = |of: fn(f64, f64) -> f64, start: f64| {
            [0, 1].map(|axis| points.iter().map(|point| point[axis]).fold(start, of))
        };
        let span = [least(f64::min, f64::INFINITY), least(f64::max, f64::NEG_INFINITY)];
        Self { vehicle, points, span }
    }

    fn legs(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let only = self.points.first().filter(|_| self.points.len() == 1).map(|&point| [point; 2]);
        only.into_iter().chain(self.points.windows(2).map(|leg| [leg[0], leg[1]]))
    }

    fn meets(&self, other: &Self) -> bool {
        // Of a rectangle the disc inside of it, which it is whatever its heading is.
        let inner = |way: &Self| match way.vehicle.abilities().rectangle {
            Some(sides) => 0.5 * sides[0].min(sides[1]),
            None => way.vehicle.abilities().radius,
        };
        let apart = inner(self) + inner(other) - ROUNDING;
        let far = |axis: usize| {
            self.span[0][axis] > other.span[1][axis] + apart || other.span[0][axis] > self.span[1][axis] + apart
        };
        !far(0) && !far(1) && self.legs().any(|leg| other.legs().any(|their| distance(leg, their) < apart))
    }
}
