//! Looking for points worth checking: nothing is decided here.

/// A point that is no further than its neighbours, by a search that halves its steps.
pub(super) fn descend(f: impl Fn([f64; 2]) -> f64, from: [f64; 2], size: [f64; 2]) -> [f64; 2] {
    const HALVINGS: usize = 40;
    let (mut at, mut value) = (from, f(from));
    let mut step = size.map(|size| 0.2 * size);
    for _ in 0..HALVINGS {
        for axis in [0, 1] {
            for sign in [1.0, -1.0] {
                let mut next = at;
                next[axis] = (next[axis] + sign * step[axis]).clamp(0.0, size[axis]);
                let there = f(next);
                if there < value {
                    (at, value) = (next, there);
                }
            }
        }
        step = step.map(|step| 0.5 * step);
    }
    at
}

/// The least value between `lo` and `hi`, where there is one valley.
pub(super) fn valley(f: impl Fn(f64) -> f64, mut lo: f64, mut hi: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let (mut a, mut b) = (hi - GOLDEN * (hi - lo), lo + GOLDEN * (hi - lo));
    let (mut fa, mut fb) = (f(a), f(b));
    for _ in 0..40 {
        if fa < fb {
            (hi, b, fb) = (b, a, fa);
            a = hi - GOLDEN * (hi - lo);
            fa = f(a);
        } else {
            (lo, a, fa) = (a, b, fb);
            b = lo + GOLDEN * (hi - lo);
            fb = f(b);
        }
    }
    let ends = [lo, a, b, hi];
    ends.into_iter().min_by(|x, y| f(*x).total_cmp(&f(*y))).expect("four")
}

/// Where a function crosses `threshold` between a point where it is not above and one where it is.
pub(super) fn bisect(f: impl Fn([f64; 2]) -> f64, below: [f64; 2], above: [f64; 2], threshold: f64) -> [f64; 2] {
    let at = |part: f64| [0, 1].map(|k| below[k] + part * (above[k] - below[k]));
    let (mut lo, mut hi) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (lo + hi);
        if f(at(middle)) > threshold { hi = middle } else { lo = middle }
    }
    at(lo)
}
