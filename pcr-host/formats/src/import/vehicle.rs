//! The vehicle that travels a layout, and the options of the command line about it and its routes.

use super::{ImportError, InputFormat, WarningCode, Warnings};
use crate::footprint::Footprint;
use crate::plane_geometry::wrapped;
use crate::scenario::REVERSE;
use std::path::PathBuf;

/// Where the size of a vehicle comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SizeSource {
    /// The radius is an option.
    Option,
    /// It is in the configuration of a fleet or in a factsheet.
    Fleet,
    /// It is in the file of the layout.
    File,
    /// Nobody said it.
    #[default]
    Assumed,
}

/// What a vehicle is and can.
#[derive(Clone, Debug, PartialEq)]
pub struct VehicleTraits {
    /// Name or type, where it has one.
    pub name: Option<String>,
    /// Radius of its disc \[m\]; with a footprint that of the disc around all of it.
    pub radius: f64,
    /// Its outline, if it is no disc.
    pub footprint: Option<Footprint>,
    /// Where radius or outline come from.
    pub size: SizeSource,
    /// Margin to be kept around it \[m\].
    pub margin: f64,
    /// \[m/s\]
    pub speed: f64,
    /// \[m/s²\]
    pub acceleration: f64,
    /// \[rad/s\]
    pub rotation: f64,
    /// \[rad/s²\]
    pub rotation_acceleration: f64,
}

/// Which way a vehicle faces where it travels a path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Facing {
    /// Along its path.
    #[default]
    Ahead,
    /// Against its path: it drives backward.
    Backward,
    /// One of both, which of them is not known.
    Either,
    /// At another angle to its path, which is the same all along: it travels sideways.
    Sideways(FacingAngle),
    /// At this angle on the map, along an edge that is curved: it does not turn there.
    Steady(FacingAngle),
    /// Any way.
    Any,
}

/// An angle from the direction of travel to the heading, or from the x-axis of the map. Angles are the same if their numbers are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FacingAngle(u64);

impl Facing {
    /// At an angle from the direction of travel to the heading \[rad\].
    pub fn sideways(angle: f64) -> Self {
        Self::Sideways(FacingAngle(angle.to_bits()))
    }

    /// At an angle on the map \[rad\].
    pub fn steady(heading: f64) -> Self {
        Self::Steady(FacingAngle(heading.to_bits()))
    }

    /// What holds if either of two may.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::Any, _) | (_, Self::Any) => Self::Any,
            (a, b) if a == b => a,
            (Self::Ahead | Self::Backward | Self::Either, Self::Ahead | Self::Backward | Self::Either) => Self::Either,
            _ => Self::Any,
        }
    }

    /// Angle from the direction of travel to its heading \[rad\], where it is known and the same all along.
    pub fn angle(self) -> Option<f64> {
        match self {
            Self::Ahead => Some(0.0),
            Self::Backward => Some(REVERSE),
            Self::Sideways(FacingAngle(angle)) => Some(f64::from_bits(angle)),
            Self::Steady(_) | Self::Either | Self::Any => None,
        }
    }

    /// Returns the angle from the direction of travel to its heading \[rad\] at a place where the direction of travel is `ahead`, if that is known.
    pub fn angle_at(self, ahead: f64) -> Option<f64> {
        match self {
            Self::Steady(FacingAngle(heading)) => Some(wrapped(f64::from_bits(heading) - ahead)),
            other => other.angle(),
        }
    }

    /// Its heading on the map \[rad\], where that is the same all along a curve.
    pub fn heading(self) -> Option<f64> {
        match self {
            Self::Steady(FacingAngle(heading)) => Some(f64::from_bits(heading)),
            _ => None,
        }
    }

    /// Whether the angle from the direction of travel to the heading of a vehicle that faces so on the parts of a path changes, and is known all
    /// along.
    pub(super) fn changes(parts: impl Iterator<Item = Self>) -> bool {
        let all: Vec<Self> = parts.collect();
        all.iter().all(|part| part.angle_at(0.0).is_some())
            && (all.iter().any(|part| part.heading().is_some())
                || all.windows(2).any(|pair| pair[0].angle() != pair[1].angle()))
    }

    /// What holds on a path of two parts in one gear: a vehicle that faces another way on the second one has turned round between them.
    #[must_use]
    pub fn then(self, other: Self) -> Self {
        match (self, other) {
            (a, b) if a == b && a.angle().is_some() => a,
            _ => Self::Any,
        }
    }
}

