//! Warnings, each with the code by which it is acknowledged.

use std::fmt;
use std::str::FromStr;

/// Defines the codes from one list, so that none is without a name and a line of explanation.
macro_rules! codes {
    ($($(#[doc = $explanation:literal])+ $variant:ident = $name:literal,)+) => {
        /// What a warning is about, whatever it names.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum WarningCode {
            $($(#[doc = $explanation])+ $variant,)+
        }

        impl WarningCode {
            /// All codes, in the order of the documentation.
            pub const ALL: &[Self] = &[$(Self::$variant,)+];

            /// Returns the name by which people and programs call it.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                }
            }

            /// Returns one line of explanation.
            pub fn explanation(self) -> String {
                let lines: &[&str] = match self {
                    $(Self::$variant => &[$($explanation,)+],)+
                };
                lines.concat().trim().to_owned()
            }
        }
    };
}

codes! {
    /// Part of the file is left out, as `--partial` asks for.
    LeftOut = "left-out",
    /// The file may have been cut: it lacks an end that such files have.
    MayBeCut = "may-be-cut",
    /// A key or an element is not known at this place, and its content is not read.
    UnknownKey = "unknown-key",
    /// The version of the file is missing or not known; the message says as which one it is read.
    UnknownVersion = "unknown-version",
    /// A known field is not read, because nothing here depends on it or stands for it.
    UnreadField = "unread-field",
    /// A name or label was replaced: names here are unique, printable and of limited length.
    Renamed = "renamed",
    /// A node or edge is in the file several times, the same each time; it is read once.
    GivenTwice = "given-twice",
    /// A size or limit of the vehicle is neither in the file nor given by an option; a common value is assumed.
    AssumedVehicle = "assumed-vehicle",
    /// The size of the vehicle is incomplete in the file, and is completed in the way that the message says.
    AssumedSize = "assumed-size",
    /// Vehicles or envelopes differ; the largest outline or the lowest limit of all is used.
    VehiclesDiffer = "vehicles-differ",
    /// The radius that was given is smaller than the outline of the vehicle.
    RadiusBelowOutline = "radius-below-outline",
    /// The vehicle is longer than its disc, and the file describes no outline.
    LongVehicle = "long-vehicle",
    /// The file has several vehicle types or graphs; the edges of all of them are used.
    SeveralGraphs = "several-graphs",
    /// The agents are on several maps or levels, which one scenario does not tell apart.
    SeveralLevels = "several-levels",
    /// Nodes name no level; the message says on which one they are taken to be.
    AssumedLevel = "assumed-level",
    /// A scale in pixels is not certain: measurements differ, or fiducials are missing.
    UncertainScale = "uncertain-scale",
    /// Lines and arcs deviate from a curve, by which the vehicle is enlarged there.
    CurveDeviation = "curve-deviation",
    /// Where the ends of a curve are drawn is not said; its control points are taken to be in the frame of the file.
    AssumedFrame = "assumed-frame",
    /// The degree of a curve contradicts its knots.
    CurveDegree = "curve-degree",
    /// Pieces of a route do not join: a drawn line, a trajectory or a link ends at another place than its node.
    Gap = "gap",
    /// A vehicle follows a line on the ground whose course is not in the file; a straight one is assumed.
    PhysicalLine = "physical-line",
    /// An edge has length 0.
    ZeroLength = "zero-length",
    /// The length that is written is missing or contradicts the geometry, which counts.
    WrittenLength = "written-length",
    /// A speed limit is missing, invalid or not constant on an edge.
    SpeedLimit = "speed-limit",
    /// An edge is closed in both directions: no route uses it, and exclusions count it.
    ClosedEdge = "closed-edge",
    /// An edge is used one way only, although the file says that it has both.
    OneWay = "one-way",
    /// A link between roads cannot be followed; no route uses it.
    BrokenLink = "broken-link",
    /// An object is neither a node nor an edge.
    NotInGraph = "not-in-graph",
    /// The programs that the file is for exchange its axes, so that left and right are exchanged, and so does the reader.
    MirroredAxes = "mirrored-axes",
    /// Orientations are not read; the outline of the vehicle faces along its path.
    Orientation = "orientation",
    /// A vehicle may turn in place by half a turn to either side; only one side is covered.
    HalfTurn = "half-turn",
    /// The file forbids a vehicle to drive backward; it is treated as if it could.
    DrivesBackward = "drives-backward",
    /// A vehicle may leave the middle of its edge or the exact position of a node, which is not covered.
    AllowedDeviation = "allowed-deviation",
    /// Actions have no duration in the file, and take no time here.
    Actions = "actions",
    /// Edges of an order are not released; they are left out.
    NotReleased = "not-released",
    /// An update of an order is there without the order before it; it is read as if the vehicle began at its first node.
    UpdateAlone = "update-alone",
    /// A vehicle is already moving; its planned path is travelled from rest.
    MovesAlready = "moves-already",
    /// A vehicle says for some time that it is not localized; nothing is known of it until its next pose.
    NotLocalized = "not-localized",
    /// The clock of a vehicle may differ from those of others, by what the message says.
    ClockOffset = "clock-offset",
    /// The number format moves agents by more than 1 mm.
    NumberFormat = "number-format",
    /// An agent keeps its own motion, which is slower than its limits, in a plan of speeds.
    OwnMotion = "own-motion",
    /// The motion of an agent is replaced by one from rest to rest in the simulation.
    ReplacedMotion = "replaced-motion",
    /// An outline is concave, or changes on the way, and its convex hull is used.
    ConvexHull = "convex-hull",
    /// Times of the simulation count from the first start, not from 0.
    ShiftedTimes = "shifted-times",
    /// Agents without a path touch one another.
    StandingContact = "standing-contact",
    /// The path of an agent ends where it begins, and a controller without a plan has nothing to do.
    ClosedPath = "closed-path",
    /// Agents are missing in the plan, as `--leave-out` allows.
    AgentsLeftOut = "agents-left-out",
    /// Missions are drawn on one level of several.
    OneLevel = "one-level",
    /// More agents were asked for than the layout has room for.
    AgentsLimited = "agents-limited",
    /// Part of the exclusions in the file does not keep vehicles apart, and is not counted.
    UncountedExclusion = "uncounted-exclusion",
    /// Exclusions of the file are replaced by those that are written.
    ReplacedExclusions = "replaced-exclusions",
    /// Edges, lanes or paths are not cut, because something belongs to all of their length.
    LeftWhole = "left-whole",
    /// The parts of a path cannot share what it costs; each has the cost of all of it.
    UnsharedCost = "unshared-cost",
    /// The exclusions in the file were written for another vehicle than the one of the audit.
    OtherVehicle = "other-vehicle",
    /// Lanes of other graphs are left as they are.
    OtherGraphs = "other-graphs",
    /// A controller is for the disc around the outline of the vehicle.
    DiscAroundOutline = "disc-around-outline",
    /// Hardly any memory is left to the process.
    Memory = "memory",
    /// Pictures of an earlier run or plan remain in the folder.
    EarlierPictures = "earlier-pictures",
    /// The font of PNG pictures lacks some letters.
    MissingLetters = "missing-letters",
    /// Fewer parking endpoints are free than there are vehicles.
    ParkingEndpoints = "parking-endpoints",
    /// An angle in radians is above one turn, and probably meant in degrees.
    AngleUnit = "angle-unit",
    /// The warning is from a file of an earlier version, which had no codes.
    Uncoded = "uncoded",
}

impl WarningCode {
    /// Returns the text of a warning with this code: the message, then the code in brackets.
    pub fn text(self, message: impl fmt::Display) -> String {
        format!("{message} [{self}]")
    }

    /// Returns the code at the end of the text of a warning; [`WarningCode::Uncoded`] where there is none that is known.
    pub fn of(text: &str) -> Self {
        let name = text.strip_suffix(']').and_then(|text| text.rsplit_once(" [")).map(|(_, name)| name);
        name.and_then(|name| name.parse().ok()).unwrap_or(Self::Uncoded)
    }

    /// Returns the text of a warning from a file, which has a code at its end; [`WarningCode::Uncoded`] is added where there is none.
    pub fn coded(text: String) -> String {
        let has_none = Self::of(&text) == Self::Uncoded && !text.ends_with("[uncoded]");
        if has_none { Self::Uncoded.text(text) } else { text }
    }
}

impl FromStr for WarningCode {
    type Err = ();

    fn from_str(name: &str) -> Result<Self, ()> {
        Self::ALL.iter().copied().find(|code| code.name() == name).ok_or(())
    }
}

impl fmt::Display for WarningCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_tells_its_code() {
        for &code in WarningCode::ALL {
            let text = code.text("edge 1: too [short]");
            assert_eq!((WarningCode::of(&text), WarningCode::coded(text.clone())), (code, text));
        }
        for text in ["edge 1: too short", "edge 1: its parameters [gap", "edge 1[gap]", "edge 1 [none-such]", ""] {
            assert_eq!(WarningCode::of(text), WarningCode::Uncoded, "{text}");
            assert_eq!(WarningCode::coded(text.to_owned()), format!("{text} [uncoded]"));
        }
    }

    #[test]
    fn every_code_has_a_name_and_an_explanation_of_its_own() {
        for (place, code) in WarningCode::ALL.iter().enumerate() {
            let name = code.name();
            assert!(
                name.split('-').all(|word| !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase())),
                "{name}"
            );
            let explanation = code.explanation();
            assert!(explanation.ends_with('.') && !explanation.contains(['|', '\n']), "{name}: {explanation}");
            let others = &WarningCode::ALL[place + 1..];
            assert!(others.iter().all(|other| other.name() != name && other.explanation() != explanation), "{name}");
        }
    }
}
