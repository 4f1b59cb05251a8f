//! The keys of orders and states in versions 2.0, 2.1 and 3.0, and those of 1.x that are still written.

use super::super::keys::Keys;

pub(super) const ORDER: Keys = Keys::new(
    &["version", "manufacturer", "serialNumber", "orderId", "orderUpdateId", "nodes", "edges"],
    &["headerId", "timestamp", "zoneSetId", "orderDescription"],
)
.not(&["trajectory", "corridor", "nodePosition", "plannedPath", "intermediatePath"]);

pub(super) const NODE: Keys =
    Keys::new(&["nodeId", "sequenceId", "released", "nodePosition"], &["nodeDescription", "nodeDescriptor", "actions"])
        .not(&["x", "y", "theta", "mapId"]);

pub(super) const NODE_POSITION: Keys = Keys::new(
    &["x", "y", "theta", "mapId", "allowedDeviationXY", "allowedDeviationXy", "allowedDeviationTheta"],
    &["mapDescription"],
);

pub(super) const EDGE: Keys = Keys::new(
    &[
        "edgeId",
        "sequenceId",
        "released",
        "startNodeId",
        "endNodeId",
        "trajectory",
        "corridor",
        "orientation",
        "orientationType",
        "rotationAllowed",
        "reachOrientationBeforeEntering",
        "length",
        "maxSpeed",
        "maximumSpeed",
        "maxRotationSpeed",
        "maximumRotationSpeed",
    ],
    &[
        "edgeDescription",
        "edgeDescriptor",
        "actions",
        "direction",
        "maxHeight",
        "minHeight",
        "maximumMobileRobotHeight",
        "minimumLoadHandlingDeviceHeight",
    ],
)
.not(&["controlPoints", "knotVector", "degree", "leftWidth", "rightWidth"]);

pub(super) const STATE: Keys = Keys::new(
    &[
        "version",
        "manufacturer",
        "serialNumber",
        "timestamp",
        "orderId",
        "orderUpdateId",
        "nodeStates",
        "edgeStates",
        "plannedPath",
        "intermediatePath",
        "mobileRobotPosition",
        "agvPosition",
        "velocity",
        "driving",
        "paused",
        "operatingMode",
        "safetyState",
        "loads",
        "actionStates",
    ],
    &[
        "headerId",
        "zoneSetId",
        "zoneSets",
        "maps",
        "lastNodeId",
        "lastNodeSequenceId",
        "distanceSinceLastNode",
        "newBaseRequest",
        "edgeRequests",
        "zoneRequests",
        "instantActionStates",
        "zoneActionStates",
        "batteryState",
        "powerSupply",
        "errors",
        "information",
    ],
)
.not(&["trajectory", "polyline", "nodes", "edges"]);

pub(super) const EDGE_STATE: Keys =
    Keys::new(&["edgeId", "sequenceId", "released", "trajectory"], &["edgeDescription", "edgeDescriptor"]);

pub(super) const POSITION: Keys = Keys::new(
    &["x", "y", "theta", "mapId", "localized", "positionInitialized", "localizationScore"],
    &["deviationRange", "mapDescription"],
);

pub(super) const PLANNED: Keys =
    Keys::new(&["trajectory", "traversedNodes"], &[]).not(&["controlPoints", "knotVector", "degree"]);

pub(super) const INTERMEDIATE: Keys = Keys::new(&["polyline"], &[]);

pub(super) const TIMED_POINT: Keys = Keys::new(&["x", "y", "eta"], &["theta"]);

pub(super) const VELOCITY: Keys = Keys::new(&["vx", "vy", "omega"], &[]);

pub(super) const SAFETY: Keys = Keys::new(&["activeEmergencyStop", "eStop", "fieldViolation"], &[]);
