//! Which topics hold poses, and of which vehicle they are.

/// What the messages of a topic are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PoseSource {
    /// `geometry_msgs/PoseStamped`
    Pose,
    /// `geometry_msgs/PoseWithCovarianceStamped`, `nav_msgs/Odometry`
    PoseWithCovariance,
    /// `nav_msgs/Path`
    Path,
    /// `tf2_msgs/TFMessage`
    Transforms,
    /// `rmf_fleet_msgs/FleetState`
    Fleet,
}

impl PoseSource {
    /// What messages of this type hold, if that is poses.
    pub(super) fn of_type(name: &str) -> Option<Self> {
        match name {
            "geometry_msgs/PoseStamped" => Some(Self::Pose),
            "geometry_msgs/PoseWithCovarianceStamped" | "nav_msgs/Odometry" => Some(Self::PoseWithCovariance),
            "nav_msgs/Path" => Some(Self::Path),
            "tf2_msgs/TFMessage" => Some(Self::Transforms),
            "rmf_fleet_msgs/FleetState" => Some(Self::Fleet),
            _ => None,
        }
    }
}

/// Frames of the body of a vehicle (REP 105 of ROS).
const BODIES: [&str; 2] = ["base_link", "base_footprint"];

/// The namespace of a topic: all levels but the last.
pub(super) fn namespace(topic: &str) -> &str {
    let topic = topic.trim_start_matches('/');
    topic.rsplit_once('/').map_or("", |(space, _)| space)
}

/// The name of the vehicle with this namespace.
pub(super) fn or_root(space: &str) -> String {
    if space.is_empty() { "/".into() } else { space.to_owned() }
}

/// Whether an option names this topic: by all of its name, or its last levels.
pub(super) fn is_chosen(topic: &str, name: &str) -> bool {
    let [topic, name] = [topic, name].map(|text| text.trim_matches('/'));
    topic == name || topic.strip_suffix(name).is_some_and(|before| before.ends_with('/'))
}

/// The name of a map: that of its frame, with the vehicle where the frame is of that vehicle alone.
pub(super) fn map_name(space: &str, frame: &str) -> String {
    let frame = frame.trim_start_matches('/');
    if frame == "odom" && !space.is_empty() { format!("{space}/{frame}") } else { frame.to_owned() }
}

/// The vehicle whose body this frame is, in the tf of a namespace.
pub(super) fn vehicle(space: &str, frame: &str) -> Option<String> {
    let (prefix, last) = frame.rsplit_once('/').unwrap_or(("", frame));
    let own = BODIES.iter().find_map(|body| {
        let before = last.strip_suffix(body)?;
        if before.is_empty() { Some("") } else { before.strip_suffix('_') }
    })?;
    let parts: Vec<&str> = [space, prefix, own].into_iter().filter(|part| !part.is_empty()).collect();
    Some(or_root(&parts.join("/")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vehicles_are_named_by_namespaces_and_frames() {
        for (space, frame, expected) in [
            ("", "base_link", Some("/")),
            ("", "robot1/base_link", Some("robot1")),
            ("", "robot1_base_footprint", Some("robot1")),
            ("fleet/robot1", "base_link", Some("fleet/robot1")),
            ("", "robot1/laser", None),
            ("", "database_link", None),
        ] {
            assert_eq!(vehicle(space, frame).as_deref(), expected, "{space} {frame}");
        }
        assert_eq!((namespace("/a/b/odom"), namespace("/tf"), namespace("tf")), ("a/b", "", ""));
        assert_eq!((map_name("a", "odom"), map_name("a", "/map")), ("a/odom".into(), "map".into()));
    }

    #[test]
    fn topics_are_chosen_by_whole_levels() {
        assert!(is_chosen("/a/odom", "odom") && is_chosen("/a/odom", "/a/odom") && is_chosen("/odom", "odom"));
        assert!(!is_chosen("/a/wheel_odom", "odom") && !is_chosen("/odom", "a/odom"));
    }
}
