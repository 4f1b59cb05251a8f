//! Vehicles of a record as bodies of the independent checker, some of which are no discs.

use super::RecordVehicle;
use pcr_certify::outline::{RawBody, RawBodySegment, RawCourse, RawHeading, RawOutline};
use pcr_certify::raw::{RawAngle, RawMotion, RawPhase};
use pcr_formats::footprint::Footprint;
use pcr_formats::plane_geometry::wrapped;

/// Rounding of the corners of an outline, relative.
const ROUNDING: f64 = 1e-12;

/// Length of a path for each radian of a turn in place \[m\]; only how long turns take counts.
const LEVER: f64 = 1.0;

/// Rounding of headings where two parts of a track meet, and headings that are the same \[rad\].
const JUMP: f64 = 1e-9;
const SAME: f64 = 1e-12;

/// The track with headings that never jump by a turn, and on each part of it either a way or a turn.
pub(super) fn unwound(track: &[[f64; 4]]) -> Vec<[f64; 4]> {
    let mut all: Vec<[f64; 4]> = Vec::with_capacity(track.len());
    for &[time, x, y, heading] in track {
        let Some(&[t0, x0, y0, h0]) = all.last() else {
            all.push([time, x, y, heading]);
            continue;
        };
        let turn = wrapped(heading - h0);
        let heading = if turn.abs() > SAME { h0 + turn } else { h0 };
        if [x0, y0] != [x, y] && heading != h0 {
            all.push([t0 + 0.5 * (time - t0), x, y, h0]);
        }
        all.push([time, x, y, heading]);
    }
    all
}

/// The bodies of a vehicle that goes from point to point: one, or the convex parts of a concave one. `far` is the largest coordinate of the
/// points that they were taken from \[m\].
///
/// # Errors
/// What is wrong with its outline, in words.
pub(super) fn bodies(id: u64, vehicle: &RecordVehicle, points: &[[f64; 4]], far: f64) -> Result<Vec<RawBody>, String> {
    let outlines = match (&vehicle.footprint, vehicle.radius) {
        (Some(footprint), _) => footprint.parts().map(|part| outline(&part)).collect::<Result<Vec<_>, _>>()?,
        (None, Some(radius)) => vec![RawOutline { corners: vec![[0.0; 2]], radius }],
        (None, None) => return Err(format!("{} has neither a radius nor a footprint", vehicle.name)),
    };
    Ok(outlines.into_iter().map(|outline| body(id, outline, points, far)).collect())
}

/// A convex outline, without corners that are on the line of their neighbours but for rounding.
fn outline(part: &Footprint) -> Result<RawOutline, String> {
    let near = ROUNDING * part.circumscribed_radius();
    let corners = part.convex(near).ok_or("a part of a footprint is not convex")?;
    let radius = part.growth() + part.beyond(&corners);
    Ok(RawOutline { corners, radius })
}

fn body(id: u64, mut outline: RawOutline, points: &[[f64; 4]], far: f64) -> RawBody {
    let [first, last] = [points.first(), points.last()].map(|end| end.copied().unwrap_or_default());
    let (mut segments, mut phases): (Vec<RawBodySegment>, Vec<RawPhase>) = (Vec::new(), Vec::new());
    let (mut length, mut fastest, mut direction) = (0.0, 0.0_f64, 0.0);
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let (time, way, turn) = (b[0] - a[0], (b[1] - a[1]).hypot(b[2] - a[2]), b[3] - a[3]);
        if time <= 0.0 {
            continue;
        }
        let mut to = length;
        if way > 0.0 {
            let ahead = (b[2] - a[2]).atan2(b[1] - a[1]);
            let turns = vec![RawAngle::Radians(ahead - direction)];
            to = length + way;
            let heading = RawHeading::Steady(RawAngle::Radians(a[3]));
            segments.push(RawBodySegment { course: RawCourse::Line, length: way, turns, heading, from: length, to });
            direction = ahead;
        } else if turn != 0.0 {
            let way = LEVER * turn.abs();
            to = length + way;
            segments.push(RawBodySegment {
                course: RawCourse::Pivot { lever: LEVER.copysign(turn) },
                length: way,
                turns: Vec::new(),
                heading: RawHeading::Along(RawAngle::Radians(a[3] - direction)),
                from: length,
                to,
            });
            direction += turn;
        }
        let speed = (to - length) / time;
        fastest = fastest.max(speed);
        let [begin, end] = [a[0] - first[0], b[0] - first[0]];
        phases.push(RawPhase { time: [begin, end], length: [length, to], speed: [speed, speed] });
        length = to;
    }
    if segments.is_empty() {
        let heading = RawHeading::Steady(RawAngle::Radians(first[3]));
        segments.push(RawBodySegment {
            course: RawCourse::Line,
            length: 0.0,
            turns: Vec::new(),
            heading,
            from: 0.0,
            to: 0.0,
        });
        phases.clear();
    }
    // Each direction, each heading and each sum is rounded, along all of the way; and so are the coordinates and the times.
    let late = fastest * (last[0] - first[0]);
    let rounding = f64::EPSILON * (length + late + far) * (64.0 + 4.0 * segments.len() as f64);
    // Outlines that are nearer than that are taken for outlines that touch.
    let reach = outline.corners.iter().map(|[ahead, left]| ahead.hypot(*left)).fold(0.0, f64::max);
    outline.radius += rounding * (1.0 + reach);
    RawBody {
        id,
        outline,
        start: [first[1], first[2]],
        direction: RawAngle::Radians(0.0),
        segments,
        rounding,
        jump: JUMP,
        step: 0.0,
        travel: Some(RawMotion { start: first[0], phases, lag: 0.0, time_excess: 0.0 }),
    }
}
