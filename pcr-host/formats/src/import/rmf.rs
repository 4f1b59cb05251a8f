//! Buildings of Open-RMF (`*.building.yaml`), navigation graphs (`nav_graphs/*.yaml`) and the configuration of a fleet.
//!
//! Vertices of a building are pixels of a floor plan, y down (`levels` tells where they are in metres), or longitudes and latitudes
//! (`projection`). Vertices of a
//! navigation graph, which the building tools generate
//! and fleet adapters load, are in metres, y up, and each lane leads in one direction. A lane is straight; the vehicle
//! stops and turns where two lanes meet at an angle. Lanes and vertices have no names of their own; they are named by
//! their level and their index in its list, from 0, as in `L1/12`.

use super::json_access::JsonObject;
use super::keys::Keys;
use super::layout::{ElementId, Layout, LayoutEdge, LayoutNode};
use super::levels::{self, EndsError, LevelTransform, ReferenceLevel, ends, parameter};
use super::projection::{Projection, ProjectionError};
use super::vehicle::{Facing, FileVehicleTraits};
use super::{ImportError, ImportOptions, WarningCode, Warnings};
use crate::footprint::Footprint;
use crate::json::JsonNode;
use crate::scenario::PlacedSegment;
use crate::yaml::YamlDocument;
use std::collections::{BTreeSet, HashMap};
use std::fmt;

const ROOT: Keys = Keys::new(
    &["levels", "name", "building_name", "coordinate_system", "reference_level_name", "lifts", "rmf_fleet"],
    &["graphs", "crowd_sim", "doors", "parameters", "generate_crs", "version", "params", "utm_grid", "pcr_vehicle"],
)
.not(&["lanes", "vertices", "measurements", "fiducials"]);

const LEVEL: Keys = Keys::new(
    &["vertices", "lanes", "measurements", "fiducials"],
    &[
        "drawing",
        "elevation",
        "flattened_x_offset",
        "flattened_y_offset",
        "x_meters",
        "y_meters",
        "floors",
        "layers",
        "walls",
        "constraints",
        "doors",
        "features",
        "models",
        "human_lanes",
        "edges",
        "roi",
        "ros_maps",
    ],
);

/// Parameters of the lanes of a building.
const LANE: Keys = Keys::new(
    &["bidirectional", "graph_idx", "orientation", "speed_limit"],
    &["demo_mock_floor_name", "demo_mock_lift_name", "mutex", "dock_name"],
);

/// Those of the lanes of a navigation graph.
const GRAPH_LANE: Keys = Keys::new(
    &["is_bidirectional", "graph_idx", "orientation_constraint", "speed_limit"],
    &["demo_mock_floor_name", "demo_mock_lift_name", "mutex", "dock_name"],
);

/// The configuration of a fleet is for many programs.
const FLEET: Keys =
    Keys::new(&["name", "profile", "limits"], &[]).not(&["footprint", "vicinity", "linear", "angular"]).free();
const PROFILE: Keys = Keys::new(&["footprint", "vicinity"], &[]);
const LIMITS: Keys = Keys::new(&["linear", "angular"], &[]);

/// Reads the vehicles from the configuration of a fleet: the footprint is the radius, and the vicinity beyond it is the margin.
/// `texts` has its scalars as they are written: a name may be any of them.
pub(super) fn fleet(
    value: &JsonNode<'_>,
    texts: &JsonNode<'_>,
    warnings: &mut Warnings,
) -> Result<FileVehicleTraits, ImportError> {
    let root = JsonObject::new("fleet", value)?;
    let fleet = root.object("rmf_fleet")?.ok_or_else(|| root.missing("rmf_fleet"))?;
    FLEET.check(&fleet, warnings)?;
    let name = match fleet.get("name") {
        None => None,
        Some(_) => {
            let text = texts.get("rmf_fleet").and_then(|fleet| fleet.get("name")?.as_str());
            Some(text.ok_or_else(|| fleet.field_error("name", "a name is expected"))?.to_owned())
        }
    };
    let mut given = FileVehicleTraits { name, ..FileVehicleTraits::default() };
    if let Some(profile) = fleet.object("profile")? {
        PROFILE.check(&profile, warnings)?;
        given.radius = profile.positive("footprint")?;
        let vicinity = profile.positive("vicinity")?;
        given.margin = given.radius.zip(vicinity).map(|(radius, vicinity)| (vicinity - radius).max(0.0));
    }
    if let Some(limits) = fleet.object("limits")? {
        LIMITS.check(&limits, warnings)?;
        let pair = |field: &str| {
            let number = |value: &JsonNode<'_>| value.as_f64().filter(|x| *x > 0.0 && *x < 1e6);
            match limits.list(field)? {
                [] => Ok((None, None)),
                [speed, acceleration] if number(speed).is_some() && number(acceleration).is_some() => {
                    Ok((number(speed), number(acceleration)))
                }
                _ => Err(limits.field_error(field, "speed and acceleration above 0 are expected")),
            }
        };
        (given.speed, given.acceleration) = pair("linear")?;
        (given.rotation, given.rotation_acceleration) = pair("angular")?;
    }
    Ok(given)
}