impl VehicleTraits {
    /// The vehicle as if it faced along its path, covering what it covers where it faces so: an outline that may face either way is the
    /// convex hull of both, and one that may face any way is the disc around it. One that keeps its heading stays as it is: its path has the angle.
    #[must_use]
    pub fn facing(&self, facing: Facing) -> Self {
        let Some(footprint) = &self.footprint else { return self.clone() };
        let outline = match facing {
            Facing::Ahead | Facing::Steady(_) => return self.clone(),
            Facing::Backward | Facing::Either if footprint.is_same_backward() => return self.clone(),
            Facing::Backward => Some(footprint.backward()),
            Facing::Either => footprint.either_way(),
            Facing::Sideways(FacingAngle(angle)) => Some(footprint.turned(f64::from_bits(angle))),
            Facing::Any => None,
        };
        let radius = outline.as_ref().map_or(self.radius, Footprint::circumscribed_radius).max(self.radius);
        Self { radius, footprint: outline, ..self.clone() }
    }

    /// Radius of the disc around its reference point that it covers \[m\]; below 0 where that point is outside of it.
    pub(super) fn inner_radius(&self) -> f64 {
        self.footprint.as_ref().map_or(self.radius, Footprint::inner_radius)
    }

    /// How far a turn by an angle \[rad\] moves any point of it at most \[m\]: 0 for a disc.
    pub fn moved_by(&self, angle: f64) -> f64 {
        if self.footprint.is_some() { self.radius * angle } else { 0.0 }
    }
}

/// What a file says about the vehicle.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct FileVehicleTraits {
    pub(super) name: Option<String>,
    pub(super) radius: Option<f64>,
    pub(super) footprint: Option<Footprint>,
    /// Whether radius and outline are those of a fleet.
    pub(super) is_of_fleet: bool,
    pub(super) margin: Option<f64>,
    pub(super) speed: Option<f64>,
    pub(super) acceleration: Option<f64>,
    pub(super) rotation: Option<f64>,
    pub(super) rotation_acceleration: Option<f64>,
}

/// Largest deviation of a fitted path from a curve, if no other is asked for \[m\].
pub const TOLERANCE: f64 = 1e-3;

/// Heading of the options in the help.
pub const HEADING: &str = "Layouts and other formats";

/// How to read files that are not scenarios.
///
/// Lengths are in metres, speeds in m/s and rad/s, accelerations in m/s² and rad/s². The command line takes numbers above 0,
/// of margin and corner radius also 0, up to 1e6.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args), command(next_help_heading = HEADING))]
pub struct ImportOptions {
    /// Format; pcr import --help lists them
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "FORMAT", hide_possible_values = true))]
    pub from: Option<InputFormat>,
    /// Route of an agent; repeat it for more agents
    #[cfg_attr(feature = "clap", arg(long = "route", value_name = "FROM:TO[@TIME]"))]
    pub routes: Vec<String>,
    /// Radius of the vehicle
    #[cfg_attr(feature = "clap", arg(long, value_name = "M", value_parser = positive))]
    pub radius: Option<f64>,
    /// Margin around discs that have none of their own
    #[cfg_attr(feature = "clap", arg(long, value_name = "M", value_parser = not_negative))]
    pub margin: Option<f64>,
    /// Largest speed of the vehicle
    #[cfg_attr(feature = "clap", arg(long, value_name = "M/S", value_parser = positive))]
    pub speed: Option<f64>,
    /// Largest acceleration of the vehicle
    #[cfg_attr(feature = "clap", arg(long, value_name = "M/S2", value_parser = positive))]
    pub acceleration: Option<f64>,
    /// Largest speed of rotation of the vehicle
    #[cfg_attr(feature = "clap", arg(long, value_name = "RAD/S", value_parser = positive))]
    pub rotation: Option<f64>,
    /// Largest angular acceleration [rad/s²]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", value_parser = positive))]
    pub rotation_acceleration: Option<f64>,
    /// Vehicle type, if there are several (LIF)
    #[cfg_attr(feature = "clap", arg(long, value_name = "TYPE"))]
    pub vehicle: Option<String>,
    /// Fleet (Open-RMF) or factsheet (VDA 5050)
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE"))]
    pub fleet: Option<PathBuf>,
    /// Radius of corners [default: 0, none]
    #[cfg_attr(feature = "clap", arg(long, value_name = "M", value_parser = not_negative))]
    pub corner_radius: Option<f64>,
    /// Deviation from curves [default: 0.001]
    #[cfg_attr(feature = "clap", arg(long, value_name = "M", value_parser = positive))]
    pub tolerance: Option<f64>,
    /// Graph, if there are several (Open-RMF)
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", value_parser = index))]
    pub graph: Option<u64>,
    /// Include the horizon of orders (VDA 5050)
    #[cfg_attr(feature = "clap", arg(long))]
    pub horizon: bool,
    /// Leave out parts that cannot be read, if any
    #[cfg_attr(feature = "clap", arg(long))]
    pub partial: bool,
}

