//! What the node is told about the robots.

use pcr_rmf_mapf::Footprint;
use serde::Deserialize;
use std::collections::HashSet;
use std::fmt;
use std::path::PathBuf;

/// The configuration of the node.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// The frame of all paths.
    pub frame: String,
    /// How long a path is used after it was published \[s\].
    pub max_age: f64,
    /// The topic of the states of Open-RMF's fleets, `rmf_fleet_msgs/FleetState`, if a robot is in one.
    pub fleet_states: Option<String>,
    /// Whether the time is that of `/clock`, `rosgraph_msgs/Clock`, and not that of the system.
    #[serde(default)]
    pub use_sim_time: bool,
    /// The route graph on which nav2 plans the routes of robots, if a robot is told which edges are closed.
    pub route_graph: Option<RouteGraphConfig>,
    /// The robots. Where two of them enter the same place at the same time, the one that is named first goes first.
    pub robots: Vec<RobotConfig>,
}

/// A route graph, and who closes its edges.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RouteGraphConfig {
    /// Its file, GeoJSON; from the folder of the configuration.
    pub file: PathBuf,
    /// How long a robot stands before the edges that it is in the way of are closed \[s\].
    pub stands: f64,
}

/// A robot.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotConfig {
    /// Its name.
    pub name: String,
    /// The topic of its paths, `nav_msgs/Path`.
    pub path: Option<String>,
    /// Or its fleet of Open-RMF; its name is that which it has there.
    pub fleet: Option<String>,
    /// The level of a robot in such a fleet: that of the frame.
    pub level: Option<String>,
    /// The service of its route server that closes edges, `nav2_msgs/DynamicEdges`.
    pub route_server: Option<String>,
    /// How fast it drives, if its planner gives no times: those of its messages are not used then.
    pub pace: Option<Pace>,
    /// Radius of a disc around its position \[m\].
    pub radius: Option<f64>,
    /// Or the corners of a convex polygon in its frame, `x` forward and `y` to the left, counter-clockwise \[m\].
    pub outline: Option<Vec<[f64; 2]>>,
    /// Margin around either \[m\]: how far the robot may be from its path, and half of what should be clear between two of them.
    pub margin: f64,
}

/// How fast a robot drives whose planner gives no times.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pace {
    /// Speed \[m/s\].
    pub speed: f64,
    /// Rate of turn \[rad/s\].
    pub turn: f64,
}

/// Why a configuration is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ConfigError {
    /// It is not JSON of this form.
    Syntax(String),
    /// A number is not finite, or negative.
    Number {
        /// Where.
        of: String,
        /// Its key.
        key: &'static str,
    },
    /// There are not two robots.
    Robots,
    /// Something is empty.
    Empty {
        /// Where.
        of: String,
        /// Its key.
        key: &'static str,
    },
    /// Two robots have the same name or the same topic.
    Repeated(String),
    /// A robot has neither a path nor a fleet, or both; or a fleet, but no level, or a pace; or there is no topic of fleet states.
    Source {
        /// The robot.
        robot: String,
    },
    /// A robot has a route server, but there is no route graph, or the other way round.
    RouteGraph,
    /// A robot has neither a radius nor an outline, or both.
    Footprint {
        /// The robot.
        robot: String,
    },
    /// The corners of a robot are not those of a convex polygon, or are out of range.
    Outline {
        /// The robot.
        robot: String,
        /// Why it is not an outline.
        problem: pcr_core::InvalidInput,
    },
}

impl Config {
    /// Reads a configuration, as JSON.
    ///
    /// # Errors
    /// [`ConfigError`].
    pub fn from_json(text: &str) -> Result<Self, ConfigError> {
        let config: Self = serde_json::from_str(text).map_err(|error| ConfigError::Syntax(error.to_string()))?;
        config.check()?;
        Ok(config)
    }