/// Whether it is a navigation graph, and not a building: the third element of a vertex has its parameters, and not its height.
pub fn is_navigation_graph(root: &JsonNode<'_>) -> bool {
    let levels = root.get("levels").map_or(&[][..], JsonNode::members);
    let vertices = levels.iter().filter_map(|(_, level)| level.get("vertices")?.as_array());
    root.get("building_name").is_some()
        || vertices.flatten().any(|vertex| vertex.element(2).is_some_and(JsonNode::is_object))
}

/// Reads a building, or a navigation graph.
pub(super) fn read(
    text: &str,
    options: &ImportOptions,
    outline: Option<&Footprint>,
    warnings: &mut Warnings,
) -> Result<Layout, ImportError> {
    let document = YamlDocument::read(text).map_err(ImportError::of_yaml)?;
    let value = document.value().map_err(ImportError::of_yaml)?;
    let root = JsonObject::new("building", &value)?;
    if root.get("rmf_fleet").is_some() {
        return Err(ImportError::new("it is the configuration of a fleet; give it beside a building, with --fleet"));
    }
    ROOT.check(&root, warnings)?;
    let levels = root.object("levels")?.ok_or_else(|| root.missing("levels"))?;
    let graph = is_navigation_graph(&value);
    // YAML does not tell where it ends.
    if !graph && root.get("name").is_none() {
        warnings.add(
            WarningCode::MayBeCut,
            "building",
            "it has no name, which a building has behind its levels: the file may be cut",
        );
    }
    let texts = document.texts().map_err(ImportError::of_yaml)?;
    let text = |field: &str| root.get(field).and_then(|_| texts.get(field)?.as_str());
    let texts_of = |name: &str| texts.get("levels").and_then(|levels| levels.get(name));
    let mut all: Vec<levels::BuildingLevel<'_>> = levels
        .members()
        .map(|(name, value)| levels::BuildingLevel::new(name, value, texts_of(name), graph))
        .collect::<Result<_, _>>()?;
    all.sort_by_key(|level| level.name);
    let frame = match root.text("coordinate_system")? {
        None if graph => RmfFrame::Metres,
        None | Some("reference_image") => {
            // The first one of the file; a level may also be called null.
            let first = levels.members().next().map(|(name, _)| name);
            let null =
                || texts.get("reference_level_name")?.as_str().filter(|name| all.iter().any(|it| it.name == *name));
            let named = text("reference_level_name").or_else(null).or(first);
            RmfFrame::Images(ReferenceLevel::new(&all, named, warnings)?)
        }
        Some("cartesian_meters") => RmfFrame::Metres,
        // The building tools write metres into navigation graphs of such buildings, and no name of a system.
        Some("wgs84") if graph => RmfFrame::Metres,
        Some("wgs84") => RmfFrame::Earth(earth(&root, outline, warnings)?),
        Some(other) => return Err(root.field_error("coordinate_system", format_args!("{other} is not read"))),
    };
    let mut layout = Layout {
        name: text(if graph { "building_name" } else { "name" }).unwrap_or_default().to_owned(),
        ..Layout::default()
    };
    let mut graphs = BTreeSet::new();
    for source in &all {
        let (name, lanes) = (source.name, source.object.list("lanes")?);
        if let Err(error) = LEVEL.check(&source.object, warnings) {
            warnings.lose(error);
        }
        if lanes.is_empty() {
            continue;
        }
        let placing = match &frame {
            RmfFrame::Metres => LevelTransform::METRES,
            RmfFrame::Images(reference) => reference.level_transform(source, warnings)?,
            RmfFrame::Earth(projection) => LevelTransform::Earth(*projection),
        };
        let mut level = RmfLevel { source, graph, placing, outline, nodes: HashMap::new(), layout: &mut layout };
        for (k, lane) in lanes.iter().enumerate() {
            match level.lane(k, lane, options, &mut graphs, warnings) {
                Ok(Some((code, problem))) => warnings.add(code, format_args!("lane {name}/{k}"), problem),
                Ok(None) => {}
                Err(problem) => {
                    warnings.lose(ImportError::in_json(lane.position, format!("lane {name}/{k}: {problem}")));
                }
            }
        }
        layout.levels.push(name.to_owned());
    }
    if layout.edges.is_empty() {
        return Err(ImportError::new(match options.graph {
            Some(graph) => format!("building, levels: there is no lane of graph {graph} in them"),
            None => "building, levels: there is no lane in them".to_owned(),
        }));
    }
    if graphs.len() > 1 && options.graph.is_none() {
        let there = graphs.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        warnings.add(
            WarningCode::SeveralGraphs,
            format_args!("graphs {there}"),
            "the lanes of all of them are taken (--graph N)",
        );
    }
    if layout.levels.len() > 1 && root.object("lifts")?.is_some_and(|lifts| lifts.members().next().is_some()) {
        warnings.add(WarningCode::UnreadField, "lifts", "they are not read; routes stay on their level");
    }
    Ok(layout)
}

