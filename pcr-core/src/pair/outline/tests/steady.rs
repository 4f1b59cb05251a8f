//! Outlines that keep their heading on arcs, against the independent distance, and with the numbers at which closed forms degenerate.

use super::*;

impl Case {
    /// Returns the case with bodies that keep their heading on most arcs, and with a disc in place of some outline. At the start the angle to the
    /// direction of travel is anything.
    pub(super) fn with_steady(mut self, random: &mut Random) -> Self {
        for step in self.segments.iter_mut().flatten() {
            if let Step::Arc(radius, length) = *step
                && random.below(4) > 0
            {
                *step = Step::Steady(radius, length);
            }
        }
        self.kinks = [(); 2].map(|()| Vec::from([[0.0, PI, FRAC_PI_2, random.within(-3.0, 3.0)][random.below(4)]]));
        for outline in &mut self.outlines {
            if random.below(6) == 0 {
                *outline = Outline::disc(0.125 * (1 + random.below(4)) as f64).unwrap();
            }
        }
        self
    }

    /// On a grid: arcs about one centre or near to it, of equal radii or of the radius R, bodies with parallel edges, full circles.
    fn degenerate(random: &mut Random) -> Self {
        let mut eighths = |lo: usize, hi: usize| 0.125 * (lo + random.below(hi - lo)) as f64;
        let roundings = [eighths(0, 3), eighths(0, 3)];
        let outlines = roundings.map(|rounding| {
            let [ahead, behind, left, right] = [eighths(1, 6), eighths(1, 6), eighths(1, 4), eighths(1, 4)];
            let [behind, left, right] = if rounding > 0.0 {
                [behind, left, right].map(|side| if side > 0.4 { 0.0 } else { side })
            } else {
                [behind, left, right]
            };
            match (8.0 * eighths(0, 4)) as usize {
                0 => Outline::disc(rounding + 0.125),
                1 => Outline::capsule(
                    Vector { x: -behind, y: 0.0 },
                    Vector { x: ahead, y: left - right },
                    rounding + 0.125,
                ),
                _ => Outline::rectangle(ahead, behind + 0.125, left + 0.125, right, rounding),
            }
            .unwrap()
        });
        let sum = outlines[0].as_outline().radius() + outlines[1].as_outline().radius();
        let first = [eighths(1, 9), eighths(1, 3), sum.max(0.125)][(8.0 * eighths(0, 3)) as usize];
        let second = [eighths(1, 9), first, sum.max(0.125)][(8.0 * eighths(0, 3)) as usize];
        let radii = [first, second];
        let apart = [eighths(0, 9) - 0.5, eighths(0, 9) - 0.5].map(|x| if radii[1] > 0.6 { 0.0 } else { x });
        let centres = [[0.0, 0.0], apart];
        let headings = [0, 1].map(|_| FRAC_PI_2 * (8.0 * eighths(0, 4)));
        let poses = [0, 1].map(|k| {
            let [x, y] = centres[k];
            [x + radii[k] * headings[k].sin(), y - radii[k] * headings[k].cos(), headings[k]]
        });
        let mut kind = |k: usize, radius: f64| {
            let sweep = [FRAC_PI_2, PI, TAU, TAU, 1.0][random.below(5)];
            let side = if k == 1 && random.below(3) == 0 { -1.0 } else { 1.0 };
            let step = match if k == 0 { 4 } else { random.below(6) } {
                0 => Step::Line(2.0 * radius),
                1 => Step::Arc(side * radius, radius * sweep),
                2 => Step::Pivot(side * radius, radius * sweep),
                _ => Step::Steady(side * radius, radius * sweep),
            };
            Vec::from([step])
        };
        let segments = [kind(0, radii[0]), kind(1, radii[1])];
        let kinks = [(); 2].map(|()| Vec::from([FRAC_PI_2 * random.below(4) as f64]));
        Self { segments, kinks, poses, outlines }
    }
}

#[test]
fn regions_of_bodies_that_keep_their_heading_hold_what_the_oracle_says() {
    fn campaign<S: Number>(seeds: core::ops::Range<u64>) -> Tally {
        let mut tally = Tally::default();
        for seed in seeds {
            let mut random = Random::of(seed);
            let case = Case::random(&mut random, if seed % 2 == 0 { 1 } else { 4 });
            let case = if seed % 4 < 2 { case } else { case.with_pivots(&mut random) };
            let case = case.with_steady(&mut random);
            compare::<S>(&case, &mut random, &mut tally, seed);
        }
        tally
    }
    let tally = campaign::<f64>(27_000..27_600);
    assert!(tally.pairs > 590 && tally.inside > 8_000, "{tally:?}");
    let tally = campaign::<f32>(28_000..28_600);
    assert!(tally.pairs > 540 && tally.inside > 8_000, "{tally:?}");
    #[cfg(feature = "micromath")]
    {
        let tally = campaign::<crate::scalar::Micro>(29_000..29_200);
        assert!(tally.pairs > 150 && tally.inside > 2_000, "{tally:?}");
    }
}

#[test]
fn steady_arcs_at_which_closed_forms_degenerate_lose_nothing() {
    let mut tally = Tally::default();
    for seed in 61_000..61_500_u64 {
        let mut random = Random::of(seed);
        let case = Case::degenerate(&mut random);
        compare::<f64>(&case, &mut random, &mut tally, seed);
        compare::<f32>(&case, &mut random, &mut tally, seed);
    }
    assert!(tally.pairs > 900 && tally.inside > 10_000, "{tally:?}");
}