    fn check(&self) -> Result<(), ConfigError> {
        if !(self.max_age.is_finite() && self.max_age > 0.0) {
            return Err(ConfigError::Number { of: "the configuration".to_owned(), key: "max_age" });
        }
        if self.frame.is_empty() {
            return Err(ConfigError::Empty { of: "the configuration".to_owned(), key: "frame" });
        }
        if self.robots.len() < 2 {
            return Err(ConfigError::Robots);
        }
        if self.fleet_states.as_deref() == Some("") {
            return Err(ConfigError::Empty { of: "the configuration".to_owned(), key: "fleet_states" });
        }
        if self.route_graph.is_some() != self.robots.iter().any(|robot| robot.route_server.is_some()) {
            return Err(ConfigError::RouteGraph);
        }
        if self.route_graph.as_ref().is_some_and(|graph| !(graph.stands.is_finite() && graph.stands >= 0.0)) {
            return Err(ConfigError::Number { of: "\"route_graph\"".to_owned(), key: "stands" });
        }
        let mut taken = HashSet::new();
        for robot in &self.robots {
            let of = || format!("robot \"{}\"", robot.name);
            let server = ("route_server", robot.route_server.as_ref());
            let texts =
                [("name", Some(&robot.name)), ("path", robot.path.as_ref()), ("fleet", robot.fleet.as_ref()), server];
            for (key, text) in texts.into_iter().filter_map(|(key, text)| Some((key, text?))) {
                if text.is_empty() {
                    return Err(ConfigError::Empty { of: of(), key });
                }
                if key != "fleet" && !taken.insert((key, text)) {
                    return Err(ConfigError::Repeated(text.clone()));
                }
            }
            robot.check_source(self.fleet_states.is_some())?;
            for (key, number) in [("radius", robot.radius.unwrap_or(0.0)), ("margin", robot.margin)] {
                if !(number.is_finite() && number >= 0.0) {
                    return Err(ConfigError::Number { of: of(), key });
                }
            }
            robot.check_outline()?;
        }
        Ok(())
    }
}

impl RobotConfig {
    fn check_source(&self, has_states: bool) -> Result<(), ConfigError> {
        let is_told = match (&self.path, &self.fleet) {
            (Some(_), None) => self.level.is_none(),
            (None, Some(_)) => self.level.is_some() && self.pace.is_none() && has_states,
            _ => false,
        };
        if !is_told {
            return Err(ConfigError::Source { robot: self.name.clone() });
        }
        let paces = self.pace.iter().flat_map(|pace| [("speed", pace.speed), ("turn", pace.turn)]);
        for (key, number) in paces {
            if !(number.is_finite() && number > 0.0) {
                return Err(ConfigError::Number { of: format!("robot \"{}\"", self.name), key });
            }
        }
        Ok(())
    }

    fn check_outline(&self) -> Result<(), ConfigError> {
        let robot = || self.name.clone();
        if self.radius.is_some() == self.outline.is_some() {
            return Err(ConfigError::Footprint { robot: robot() });
        }
        if let Some(corners) = &self.outline {
            let corners = corners.iter().map(|&[x, y]| pcr_core::Vector { x, y });
            let made = pcr_core::Outline::<f64, 16>::polygon(corners, self.margin);
            made.map_err(|problem| ConfigError::Outline { robot: robot(), problem })?;
        }
        Ok(())
    }

    /// What the robot occupies, without the margin. Without a radius and an outline, as no configuration is that was read, it is a disc whose motion
    /// is refused.
    pub(crate) fn footprint(&self) -> Footprint {
        match &self.outline {
            Some(corners) => Footprint::Polygon { corners: corners.clone() },
            None => Footprint::Disc { radius: self.radius.unwrap_or(f64::NAN) },
        }
    }
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Syntax(problem) => f.write_str(problem),
            Self::Number { of, key } => write!(f, "{of}: \"{key}\" is not a number in range"),
            Self::Robots => f.write_str("there are not two robots"),
            Self::Empty { of, key } => write!(f, "{of}: \"{key}\" is empty"),
            Self::Repeated(text) => write!(f, "two robots have \"{text}\""),
            Self::Source { robot } => write!(
                f,
                "robot \"{robot}\" needs either \"path\", or \"fleet\" and \"level\" (without \"pace\"), and then \"fleet_states\" beside the robots"
            ),
            Self::RouteGraph => f.write_str("\"route_graph\" and a robot with a \"route_server\" need one another"),
            Self::Footprint { robot } => write!(f, "robot \"{robot}\" needs either \"radius\" or \"outline\""),
            Self::Outline { robot, problem } => write!(f, "robot \"{robot}\": its outline is not valid: {problem}"),
        }
    }
}

impl std::error::Error for ConfigError {}