/// The coordinates of a file.
enum RmfFrame<'j> {
    /// Metres, y up.
    Metres,
    /// Pixels of floor plans, y down.
    Images(ReferenceLevel<'j>),
    /// Longitudes and latitudes.
    Earth(Projection),
}

/// Why a lane is left out.
#[derive(Clone, Debug, PartialEq)]
enum LaneError {
    /// Its parameters are no object, but this.
    NoObject(String),
    /// Its parameters have a key that is not read here.
    Parameters(ImportError),
    /// A parameter of this name has a value that is not read.
    NotRead(&'static str, String),
    /// Its ends are none.
    Ends(EndsError),
    /// An end is out of range.
    Projection(ProjectionError),
}

impl fmt::Display for LaneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoObject(other) => write!(f, "its parameters {other} are not read"),
            Self::Parameters(error) => f.write_str(error.problem()),
            Self::NotRead(name, value) => write!(f, "{name}: {value} is not read"),
            Self::Ends(error) => error.fmt(f),
            Self::Projection(error) => error.fmt(f),
        }
    }
}

impl From<ImportError> for LaneError {
    fn from(error: ImportError) -> Self {
        Self::Parameters(error)
    }
}

impl From<EndsError> for LaneError {
    fn from(error: EndsError) -> Self {
        Self::Ends(error)
    }
}

impl From<ProjectionError> for LaneError {
    fn from(error: ProjectionError) -> Self {
        Self::Projection(error)
    }
}

/// The projection of a building with longitudes and latitudes: that of its `generate_crs`, as its building tools use it.
fn earth(
    root: &JsonObject<'_>,
    outline: Option<&Footprint>,
    warnings: &mut Warnings,
) -> Result<Projection, ImportError> {
    let parameters = root.object("parameters")?.ok_or_else(|| root.missing("parameters"))?;
    let refused = |problem: &dyn fmt::Display| parameters.field_error("generate_crs", problem);
    let value = parameters.get("generate_crs").ok_or_else(|| parameters.missing("generate_crs"))?;
    let name = value.element(1).unwrap_or(value);
    let name =
        name.as_str().ok_or_else(|| refused(&format_args!("{name} where a name such as EPSG:3414 is expected")))?;
    let projection = Projection::named(name).map_err(|unknown| refused(&unknown))?;
    if projection.is_mirrored() {
        if outline.is_some() {
            let problem = "the building tools exchange easting and northing of this system, so that left and right are exchanged, too; a \
                           contour is refused, give its --radius";
            return Err(refused(&format_args!("{name}: {problem}")));
        }
        let problem = "the building tools take its easting for a northing and its northing for an easting; coordinates here are theirs";
        warnings.add(WarningCode::MirroredAxes, name, problem);
    }
    Ok(projection)
}

struct RmfLevel<'a> {
    source: &'a levels::BuildingLevel<'a>,
    /// Whether the file is a navigation graph.
    graph: bool,
    /// From the coordinates of its vertices to metres.
    placing: LevelTransform,
    /// The outline of the vehicle, if its heading matters.
    outline: Option<&'a Footprint>,
    /// Places of the nodes in the layout, by vertex.
    nodes: HashMap<usize, usize>,
    layout: &'a mut Layout,
}

