//! Messages of ROS 2 that are read and written: fields in the order of the published `.msg` files, which is that of their bytes.

use ros2_client::Message;
use serde::{Deserialize, Serialize};

/// Nanoseconds of a second.
const SECOND: i64 = 1_000_000_000;

/// `builtin_interfaces/msg/Time`: since 1970.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Time {
    /// Seconds.
    pub sec: i32,
    /// Nanoseconds, below 1e9.
    pub nanosec: u32,
}

impl Time {
    /// In nanoseconds since 1970.
    pub fn nanoseconds(self) -> i64 {
        i64::from(self.sec) * SECOND + i64::from(self.nanosec)
    }

    /// Seconds since another time.
    pub fn since(self, origin: Self) -> f64 {
        (self.nanoseconds() - origin.nanoseconds()) as f64 / SECOND as f64
    }

    /// This time and some seconds, rounded to a nanosecond. `None` where the message has no number for it, as after January 2038.
    pub fn later(self, seconds: f64) -> Option<Self> {
        let by = (seconds * SECOND as f64).round();
        // Beyond that the message cannot tell it either; the conversion would round silently.
        if by.is_nan() || by.abs() > 9e18 {
            return None;
        }
        let at = self.nanoseconds().checked_add(by as i64)?;
        let sec = i32::try_from(at.div_euclid(SECOND)).ok()?;
        Some(Self { sec, nanosec: at.rem_euclid(SECOND) as u32 })
    }
}

/// `builtin_interfaces/msg/Duration`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Duration {
    /// Seconds.
    pub sec: i32,
    /// Nanoseconds, below 1e9.
    pub nanosec: u32,
}

/// `std_msgs/msg/Header`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// When.
    pub stamp: Time,
    /// The frame of the coordinates.
    pub frame_id: String,
}

/// `geometry_msgs/msg/Point` \[m\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct Position {
    pub x: f64,
    pub y: f64,
    pub z: f64,
}

/// `geometry_msgs/msg/Quaternion`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct Quaternion {
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub w: f64,
}

impl Quaternion {
    /// A heading, counter-clockwise from the `x` axis \[rad\].
    pub fn heading(yaw: f64) -> Self {
        Self { x: 0.0, y: 0.0, z: (yaw / 2.0).sin(), w: (yaw / 2.0).cos() }
    }
}

impl Default for Quaternion {
    fn default() -> Self {
        Self { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }
    }
}

/// `geometry_msgs/msg/Pose`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct SpatialPose {
    pub position: Position,
    pub orientation: Quaternion,
}

/// `geometry_msgs/msg/PoseStamped`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PoseStamped {
    /// When it is reached, and its frame.
    pub header: Header,
    /// The pose.
    pub pose: SpatialPose,
}

/// `nav_msgs/msg/Path`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PathMessage {
    /// When it was published, and its frame.
    pub header: Header,
    /// The poses.
    pub poses: Vec<PoseStamped>,
}

/// `std_msgs/msg/ColorRGBA`, from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct Colour {
    pub r: f32,
    pub g: f32,
    pub b: f32,
    pub a: f32,
}

/// `sensor_msgs/msg/CompressedImage`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct CompressedImage {
    pub header: Header,
    pub format: String,
    pub data: Vec<u8>,
}

/// `visualization_msgs/msg/UVCoordinate`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct TextureCoordinate {
    pub u: f32,
    pub v: f32,
}

/// `visualization_msgs/msg/MeshFile`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct MeshFile {
    pub filename: String,
    pub data: Vec<u8>,
}

/// `visualization_msgs/msg/Marker`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct Marker {
    pub header: Header,
    pub ns: String,
    pub id: i32,
    /// [`Marker::LINE_STRIP`], or another shape.
    pub kind: i32,
    /// [`Marker::ADD`] or [`Marker::DELETE_ALL`].
    pub action: i32,
    pub pose: SpatialPose,
    /// `geometry_msgs/msg/Vector3`; of a strip of lines `x` is the width \[m\].
    pub scale: Position,
    pub color: Colour,
    /// 0: until it is deleted.
    pub lifetime: Duration,
    pub frame_locked: bool,
    pub points: Vec<Position>,
    pub colors: Vec<Colour>,
    pub texture_resource: String,
    pub texture: CompressedImage,
    pub uv_coordinates: Vec<TextureCoordinate>,
    pub text: String,
    pub mesh_resource: String,
    pub mesh_file: MeshFile,
    pub mesh_use_embedded_materials: bool,
}

impl Marker {
    /// Points that are joined by lines.
    pub const LINE_STRIP: i32 = 4;
    /// Adds a marker or exchanges that of the same namespace and number.
    pub const ADD: i32 = 0;
    /// Deletes all markers of the topic.
    pub const DELETE_ALL: i32 = 3;
}

/// `visualization_msgs/msg/MarkerArray`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MarkerArray {
    /// The markers.
    pub markers: Vec<Marker>,
}

/// `rmf_fleet_msgs/msg/Location`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct FleetLocation {
    pub t: Time,
    pub x: f32,
    pub y: f32,
    pub yaw: f32,
    pub obey_approach_speed_limit: bool,
    pub approach_speed_limit: f32,
    pub level_name: String,
    pub index: u64,
}

/// `rmf_fleet_msgs/msg/RobotMode`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct FleetRobotMode {
    pub mode: u32,
    pub mode_request_id: u64,
    pub performing_action: String,
}

/// `rmf_fleet_msgs/msg/RobotState`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct FleetRobotState {
    pub name: String,
    pub model: String,
    pub task_id: String,
    pub seq: u64,
    pub mode: FleetRobotMode,
    pub battery_percent: f32,
    /// Where it is, and when.
    pub location: FleetLocation,
    /// Where it will be.
    pub path: Vec<FleetLocation>,
}

/// `rmf_fleet_msgs/msg/FleetState`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct FleetState {
    pub name: String,
    pub robots: Vec<FleetRobotState>,
}

/// `nav2_msgs/msg/EdgeCost`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct EdgeCost {
    pub edgeid: u16,
    pub cost: f32,
}

/// The request of `nav2_msgs/srv/DynamicEdges`. What is in both lists is open afterwards.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct DynamicEdgesRequest {
    pub closed_edges: Vec<u16>,
    pub opened_edges: Vec<u16>,
    pub adjust_edges: Vec<EdgeCost>,
}

/// The response of `nav2_msgs/srv/DynamicEdges`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct DynamicEdgesResponse {
    pub success: bool,
}

impl Message for DynamicEdgesRequest {}

impl Message for DynamicEdgesResponse {}

/// `rosgraph_msgs/msg/Clock`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Clock {
    /// The simulated time.
    pub clock: Time,
}
