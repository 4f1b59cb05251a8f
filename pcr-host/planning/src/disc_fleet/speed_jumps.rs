//! Joins the pieces of a motion at the places where its speed jumps.
//!
//! A profile has no jumps: the speed changes within a short time, half of which either neighbour gives. Pieces that are too short to give
//! any are replaced as well, together with the jumps at both their ends. What replaces them takes the same time and goes the same way, so
//! that nothing before or after is moved; in between, the agent is off by less than that way.

/// A piece of a motion at constant acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ProfilePiece {
    /// \[s\]
    pub(super) duration: f64,
    /// Speed at its start and at its end \[m/s\].
    pub(super) speed: [f64; 2],
    /// Way at its start that takes no time \[m\]: a turn in place, which has a small radius.
    pub(super) detour: f64,
}

impl ProfilePiece {
    fn way(&self) -> f64 {
        self.detour + 0.5 * (self.speed[0] + self.speed[1]) * self.duration
    }

    fn speed_after(&self, time: f64) -> f64 {
        self.speed[0] + (self.speed[1] - self.speed[0]) * (time / self.duration)
    }

    /// The parts before and after a time.
    fn cut(&self, time: f64) -> [Self; 2] {
        let between = self.speed_after(time);
        [
            Self { duration: time, speed: [self.speed[0], between], ..*self },
            Self { duration: self.duration - time, speed: [between, self.speed[1]], detour: 0.0 },
        ]
    }
}

/// A motion without jumps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ContinuousMotion {
    pub(super) pieces: Vec<ProfilePiece>,
    /// Largest distance from the given motion \[m\].
    pub(super) position_error: f64,
}

/// The largest change of speed between two pieces \[m/s\].
pub(super) fn largest_jump(given: &[ProfilePiece]) -> f64 {
    given.windows(2).map(|pair| (pair[1].speed[0] - pair[0].speed[1]).abs()).fold(0.0, f64::max)
}

/// What a number format can tell apart, and how long a change of speed takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct TimeResolution {
    /// \[s\]
    pub(super) change: f64,
    /// Speed that is rounding and nothing else \[m/s\].
    pub(super) nothing: f64,
    /// Times that are shorter than this are left out \[s\].
    pub(super) tick: f64,
}

/// The motion without its jumps.
pub(super) fn joined(given: &[ProfilePiece], times: TimeResolution) -> ContinuousMotion {
    let TimeResolution { change: least, nothing, .. } = times;
    let jumps = |k: usize| {
        let [before, after] = [given[k].speed[1], given[k + 1].speed[0]];
        let differ = (after - before).abs() > nothing || before != after && (before == 0.0 || after == 0.0);
        differ || given[k + 1].detour > 0.0
    };
    let mut own = ContinuousMotion { pieces: Vec::new(), position_error: 0.0 };
    // The pieces that are replaced together, as far as they are known.
    let mut open: Vec<ProfilePiece> = Vec::new();
    for (k, piece) in given.iter().enumerate() {
        let [begins, ends] = [k > 0 && jumps(k - 1), k + 1 < given.len() && jumps(k)];
        if (begins || ends || !open.is_empty()) && piece.duration < 2.0 * least {
            open.push(*piece);
            continue;
        }
        let mut rest = *piece;
        if begins || !open.is_empty() {
            let [given, left] = rest.cut(0.5 * least);
            open.push(given);
            rest = left;
            own.replace(&mut open, times);
        }
        let lent = ends.then(|| rest.cut(rest.duration - 0.5 * least));
        own.pieces.push(lent.map_or(rest, |[kept, _]| kept));
        open.extend(lent.map(|[_, lent]| lent));
    }
    own.replace(&mut open, times);
    own
}