/// Largest value of an option: beyond it nothing is a vehicle.
const MOST: f64 = 1e6;

/// A value of an option that is out of range, by the range that is expected.
#[cfg(feature = "clap")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum OptionError {
    NotNegative,
    Positive,
    Index,
}

#[cfg(feature = "clap")]
impl std::fmt::Display for OptionError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotNegative => write!(f, "a number from 0 to {MOST:e} is expected"),
            Self::Positive => write!(f, "a number from {:e} to {MOST:e} is expected", 1.0 / MOST),
            Self::Index => f.write_str("a whole number from 0 is expected"),
        }
    }
}

#[cfg(feature = "clap")]
impl std::error::Error for OptionError {}

#[cfg(feature = "clap")]
pub(super) fn not_negative(text: &str) -> Result<f64, OptionError> {
    match text.parse::<f64>() {
        Ok(number) if (0.0..=MOST).contains(&number) => Ok(number),
        _ => Err(OptionError::NotNegative),
    }
}

#[cfg(feature = "clap")]
pub(super) fn positive(text: &str) -> Result<f64, OptionError> {
    match not_negative(text) {
        Ok(number) if number >= 1.0 / MOST => Ok(number),
        _ => Err(OptionError::Positive),
    }
}

#[cfg(feature = "clap")]
fn index(text: &str) -> Result<u64, OptionError> {
    text.parse().map_err(|_| OptionError::Index)
}

impl ImportOptions {
    pub(super) fn tolerance(&self) -> f64 {
        self.tolerance.unwrap_or(TOLERANCE)
    }

    /// Whether anything that a file says about the vehicle counts beside these options.
    pub(super) fn leave_some_of(&self, given: &FileVehicleTraits) -> bool {
        let numbers = [
            (self.radius, given.radius.or(given.footprint.as_ref().map(Footprint::circumscribed_radius))),
            (self.margin, given.margin),
            (self.speed, given.speed),
            (self.acceleration, given.acceleration),
            (self.rotation, given.rotation),
            (self.rotation_acceleration, given.rotation_acceleration),
        ];
        let is_left = |(option, given): (Option<f64>, Option<f64>)| option.is_none() && given.is_some();
        self.vehicle.is_none() && given.name.is_some() || numbers.into_iter().any(is_left)
    }