impl RmfLevel<'_> {
    /// The node of a vertex, which is at this place \[m\].
    fn node(&mut self, vertex: usize, at: [f64; 2]) -> usize {
        *self.nodes.entry(vertex).or_insert_with(|| {
            let name = self.source.vertices.get(vertex).and_then(|vertex| vertex.as_ref()?.1.clone());
            let level = self.layout.levels.len();
            self.layout.nodes.push(LayoutNode {
                id: ElementId::Text(format!("{}/{vertex}", self.source.name)),
                name,
                level,
                point: at,
            });
            let place = self.layout.nodes.len() - 1;
            let list = self.source.object.get("vertices").and_then(JsonNode::as_array);
            let parameters = list.and_then(|list| list.get(vertex)?.element(if self.graph { 2 } else { 4 }));
            if let Some(group) = mutex(parameters) {
                self.layout.zone_called(&group).nodes.push(place);
            }
            place
        })
    }

    /// Adds a lane; returns a warning, or says why it is left out.
    fn lane(
        &mut self,
        k: usize,
        value: &JsonNode<'_>,
        options: &ImportOptions,
        graphs: &mut BTreeSet<u64>,
        warnings: &mut Warnings,
    ) -> Result<Option<(WarningCode, &'static str)>, LaneError> {
        let parameters = value.element(2).filter(|parameters| !parameters.is_null());
        if let Some(odd) = parameters.filter(|parameters| !parameters.is_object()) {
            return Err(LaneError::NoObject(odd.to_string()));
        }
        if let Some(parameters) = parameters {
            // A message of a lane names it anyway.
            let parameters = JsonObject::new("its parameters", parameters)?;
            let mut odd = Warnings::default();
            let keys = if self.graph { GRAPH_LANE } else { LANE };
            keys.check(&parameters, &mut odd)?;
            odd.iter().for_each(|(code, problem, _)| {
                warnings.add(code, format_args!("lane {}/{k}", self.source.name), problem)
            });
        }
        // A parameter that is there and has the wrong type is not left aside.
        fn typed<T>(
            value: Option<&JsonNode<'_>>,
            name: &'static str,
            read: impl Fn(&JsonNode<'_>) -> Option<T>,
        ) -> Result<Option<T>, LaneError> {
            let read = |value| read(value).ok_or_else(|| LaneError::NotRead(name, value.to_string()));
            parameter(value, name).map(read).transpose()
        }
        let graph = typed(parameters, "graph_idx", |value| value.as_u64())?.unwrap_or(0);
        if options.graph.is_some_and(|asked| asked != graph) {
            return Ok(None);
        }
        let both = ends(value, &self.source.vertices)?;
        let at = [self.placing.apply(both[0].1)?, self.placing.apply(both[1].1)?];
        graphs.insert(graph);
        let [from, to] = [0, 1].map(|end| self.node(both[end].0, at[end]));
        let line = PlacedSegment::line(at[0], at[1]);
        let straight = line.shape.length() > 0.0;
        // Fleet adapters take a lane of a navigation graph one way, whatever else it says.
        let two_way =
            typed(parameters, if self.graph { "is_bidirectional" } else { "bidirectional" }, |value| value.as_bool())?;
        let both_ways = two_way.unwrap_or(false);
        let mut facing = [Facing::Ahead; 2];
        if self.outline.is_some() {
            let field = if self.graph { "orientation_constraint" } else { "orientation" };
            // A vehicle that does not turn round faces the other way in the other direction, where the building does not say what it does.
            facing = match typed(parameters, field, |value| value.as_str().map(str::to_owned))?.as_deref() {
                None | Some("") => facing,
                Some("forward") => [Facing::Ahead, Facing::Either],
                Some("backward") => [Facing::Backward, Facing::Either],
                Some(other) => return Err(LaneError::NotRead(field, other.to_owned())),
            };
        }
        // 0 is what the editor writes where there is no limit.
        let not_negative = |value: &JsonNode<'_>| value.as_f64().filter(|speed| *speed >= 0.0);
        let speed = typed(parameters, "speed_limit", not_negative)?.filter(|speed| *speed > 0.0);
        let curve = if straight { vec![line] } else { Vec::new() };
        self.layout.edges.push(LayoutEdge {
            ways: [true, both_ways && !self.graph],
            facing,
            speed: [speed.filter(|speed| *speed < 1e6); 2],
            ..LayoutEdge::new(ElementId::Text(format!("{}/{k}", self.source.name)), [from, to], curve)
        });
        if let Some(group) = mutex(parameters) {
            let edge = self.layout.edges.len() - 1;
            self.layout.zone_called(&group).edges.push(edge);
        }
        Ok(match () {
            () if !straight => Some((WarningCode::ZeroLength, "its length is 0")),
            () if both_ways && self.graph => {
                Some((WarningCode::OneWay, "it is taken one way, as fleet adapters do with navigation graphs"))
            }
            () => None,
        })
    }
}

/// The mutex group of a vertex or lane with these parameters. Adapters accept any scalar as its name; without a text there is no group.
fn mutex(parameters: Option<&JsonNode<'_>>) -> Option<String> {
    let value = parameter(parameters, "mutex").filter(|value| !value.is_null())?;
    let name = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    Some(name).filter(|name| !name.is_empty())
}
