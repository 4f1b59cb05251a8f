//! What the tests share: paths as messages, and a watch of some robots.

#![allow(dead_code)]

use pcr_ros2::messages::{Header, PathMessage, PoseStamped, Position, Quaternion, SpatialPose, Time};
use pcr_ros2::report::{AuthorityReport, PairReport};
use pcr_ros2::{Answer, Config, Watch};

/// When the paths are published, and asked for.
pub(crate) const NOW: Time = Time { sec: 1_800_000_000, nanosec: 250_000_000 };

/// Seconds after [`NOW`].
pub(crate) fn at(seconds: f64) -> Time {
    NOW.later(seconds).expect("a time in range")
}

/// A time, position and heading.
pub(crate) type Timed = (f64, f64, f64, f64);

pub(crate) fn path(poses: &[Timed]) -> PathMessage {
    let stamped = |&(time, x, y, yaw): &Timed| PoseStamped {
        header: Header { stamp: at(time), frame_id: String::new() },
        pose: SpatialPose { position: Position { x, y, z: 0.0 }, orientation: Quaternion::heading(yaw) },
    };
    PathMessage {
        header: Header { stamp: NOW, frame_id: "map".to_owned() },
        poses: poses.iter().map(stamped).collect(),
    }
}

/// Robots "0", "1" and so on with these footprints, as in a configuration, and no margin.
pub(crate) fn watch(footprints: &[&str]) -> Watch {
    let robot = |(k, footprint): (usize, &&str)| {
        format!(r#"{{ "name": "{k}", "path": "/r{k}/plan", {footprint}, "margin": 0 }}"#)
    };
    let robots: Vec<String> = footprints.iter().enumerate().map(robot).collect();
    let config = format!(r#"{{ "frame": "map", "max_age": 2, "robots": [{}] }}"#, robots.join(", "));
    Watch::new(Config::from_json(&config).expect("a configuration"))
}

/// What a pair is, by its names.
pub(crate) fn pair<'a>(answer: &'a Answer, a: &str, b: &str) -> &'a PairReport {
    let mut found =
        answer.conflicts.pairs.iter().filter(|pair| (pair.robot_a.as_str(), pair.robot_b.as_str()) == (a, b));
    let only = found.next().expect("each pair is told");
    assert!(found.next().is_none());
    only
}

pub(crate) fn authority<'a>(answer: &'a Answer, robot: &str) -> &'a AuthorityReport {
    answer.authorities.robots.iter().find(|authority| authority.robot == robot).expect("each robot is told")
}

/// Random numbers.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// From `lo` to `hi`.
    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        lo + (hi - lo) * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
