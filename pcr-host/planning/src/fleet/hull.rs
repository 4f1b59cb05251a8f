//! An agent as one body that never changes: for what moves one body, and not a list of parts that come and go.

use super::RangeProblem;
use super::outline::CORNERS;
use pcr_core::{InvalidInput, Motion, Outline, PathRef, ProfileRef, Vector};
use pcr_formats::footprint::Footprint;
use pcr_formats::plane_geometry::{drop_needless, from_segment, hull, turn};
use pcr_formats::scenario::Agent;
use std::f64::consts::PI;

/// What an agent occupies, and a convex body that holds all of it.
#[derive(Clone, Debug)]
pub enum ConvexBody {
    /// A disc of this radius about the reference point \[m\].
    Disc(f64),
    /// The convex hull of all outlines of the agent.
    Outline(Box<HullOutline>),
}

/// A convex hull of outlines.
#[derive(Clone, Debug)]
pub struct HullOutline {
    /// Corners, counter-clockwise, ahead and left of the reference point \[m\].
    corners: Vec<[f64; 2]>,
    /// Radius by which they are rounded \[m\].
    radius: f64,
    outline: Outline<f64, CORNERS>,
    /// How far it reaches beyond one of the outlines at most \[m\].
    excess: f64,
}

/// An outline: points, and the distance from their convex hull that it contains \[m\].
struct Part {
    points: Vec<[f64; 2]>,
    growth: f64,
}

impl Part {
    fn of(footprint: Option<&Footprint>, radius: f64) -> Self {
        match footprint {
            Some(footprint) => Self { points: footprint.polygon().to_vec(), growth: footprint.growth() },
            None => Self { points: vec![[0.0; 2]], growth: radius },
        }
    }

    /// How far a point is beyond the outline, which may be concave \[m\]; in it the distance by which the polygon grows, negative.
    fn beyond(&self, point: [f64; 2]) -> f64 {
        let sides = || self.points.iter().zip(self.points.iter().cycle().skip(1));
        let crosses = |([ax, ay], [bx, by]): &(&[f64; 2], &[f64; 2])| {
            (*ay > point[1]) != (*by > point[1]) && point[0] < ax + (bx - ax) * (point[1] - ay) / (by - ay)
        };
        if sides().filter(crosses).count() % 2 == 1 {
            return -self.growth;
        }
        sides().map(|(a, b)| from_segment(point, [*a, *b])).fold(f64::INFINITY, f64::min) - self.growth
    }
}

impl ConvexBody {
    /// Returns the body of an agent: its disc, or the convex hull of its outlines with and without loads.
    ///
    /// # Errors
    /// [`InvalidInput`] where coordinates are out of range.
    pub fn of_agent(agent: &Agent) -> Result<Self, InvalidInput> {
        let outlines = agent.outlines();
        let own = Part::of(agent.footprint.as_ref(), agent.radius);
        if agent.footprint.is_none() && outlines.iter().all(|outline| outline.footprint.is_none()) {
            return Ok(Self::Disc(agent.circumscribed_radius()));
        }
        Self::of_parts(outlines.iter().map(|it| Part::of(it.footprint, it.radius)).chain([own]).collect())
    }

    /// Returns the body of a vehicle with this outline, or with this radius \[m\] if it has none.
    ///
    /// # Errors
    /// [`InvalidInput`] where coordinates are out of range.
    pub fn of_vehicle(footprint: Option<&Footprint>, radius: f64) -> Result<Self, InvalidInput> {
        match footprint {
            Some(_) => Self::of_parts(vec![Part::of(footprint, radius)]),
            None => Ok(Self::Disc(radius)),
        }
    }

    fn of_parts(parts: Vec<Part>) -> Result<Self, InvalidInput> {
        let rounding = parts.iter().map(|part| part.growth).fold(f64::INFINITY, f64::min);
        let points = parts.iter().flat_map(|part| {
            // What is rounded by more has the corners of an octagon around each point, a little larger for rounding.
            let more = (part.growth - rounding) / (PI / 8.0).cos() * (1.0 + 1e-12);
            let around = if more > 0.0 { 8 } else { 1 };
            part.points.iter().flat_map(move |&[x, y]| {
                (0..around).map(move |k| {
                    let (sin, cos) = (PI / 4.0 * (f64::from(k) + 0.5)).sin_cos();
                    [x + more * cos, y + more * sin]
                })
            })
        });
        let all = hull(points.collect());
        let corners = fewer(all.clone());
        // What was left out, or is off by rounding, the radius makes up for.
        let beyond = all.iter().map(|&point| outside(&corners, point)).fold(0.0, f64::max);
        let radius = (rounding + beyond * (1.0 + f64::EPSILON)).next_up();
        Self::of_corners(corners, if rounding + beyond > 0.0 { radius } else { 0.0 }).map(|body| match body {
            Self::Outline(mut it) => {
                it.excess = it.excess(&parts);
                Self::Outline(it)
            }
            disc => disc,
        })
    }

