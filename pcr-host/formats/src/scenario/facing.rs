//! The angle from the direction of travel to the heading of a vehicle: in files a property of lines and arcs, in paths a change between them.

use super::{Agent, MotionPiece, PathSegment, turns};

/// Whether the angle to the heading changes there.
pub(super) fn changes(segment: &PathSegment) -> bool {
    matches!(segment, PathSegment::Facing { .. })
}

/// The segments of a path as files have them, each with the angle from the direction of travel to the heading at their
/// start \[rad\].
pub(super) fn file_segments(path: &[PathSegment]) -> impl Iterator<Item = (&PathSegment, f64)> {
    let mut facing = 0.0;
    path.iter().filter_map(move |segment| {
        let before = facing;
        facing = segment.facing_after(facing);
        (!changes(segment)).then_some((segment, before))
    })
}

impl Agent {
    /// Whether the vehicle changes its gear, or travels at another angle to its heading, if only at its start.
    pub fn changes_facing(&self) -> bool {
        self.path.iter().any(changes)
    }

    /// Whether the vehicle keeps its heading on an arc.
    pub fn has_steady_arcs(&self) -> bool {
        self.path.iter().any(|segment| matches!(segment, PathSegment::Arc { steady: true, .. }))
    }

    /// The number in a file (from 0) of a segment of the path.
    pub fn file_segment(&self, segment: usize) -> usize {
        segment - self.path.iter().take(segment).filter(|segment| changes(segment)).count()
    }

    /// The speed with which it reaches a change of facing other than at its start, if that is above 0 \[m/s\], and the number of the segment
    /// before (from 0).
    pub(super) fn speed_at_change(&self) -> Option<(usize, f64)> {
        if !self.changes_facing() {
            return None;
        }
        let parts = self.parts();
        let mut speed = self.motion.pieces(self.length()).0;
        let mut travelled = 0.0;
        for (place, (segment, phases)) in self.path.iter().zip(&parts).enumerate() {
            speed = phases.last().map_or(speed, |phase| phase.after);
            travelled += segment.length();
            if changes(segment) && travelled > 0.0 && speed > 0.0 {
                return Some((self.file_segment(place).saturating_sub(1), speed));
            }
        }
        None
    }
}

