//! The versions of LIF: which one a file has, and what its names are.
//!
//! Names of LIF 1 in a file of LIF 2 mean nothing there, and what they say of curves and directions would be lost; so a file with names of
//! another version than it says is refused.

use super::super::json_access::JsonObject;
use super::super::keys::{Keys, nearest};
use super::super::{ImportError, WarningCode, Warnings};
use crate::json::{JsonData, JsonNode};

/// A version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LifVersion {
    /// 0.11 to 1.0.
    First,
    /// 2.0.
    Second,
}

/// Names of the same thing in LIF 1 and in LIF 2.
const RENAMED: [[&str; 2]; 7] = [
    ["vehicleTypeNodeProperties", "mobileRobotTypeNodeProperties"],
    ["vehicleTypeEdgeProperties", "mobileRobotTypeEdgeProperties"],
    ["vehicleTypeId", "mobileRobotTypes"],
    ["vehicleOrientation", "mobileRobotOrientations"],
    ["rotationAllowed", "reachOrientationBeforeEntering"],
    ["maxSpeed", "maximumSpeed"],
    ["maxRotationSpeed", "maximumRotationSpeed"],
];

/// Names of drafts of LIF 2, with what they have become.
const DRAFTED: [[&str; 2]; 2] =
    [["vehicleTypeIds", "mobileRobotTypes"], ["vehicleOrientations", "mobileRobotOrientations"]];

/// Objects whose keys are not those of the format, or say nothing of geometry.
const OTHERS: [&str; 6] =
    ["actions", "requiredActions", "feasibleActions", "forbiddenActionTypes", "stations", "metaInformation"];

/// Keys that belong into properties of nodes and edges.
const PROPERTIES: &[&str] = &[
    "trajectory",
    "corridor",
    "orientationType",
    "vehicleOrientation",
    "mobileRobotOrientations",
    "controlPoints",
    "knotVector",
    "theta",
];

const FIRST_ROOT: Keys = Keys::new(&["layouts"], &["metaInformation"]);
const SECOND_ROOT: Keys = Keys::new(&["origins", "layouts"], &["metaInformation"]);
const META: Keys = Keys::new(&["lifVersion"], &["projectIdentification", "lifId", "creator", "exportTimestamp"]);

pub(super) const ORIGIN: Keys = Keys::new(&["originId", "layouts"], &["originDescriptor", "originDescription"]);

pub(super) const LAYOUT: Keys = Keys::new(
    &["layoutId", "layoutLevelId", "nodes", "edges"],
    &["layoutName", "layoutVersion", "layoutDescription", "layoutDescriptor", "stations"],
);

pub(super) const POSITION: Keys = Keys::new(&["x", "y"], &[]).not(&["theta"]);

pub(super) const LINE: Keys = Keys::new(&["length"], &["direction"]);

pub(super) const ROBOT_TYPE: Keys = Keys::new(&["manufacturer", "seriesName"], &[]);

const FIRST_NODE: Keys = Keys::new(
    &["nodeId", "mapId", "nodePosition", "vehicleTypeNodeProperties"],
    &["nodeName", "nodeDescription", "nodeDescriptor"],
)
.not(&["theta", "x", "y"]);

const SECOND_NODE: Keys = Keys::new(
    &["nodeId", "mapId", "nodePosition", "mobileRobotTypeNodeProperties"],
    &["nodeName", "nodeDescription", "nodeDescriptor"],
)
.not(&["theta", "x", "y"]);

const FIRST_NODE_PROPERTY: Keys = Keys::new(&["vehicleTypeId", "theta"], &["actions"]);

const SECOND_NODE_PROPERTY: Keys = Keys::new(
    &["mobileRobotTypes", "theta", "allowedDeviationXY"],
    &["actions", "loadRestriction", "requiredActions", "feasibleActions", "forbiddenActionTypes"],
);

const FIRST_EDGE: Keys = Keys::new(
    &["edgeId", "startNodeId", "endNodeId", "vehicleTypeEdgeProperties"],
    &["edgeName", "edgeDescription", "edgeDescriptor"],
)
.not(PROPERTIES);