    /// The convex hull of what an agent is, where that is no disc and more than one convex outline.
    ///
    /// # Errors
    /// Why it is no outline.
    pub(super) fn hull_of(agent: &Agent) -> Result<Option<Footprint>, RangeProblem> {
        if !agent.has_parts() {
            return Ok(None);
        }
        match Self::of_agent(agent).map_err(RangeProblem::Hull)? {
            Self::Disc(_) => Ok(None),
            Self::Outline(hull) => Footprint::new(hull.corners)
                .map(|it| Some(it.inflated(hull.radius)))
                .map_err(RangeProblem::HullFootprint),
        }
    }

    fn of_corners(corners: Vec<[f64; 2]>, radius: f64) -> Result<Self, InvalidInput> {
        let outline = Outline::polygon(corners.iter().map(|&[x, y]| Vector { x, y }), radius)?;
        Ok(Self::Outline(Box::new(HullOutline { corners, radius, outline, excess: 0.0 })))
    }

    /// Whether it is a disc about its reference point.
    pub fn is_disc(&self) -> bool {
        matches!(self, Self::Disc(_))
    }

    /// Radius of the disc about the reference point that contains it \[m\].
    pub fn reach(&self) -> f64 {
        match self {
            Self::Disc(radius) => *radius,
            Self::Outline(hull) => hull.outline.as_outline().reach(),
        }
    }

    /// Returns how far it reaches beyond one of the outlines of the agent at most, about \[m\]: 0 for a disc and for one convex outline.
    pub fn excess(&self) -> f64 {
        match self {
            Self::Disc(_) => 0.0,
            Self::Outline(hull) => hull.excess,
        }
    }

    /// Returns the corners, counter-clockwise, ahead and left of the reference point, and the radius by which they are rounded \[m\]. A
    /// disc has its reference point as its only corner.
    pub fn corners(&self) -> (Vec<[f64; 2]>, f64) {
        match self {
            Self::Disc(radius) => (vec![[0.0; 2]], *radius),
            Self::Outline(hull) => (hull.corners.clone(), hull.radius),
        }
    }

    /// Returns the body that holds all within a distance of this one \[m\].
    ///
    /// # Errors
    /// [`InvalidInput`] where it is out of range.
    pub fn inflated(&self, by: f64) -> Result<Self, InvalidInput> {
        match self {
            Self::Disc(radius) => Ok(Self::Disc(radius + by)),
            Self::Outline(hull) => Self::of_corners(hull.corners.clone(), hull.radius + by).map(|body| match body {
                Self::Outline(larger) => Self::Outline(Box::new(HullOutline { excess: hull.excess, ..*larger })),
                disc => disc,
            }),
        }
    }

    /// Returns the motion of the body.
    ///
    /// # Errors
    /// As [`Motion::new`] and [`Motion::with_outline`].
    pub fn motion<'a>(
        &'a self,
        path: PathRef<'a, f64>,
        profile: ProfileRef<'a, f64>,
        start: f64,
    ) -> Result<Motion<'a, f64>, InvalidInput> {
        match self {
            Self::Disc(radius) => Motion::new(path, profile, *radius, start),
            Self::Outline(hull) => Motion::with_outline(path, profile, &hull.outline, start),
        }
    }
}

impl HullOutline {
    /// How far it reaches beyond one of these outlines, at many points of its sides \[m\].
    fn excess(&self, parts: &[Part]) -> f64 {
        const POINTS: usize = 32;
        let sides = self.corners.iter().zip(self.corners.iter().cycle().skip(1));
        let points = sides.flat_map(|(a, b)| {
            (0..POINTS).map(move |k| {
                let share = k as f64 / POINTS as f64;
                [0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * share)
            })
        });
        let off = |point| parts.iter().map(move |part| part.beyond(point)).fold(f64::NEG_INFINITY, f64::max);
        let off = points.map(off).fold(f64::NEG_INFINITY, f64::max) + self.radius;
        // Sides are at a distance of no more than rounding from their own outline.
        if off > 1e-9 { off } else { 0.0 }
    }
}

/// How far a point is outside of a convex polygon \[m\]; 0 inside.
fn outside(corners: &[[f64; 2]], point: [f64; 2]) -> f64 {
    let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
    if sides().all(|(a, b)| turn(*a, *b, point) >= 0.0) {
        return 0.0;
    }
    sides().map(|(a, b)| from_segment(point, [*a, *b])).fold(f64::INFINITY, f64::min)
}

