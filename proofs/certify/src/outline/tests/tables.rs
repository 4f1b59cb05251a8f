//! Whole tables, and what is refused as one.

use super::*;

/// A table of the rectangle and the wall, with half of the excess as slack.
fn table_beside_a_wall(excess: f64) -> RawOutlineTable {
    let ranks = [[0, 4], [1, 4], [2, 4], [3, 4], [0, 2], [1, 2], [0, 1]];
    let pieces: Vec<_> = rectangles_beside_a_wall(0.05 + 0.5 * excess, 0.0)
        .into_iter()
        .zip(ranks)
        .map(|(lengths, rank)| RawOutlinePiece { segments: [0, 0], lengths, rank, region: 0 })
        .collect();
    let mut table = RawOutlineTable {
        bodies: turning_beside_a_wall().to_vec(),
        pairs: vec![RawOutlinePair { bodies: [0, 1], excess, regions: Vec::new(), pieces }],
        apart: None,
    };
    with_hull(&mut table);
    table
}

/// The region of all pieces, with the times at which the bodies are at its ends, if they move at 1 m/s from the start.
fn with_hull(table: &mut RawOutlineTable) {
    let moves = table.bodies.iter().all(|body| body.travel.is_some());
    let pieces = &table.pairs[0].pieces;
    let lengths = [0, 1].map(|k| {
        let lo = pieces.iter().map(|piece| piece.lengths[k][0]).fold(f64::INFINITY, f64::min);
        let hi = pieces.iter().map(|piece| piece.lengths[k][1]).fold(f64::NEG_INFINITY, f64::max);
        [lo, hi]
    });
    table.pairs[0].regions = vec![RawRegion { lengths, times: moves.then_some(lengths) }];
}

fn steady(body: &mut RawBody) {
    let length = body.segments[0].length;
    let phases = vec![RawPhase { time: [0.0, length], length: [0.0, length], speed: [1.0; 2] }];
    body.travel = Some(RawMotion { start: 0.0, phases, lag: 0.0, time_excess: 1e-9 });
}

fn checked(table: &RawOutlineTable) -> Report {
    Checker::new(table).unwrap().check(CoverageMargin::Needed).unwrap()
}

#[test]
fn a_table_is_proved_and_altered_ones_are_refuted() {
    for excess in [1e-3, 1e-5, 1e-8, 1e-11] {
        let mut table = table_beside_a_wall(excess);
        for moves in [false, true] {
            if moves {
                table.bodies.iter_mut().for_each(steady);
                with_hull(&mut table);
            }
            let report = checked(&table);
            assert!(report.findings.refuted.is_empty(), "{excess}: {report:?}");
            assert!(report.findings.undecided.is_empty(), "{excess}: {report:?}");
            // A tenth of the excess, about, at each of the three events.
            assert!(report.unranked < 8.0 * excess, "{excess}: {}", report.unranked);
            assert_eq!(report.findings.times, usize::from(moves));
        }
        let margin = Checker::new(&table).unwrap().margin().unwrap().unwrap();
        assert!(margin > 0.49 && margin < 0.51, "{margin}");
    }
    let table = table_beside_a_wall(1e-5);
    let refuted = |name: &str, promise: TableProperty, change: &dyn Fn(&mut RawOutlineTable)| {
        let mut altered = table.clone();
        change(&mut altered);
        with_hull(&mut altered);
        let report = checked(&altered);
        assert!(report.findings.refuted.iter().any(|witness| witness.promise == promise), "{name}: {report:?}");
    };
    for k in 0..7 {
        refuted("a piece is missing", TableProperty::Covered, &|table| {
            table.pairs[0].pieces.remove(k);
        });
        refuted("it begins too late", TableProperty::Covered, &|table| table.pairs[0].pieces[k].lengths[0][0] += 1e-3);
        refuted("it ends too early", TableProperty::Covered, &|table| table.pairs[0].pieces[k].lengths[1][1] -= 1e-3);
    }
    refuted("it begins too early", TableProperty::Near, &|table| table.pairs[0].pieces[0].lengths[0][0] -= 1e-3);
    refuted("a corner is elsewhere", TableProperty::Covered, &|table| table.bodies[0].outline.corners[1][0] += 1e-3);
    refuted("the radius is larger", TableProperty::Covered, &|table| table.bodies[1].outline.radius += 1e-3);
    refuted("the radius is less", TableProperty::Near, &|table| table.bodies[1].outline.radius -= 1e-3);
    refuted("ranks are exchanged", TableProperty::Shared, &|table| {
        for (k, rank) in [[1, 4], [0, 4]].into_iter().enumerate() {
            table.pairs[0].pieces[k].rank = rank;
        }
    });
    refuted("another one of two", TableProperty::Shared, &|table| table.pairs[0].pieces[4].rank = [1, 2]);
    // Of more intervals than there are nothing is proved.
    let mut altered = table.clone();
    altered.pairs[0].pieces[4].rank = [0, 3];
    let report = checked(&altered);
    assert!(report.findings.undecided.iter().any(|witness| witness.promise == TableProperty::Shared), "{report:?}");
    let mut moving = table.clone();
    moving.bodies.iter_mut().for_each(steady);
    with_hull(&mut moving);
    for (k, end, by, promise) in [(1, 0, 1e-3, TableProperty::Timed), (1, 0, -1e-3, TableProperty::Prompt)] {
        let mut altered = moving.clone();
        altered.pairs[0].regions[0].times.as_mut().unwrap()[k][end] += by;
        let report = checked(&altered);
        assert!(report.findings.refuted.iter().any(|witness| witness.promise == promise), "{promise:?}: {report:?}");
    }
}

