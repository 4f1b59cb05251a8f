//! Buildings of Open-RMF (`*.building.yaml`), navigation graphs (`nav_graphs/*.yaml`) and the configuration of a fleet.
//!
//! Vertices of a building are pixels of a floor plan, y down (`levels` tells where they are in metres). Vertices of a
//! navigation graph, which the building tools generate
//! and fleet adapters load, are in metres, y up, and each lane leads in one direction. A lane is straight; the vehicle
//! stops and turns where two lanes meet at an angle. Lanes and vertices have no names of their own; they are named by
//! their level and their index in its list, from 0, as in `L1/12`.

use super::keys::Keys;
use super::layout::{Edge, Id, Layout, Node};
use super::levels::{Placing, Reference, Vertex, ends, parameter, vertices};
use super::value::Object;
use super::vehicle::{Facing, Given};
use super::{ImportError, Options, WarningCode, Warnings};
use crate::footprint::Footprint;
use crate::scenario::Placed;
use crate::yaml::Document;
use serde_json::Value;
use std::collections::{BTreeSet, HashMap};

const ROOT: Keys = Keys::new(
    &["levels", "name", "building_name", "coordinate_system", "reference_level_name", "lifts", "rmf_fleet"],
    &["graphs", "crowd_sim", "doors", "parameters", "generate_crs", "version", "params", "utm_grid"],
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
pub(super) fn fleet(value: &Value, warnings: &mut Warnings) -> Result<Given, ImportError> {
    let root = Object::new("fleet", value)?;
    let fleet = root.object("rmf_fleet")?.ok_or_else(|| root.missing("rmf_fleet"))?;
    FLEET.check(&fleet, warnings)?;
    let mut given = Given { name: fleet.label("name")?, ..Given::default() };
    if let Some(profile) = fleet.object("profile")? {
        PROFILE.check(&profile, warnings)?;
        given.radius = profile.positive("footprint")?;
        let vicinity = profile.positive("vicinity")?;
        given.margin = given.radius.zip(vicinity).map(|(radius, vicinity)| (vicinity - radius).max(0.0));
    }
    if let Some(limits) = fleet.object("limits")? {
        LIMITS.check(&limits, warnings)?;
        let pair = |field: &str| {
            let number = |value: &Value| value.as_f64().filter(|x| *x > 0.0 && *x < 1e6);
            match limits.list(field)? {
                [] => Ok((None, None)),
                [speed, acceleration] if number(speed).is_some() && number(acceleration).is_some() => {
                    Ok((number(speed), number(acceleration)))
                }
                _ => Err(ImportError::new(format!(
                    "{}, {field}: speed and acceleration above 0 are expected",
                    limits.name
                ))),
            }
        };
        (given.speed, given.acceleration) = pair("linear")?;
        (given.rotation, given.rotation_acceleration) = pair("angular")?;
    }
    Ok(given)
}

/// Whether it is a navigation graph, and not a building: the third element of a vertex has its parameters, and not its height.
pub fn is_navigation_graph(root: &Value) -> bool {
    let levels = root.get("levels").and_then(Value::as_object);
    let vertices =
        levels.into_iter().flat_map(|levels| levels.values()).filter_map(|level| level.get("vertices")?.as_array());
    root.get("building_name").is_some() || vertices.flatten().any(|vertex| vertex.get(2).is_some_and(Value::is_object))
}

/// Reads a building, or a navigation graph.
pub(super) fn read(
    text: &str,
    options: &Options,
    outline: Option<&Footprint>,
    warnings: &mut Warnings,
) -> Result<Layout, ImportError> {
    let document = Document::read(text).map_err(ImportError::of_yaml)?;
    let value = document.value().map_err(ImportError::of_yaml)?;
    let root = Object::new("building", &value)?;
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
    let reference = match root.text("coordinate_system")? {
        None if graph => None,
        None | Some("reference_image") => Some(Reference::of(&document, &root, &levels, warnings)?),
        Some("cartesian_meters") => None,
        Some(other) => return Err(ImportError::new(format!("building, coordinate_system: {other} is not read"))),
    };
    let mut layout = Layout {
        name: root.label(if graph { "building_name" } else { "name" })?.unwrap_or_default(),
        ..Layout::default()
    };
    let mut graphs = BTreeSet::new();
    for (name, value) in levels.members() {
        let object = Object::new(format!("level {name}"), value)?;
        if let Err(error) = LEVEL.check(&object, warnings) {
            warnings.lose(error);
        }
        let vertices = vertices(&object, graph)?;
        if object.list("lanes")?.is_empty() {
            continue;
        }
        let placing = reference.as_ref().map(|reference| reference.place(name, &object, &vertices, warnings));
        let placing = placing.transpose()?.unwrap_or(Placing::METRES);
        let mut level = Level { name, graph, placing, vertices, outline, nodes: HashMap::new(), layout: &mut layout };
        for (k, lane) in object.list("lanes")?.iter().enumerate() {
            match level.lane(k, lane, options, &mut graphs, warnings) {
                Ok(Some((code, problem))) => warnings.add(code, format_args!("lane {name}/{k}"), problem),
                Ok(None) => {}
                Err(problem) => warnings.lose(format_args!("lane {name}/{k}: {problem}")),
            }
        }
        layout.levels.push(name.clone());
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

struct Level<'a> {
    name: &'a str,
    /// Whether the file is a navigation graph.
    graph: bool,
    /// From the coordinates of its vertices to metres.
    placing: Placing,
    vertices: Vec<Vertex>,
    /// The outline of the vehicle, if its heading matters.
    outline: Option<&'a Footprint>,
    /// Places of the nodes in the layout, by vertex.
    nodes: HashMap<usize, usize>,
    layout: &'a mut Layout,
}

impl Level<'_> {
    fn node(&mut self, vertex: usize, pixels: [f64; 2]) -> (usize, [f64; 2]) {
        let at = self.placing.apply(pixels);
        let place = *self.nodes.entry(vertex).or_insert_with(|| {
            let name = self.vertices.get(vertex).and_then(|vertex| vertex.as_ref()?.1.clone());
            let level = self.layout.levels.len();
            self.layout.nodes.push(Node { id: Id::Text(format!("{}/{vertex}", self.name)), name, level, at });
            self.layout.nodes.len() - 1
        });
        (place, at)
    }

    /// Adds a lane; returns a warning, or says why it is left out.
    fn lane(
        &mut self,
        k: usize,
        value: &Value,
        options: &Options,
        graphs: &mut BTreeSet<u64>,
        warnings: &mut Warnings,
    ) -> Result<Option<(WarningCode, &'static str)>, String> {
        let parameters = value.get(2).filter(|parameters| !parameters.is_null());
        if let Some(odd) = parameters.filter(|parameters| !parameters.is_object()) {
            return Err(format!("its parameters {odd} are not read"));
        }
        if let Some(parameters) = parameters {
            // A message of a lane names it anyway.
            let parameters = Object::new("its parameters", parameters).map_err(|error| error.to_string())?;
            let mut odd = Warnings::default();
            let keys = if self.graph { GRAPH_LANE } else { LANE };
            keys.check(&parameters, &mut odd).map_err(|error| error.to_string())?;
            odd.iter()
                .for_each(|(code, problem, _)| warnings.add(code, format_args!("lane {}/{k}", self.name), problem));
        }
        // A parameter that is there and has the wrong type is not left aside.
        fn typed<T>(
            value: Option<&Value>,
            name: &str,
            read: impl Fn(&Value) -> Option<T>,
        ) -> Result<Option<T>, String> {
            let read = |value| read(value).ok_or_else(|| format!("{name}: {value} is not read"));
            parameter(value, name).map(read).transpose()
        }
        let graph = typed(parameters, "graph_idx", Value::as_u64)?.unwrap_or(0);
        if options.graph.is_some_and(|asked| asked != graph) {
            return Ok(None);
        }
        let both = ends(value, &self.vertices)?;
        graphs.insert(graph);
        let [from, to] = both.map(|(vertex, pixels)| self.node(vertex, pixels));
        let line = Placed::line(from.1, to.1);
        let straight = line.shape.length() > 0.0;
        // Fleet adapters take a lane of a navigation graph one way, whatever else it says.
        let two_way = typed(parameters, if self.graph { "is_bidirectional" } else { "bidirectional" }, Value::as_bool)?;
        let both_ways = two_way.unwrap_or(false);
        let mut facing = [Facing::Ahead; 2];
        if self.outline.is_some() {
            let field = if self.graph { "orientation_constraint" } else { "orientation" };
            // A vehicle that does not turn round faces the other way in the other direction, where the building does not say what it does.
            facing = match typed(parameters, field, |value| value.as_str().map(str::to_owned))?.as_deref() {
                None | Some("") => facing,
                Some("forward") => [Facing::Ahead, Facing::Either],
                Some("backward") => [Facing::Backward, Facing::Either],
                Some(other) => return Err(format!("{field}: {other} is not read")),
            };
        }
        // 0 is what the editor writes where there is no limit.
        let not_negative = |value: &Value| value.as_f64().filter(|speed| *speed >= 0.0);
        let speed = typed(parameters, "speed_limit", not_negative)?.filter(|speed| *speed > 0.0);
        let curve = if straight { vec![line] } else { Vec::new() };
        self.layout.edges.push(Edge {
            ways: [true, both_ways && !self.graph],
            facing,
            speed: [speed.filter(|speed| *speed < 1e6); 2],
            ..Edge::new(Id::Text(format!("{}/{k}", self.name)), [from.0, to.0], curve)
        });
        Ok(match () {
            () if !straight => Some((WarningCode::ZeroLength, "its length is 0")),
            () if both_ways && self.graph => {
                Some((WarningCode::OneWay, "it is taken one way, as fleet adapters do with navigation graphs"))
            }
            () => None,
        })
    }
}
