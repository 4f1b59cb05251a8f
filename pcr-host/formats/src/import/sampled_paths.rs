//! Paths given by points: a line `x y` for each point (further columns, such as a heading, are ignored), separated by
//! blanks, tabs, commas or semicolons. The path of an agent ends at an empty line. `#` begins a comment.
//!
//! The path is the polyline through the points. Biarcs replace a stretch of it if they are within the tolerance; their
//! distance is bounded as for curves. At the remaining corners the vehicle turns in place.

use super::biarc::{BiarcFit, CurvePart, FitDeviation, ROUNDINGS, biarc, distance, is_beyond};
use super::nurbs::RationalBezier;
use super::path_builder::{LimitedPathBuilder, STRAIGHT};
use super::{ImportError, ImportOptions, VehicleTraits, Warnings, route};
use crate::byte_order_mark::unmarked;
use crate::plane_geometry::wrapped;
use crate::scenario::PlacedSegment;
use crate::scenario::{LIMIT, Scenario};

/// Angle between two steps from which on a point is a corner, not a sample of something smooth \[rad\].
const CORNER: f64 = 0.35;

/// Most points of a file.
const MOST: usize = 200_000;

/// Reads the paths, an agent each.
pub(super) fn read(
    text: &str,
    options: &ImportOptions,
    vehicle: &VehicleTraits,
    warnings: &mut Warnings,
) -> Result<Scenario, ImportError> {
    let mut agents = Vec::new();
    for points in paths(text)? {
        let id = agents.len() as u64 + 1;
        let fit = fit(&points, options.tolerance()).map_err(|error| ImportError::new(format!("path {id}: {error}")))?;
        if fit.bends {
            warnings.use_option("tolerance");
        }
        let mut tracer = LimitedPathBuilder::default();
        fit.pieces.iter().for_each(|piece| tracer.follow(piece));
        let mut trace = tracer.finish(points.first().copied().unwrap_or_default());
        trace.deviation += fit.deviation;
        agents.push(route::agent(id, &trace, vehicle, 0.0));
    }
    if agents.is_empty() {
        return Err(ImportError::new("there is no point in it"));
    }
    Ok(Scenario::new("", agents))
}

/// The points of each path.
fn paths(text: &str) -> Result<Vec<Vec<[f64; 2]>>, ImportError> {
    let text = unmarked(text);
    let (mut paths, mut points, mut count) = (Vec::new(), Vec::new(), 0);
    for (k, line) in text.lines().chain([""]).enumerate() {
        let content = line.split('#').next().unwrap_or_default().trim();
        if content.is_empty() {
            // A comment does not end a path.
            if line.trim().is_empty() && !points.is_empty() {
                paths.push(std::mem::take(&mut points));
            }
            continue;
        }
        // Some end each row with the mark between rows.
        let content = content.trim_end_matches([',', ';', ' ', '\t']);
        if has_empty_column(line) {
            let problem =
                "nothing before or between tabs, where a column may be missing; one tab or blanks are expected";
            return Err(ImportError::at(k + 1, None, problem));
        }
        if mixes_separators(content) {
            let problem =
                "commas beside other separators: decimal commas, or several points; one point x y is expected";
            return Err(ImportError::at(k + 1, None, problem));
        }
        let mut numbers = fields(content).map(|field| field.parse::<f64>().ok().filter(|x| x.abs() <= LIMIT));
        let (Some(Some(x)), Some(Some(y))) = (numbers.next(), numbers.next()) else {
            // At the first field that is none.
            let field = fields(content).take(2).find(|field| !field.parse::<f64>().is_ok_and(|x| x.abs() <= LIMIT));
            let at = field.map(|field| field.as_ptr() as usize - line.as_ptr() as usize);
            let column = at.and_then(|at| line.get(..at)).map(|before| before.chars().count() + 1);
            return Err(ImportError::at(k + 1, column, format!("two numbers x y up to {LIMIT:e} are expected")));
        };
        count += 1;
        if count > MOST {
            return Err(ImportError::new(format!("more than {MOST} points")));
        }
        points.push([x, y]);
    }
    Ok(paths)
}

