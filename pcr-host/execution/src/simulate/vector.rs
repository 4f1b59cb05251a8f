//! Points and vectors of the plane as pairs of numbers.

/// A point or a vector \[m\] or \[m/s\].
pub type PlaneVector = [f64; 2];

pub(super) fn add(a: PlaneVector, b: PlaneVector) -> PlaneVector {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn sub(a: PlaneVector, b: PlaneVector) -> PlaneVector {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn scale(a: PlaneVector, by: f64) -> PlaneVector {
    [a[0] * by, a[1] * by]
}

pub(super) fn dot(a: PlaneVector, b: PlaneVector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn norm(a: PlaneVector) -> f64 {
    a[0].hypot(a[1])
}

/// The vector, shortened to this length where it is longer.
pub(super) fn limited(a: PlaneVector, length: f64) -> PlaneVector {
    let norm = norm(a);
    if norm > length { scale(a, length / norm) } else { a }
}