#[test]
fn what_is_no_table_no_outline_and_no_path_is_refused_by_name() {
    let table = table_beside_a_wall(1e-5);
    let refused = |why: &str, change: &dyn Fn(&mut RawOutlineTable)| {
        let mut altered = table.clone();
        change(&mut altered);
        let found =
            Checker::new(&altered).and_then(|checker| checker.check(CoverageMargin::Needed)).unwrap_err().to_string();
        assert!(found.contains(why), "{found}");
    };
    refused("is missing", &|table| table.pairs.clear());
    refused("is none, or there twice", &|table| table.pairs.push(table.pairs[0].clone()));
    refused("stands for the interval 4 of 4", &|table| table.pairs[0].pieces[3].rank = [4, 4]);
    refused("not on its segment", &|table| table.pairs[0].pieces[3].lengths[1][1] = 1.3);
    refused("its lengths are not those of its pieces", &|table| table.pairs[0].regions[0].lengths[0][1] = 3.0);
    refused("no convex polygon", &|table| table.bodies[0].outline.corners.reverse());
    refused("no convex polygon", &|table| table.bodies[0].outline.corners.swap(1, 2));
    refused("no convex polygon", &|table| table.bodies[0].outline.corners[2] = [0.0, 0.0]);
    // Twice around.
    refused("no convex polygon", &|table| {
        let corner = |k: usize| [(TAU * 0.4 * k as f64).cos(), (TAU * 0.4 * k as f64).sin()];
        table.bodies[0].outline.corners = (0..5).map(corner).collect();
    });
    refused("are the same", &|table| table.bodies[0].outline.corners[1] = table.bodies[0].outline.corners[0]);
    refused("of 0 corners", &|table| table.bodies[0].outline.corners.clear());
    refused("of 17 corners", &|table| table.bodies[0].outline.corners = vec![[0.0; 2]; 17]);
    refused("out of range", &|table| table.bodies[0].outline.corners[0][1] = f64::NAN);
    refused("radius -1", &|table| table.bodies[0].outline.radius = -1.0);
    refused("more than one turn", &|table| table.bodies[0].segments[0].course = RawCourse::Pivot { lever: 0.5 });
    refused("out of range", &|table| table.bodies[0].segments[0].course = RawCourse::Arc { radius: 0.0 });
    refused("with a constant heading", &|table| {
        table.bodies[0].segments[0].heading = RawHeading::Steady(RawAngle::Turns(0.0));
    });
    // A heading that jumps where two segments meet, and one that goes on in reverse gear.
    let next = |facing: f64, turn: f64| {
        let mut altered = table.clone();
        let mut second = single(RawCourse::Line, 1.0, RawHeading::Along(RawAngle::Turns(facing)));
        second.turns = vec![RawAngle::Turns(turn)];
        (second.from, second.to) = (1.2, 2.2);
        altered.bodies[1].segments[0].heading = ahead();
        altered.bodies[1].segments.push(second);
        Checker::new(&altered).map(|_| ())
    };
    assert_eq!(next(0.0, 0.0), Ok(()));
    assert_eq!(next(0.5, 0.5), Ok(()));
    assert!(next(0.0, 0.5).unwrap_err().to_string().contains("its heading is off by"));
    assert!(next(1e-6, 0.0).unwrap_err().to_string().contains("its heading is off by"));
}

#[test]
fn who_is_left_out_has_to_be_far() {
    let mut table = table_beside_a_wall(1e-5);
    table.pairs.clear();
    table.apart = Some(1e-5);
    assert!(Checker::new(&table).unwrap_err().to_string().contains("is missing"));
    table.bodies[1].start[1] += 20.0;
    assert!(Checker::new(&table).is_ok());
}