const SECOND_EDGE: Keys = Keys::new(
    &["edgeId", "startNodeId", "endNodeId", "mobileRobotTypeEdgeProperties"],
    &["edgeName", "edgeDescription", "edgeDescriptor"],
)
.not(PROPERTIES);

const FIRST_EDGE_PROPERTY: Keys = Keys::new(
    &[
        "vehicleTypeId",
        "vehicleOrientation",
        "orientationType",
        "rotationAllowed",
        "rotationAtStartNodeAllowed",
        "rotationAtEndNodeAllowed",
        "maxSpeed",
        "maxRotationSpeed",
        "trajectory",
        "corridor",
    ],
    &["minHeight", "maxHeight", "loadRestriction", "actions", "reentryAllowed"],
)
.not(&["controlPoints", "knotVector", "degree"]);

const SECOND_EDGE_PROPERTY: Keys = Keys::new(
    &[
        "mobileRobotTypes",
        "mobileRobotOrientations",
        "orientationType",
        "reachOrientationBeforeEntering",
        "rotationAtStartNodeAllowed",
        "rotationAtEndNodeAllowed",
        "maximumSpeed",
        "maximumRotationSpeed",
        "trajectory",
        "corridor",
        "physicalLineGuidedProperty",
    ],
    &[
        "minimumLoadHandlingDeviceHeight",
        "maximumMobileRobotHeight",
        "loadRestriction",
        "actions",
        "requiredActions",
        "feasibleActions",
        "forbiddenActionTypes",
        "reentryAllowed",
    ],
)
.not(&["controlPoints", "knotVector", "degree", "length"]);

/// The names of a version.
#[derive(Debug)]
pub(super) struct VersionNames {
    pub(super) node_properties: &'static str,
    pub(super) edge_properties: &'static str,
    pub(super) speed: &'static str,
    pub(super) rotation_speed: &'static str,
    pub(super) node: Keys,
    pub(super) node_property: Keys,
    pub(super) edge: Keys,
    pub(super) edge_property: Keys,
}

const FIRST: VersionNames = VersionNames {
    node_properties: "vehicleTypeNodeProperties",
    edge_properties: "vehicleTypeEdgeProperties",
    speed: "maxSpeed",
    rotation_speed: "maxRotationSpeed",
    node: FIRST_NODE,
    node_property: FIRST_NODE_PROPERTY,
    edge: FIRST_EDGE,
    edge_property: FIRST_EDGE_PROPERTY,
};

const SECOND: VersionNames = VersionNames {
    node_properties: "mobileRobotTypeNodeProperties",
    edge_properties: "mobileRobotTypeEdgeProperties",
    speed: "maximumSpeed",
    rotation_speed: "maximumRotationSpeed",
    node: SECOND_NODE,
    node_property: SECOND_NODE_PROPERTY,
    edge: SECOND_EDGE,
    edge_property: SECOND_EDGE_PROPERTY,
};