/// A convex polygon with no more corners than an outline may have. Corners that are on the line of their neighbours but for rounding go;
/// then the sides whose neighbours meet nearest to them, so that it grows.
fn fewer(mut corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let size = corners.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let near = 16.0 * f64::EPSILON * size;
    drop_needless(&mut corners, near);
    while corners.len() > CORNERS {
        let count = corners.len();
        let meeting = |k: usize| {
            let [before, from, to, after] = [k + count - 1, k, k + 1, k + 2].map(|place| corners[place % count]);
            let at = intersection([before, from], [after, to])?;
            Some((k, at, from_segment(at, [from, to])))
        };
        let nearest = (0..count).filter_map(meeting).min_by(|a, b| a.2.total_cmp(&b.2));
        let Some((side, at, _)) = nearest else { break };
        corners[side] = at;
        corners.remove((side + 1) % count);
    }
    corners
}

/// Where two rays meet beyond their second points, if they do.
fn intersection([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let ([u, v], [p, q]) = ([b[0] - a[0], b[1] - a[1]], [d[0] - c[0], d[1] - c[1]]);
    let cross = u * q - v * p;
    let share = ((c[0] - a[0]) * q - (c[1] - a[1]) * p) / cross;
    let other = ((c[0] - a[0]) * v - (c[1] - a[1]) * u) / cross;
    (share >= 1.0 && other >= 1.0 && share.is_finite()).then(|| [a[0] + share * u, a[1] + share * v])
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::scenario::{LoadOutline, MotionSpec};

    fn body(agent: &Agent) -> ConvexBody {
        ConvexBody::of_agent(agent).expect("a body")
    }

    fn agent(polygon: Vec<[f64; 2]>) -> Agent {
        let footprint = Footprint::new(polygon).expect("a footprint");
        Agent {
            id: 1,
            label: String::new(),
            radius: footprint.circumscribed_radius(),
            footprint: Some(footprint),
            loads: Vec::new(),
            margin: 0.0,
            t_start: 0.0,
            start: [0.0; 3],
            path: Vec::new(),
            motion: MotionSpec::RestToRest { v_max: 1.0, a_max: 1.0 },
        }
    }

    fn holds(body: &ConvexBody, point: [f64; 2]) -> bool {
        let (corners, radius) = body.corners();
        outside(&corners, point) <= radius
    }

    #[test]
    fn a_convex_outline_is_its_own_hull() {
        let rectangle = vec![[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]];
        let body = body(&agent(rectangle.clone()));
        assert_eq!(body.corners(), (rectangle, 0.0));
        assert_eq!(body.excess(), 0.0);
        let larger = body.inflated(0.1).unwrap();
        assert_eq!(larger.corners().1, 0.1);
        assert!((larger.reach() - body.reach() - 0.1).abs() < 1e-12);
    }

    #[test]
    fn what_is_concave_or_has_many_corners_or_loads_is_within_its_hull() {
        let fork =
            vec![[0.0, -0.5], [1.5, -0.5], [1.5, -0.3], [0.3, -0.3], [0.3, 0.3], [1.5, 0.3], [1.5, 0.5], [0.0, 0.5]];
        let round: Vec<[f64; 2]> = (0..40).map(|k| (f64::from(k) * PI / 20.0).sin_cos()).map(|(y, x)| [x, y]).collect();
        let mut loaded = agent(vec![[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]]);
        loaded.path = vec![pcr_formats::scenario::PathSegment::Line { length: 1.0 }; 3];
        let mut disc = loaded.clone();
        loaded.loads = vec![LoadOutline { segments: [1, 1], ..LoadOutline::clone(&load(&agent(fork.clone()))) }];
        disc.loads = vec![LoadOutline { segments: [0, 0], radius: 0.9, footprint: None }];
        for (agent, least) in [(agent(fork), 0.3), (agent(round), 1e-3), (loaded, 0.5), (disc, 0.3)] {
            let body = body(&agent);
            assert!(body.corners().0.len() <= CORNERS);
            assert!((least..1.3).contains(&body.excess()), "{}", body.excess());
            for it in agent.outlines() {
                match it.footprint {
                    Some(footprint) => assert!(footprint.polygon().iter().all(|&corner| holds(&body, corner))),
                    None => {
                        let on = |k: i32| (f64::from(k) * 0.01).sin_cos();
                        assert!((0..629).map(on).all(|(sin, cos)| holds(&body, [it.radius * cos, it.radius * sin])));
                    }
                }
            }
        }
    }

    fn load(agent: &Agent) -> LoadOutline {
        LoadOutline { segments: [0, 0], radius: agent.radius, footprint: agent.footprint.clone() }
    }
}
