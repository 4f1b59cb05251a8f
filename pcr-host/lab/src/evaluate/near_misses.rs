//! Contacts and near misses down to a ten-millionth of a metre.

use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness};
use crate::methods::methods;
use pcr_comparing::compare::{
    CollisionMethod, ComparisonFleet, ComparisonInput, MethodAnswer, MethodError, MethodQuestion,
};
use pcr_formats::scenario::{Agent, MotionSpec, PathSegment, Scenario};
use pcr_planning::fleet::FormatRangeError;
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};
use std::fmt::Write as _;

/// How deep, and how near \[m\].
const DEPTHS: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7];

/// \[m/s\]
const SPEED: f64 = 0.37;

/// Radii, sum 0.31 m.
const RADII: [f64; 2] = [0.12, 0.19];

/// Time between looks at a map along the own motion \[s\].
const LOOK: f64 = 1e-3;

pub(super) fn section(_: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let mut text = String::from(
        "## Grazing pairs\n\nTwo discs at constant speeds that miss each other, or overlap, by 10⁻² to 10⁻⁷ m: on opposite lines, on crossing lines, \
        on concentric arcs, and on a line and an arc with a common tangent. Each cell has the number of collisions found of 4, and of collisions \
        invented of 4 near misses; the right answer is `4 · 0`. Maps are queried along the agent's own motion.\n\n| method |",
    );
    for depth in DEPTHS {
        let _ = write!(text, " {depth:e} m |");
    }
    text.push_str(" wrong | where |\n|---|");
    text.push_str(&"---:|".repeat(DEPTHS.len() + 1));
    text.push_str("---|\n");
    let mut inputs = Vec::new();
    for depth in DEPTHS {
        let named = |scenario: &Scenario| Ok((scenario.name.clone(), ComparisonInput::new(scenario)?));
        let of = |clearance: f64| pairs(clearance).iter().map(named).collect::<Result<Vec<_>, FormatRangeError>>();
        inputs.push([of(-depth)?, of(depth)?]);
    }
    for method in
        methods().iter().filter(|method| method.question() == MethodQuestion::Conflicts || sampled(method.as_ref()))
    {
        let name = method.name();
        let wanted = extent.filters().is_empty() || extent.filters().iter().any(|filter| name.contains(filter));
        if name.contains("all cores") || !wanted || method.missing().is_some() {
            continue;
        }
        let _ = write!(text, "| {name} |");
        let mut wrong: Vec<&str> = Vec::new();
        for cases in &inputs {
            // Of the contacts, then of the near misses.
            let mut counts = [0; 2];
            for ((count, pairs), contact) in counts.iter_mut().zip(cases).zip([true, false]) {
                for (kind, input) in pairs {
                    let found = collides(method.as_ref(), &input.field())?;
                    *count += usize::from(found);
                    if found != contact {
                        wrong.push(kind);
                    }
                }
            }
            let _ = write!(text, " {} · {} |", counts[0], counts[1]);
        }
        let count = wrong.len();
        wrong.sort_unstable();
        wrong.dedup();
        let places = match wrong.len() {
            0 => "–".into(),
            KINDS => "everywhere".into(),
            _ => wrong.join(", "),
        };
        let _ = writeln!(text, " {count} | {places} |");
    }
    text.push_str(
        "\nFixed point and single precision round outward: discs that are nearer than ε count as touching \
        ([errors.md](../theory/errors.md)). Meshes and polylines enclose the discs and paths. Box2D, in single precision, stops at a \
        distance of a quarter of its slop of 5 mm.\n",
    );
    Ok(DocumentSection { text, pictures: Vec::new() })
}

/// One sampled map is enough: boxes do not change it.
fn sampled(method: &dyn CollisionMethod) -> bool {
    method.name() == "sampled map 0.01 s, boxes"
}