/// The columns of a line. Blanks may be any number; a column between commas or semicolons may be empty, and is one all the same.
fn fields(content: &str) -> Box<dyn Iterator<Item = &str> + '_> {
    match [',', ';'].into_iter().find(|mark| content.contains(*mark)) {
        Some(mark) => Box::new(content.split(mark).map(str::trim)),
        None => Box::new(content.split_whitespace()),
    }
}

/// Whether tabs have nothing before or between them: an empty column, which would shift the others.
fn has_empty_column(line: &str) -> bool {
    let columns = line.split('#').next().unwrap_or_default().trim_end().split('\t');
    columns.clone().count() > 1 && columns.into_iter().any(|column| column.trim().is_empty())
}

/// Whether commas separate something within what blanks or semicolons separate, as in `1,5 2,5` and `0,0 4,0 4,4`: the
/// first two numbers are then not the point that is meant. Blanks beside a comma do not count.
fn mixes_separators(content: &str) -> bool {
    let columns = content.split(',').map(str::trim).collect::<Vec<_>>();
    columns.len() > 1 && columns.iter().any(|column| column.contains([' ', '\t', ';']))
}

/// The lines and arcs for a polyline.
fn fit(points: &[[f64; 2]], tolerance: f64) -> Result<BiarcFit, ImportError> {
    let mut points = points.to_vec();
    points.dedup();
    let extent = points.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let rounding = ROUNDINGS * extent;
    if tolerance <= 2.0 * rounding {
        return Err(ImportError::new(format!(
            "coordinates up to {extent:e} m cannot be fitted within {tolerance:e} m"
        )));
    }
    let steps: Vec<PlacedSegment> = points.windows(2).map(|pair| PlacedSegment::line(pair[0], pair[1])).collect();
    let turn = |k: usize| wrapped(steps[k].heading - steps[k - 1].heading);
    let (mut fit, mut along) = (BiarcFit::default(), FitDeviation::default());
    fit.bends = (1..steps.len()).any(|k| (STRAIGHT..=CORNER).contains(&turn(k).abs()));
    let mut from = 0;
    while from < steps.len() {
        let to = (from + 1..steps.len()).find(|&k| turn(k).abs() > CORNER).unwrap_or(steps.len());
        let smooth = SmoothRun::new(&steps[from..to], &turn, from);
        smooth.fit(tolerance - rounding, &mut fit, &mut along);
        from = to;
    }
    if fit.deviation > 0.0 {
        fit.deviation = fit.deviation.max(along.deviation) + rounding;
        fit.length_error = along.longer() + rounding;
    }
    Ok(fit)
}

/// Steps without a corner between them, and the directions at their points: those of the circles through three points each.
struct SmoothRun<'a> {
    steps: &'a [PlacedSegment],
    headings: Vec<f64>,
}

impl<'a> SmoothRun<'a> {
    fn new(steps: &'a [PlacedSegment], turn: &impl Fn(usize) -> f64, from: usize) -> Self {
        let length = |k: usize| steps[k].shape.length();
        let inner = |k: usize| steps[k - 1].heading + turn(from + k) * length(k - 1) / (length(k - 1) + length(k));
        let mut headings: Vec<f64> = (1..steps.len()).map(inner).collect();
        // At an end the circle of its neighbour.
        let last = steps.len() - 1;
        let mirrored = |step: f64, inner: Option<&f64>| inner.map_or(step, |inner| 2.0 * step - inner);
        let (begin, end) = (mirrored(steps[0].heading, headings.first()), steps[last].heading);
        // The heading of the last inner point may be more than half a turn away in numbers, not in direction.
        let end = mirrored(end, headings.last());
        headings.insert(0, begin);
        headings.push(end);
        Self { steps, headings }
    }

