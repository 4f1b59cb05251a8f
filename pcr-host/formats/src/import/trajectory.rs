//! Trajectories of VDA 5050 and LIF: NURBS in the project's coordinates.

use super::biarc::{BiarcFit, fit};
use super::json_access::JsonObject;
use super::keys::Keys;
use super::nurbs::Nurbs;
use super::{ImportError, WarningCode, Warnings};
use crate::scenario::LIMIT;

const KEYS: Keys = Keys::new(&["degree", "knotVector", "controlPoints"], &[]);

/// The orientation is that of VDA 5050 1.x.
const POINT: Keys = Keys::new(&["x", "y", "weight", "orientation"], &[]);

/// A trajectory as lines and arcs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FittedTrajectory {
    pub(super) fit: BiarcFit,
    /// Where it begins and ends, which no line and no arc tells where it has no length \[m\].
    pub(super) ends: [[f64; 2]; 2],
}

/// Reads a trajectory and fits lines and arcs to it.
///
/// Degree 1 and even knots where they are missing, weight 1 likewise. Some senders give the order, which is the degree plus 1, as
/// `degree`: where the number of knots says so, it is taken as that, with a warning.
pub(super) fn read(
    object: &JsonObject<'_>,
    tolerance: f64,
    warnings: &mut Warnings,
) -> Result<FittedTrajectory, ImportError> {
    let named = |error: ImportError| object.error(error);
    KEYS.check(object, warnings)?;
    let mut points = Vec::new();
    for (k, value) in object.list("controlPoints")?.iter().enumerate() {
        let point = JsonObject::new(format!("{}, control point {}", object.name, k + 1), value)?;
        POINT.check(&point, warnings)?;
        points.push((point.point()?, point.number("weight")?.unwrap_or(1.0)));
    }
    let mut knots = Vec::new();
    for value in object.list("knotVector")? {
        let knot = value.as_f64().ok_or_else(|| object.error("a knot that is not a number"))?;
        // Differences of larger ones are no numbers.
        if knot.abs() > LIMIT {
            return Err(object.error(format_args!("a knot of {knot:e} is out of range; allowed is up to {LIMIT:e}")));
        }
        knots.push(knot);
    }
    let mut degree = match object.number("degree")? {
        None => 1,
        Some(degree) if degree.fract() == 0.0 && (1.0..=64.0).contains(&degree) => degree as usize,
        Some(degree) => return Err(object.error(format_args!("degree {degree}, which is no degree"))),
    };
    // Senders that mean a straight edge write an empty object, or a type.
    if points.is_empty() {
        let problem = "it has no controlPoints; a straight edge has no trajectory, or null in its place";
        return Err(object.error(problem));
    }
    if degree > 1 && !knots.is_empty() && knots.len() == points.len() + degree {
        warnings.add(
            WarningCode::CurveDegree,
            &object.name,
            "its degree is one more than its knots say; it is taken as the order of the curve",
        );
        degree -= 1;
    }
    let curves = Nurbs { degree, knots, points }.beziers().map_err(named)?;
    let ends = curves.first().zip(curves.last()).map(|(first, last)| [first.ends()[0], last.ends()[1]]);
    let fit = fit(&curves, tolerance).map_err(named)?;
    if fit.bends {
        warnings.use_option("tolerance");
    }
    Ok(FittedTrajectory { fit, ends: ends.unwrap_or_default() })
}
