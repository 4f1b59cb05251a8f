//! Points and vectors of the plane as pairs of numbers.

/// A point or a vector \[m\] or \[m/s\].
pub type Vector = [f64; 2];

pub(super) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn scale(a: Vector, by: f64) -> Vector {
    [a[0] * by, a[1] * by]
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn norm(a: Vector) -> f64 {
    a[0].hypot(a[1])
}

/// The vector, shortened to this length where it is longer.
pub(super) fn limited(a: Vector, length: f64) -> Vector {
    let norm = norm(a);
    if norm > length { scale(a, length / norm) } else { a }
}
