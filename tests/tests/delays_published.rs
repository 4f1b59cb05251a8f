//! Equations for unsafe delays that others use, and where they are wrong (docs/theory/equations.md). What is true is told by the definition
//! with 106 bits.

use pcr_certify::double_double::DoubleDouble;
use pcr_planning::exclusion_table::StraightEdge;
use pcr_tests::delays::Exact;
use pcr_tests::delays::published::{Line, cut_conic, whole_conic};

fn exact([from, to]: Line) -> Exact {
    Exact::new(from, to, 1.0)
}

/// The least distance if `b` sets off so much later than `a`.
fn distance(a: Line, b: Line, delay: f64) -> f64 {
    exact(a).nearest(&exact(b), DoubleDouble::from(delay)).map_or(f64::INFINITY, |square| square.sqrt().to_f64())
}

fn ours(a: Line, b: Line, reach: f64) -> Option<[f64; 2]> {
    let [a, b] = [a, b].map(|[from, to]| StraightEdge::new(from, to, 1.0).unwrap());
    a.delays(&b, reach)
}

fn near(found: Option<[f64; 2]>, expected: [f64; 2]) -> bool {
    found.is_some_and(|found| (0..2).all(|end| (found[end] - expected[end]).abs() < 1e-9))
}

const CROSS: [Line; 2] = [[[-4.0, 0.0], [4.0, 0.0]], [[0.0, -4.0], [0.0, 4.0]]];

#[test]
fn all_agree_where_edges_cross_far_from_their_ends() {
    let half = 2.0_f64.sqrt();
    for found in
        [whole_conic(CROSS[0], CROSS[1], 1.0), cut_conic(CROSS[0], CROSS[1], 1.0), ours(CROSS[0], CROSS[1], 1.0)]
    {
        assert!(near(found, [-half, half]), "{found:?}");
    }
}

/// One behind the other on one line: E has the wrong sign, and the interval is that of the other order.
#[test]
fn the_cut_conic_is_turned_over_for_equal_velocities() {
    let [a, b] = [[[0.0, 0.0], [5.0, 0.0]], [[1.0, 0.0], [6.0, 0.0]]];
    assert!(near(cut_conic(a, b, 2.0), [-3.0, 1.0]));
    assert!(near(ours(a, b, 2.0), [-1.0, 3.0]));
    // 1.5 s later it sets off with the first one half a metre ahead: a contact that the table does not know.
    assert!((distance(a, b, 1.5) - 0.5).abs() < 1e-12);
    // And one that there is not.
    assert!((distance(a, b, -2.5) - 3.5).abs() < 1e-12);
}

/// The conic of lines without ends forbids what never happens.
#[test]
fn the_whole_conic_does_not_know_that_edges_end() {
    let [a, b] = [[[-4.0, 0.0], [-2.0, 0.0]], [[0.0, 1.5], [0.0, 4.0]]];
    assert_eq!(ours(a, b, 1.0), None);
    let [lo, hi] = whole_conic(a, b, 1.0).unwrap();
    assert!(hi - lo > 2.8, "{lo} {hi}");
    assert!((0..=10).all(|k| distance(a, b, lo + (hi - lo) * 0.1 * f64::from(k)) > 1.0));
}

/// The distance of two starts has no sign: in front is taken for behind.
#[test]
fn the_whole_conic_takes_in_front_for_behind() {
    let [a, b] = [[[1.0, 0.0], [6.0, 0.0]], [[0.0, 0.0], [5.0, 0.0]]];
    // Both orders have the same answer.
    assert_eq!(whole_conic(a, b, 0.5), whole_conic(b, a, 0.5));
    let [lo, hi] = whole_conic(a, b, 0.5).unwrap();
    // Delays of the first one: positive, though it starts in front.
    assert!((lo - 0.5).abs() < 1e-12 && (hi - 1.5).abs() < 1e-12);
    assert!(near(ours(b, a, 0.5), [0.5, 1.5]) && near(ours(a, b, 0.5), [-1.5, -0.5]));
}