/// From rest to rest between all changes of facing and turns in place, in the least time under limits of speed and acceleration, of turns as
/// well.
pub(super) fn pieces(path: &[PathSegment], limits: [f64; 2], turn_limits: [f64; 2]) -> Vec<MotionPiece> {
    let runs = path.split(changes);
    runs.flat_map(|run| turns::pieces(run, limits, turn_limits)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;
    use serde_json::{Value, json};
    use std::f64::consts::{FRAC_PI_2, PI};

    fn file(version: u64, path: &Value, more: &[(&str, Value)]) -> String {
        let mut agent = json!({ "id": 7, "radius": 0.2, "v_max": 1.0, "a_max": 1.0, "path": path,
            "start": { "x": 0.0, "y": 0.0, "heading": 0.0 } });
        more.iter().for_each(|(key, value)| agent[key] = value.clone());
        json!({ "version": version, "agents": [agent] }).to_string()
    }

    fn line(length: f64, gear: Option<&str>) -> Value {
        gear.map_or(
            json!({ "kind": "line", "length": length }),
            |gear| json!({ "kind": "line", "length": length, "gear": gear }),
        )
    }

    #[test]
    fn gears_change_between_segments_and_the_vehicle_stands_there() {
        let turn = json!({ "kind": "turn", "sweep": 1.0 });
        let path = json!([
            line(1.0, Some("reverse")),
            line(2.0, None),
            line(4.0, Some("forward")),
            line(1.0, Some("reverse")),
            turn,
            line(3.0, Some("reverse"))
        ]);
        let turns = [("turn_v_max", json!(1.0)), ("turn_a_max", json!(1.0))];
        let scenario = Scenario::from_json(&file(2, &path, &turns)).unwrap();
        let agent = &scenario.agents[0];
        assert_eq!(agent.structure(), "CSCSSCSTS");
        assert_eq!([1, 3, 4, 6, 8].map(|place| agent.file_segment(place)), [0, 1, 2, 3, 5]);
        // 1 m, 6 m, 1 m, a turn by 1 rad, 3 m, each from rest to rest.
        let durations = [2.0, 7.0, 2.0, 2.0, 4.0];
        assert!((agent.duration() - durations.iter().sum::<f64>()).abs() < 1e-9, "{}", agent.duration());
        assert_eq!(agent.speed_at_change(), None);
        assert_eq!(Scenario::from_json(&scenario.to_json()), Ok(scenario.clone()));
        assert!(scenario.to_json().contains("\"version\": 3"));
        // Files without gears are those of version 1.
        let plain = Scenario::from_json(&file(2, &json!([line(2.0, Some("forward"))]), &[])).unwrap();
        assert!(plain.to_json().contains("\"version\": 1") && !plain.to_json().contains("gear"));
    }

    #[test]
    fn angles_between_way_and_heading_are_kept() {
        let across = |mut segment: Value, key: &str, angle: f64| {
            segment[key] = json!(angle);
            segment
        };
        let arc = json!({ "kind": "arc", "radius": 1.0, "sweep": 0.7 });
        let path = json!([
            across(line(2.0, None), "facing", 0.3),
            across(arc, "facing", 0.1 + 0.2),
            across(line(1.0, None), "facing_deg", -90.0),
            line(1.0, Some("reverse")),
            line(1.0, None)
        ]);
        let loads = json!([{ "segments": [2, 3], "radius": 0.5 }, { "segments": [4, 4], "radius": 0.4 }]);
        let scenario = Scenario::from_json(&file(4, &path, &[("loads", loads)])).unwrap();
        let agent = &scenario.agents[0];
        assert_eq!(agent.structure(), "CSCACSCSCS");
        assert_eq!(Scenario::from_json(&scenario.to_json()), Ok(scenario.clone()));
        let written: Value = serde_json::from_str(&scenario.to_json()).unwrap();
        assert_eq!(written["version"], 4);
        assert_eq!(written["agents"][0]["path"][2]["facing"], json!(-FRAC_PI_2));
        assert_eq!(written["agents"][0]["loads"][1]["segments"], json!([4, 4]));
        // The vehicle has a load already where its facing changes before it, so that no outline is there for nothing.
        let outlines = agent.outlines();
        let segments: Vec<[usize; 2]> = outlines.iter().map(|outline| outline.segments).collect();
        assert_eq!(segments, [[0, 1], [2, 5], [6, 7], [8, 9]]);
        // The body goes on where it was: its heading is that of the whole path, on each part of it.
        let headings = |agent: &Agent| -> Vec<f64> {
            let [_, _, mut heading] = agent.start;
            agent
                .path
                .iter()
                .map(|segment| {
                    heading += segment.sweep();
                    heading
                })
                .collect()
        };
        let whole = headings(agent);
        for [first, last] in segments {
            let part = agent.stretch(first, last).agent;
            let end = headings(&part).pop().unwrap();
            assert!((end - whole[last]).abs() < 1e-12, "{first} to {last}: {end}");
            // It begins ahead, with the angle that it has on its first segment.
            let facing = match part.path[0] {
                PathSegment::Facing { before, after } => {
                    assert_eq!(before, 0.0);
                    after
                }
                _ => 0.0,
            };
            assert_eq!(Some(facing), file_segments(&part.path).map(|(_, facing)| facing).next());
        }
    }

    #[test]
    fn a_heading_that_is_kept_on_arcs_goes_on_behind_them() {
        let steady = |mut segment: Value| {
            segment["steady"] = json!(true);
            segment
        };
        let arc = |sweep: f64| json!({ "kind": "arc", "radius": 1.0, "sweep": sweep });
        let (mut across, mut plain) = (steady(arc(0.7)), arc(0.2));
        (across["facing"], plain["steady"]) = (json!(0.3), json!(false));
        let path =
            json!([steady(arc(0.5)), steady(arc(5.0)), steady(line(1.0, None)), across, plain, steady(arc(0.0))]);
        let scenario = Scenario::from_json(&file(5, &path, &[])).unwrap();
        let agent = &scenario.agents[0];
        assert_eq!(agent.structure(), "AASCACAA");
        let facings: Vec<f64> = file_segments(&agent.path).map(|(_, facing)| facing).collect();
        for (facing, expected) in facings.iter().zip([0.0, -0.5, 2.0 * PI - 5.5, 0.3, 0.0, 0.0]) {
            assert!((facing - expected).abs() < 1e-14, "{facings:?}");
        }
        assert_eq!(Scenario::from_json(&scenario.to_json()), Ok(scenario.clone()));
        assert!(scenario.to_json().contains("\"version\": 5"));
        // Where a part of the path begins, the vehicle has the heading that it has there.
        for first in 0..agent.path.len() {
            let part = agent.stretch(first, agent.path.len() - 1).agent;
            let own = file_segments(&part.path).map(|(_, facing)| facing).next().unwrap();
            assert!((own - facings[agent.file_segment(first)]).abs() < 1e-14, "{first}: {own} {facings:?}");
        }
    }

    #[test]
    fn a_heading_that_is_kept_needs_its_version() {
        for steady in [json!(true), json!(false)] {
            for segment in
                [json!({ "kind": "line", "length": 1.0 }), json!({ "kind": "arc", "radius": 1.0, "sweep": 1.0 })]
            {
                let mut segment = segment;
                segment["steady"] = steady.clone();
                let refused = Scenario::from_json(&file(4, &json!([segment]), &[])).unwrap_err().to_string();
                assert!(refused.contains("segment 1, steady: it is there from version 5 on"), "{refused}");
            }
        }
        let odd = json!({ "kind": "line", "length": 1.0, "steady": 1 });
        let refused = Scenario::from_json(&file(5, &json!([odd]), &[])).unwrap_err().to_string();
        assert!(refused.contains("steady: 1 where true or false is expected"), "{refused}");
        let turn = json!({ "kind": "turn", "sweep": 1.0, "steady": true });
        assert!(Scenario::from_json(&file(5, &json!([turn]), &[])).unwrap_err().to_string().contains("steady"));
    }

    #[test]
    fn an_angle_beside_a_gear_is_refused() {
        let refused = |version: u64, segment: Value| {
            Scenario::from_json(&file(version, &json!([segment]), &[])).unwrap_err().to_string()
        };
        let beside = |key: &str| json!({ "kind": "line", "length": 1.0, "gear": "reverse", key: 1.0 });
        for key in ["facing", "facing_deg"] {
            let refused = refused(4, beside(key));
            assert!(refused.contains("given beside gear"), "{refused}");
        }
        let alone = json!({ "kind": "line", "length": 1.0, "facing": 1.0 });
        for version in 1..4 {
            let refused = refused(version, alone.clone());
            assert!(refused.contains("segment 1, facing: it is there from version 4 on"), "{refused}");
        }
        let turn = refused(4, json!({ "kind": "turn", "sweep": 1.0, "facing": 1.0 }));
        assert!(turn.contains("facing"), "{turn}");
        assert!(
            refused(4, json!({ "kind": "line", "length": 1.0, "facing": 1.0, "facing_deg": 1.0 })).contains("degrees")
        );
    }

    #[test]
    fn what_has_no_gear_is_refused() {
        let refused = |text: &str| Scenario::from_json(text).unwrap_err().to_string();
        let back = json!([line(1.0, Some("reverse"))]);
        for version in [json!(1), Value::Null] {
            let mut file: Value = serde_json::from_str(&file(2, &back, &[])).unwrap();
            file["version"] = version.clone();
            if version.is_null() {
                file.as_object_mut().unwrap().remove("version");
            }
            let refused = refused(&file.to_string());
            assert!(refused.contains("agent 7, segment 1, gear: it is there from version 2 on"), "{refused}");
        }
        assert!(refused(&file(6, &back, &[])).contains("1 to 5, all that this pcr knows,"));
        let neutral = refused(&file(2, &json!([line(1.0, Some("neutral"))]), &[]));
        assert!(neutral.contains("gear: \"neutral\" where \"forward\" or \"reverse\" is expected"), "{neutral}");
        let turn = refused(&file(2, &json!([{ "kind": "turn", "sweep": 1.0, "gear": "reverse" }]), &[]));
        assert!(turn.contains("gear"), "{turn}");
    }

    #[test]
    fn a_profile_stops_where_the_gear_changes() {
        let path = json!([line(1.0, None), line(1.0, Some("reverse"))]);
        let with = |pieces: Value| {
            Scenario::from_json(&file(2, &path, &[("profile", json!({ "v0": 0.0, "pieces": pieces }))]))
        };
        let piece = |duration: f64, accel: f64| json!({ "duration": duration, "accel": accel });
        assert!(
            with(json!([piece(1.0, 1.0), piece(1.0, -1.0), piece(3.0, 0.0), piece(1.0, 1.0), piece(1.0, -1.0)]))
                .is_ok()
        );
        let through = with(json!([piece(2.0_f64.sqrt(), 1.0), piece(2.0_f64.sqrt(), -1.0)])).unwrap_err().to_string();
        assert!(
            through.contains("m/s at the end of segment 1; allowed is 0, because the gear or facing changes"),
            "{through}"
        );
        // Whoever begins in reverse gear may come from somewhere.
        let back = json!([line(1.0, Some("reverse"))]);
        let profile = json!({ "v0": 1.0, "pieces": [piece(1.0, 0.0)] });
        assert!(Scenario::from_json(&file(2, &back, &[("profile", profile)])).is_ok());
    }
}