impl ContinuousMotion {
    /// Adds at most three pieces of the same time and way in the place of these.
    fn replace(&mut self, open: &mut Vec<ProfilePiece>, TimeResolution { nothing, tick, .. }: TimeResolution) {
        let (Some(first), Some(last)) = (open.first(), open.last()) else { return };
        let ends = [first.speed[0], last.speed[1]];
        let time: f64 = open.iter().map(|piece| piece.duration).sum();
        let way: f64 = open.iter().map(ProfilePiece::way).sum();
        open.clear();
        self.position_error = self.position_error.max(way);
        let mean = 0.5 * (ends[0] + ends[1]);
        let middle = 2.0 * way / time - mean;
        let mut add = |duration: f64, speed: [f64; 2]| self.pieces.push(ProfilePiece { duration, speed, detour: 0.0 });
        // If it is slow enough in between, it stands for some time.
        let ramp = way / mean;
        let stands = time - 2.0 * ramp;
        if (middle - mean).abs() <= nothing {
            add(time, ends);
        } else if middle >= 0.0 || stands < tick {
            add(0.5 * time, [ends[0], middle.max(0.0)]);
            add(0.5 * time, [middle.max(0.0), ends[1]]);
        } else {
            add(ramp, [ends[0], 0.0]);
            add(stands, [0.0; 2]);
            add(ramp, [0.0, ends[1]]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(duration: f64, before: f64, after: f64) -> ProfilePiece {
        ProfilePiece { duration, speed: [before, after], detour: 0.0 }
    }

    /// The way after a time.
    fn travelled(pieces: &[ProfilePiece], time: f64) -> f64 {
        let mut left = time;
        let mut way = 0.0;
        for piece in pieces.iter().filter(|piece| piece.duration > 0.0) {
            let own = left.clamp(0.0, piece.duration);
            way += piece.cut(own)[0].way();
            left -= own;
        }
        way
    }

    #[test]
    fn nothing_before_or_after_is_moved() {
        let cases = [
            vec![piece(1.0, 0.0, 2.0), piece(1.0, 5.0, 5.0), piece(1.0, 2.0, 0.0)],
            vec![piece(1.0, 1.0, 1.0), piece(1e-4, 300.0, 300.0), piece(2.0, 1.0, 0.0)],
            vec![piece(1.0, 1.0, 1.0), piece(1e-3, 0.0, 0.0), piece(2.0, 1.0, 0.0)],
            vec![piece(1.0, 1.0, 1.0), piece(1.5e-3, 0.01, 0.01), piece(1e-4, 4.0, 3.0), piece(2.0, 1.0, 0.0)],
            vec![piece(1e-4, 5.0, 5.0), piece(1.0, 1.0, 1.0), piece(5.0, 0.0, 0.0), piece(1e-4, 7.0, 7.0)],
            vec![piece(1e-4, 5.0, 5.0), piece(1e-5, 1.0, 1.0)],
            // Short ones behind a jump, without another one between them.
            vec![
                piece(1.0, 1.0, 1.0),
                piece(1e-4, 3.0, 2.0),
                piece(1e-4, 2.0, 2.0),
                piece(1e-4, 2.0, 1.0),
                piece(1.0, 1.0, 0.0),
            ],
            vec![piece(1.0, 0.0, 1.0), piece(1.0, 1.0, 0.0)],
        ];
        for given in cases {
            let ContinuousMotion { pieces, position_error: off } =
                joined(&given, TimeResolution { change: 1e-3, nothing: 1e-12, tick: 1e-15 });
            for pair in pieces.windows(2) {
                assert!((pair[0].speed[1] - pair[1].speed[0]).abs() <= 1e-12, "{pieces:?}");
            }
            assert!(pieces.iter().all(|piece| piece.duration >= 0.0 && piece.speed.iter().all(|speed| *speed >= 0.0)));
            let whole: f64 = given.iter().map(|piece| piece.duration).sum();
            let times: f64 = pieces.iter().map(|piece| piece.duration).sum();
            assert!((whole - times).abs() < 1e-9, "{pieces:?}");
            let mut worst = 0.0_f64;
            for k in 0..=100_000 {
                let time = whole * f64::from(k) / 1e5;
                worst = worst.max((travelled(&given, time) - travelled(&pieces, time)).abs());
            }
            assert!(worst <= off + 1e-9, "{worst} {off} {pieces:?}");
            assert!((travelled(&given, whole) - travelled(&pieces, whole)).abs() < 1e-6, "{pieces:?}");
        }
    }
}