    /// The vehicle: what the options say, else the file, else a default that is warned about. If nothing `moves` only the
    /// radius matters.
    pub(super) fn vehicle(&self, given: &FileVehicleTraits, moves: bool, warnings: &mut Warnings) -> VehicleTraits {
        let mut assumed = Vec::new();
        let mut choose = |option: Option<f64>, given: Option<f64>, default: f64, what: &str| {
            option.or(given).unwrap_or_else(|| {
                assumed.push(format!("{what} {default}"));
                default
            })
        };
        // A radius that is asked for is that of a disc.
        let footprint = given.footprint.clone().filter(|_| self.radius.is_none());
        let reach = footprint.as_ref().map(Footprint::circumscribed_radius);
        let outline = given
            .footprint
            .as_ref()
            .map(|footprint| footprint.polygon().iter().map(|[ahead, left]| ahead.hypot(*left)).fold(0.0, f64::max));
        if let Some((radius, reach)) = self.radius.zip(outline).filter(|(radius, reach)| radius < reach) {
            let problem =
                format!("{radius} m, a disc; the outline of the vehicle, which is not used then, reaches {reach:.3} m");
            warnings.add(WarningCode::RadiusBelowOutline, "radius", problem);
        }
        let size = match (self.radius, reach.or(given.radius)) {
            (Some(_), _) => SizeSource::Option,
            (None, None) => SizeSource::Assumed,
            (None, Some(_)) if given.is_of_fleet => SizeSource::Fleet,
            (None, Some(_)) => SizeSource::File,
        };
        let radius = choose(self.radius, reach.or(given.radius), 0.5, "radius [m]");
        let vehicle = VehicleTraits {
            name: given.name.clone(),
            radius,
            footprint,
            size,
            margin: self.margin.or(given.margin).unwrap_or(0.0),
            speed: choose(self.speed, given.speed, 1.0, "speed [m/s]"),
            acceleration: choose(self.acceleration, given.acceleration, 0.5, "acceleration [m/s²]"),
            rotation: choose(self.rotation, given.rotation, 1.0, "rotation [rad/s]"),
            rotation_acceleration: choose(
                self.rotation_acceleration,
                given.rotation_acceleration,
                1.0,
                "rotation-acceleration [rad/s²]",
            ),
        };
        if !moves {
            assumed.retain(|what| what.starts_with("radius"));
        }
        if !assumed.is_empty() {
            warnings.add(
                WarningCode::AssumedVehicle,
                "vehicle",
                format!("not in the file and not given, hence taken as: {}", assumed.join(", ")),
            );
        }
        vehicle
    }
}

/// A route that was asked for.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RouteRequest {
    pub(super) ends: [usize; 2],
    pub(super) time: f64,
}

impl RouteRequest {
    /// The route in `FROM:TO[@TIME]`; names of nodes may hold colons and `@`, as long as it can be read in one way only.
    pub(super) fn parse(text: &str, nodes: impl Fn(&str) -> Vec<usize>) -> Result<Self, ImportError> {
        let refused = |problem: String| Err(ImportError::new(format!("route {text}: {problem}")));
        let splits = |text: &str| -> Vec<[String; 2]> {
            let split = |(colon, _)| Some([text.get(..colon)?.to_owned(), text.get(colon + 1..)?.to_owned()]);
            let names = text.match_indices(':').filter_map(split);
            names.filter(|names| names.iter().all(|name| !nodes(name).is_empty())).collect()
        };
        let timed = text.rsplit_once('@').and_then(|(names, time)| {
            let time = time.parse::<f64>().ok().filter(|time| time.abs() <= MOST)?;
            Some((names, time))
        });
        let mut readings: Vec<([String; 2], f64)> = splits(text).into_iter().map(|names| (names, 0.0)).collect();
        readings.extend(timed.into_iter().flat_map(|(text, time)| splits(text).into_iter().map(move |it| (it, time))));
        match readings.as_slice() {
            [(names, time)] => {
                let mut ends = [0; 2];
                for (end, name) in ends.iter_mut().zip(names) {
                    match nodes(name)[..] {
                        [only] => *end = only,
                        ref several => return refused(format!("{} nodes have the name {name}", several.len())),
                    }
                }
                Ok(Self { ends, time: *time })
            }
            [] => {
                let names = text.rsplit_once('@').map_or(text, |(names, _)| names);
                let unknown = names.split_once(':').map(|(from, to)| if nodes(from).is_empty() { from } else { to });
                match unknown {
                    Some(name) if nodes(name).is_empty() => refused(format!("there is no node {name}")),
                    _ => refused("FROM:TO or FROM:TO@TIME is expected".into()),
                }
            }
            _ => refused("there are nodes for more than one reading of it".into()),
        }
    }
}