    /// Adds lines and arcs for all steps, halving where a biarc is too far away.
    fn fit(&self, tolerance: f64, fit: &mut BiarcFit, along: &mut FitDeviation) {
        let mut rest = vec![(0, self.steps.len())];
        while let Some((from, to)) = rest.pop() {
            let steps = &self.steps[from..to];
            let (first, last) = (steps[0], steps[steps.len() - 1]);
            let ends = [first.start, last.end()];
            let line = PlacedSegment::line(ends[0], ends[1]);
            let found = self.line(steps, &line, tolerance).or_else(|| {
                let arcs = biarc(ends, [self.headings[from], self.headings[to]])?;
                let deviation = self.distance(steps, &arcs);
                (deviation <= tolerance).then(|| (arcs.to_vec(), deviation))
            });
            match found {
                Some((pieces, deviation)) => {
                    let parts = steps.iter().map(|step| {
                        let length = step.shape.length();
                        CurvePart { end: step.end(), length: [length; 2], lateral_deviation: 0.0 }
                    });
                    along.follow(ends[0], &pieces, &parts.collect::<Vec<_>>());
                    fit.deviation = fit.deviation.max(deviation);
                    fit.pieces.extend(pieces.into_iter().filter(|piece| piece.shape.length() > 0.0));
                }
                None if steps.len() == 1 => fit.pieces.push(first),
                None => {
                    let middle = from + steps.len() / 2;
                    rest.extend([(middle, to), (from, middle)]);
                }
            }
        }
    }

    /// One line for steps that are straight, but for what is far below the tolerance.
    fn line(&self, steps: &[PlacedSegment], line: &PlacedSegment, tolerance: f64) -> Option<(Vec<PlacedSegment>, f64)> {
        let far = |step: &PlacedSegment| distance(&RationalBezier::new(&[step.start, step.end()]), line);
        let deviation = steps.iter().map(far).fold(0.0, f64::max);
        (steps.len() > 1 && deviation <= tolerance / 1024.0).then(|| (vec![*line], deviation))
    }

    /// Bound of the distance of all points of some steps from two arcs.
    fn distance(&self, steps: &[PlacedSegment], arcs: &[PlacedSegment; 2]) -> f64 {
        let mut deviation = 0.0_f64;
        let mut arc = 0;
        for step in steps {
            let whole = RationalBezier::new(&[step.start, step.end()]);
            if arc == 0 && is_beyond(step.end(), &arcs[1]) {
                // The step in which the second arc begins, cut there.
                let (sin, cos) = arcs[1].heading.sin_cos();
                let along = |[x, y]: [f64; 2]| (x - arcs[1].start[0]) * cos + (y - arcs[1].start[1]) * sin;
                let (before, after) = (along(step.start).min(0.0), along(step.end()));
                let [first, second] = whole.split(-before / (after - before));
                deviation = deviation.max(distance(&first, &arcs[0])).max(distance(&second, &arcs[1]));
                arc = 1;
            } else {
                deviation = deviation.max(distance(&whole, &arcs[arc]));
            }
        }
        deviation
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::PathSegment;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn radii(fit: &BiarcFit) -> Vec<f64> {
        let radius = |piece: &PlacedSegment| match piece.shape {
            PathSegment::Arc { radius, .. } => Some(radius),
            _ => None,
        };
        fit.pieces.iter().filter_map(radius).collect()
    }

    #[test]
    fn samples_of_a_circle_are_its_arcs() {
        let at = |k: i32| [2.0 * (f64::from(k) * 0.02).cos(), 2.0 * (f64::from(k) * 0.02).sin()];
        let points: Vec<[f64; 2]> = (0..=250).map(at).collect();
        let fit = fit(&points, 1e-3).unwrap();
        let radii = radii(&fit);
        assert!(radii.len() == fit.pieces.len() && radii.len() <= 16, "{radii:?}");
        assert!(radii.iter().all(|radius| (radius - 2.0).abs() < 1e-9), "{radii:?}");
        // Sagitta of a step: 2 (1 - cos 0.01); and 10 m of arcs are 1.7e-4 m longer than the steps.
        assert!(fit.deviation > 1.0e-4 - 1e-8 && fit.deviation < 5e-4, "{}", fit.deviation);
        let length: f64 = fit.pieces.iter().map(|piece| piece.shape.length()).sum();
        assert!((length - 10.0).abs() < 1e-6);
    }

    #[test]
    fn samples_of_a_clothoid_take_few_arcs() {
        // Curvature k s, integrated by the midpoint rule, a millimetre a step.
        let (mut point, mut points) = ([0.0, 0.0], vec![[0.0, 0.0]]);
        for k in 0..6000 {
            let s = (f64::from(k) + 0.5) * 1e-3;
            let heading: f64 = 0.1 * s * s;
            point = [point[0] + 1e-3 * heading.cos(), point[1] + 1e-3 * heading.sin()];
            if k % 20 == 19 {
                points.push(point);
            }
        }
        let fit = fit(&points, 1e-3).unwrap();
        assert!(fit.pieces.len() <= 32 && fit.deviation <= 1e-3, "{} {}", fit.pieces.len(), fit.deviation);
        let (first, last) = (fit.pieces[0], fit.pieces[fit.pieces.len() - 1]);
        let apart = |a: f64, b: f64| ((a - b + PI).rem_euclid(2.0 * PI) - PI).abs();
        assert!(apart(first.heading, 0.0) < 0.01 && apart(last.heading_at_end(), 3.6) < 0.02);
        for pair in fit.pieces.windows(2) {
            assert!(apart(pair[1].heading, pair[0].heading_at_end()) < 1e-6, "smooth");
        }
    }

    #[test]
    fn corners_stay_and_straight_stretches_are_lines() {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [2.5, 0.0], [4.0, 0.0], [4.0, 2.0], [4.0, 3.0]];
        let fit = fit(&points, 1e-3).unwrap();
        assert_eq!(
            fit.pieces,
            [PlacedSegment::line([0.0, 0.0], [4.0, 0.0]), PlacedSegment::line([4.0, 0.0], [4.0, 3.0])]
        );
        assert_eq!(fit.pieces[1].heading, FRAC_PI_2);
        assert!(fit.deviation < 1e-12);
    }

