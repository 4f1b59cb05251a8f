//! Proximity of meshes at every sample of time, as the paper uses the library PQP: cylinders of 100 triangles, here
//! with the discrete queries of the crate `parry3d`, for pairs whose boxes meet. The cylinders circumscribe the discs.

use super::disc_track::{DiscTrack, Xy};
use super::{CollisionMethod, ComparisonFleet, MethodAnswer, MethodContact, MethodError, MethodQuestion, MethodResult};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::intersection_test;
use parry3d_f64::shape::TriMesh;
use std::f64::consts::{PI, TAU};

/// Time between samples, that of the paper \[s\].
pub const STEP: f64 = 0.01;

/// Sides of a cylinder: two triangles a side, and two less than there are sides on either end make 100.
pub const SIDES: u32 = 26;

/// Height of a cylinder \[m\].
pub const HEIGHT: f64 = 0.1;

/// How far the second cylinder stands above the first one, so that no two faces lie in one plane \[m\].
pub const STEP_UP: f64 = 0.037;

struct MeshProximityMethod;

pub(super) fn methods() -> Vec<Box<dyn CollisionMethod>> {
    vec![Box::new(MeshProximityMethod)]
}

impl CollisionMethod for MeshProximityMethod {
    fn name(&self) -> String {
        format!("parry3d meshes {STEP} s")
    }

    fn question(&self) -> MethodQuestion {
        MethodQuestion::Conflicts
    }

    fn output_description(&self) -> &'static str {
        "samples"
    }

    fn answer<'f>(&self, field: &'f ComparisonFleet<'_>) -> MethodResult<'f> {
        let times = samples(field);
        let bodies = field
            .tracks
            .iter()
            .map(|track| MeshCylinder::new(track, &times))
            .collect::<Option<Vec<_>>>()
            .ok_or(MethodError::Beyond)?;
        let mut found = Vec::new();
        for (first, a) in bodies.iter().enumerate() {
            for (second, b) in bodies.iter().enumerate().skip(first + 1) {
                let mut last: Option<usize> = None;
                for k in (0..times.len()).filter(|&k| a.meets(b, k)) {
                    match found.last_mut() {
                        Some(MethodContact { end, .. }) if last.is_some_and(|last| last + 1 == k) => {
                            *end = Some(times[k])
                        }
                        _ => {
                            found.push(MethodContact { agents: [first, second], begin: times[k], end: Some(times[k]) })
                        }
                    }
                    last = Some(k);
                }
            }
        }
        Ok(MethodAnswer::Conflicts(found))
    }
}

/// The times at which a fleet is looked at.
pub fn samples(field: &ComparisonFleet<'_>) -> Vec<f64> {
    let [begin, end] = field.horizon;
    (0..=((end - begin) / STEP) as usize).map(|k| begin + STEP * k as f64).collect()
}

/// The radius of the edges of a cylinder around a disc.
pub fn circumscribed(radius: f64) -> f64 {
    radius / (PI / f64::from(SIDES)).cos()
}

struct MeshCylinder {
    mesh: TriMesh,
    radius: f64,
    /// At all times.
    at: Vec<Xy>,
}

impl MeshCylinder {
    fn new(track: &DiscTrack, times: &[f64]) -> Option<Self> {
        let radius = circumscribed(track.radius);
        let at = times.iter().map(|&time| track.position(time)).collect();
        Some(Self { mesh: cylinder(radius)?, radius, at })
    }

    fn meets(&self, other: &Self, k: usize) -> bool {
        let (Some(a), Some(b)) = (self.at.get(k), other.at.get(k)) else { return false };
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let reach = self.radius + other.radius;
        if dx.abs() > reach || dy.abs() > reach {
            return false;
        }
        let pose = |x, y, z| Pose::from_translation(Vector::new(x, y, z));
        let (own, their) = (pose(a[0], a[1], 0.0), pose(b[0], b[1], STEP_UP));
        intersection_test(&own, &self.mesh, &their, &other.mesh).is_ok_and(|test| test.intersecting)
    }
}

/// An upright cylinder of 100 triangles; `radius` is that of its edges.
fn cylinder(radius: f64) -> Option<TriMesh> {
    let corner = |k: u32, z: f64| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(SIDES)).sin_cos();
        Vector::new(radius * cos, radius * sin, z)
    };
    let mut corners: Vec<Vector> = (0..SIDES).map(|k| corner(k, 0.0)).collect();
    corners.extend((0..SIDES).map(|k| corner(k, HEIGHT)));
    let mut faces = Vec::new();
    for k in 0..SIDES {
        let next = (k + 1) % SIDES;
        faces.extend([[k, next, SIDES + next], [k, SIDES + next, SIDES + k]]);
    }
    for k in 1..SIDES - 1 {
        faces.extend([[0, k + 1, k], [SIDES, SIDES + k, SIDES + k + 1]]);
    }
    TriMesh::new(corners, faces).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cylinder_has_a_hundred_triangles() {
        assert_eq!(cylinder(0.2).unwrap().indices().len(), 100);
    }
}
