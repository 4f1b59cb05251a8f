//! A rectangle that turns beside a wall, whose contacts have a closed form.

use super::*;

#[test]
fn slices_beside_a_wall_end_where_they_are_known_to() {
    let raw = turning_beside_a_wall();
    let bodies = [Body::new(&raw[0]).unwrap(), Body::new(&raw[1]).unwrap()];
    let segments = Segments([&bodies[0].segments[0], &bodies[1].segments[0]]);
    let slices: [(f64, &[[f64; 2]]); 3] = [
        (
            0.7,
            &[
                [0.534961326318396, 1.43062612017626],
                [1.71096653341353, 2.6066313272714],
                [3.67655397990819, 4.57221877376606],
                [4.85255918700332, 5.74822398086119],
            ],
        ),
        (0.8, &[[0.279494746222193, 2.8620979073676], [3.42108739981199, 6.00369056095739]]),
        (0.9, &[[0.0858968327951782, 3.05569582069461], [3.22748948638497, 6.19728847438441]]),
    ];
    let mut steps = 0;
    for (at, slice) in slices {
        let mut from = 0.0_f64;
        for end in slice.iter().copied().chain([[TAU, TAU]]) {
            let gap = [[if from == 0.0 { 0.0 } else { from + 1e-9 }, end[0] - 1e-9], [at, at]];
            let outcome = segments.farther(gap.map(number_of), Ball::from(0.05), &mut steps);
            assert_eq!(outcome, Verdict::Proved, "{at} {from}");
            let radius = Ball::from(0.05);
            let outward = [[(from - 1e-3).max(0.0), (end[0] + 1e-3).min(TAU)], [at, at]].map(number_of);
            let found = segments.farther(outward, radius, &mut steps);
            assert!(matches!(found, Verdict::Refuted(_)), "{at} {from}: {found:?}");
            from = end[1];
        }
    }
}

#[test]
fn contacts_beside_a_wall_are_covered_and_altered_rectangles_refuted() {
    let raw = turning_beside_a_wall();
    let bodies = [Body::new(&raw[0]).unwrap(), Body::new(&raw[1]).unwrap()];
    let segments = Segments([&bodies[0].segments[0], &bodies[1].segments[0]]);
    let radius = Ball::from(0.05);
    for by in [1e-3, 1e-6, 1e-9, 1e-12] {
        let all = placed(&rectangles_beside_a_wall(0.05, by));
        let mut steps = 0;
        let found = segments.covered(&all, radius, &mut steps);
        assert!(found.is_empty(), "{by}: {found:?}");
        assert!(steps < 60_000, "{by}: {steps}");
        for rectangle in &all {
            for of in [0, 1] {
                let most = Ball::from(0.05 + 4.0 * by);
                let outcome = segments.within(of, *rectangle, most, &mut steps);
                assert_eq!(outcome, Verdict::Proved, "{by} {of} {rectangle:?}");
            }
        }
    }
    // Each of them a millimetre too small, on each side where it does not end with the segment or with another one.
    let exact = rectangles_beside_a_wall(0.05, 1e-9);
    for place in 0..exact.len() {
        for (k, end, by) in [(0, 0, 1e-3), (0, 1, -1e-3), (1, 0, 1e-3), (1, 1, -1e-3)] {
            let mut altered = exact.clone();
            altered[place][k][end] += by;
            let found = segments.covered(&placed(&altered), radius, &mut 0);
            assert!(found.iter().any(|one| matches!(one, Verdict::Refuted(_))), "{place} {k} {end}: {found:?}");
        }
    }
    // Where nothing else touches, 2 mm too much.
    for k in [0, 1] {
        let mut altered = exact[0];
        altered[k][0] -= 2e-3;
        for (most, far) in [(0.0501, true), (0.053, false)] {
            let outcome = segments.within(k, altered.map(number_of), Ball::from(most), &mut 0);
            assert_eq!(matches!(outcome, Verdict::Refuted(_)), far, "{k} {most}: {outcome:?}");
            assert_eq!(outcome == Verdict::Proved, !far, "{k} {most}: {outcome:?}");
        }
    }
    // The same rectangles for another body: one corner 1 mm farther out, or the radius larger by 1 mm.
    for change in [0, 1] {
        let mut other = raw.clone();
        if change == 0 {
            other[0].outline.corners[2][1] += 1e-3
        } else {
            other[1].outline.radius += 1e-3
        }
        let bodies = [Body::new(&other[0]).unwrap(), Body::new(&other[1]).unwrap()];
        let segments = Segments([&bodies[0].segments[0], &bodies[1].segments[0]]);
        let radius = bodies[0].radius + bodies[1].radius;
        let found = segments.covered(&placed(&exact), radius, &mut 0);
        assert!(found.iter().any(|one| matches!(one, Verdict::Refuted(_))), "{change}: {found:?}");
    }
}
