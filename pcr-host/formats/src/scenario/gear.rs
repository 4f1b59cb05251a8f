//! Reverse gear: in files a property of segments, in paths a change of gear between them.

use super::{Agent, MotionPiece, PathSegment, turns};

/// A path in which the gear may change.
pub(super) trait GearShifts {
    /// The segments without changes of gear, each with whether the vehicle drives backward on it.
    fn in_gear(&self) -> impl Iterator<Item = (&PathSegment, bool)>;
}

impl GearShifts for [PathSegment] {
    fn in_gear(&self) -> impl Iterator<Item = (&PathSegment, bool)> {
        let mut reverse = false;
        self.iter().filter_map(move |segment| {
            let is_cusp = *segment == PathSegment::Cusp;
            reverse ^= is_cusp;
            (!is_cusp).then_some((segment, reverse))
        })
    }
}

impl Agent {
    /// Whether the vehicle changes its gear, or begins in reverse gear.
    pub fn changes_gear(&self) -> bool {
        self.path.contains(&PathSegment::Cusp)
    }

    /// The number in a file (from 0) of a segment of the path: changes of gear are none.
    pub(crate) fn file_segment(&self, segment: usize) -> usize {
        let before = self.path.iter().take(segment).filter(|segment| **segment == PathSegment::Cusp);
        segment - before.count()
    }

    /// The speed with which it reaches a change of gear other than at its start, if that is above 0 \[m/s\], and the number of the segment
    /// before (from 0).
    pub(super) fn speed_at_cusp(&self) -> Option<(usize, f64)> {
        if !self.changes_gear() {
            return None;
        }
        let parts = self.parts();
        let mut speed = self.motion.pieces(self.length()).0;
        let mut travelled = 0.0;
        for (place, (segment, phases)) in self.path.iter().zip(&parts).enumerate() {
            speed = phases.last().map_or(speed, |phase| phase.after);
            travelled += segment.length();
            if *segment == PathSegment::Cusp && travelled > 0.0 && speed > 0.0 {
                return Some((self.file_segment(place).saturating_sub(1), speed));
            }
        }
        None
    }
}

/// From rest to rest between all changes of gear and turns in place, in the least time under limits of speed and acceleration, of turns as
/// well.
pub(super) fn pieces(path: &[PathSegment], limits: [f64; 2], turn_limits: [f64; 2]) -> Vec<MotionPiece> {
    let runs = path.split(|segment| *segment == PathSegment::Cusp);
    runs.flat_map(|run| turns::pieces(run, limits, turn_limits)).collect()
}

#[cfg(test)]
mod tests {
    use crate::scenario::Scenario;
    use serde_json::{Value, json};

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
        assert_eq!(agent.speed_at_cusp(), None);
        assert_eq!(Scenario::from_json(&scenario.to_json()), Ok(scenario.clone()));
        assert!(scenario.to_json().contains("\"version\": 3"));
        // Files without gears are those of version 1.
        let plain = Scenario::from_json(&file(2, &json!([line(2.0, Some("forward"))]), &[])).unwrap();
        assert!(plain.to_json().contains("\"version\": 1") && !plain.to_json().contains("gear"));
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
            assert!(refused.contains("agent 7, segment 1, gear: there are gears from version 2 on"), "{refused}");
        }
        assert!(refused(&file(4, &back, &[])).contains("1, 2 or 3, all that this pcr knows,"));
        let neutral = refused(&file(2, &json!([line(1.0, Some("neutral"))]), &[]));
        assert!(neutral.contains("gear: \"neutral\" where \"forward\" or \"reverse\" is expected"), "{neutral}");
        let turn = refused(&file(2, &json!([{ "kind": "turn", "sweep": 1.0, "gear": "reverse" }]), &[]));
        assert!(turn.contains("gear"), "{turn}");
        let loads = json!([{ "segments": [1, 1], "radius": 0.5 }]);
        assert!(refused(&file(2, &back, &[("loads", loads)])).contains("none yet on a path with reverse gear"));
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
        assert!(through.contains("m/s at the end of segment 1; allowed is 0, because the gear changes"), "{through}");
        // Whoever begins in reverse gear may come from somewhere.
        let back = json!([line(1.0, Some("reverse"))]);
        let profile = json!({ "v0": 1.0, "pieces": [piece(1.0, 0.0)] });
        assert!(Scenario::from_json(&file(2, &back, &[("profile", profile)])).is_ok());
    }
}