fn collides(method: &dyn CollisionMethod, field: &ComparisonFleet<'_>) -> Result<bool, EvaluationError> {
    let failed = |reason: MethodError| EvaluationError::Method(method.name(), reason.to_string());
    Ok(match method.answer(field).map_err(failed)? {
        MethodAnswer::Conflicts(found) => !found.is_empty(),
        MethodAnswer::Regions(regions) => {
            let [begin, end] = field.horizon;
            let times = (0..=((end - begin) / LOOK) as usize).map(|k| begin + LOOK * k as f64);
            times.into_iter().any(|time| {
                let length = field.tracks[0].length_at(time);
                regions.slice(0, 1, time).iter().any(|[from, to]| (*from..=*to).contains(&length))
            })
        }
    })
}

fn agent(id: usize, t_start: f64, start: [f64; 3], segment: PathSegment) -> Agent {
    let motion = MotionSpec::profile(SPEED, [(segment.length() / SPEED, 0.0)]);
    Agent { t_start, ..Agent::disc(id as u64 + 1, RADII[id], start, vec![segment], motion) }
}

/// Kinds of pairs.
const KINDS: usize = 4;

/// One pair of each kind whose discs come within this clearance \[m\], and no nearer.
fn pairs(clearance: f64) -> [Scenario; KINDS] {
    let reach = RADII[0] + RADII[1] + clearance;
    let line = |length| PathSegment::Line { length };
    let arc = |radius, sweep| PathSegment::arc(radius, sweep);
    let of = |name: &str, agents: [Agent; 2]| Scenario::new(name, agents.into());
    let east = |t_start| agent(0, t_start, [-4.0, 0.0, 0.0], line(8.0));
    [
        of("opposite lines", [east(0.123), agent(1, 0.0, [4.0, reach, PI], line(8.0))]),
        // At equal speeds on perpendicular lines they are nearest at the way that one is late by, over √2.
        of("crossing lines", [east(SQRT_2 * reach / SPEED), agent(1, 0.0, [0.0, -4.0, FRAC_PI_2], line(8.0))]),
        of(
            "concentric arcs",
            [
                agent(0, 0.0, [2.0, 0.0, FRAC_PI_2], arc(2.0, 3.0)),
                agent(1, 0.0, [-2.0 - reach, 0.0, FRAC_PI_2], arc(2.0 + reach, -3.0)),
            ],
        ),
        // Both pass the common normal at the same time, in opposite directions.
        of(
            "line and arc",
            [agent(0, 0.0, [-1.5, 0.0, 0.0], line(3.0)), {
                let (radius, way): (f64, f64) = (1.2, 1.5);
                let turned = way / radius;
                let start = [radius * turned.sin(), reach + radius - radius * turned.cos(), PI + turned];
                agent(1, 0.0, start, arc(radius, -2.0 * turned))
            }],
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_comparing::compare::reference::contacts;

    #[test]
    fn pairs_come_as_near_as_they_are_said_to() {
        for depth in DEPTHS {
            for (clearance, met) in [(-depth, true), (depth, false)] {
                for scenario in pairs(clearance) {
                    let input = ComparisonInput::new(&scenario).unwrap();
                    let field = input.field();
                    let found = contacts(&field.tracks[0], &field.tracks[1], field.horizon);
                    assert_eq!(found.iter().any(|contact| contact.certain), met, "{} {clearance}", scenario.name);
                    // Half as much again in the other direction.
                    let nearest = 1.5 * clearance;
                    let grown = |radius: f64| radius + 0.5 * nearest;
                    let mut scenario = scenario.clone();
                    scenario.agents.iter_mut().for_each(|agent| agent.radius = grown(agent.radius));
                    let input = ComparisonInput::new(&scenario).unwrap();
                    let field = input.field();
                    let found = contacts(&field.tracks[0], &field.tracks[1], field.horizon);
                    assert_eq!(found.iter().any(|contact| contact.certain), !met, "{} {clearance}", scenario.name);
                }
            }
        }
    }
}
