//! Paths for the searches for the worst case: each is made of some bytes, and one of these is changed at a time.

use crate::Number;
use pcr_core::scalar::{self, Angle};
use pcr_core::{Curve, FleetStorage, InvalidInput, Limits, Point, Pose, Scalar, TurnSide};
use pcr_supervisor::{Agent, Step};

/// One metre, one second.
pub const ONE: Number = <Number as pcr_supervisor::Number>::ONE;

/// Largest number of segments of a path.
pub const LONGEST: usize = 8;

/// Rounds of a search: one, unless the build says how many. `None` if that is no number.
pub fn rounds() -> Option<u32> {
    option_env!("PCR_WORST_ROUNDS").map_or(Some(1), |rounds| rounds.parse().ok())
}

/// What an agent is made of, each from 0 to 255.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    /// Its place, its heading, the radius of its disc.
    pub start: [u8; 5],
    /// Its speed, acceleration and start time; tables do not depend on these.
    pub pace: [u8; 3],
    /// Its lines and arcs.
    pub steps: [[u8; 3]; LONGEST],
}

/// From 0 to 255/256.
fn part(byte: u8) -> Number {
    let (mut sum, mut weight) = (Number::ZERO, ONE);
    for bit in (0..8).rev() {
        weight = weight.half();
        if byte & 1 << bit != 0 {
            sum = sum + weight;
        }
    }
    sum
}

impl Course {
    /// Adds an agent on lines and arcs, full circles among them, that begins in a square of two metres: most of them meet others. Places and
    /// radii are multiples of 1/256 m, so that some touch exactly.
    ///
    /// # Errors
    /// [`InvalidInput::Full`] if the storage has no room.
    pub fn add<const A: usize, const N: usize>(
        &self,
        store: &mut FleetStorage<'_, Number, A, N>,
        size: usize,
    ) -> Result<usize, InvalidInput> {
        let least = ONE.half().half().half();
        let mut path = [Step { curve: Curve::Line, length: least }; LONGEST];
        let path = path.get_mut(..size).ok_or(InvalidInput::Full("segment"))?;
        for (step, [kind, radius, length]) in path.iter_mut().zip(self.steps) {
            let radius = least + part(radius);
            let circle = <Number as Scalar>::Angle::circumference(radius);
            let arc = |turn, length| Step { curve: Curve::Arc { radius, turn }, length };
            let some = scalar::Wide::narrow(circle.times(part(length)));
            *step = match kind % 4 {
                0 => Step { curve: Curve::Line, length: least + part(length).double() },
                1 => arc(TurnSide::Left, some),
                2 => arc(TurnSide::Right, some),
                _ => arc(TurnSide::Left, circle),
            };
        }
        let [x, y, ahead, aside, radius] = self.start.map(part);
        let start = Pose {
            position: Point::new(x.double(), y.double()),
            heading: <Number as Scalar>::Angle::atan2(ahead - ONE.half(), aside - ONE.half()),
        };
        let [speed, acceleration, start_time] = self.pace.map(part);
        let limits = Limits { speed: speed + ONE.half(), acceleration: acceleration + ONE.half() };
        let (radius, start_time) = (least + radius.half(), start_time.double().double());
        Agent { radius, start_time, limits, start, path: &*path }.add_to(store)
    }
}

/// Xorshift (Marsaglia 2003).
#[derive(Debug)]
pub struct Random(u32);

impl Default for Random {
    fn default() -> Self {
        Self::new()
    }
}

impl Random {
    /// Returns the same sequence every time.
    pub const fn new() -> Self {
        Self(1)
    }

    /// A number of this many bits.
    pub fn below(&mut self, bits: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0.wrapping_shr(32_u32.wrapping_sub(bits))
    }

    /// A byte.
    pub fn byte(&mut self) -> u8 {
        self.below(8) as u8
    }

    /// A path at 1 m/s and 1 m/s².
    pub fn course(&mut self) -> Course {
        let start = [(); 5].map(|()| self.byte());
        Course { start, pace: [128, 128, 0], steps: [[(); 3]; LONGEST].map(|step| step.map(|()| self.byte())) }
    }

    /// Changes one number of a path of this size, or of its pace: by one, or to any other.
    pub fn change(&mut self, course: &mut Course, size: usize, pace: bool) {
        if pace && self.below(2) == 0 {
            let at = self.below(2) as usize;
            return self.alter(course.pace.iter_mut().nth(at));
        }
        // Of the places of a path, the last ones count double, which does not matter.
        let all = size.saturating_mul(3).saturating_add(5);
        let at = (self.below(5) as usize).min(all.saturating_sub(1));
        self.alter(course.start.iter_mut().chain(course.steps.as_flattened_mut()).nth(at));
    }

    fn alter(&mut self, byte: Option<&mut u8>) {
        let Some(byte) = byte else { return };
        *byte = match self.below(2) {
            0 => byte.wrapping_add(1),
            1 => byte.wrapping_sub(1),
            _ => self.byte(),
        };
    }
}