    #[test]
    fn files_hold_several_paths() {
        let text = "# two\n0 0 0.1\n1,0\n# not the end\n2;0\n\n\n5\t5\n";
        assert_eq!(paths(text).unwrap(), [vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], vec![[5.0, 5.0]]]);
        assert_eq!(
            paths("0 0\n1 x").unwrap_err().to_string(),
            "line 2, column 3: two numbers x y up to 1e10 are expected"
        );
        assert!(paths("1e11 0").is_err() && paths("nan 0").is_err());
        for mixed in ["1,5 2,5", "1,5;2,5", "0,0\t4,0 4,4", "1, 5 2, 5", "1 2,5"] {
            let expected =
                "line 2: commas beside other separators: decimal commas, or several points; one point x y is expected";
            assert_eq!(paths(&format!("0 0\n{mixed}\n")).unwrap_err().to_string(), expected, "{mixed}");
        }
        // A column that is empty is one: the others are not shifted.
        for empty in ["10,,5", ",10,0", ";1;2", "1; ;2", "1,"] {
            let error = paths(&format!("0,0\n{empty}\n")).unwrap_err().to_string();
            assert!(error.starts_with("line 2") && error.contains(": two numbers x y"), "{empty}: {error}");
        }
        for one in ["1.0 2.0;", "1 2 ;", "1,2, 3", "1 , 2", " 1\t2 3", "1  2", "1; 2", "1,2,,", "1,2 # a, b c"] {
            assert_eq!(paths(one).unwrap(), [[[1.0, 2.0]]], "{one}");
        }
        for empty in ["10\t\t1.57", "\t5\t6", "10\t \t1.57"] {
            let error = paths(&format!("0\t0\n{empty}\n")).unwrap_err().to_string();
            assert!(error.starts_with("line 2: nothing before or between tabs"), "{error}");
        }
        assert_eq!(paths("1\t2\t\t\n").unwrap(), [[[1.0, 2.0]]]);
        assert!(fit(&[[1.0, 1.0]], 1e-3).unwrap().pieces.is_empty());
    }
}