impl LifVersion {
    /// The version of a file: the one that it says, or else the one whose names it has.
    ///
    /// # Errors
    /// [`ImportError`] for a version that is not known, and for names of another version than the file says, or of both.
    pub(super) fn of(
        root: &JsonObject<'_>,
        value: &JsonNode<'_>,
        warnings: &mut Warnings,
    ) -> Result<Self, ImportError> {
        let meta = root.object("metaInformation")?;
        let said = meta.as_ref().map_or(Ok(None), |meta| meta.text("lifVersion"))?;
        if let Some(meta) = &meta {
            META.check(meta, warnings)?;
        }
        let parts = |said: &str| -> Option<Vec<u64>> { said.trim().split('.').map(|part| part.parse().ok()).collect() };
        let number = said.map(|said| parts(said).unwrap_or_default());
        let version = match number.as_deref() {
            None => None,
            Some([0 | 1, ..]) => Some(Self::First),
            Some([2, ..]) => Some(Self::Second),
            Some(_) => {
                let problem = "is not known; versions 0.11 to 2.0 are read";
                let problem = format!("LIF, lifVersion: {} {problem}", said.unwrap_or_default());
                let position =
                    meta.as_ref().and_then(|meta| meta.get("lifVersion")).map_or(value.position, |it| it.position);
                return Err(ImportError::in_json(position, problem));
            }
        };
        if let (Some(said), Some([major @ (1 | 2), 1..=u64::MAX, ..])) = (said, number.as_deref()) {
            warnings.add(
                WarningCode::UnknownVersion,
                "LIF",
                format!("its lifVersion {said} is not known; it is read as {major}.0.0"),
            );
        }
        let mut found = VersionEvidence::default();
        found.search(value);
        let VersionEvidence { first, second } = found;
        let version = match (version, first, second) {
            (Some(Self::Second), Some([name, meant]), _) => return Err(contradiction(said, &name, "1", &meant)),
            (Some(Self::First), _, Some([name, meant])) => return Err(contradiction(said, &name, "2", &meant)),
            (Some(version), ..) => version,
            (None, Some([name, _]), Some([other, _])) => {
                let problem = format!("{name} is a name of LIF 1, and {other} is one of LIF 2");
                return Err(ImportError::new(format!("LIF, lifVersion: missing; {problem}")));
            }
            (None, first, second) => {
                let version = if second.is_some() { Self::Second } else { Self::First };
                let by = if first.is_some() || second.is_some() { "by its names" } else { "as nothing tells" };
                let number = if version == Self::First { "1.0.0" } else { "2.0.0" };
                warnings.add(
                    WarningCode::UnknownVersion,
                    "LIF",
                    format!("it does not say its lifVersion; {by} it is read as {number}"),
                );
                version
            }
        };
        match version {
            Self::First => FIRST_ROOT.check(root, warnings)?,
            Self::Second => SECOND_ROOT.check(root, warnings)?,
        }
        Ok(version)
    }

    /// Its names.
    pub(super) fn names(self) -> &'static VersionNames {
        match self {
            Self::First => &FIRST,
            Self::Second => &SECOND,
        }
    }
}

fn contradiction(said: Option<&str>, name: &str, of: &str, meant: &str) -> ImportError {
    let said = said.unwrap_or_default();
    let problem = format!("{name} is a name of LIF {of}, where this version has {meant}");
    ImportError::new(format!("LIF, lifVersion: the file says {said}, but {problem}"))
}

/// The first names in a file that only one of the versions has, with what the other version has instead.
#[derive(Default)]
struct VersionEvidence {
    first: Option<[String; 2]>,
    second: Option<[String; 2]>,
}

impl VersionEvidence {
    fn search(&mut self, value: &JsonNode<'_>) {
        match &value.data {
            JsonData::Array(elements) => elements.iter().for_each(|element| self.search(element)),
            JsonData::Object(members) => {
                for (key, value) in members.iter().filter(|(_, value)| !value.is_null()) {
                    self.name(key);
                    if !OTHERS.contains(&&**key) {
                        self.search(value);
                    }
                }
            }
            _ => {}
        }
    }

    fn name(&mut self, key: &str) {
        if key == "origins" {
            self.second.get_or_insert_with(|| [key.to_owned(), "layouts".to_owned()]);
        }
        for [first, second] in RENAMED {
            if key == first {
                self.first.get_or_insert_with(|| [key, second].map(str::to_owned));
            }
            if key == second {
                self.second.get_or_insert_with(|| [key, first].map(str::to_owned));
            }
        }
        for [draft, meant] in DRAFTED {
            if key == draft {
                self.first.get_or_insert_with(|| [key, meant].map(str::to_owned));
            }
        }
        // One with an error in it is a name of its version, too.
        let all = || RENAMED.iter().chain(&DRAFTED).flatten();
        if all().any(|known| *known == key) {
            return;
        }
        let Some(meant) = nearest(key, all().copied()) else { return };
        for [first, second] in RENAMED {
            for (name, other, found) in [(first, second, &mut self.first), (second, first, &mut self.second)] {
                if meant == name {
                    found.get_or_insert_with(|| [format!("{key} (for {name})"), other.to_owned()]);
                }
            }
        }
    }
}
