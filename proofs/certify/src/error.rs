//! Why an input of the checker is refused.

use std::fmt;

/// Part of an input that a problem is in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InputPart {
    /// A line of a text, from 1.
    Line(usize),
    /// An agent: its number, and its place in the table if it is one of a table.
    Agent(u64, Option<usize>),
    /// A body: its number, and its place in the table if it is one of a table.
    Body(u64, Option<usize>),
    /// The pair of the agents, or bodies, in these places.
    Pair([usize; 2]),
    /// The region of a pair in this place.
    Region(usize),
    /// The segment of a path in this place.
    Segment(usize),
    /// A phase of a motion.
    Phase {
        /// From when to when \[s\].
        time: [f64; 2],
        /// From which to which length \[m\].
        length: [f64; 2],
    },
}

/// What is wrong with a table, a path, an outline, a motion, or the text of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum CertifyError {
    /// A part of the input has a problem.
    In(InputPart, Box<Self>),

    /// What has this name is out of range, or no number.
    OutOfRange(&'static str),
    /// What has this name has a value that is out of range, or no number.
    ValueOutOfRange(&'static str, f64),
    /// What has this name is not 0, and smaller in magnitude than the least number that is allowed.
    TooSmall {
        /// Of what.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The least one allowed.
        least: f64,
    },
    /// An angle is too large in magnitude.
    AngleTooLarge {
        /// Of what.
        name: &'static str,
        /// Its value.
        angle: f64,
        /// Its unit, after a space; empty where the number format decides.
        unit: &'static str,
        /// The largest one allowed.
        most: f64,
    },

    /// A path without segments.
    NoSegments,
    /// A step of lengths that is no power of two, as those of fixed-point formats are.
    Step(f64),
    /// The lengths of a segment are not the sum of those before, by so much \[m\].
    LengthsOff(f64),
    /// The lengths of a segment are no multiples of this step \[m\].
    NoMultiples(f64),
    /// A segment has a length below 0, or a radius of 0.
    LengthOrRadius,
    /// An arc or a turn in place of more than one turn.
    MoreThanATurn,
    /// A segment does not begin where the one before it ends.
    SegmentGap,
    /// A body turns in place, and its heading is to be constant.
    SteadyPivot,
    /// The radius of an arc, or the lever of a turn in place, is out of range \[m\].
    Reach(f64),
    /// The heading differs from that before it by so much \[rad\].
    HeadingJump(f64),

    /// An outline of so many corners.
    CornerCount {
        /// How many it has.
        count: usize,
        /// How many it may have.
        most: usize,
    },
    /// An outline whose radius is below 0 \[m\].
    OutlineRadius(f64),
    /// Two neighbouring corners of an outline are the same.
    SameCorners,
    /// An outline that is no convex polygon, counter-clockwise.
    NotConvex,

    /// No motion where there has to be one.
    NoMotion,
    /// A phase does not begin where the one before it ends.
    PhaseGap,
    /// A phase has a speed below 0.
    NegativeSpeed,
    /// A phase has a way, and takes no time.
    Jump,
    /// A phase that would have to come back, because its slower end has this speed already \[m/s\].
    TooShortAWay(f64),
    /// The phases do not end where the path does.
    Arrival {
        /// Where the phases end \[m\].
        reached: f64,
        /// Where the path ends \[m\].
        end: f64,
    },
    /// A disc that goes straight on has a number that is out of range.
    StraightOutOfRange {
        /// Its radius \[m\].
        radius: f64,
        /// From where to where \[m\].
        ends: [[f64; 2]; 2],
        /// How fast \[m/s\].
        speed: f64,
    },
    /// A disc that goes straight on takes too long.
    StraightTooLong {
        /// From where to where \[m\].
        ends: [[f64; 2]; 2],
        /// How fast \[m/s\].
        speed: f64,
    },

    /// A pair of one agent, of an agent that is not there, or one that is there twice.
    NoPair([usize; 2]),
    /// The ε of a pair is out of range.
    Excess([usize; 2]),
    /// An arc of the agent in this place is longer than a turn by more than the ε of its pair allows.
    ArcTooLong(usize),
    /// A pair is missing.
    MissingPair([usize; 2]),
    /// A pair is missing, and not because they are apart.
    MissingNearPair([usize; 2]),
    /// A piece of a segment that is not there.
    NoSuchSegment,
    /// A piece of a region that is not there.
    NoSuchRegion,
    /// A piece is not on its segment \[m\].
    PieceOffSegment([f64; 2]),
    /// A piece has ends that are no numbers of its format \[m\].
    PieceOffFormat([f64; 2]),
    /// A piece stands for the interval of this number, of so many.
    PieceRank([u8; 2]),
    /// A piece stands for one of two intervals, and its segment is a line.
    LineBranch,
    /// A region has times and the agents no motions, or the other way round.
    TimeWithoutMotion,
    /// A region has times that are none \[s\].
    NoTime([f64; 2]),
    /// The lengths of a region are not those of its pieces.
    RegionLengths,

    /// A text without a table.
    NoTable,
    /// A text of so many tables.
    Tables(usize),
    /// A table that has no end.
    Cut,
    /// A version of tables that is not known.
    UnknownVersion(String),
    /// A number format that is not known.
    UnknownFormat(String),
    /// Bits that are no number.
    NotFinite(u32),
    /// A line has too few words.
    MissingWord,
    /// A line has this word too much.
    ExtraWord(String),
    /// A word that is no count.
    NoCount(String),
    /// A word that is not eight hexadecimal digits.
    NotHexadecimal(String),
    /// A line begins with another word than it has to.
    Unexpected {
        /// What it begins with.
        found: String,
        /// What it may begin with.
        expected: &'static str,
    },
    /// A word that is no share of a piece.
    NoShare(String),
    /// A radius that is not above 0.
    RadiusNotPositive,
    /// The check of the text is another one.
    Checksum {
        /// What the text says.
        told: u32,
        /// That of the text.
        sum: u32,
    },
}

impl CertifyError {
    /// Returns what makes a problem one of a part of the input.
    pub fn of(part: InputPart) -> impl Fn(Self) -> Self + Copy {
        move |problem| Self::In(part, Box::new(problem))
    }
}

impl fmt::Display for InputPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Line(number) => write!(f, "line {number}"),
            Self::Agent(id, None) => write!(f, "agent {id}"),
            Self::Agent(id, Some(place)) => write!(f, "agent {id} (place {place})"),
            Self::Body(id, None) => write!(f, "body {id}"),
            Self::Body(id, Some(place)) => write!(f, "body {id} (place {place})"),
            Self::Pair([a, b]) => write!(f, "the pair of places {a} and {b}"),
            Self::Region(place) => write!(f, "region {place}"),
            Self::Segment(place) => write!(f, "segment {place}"),
            Self::Phase { time: [from, to], length: [begin, end] } => {
                write!(f, "the phase from {from} to {to} s, from {begin} to {end} m")
            }
        }
    }
}

impl fmt::Display for CertifyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::In(part, problem) => write!(f, "{part}: {problem}"),

            Self::OutOfRange(name) => write!(f, "{name} is out of range"),
            Self::ValueOutOfRange(name, value) => write!(f, "{name} {value} is out of range"),
            Self::TooSmall { name, value, least } => {
                write!(f, "{name} {value:e} is out of range; the least one is {least:e}")
            }
            Self::AngleTooLarge { name, angle, unit, most } => {
                write!(f, "{name} {angle}{unit} is out of range; allowed is up to {most:e} in magnitude")
            }

            Self::NoSegments => f.write_str("no segments"),
            Self::Step(step) => write!(f, "the step {step} is none of a fixed-point format"),
            Self::LengthsOff(off) => write!(f, "its lengths along the path are off by {off:e} m"),
            Self::NoMultiples(step) => write!(f, "its lengths are no multiples of {step:e} m"),
            Self::LengthOrRadius => f.write_str("a length below 0 or a radius of 0"),
            Self::MoreThanATurn => f.write_str("more than one turn"),
            Self::SegmentGap => f.write_str("it does not begin where the one before ends"),
            Self::SteadyPivot => f.write_str("a turn in place with a constant heading"),
            Self::Reach(reach) => write!(f, "a radius or lever of {reach} m is out of range"),
            Self::HeadingJump(off) => write!(f, "its heading is off by {off:e} rad from that before it"),

            Self::CornerCount { count, most } => write!(f, "an outline of {count} corners; allowed are 1 to {most}"),
            Self::OutlineRadius(radius) => write!(f, "an outline with the radius {radius} m"),
            Self::SameCorners => f.write_str("two neighbouring corners of the outline are the same"),
            Self::NotConvex => f.write_str("the outline is no convex polygon, counter-clockwise"),

            Self::NoMotion => f.write_str("no motion"),
            Self::PhaseGap => f.write_str("a phase does not begin where the one before ends"),
            Self::NegativeSpeed => f.write_str("a speed below 0"),
            Self::Jump => f.write_str("a way that takes no time"),
            Self::TooShortAWay(speed) => write!(f, "too short a way for {speed} m/s at its slower end"),
            Self::Arrival { reached, end } => write!(f, "its phases end at {reached} m, and its path at {end} m"),
            Self::StraightOutOfRange { radius, ends: [from, to], speed } => {
                write!(f, "a disc of {radius} m from {from:?} to {to:?} m at {speed} m/s is out of range")
            }
            Self::StraightTooLong { ends: [from, to], speed } => {
                write!(f, "from {from:?} to {to:?} m at {speed} m/s takes too long")
            }

            Self::NoPair([a, b]) => write!(f, "the pair of places {a} and {b} is none, or there twice"),
            Self::Excess([a, b]) => write!(f, "the excess of places {a} and {b} is out of range"),
            Self::ArcTooLong(place) => write!(f, "an arc of place {place} is longer than a turn"),
            Self::MissingPair([a, b]) => write!(f, "the pair of places {a} and {b} is missing"),
            Self::MissingNearPair([a, b]) => {
                write!(f, "the pair of places {a} and {b} is missing, and they come near one another")
            }
            Self::NoSuchSegment => f.write_str("a piece of a segment that is not there"),
            Self::NoSuchRegion => f.write_str("a piece of a region that is not there"),
            Self::PieceOffSegment([lo, hi]) => write!(f, "a piece from {lo} to {hi} m is not on its segment"),
            Self::PieceOffFormat([lo, hi]) => {
                write!(f, "a piece from {lo} to {hi} m has ends that its number format has not")
            }
            Self::PieceRank([k, of]) => write!(f, "a piece that stands for the interval {k} of {of}"),
            Self::LineBranch => f.write_str("a piece that stands for one of two intervals of a line"),
            Self::TimeWithoutMotion => f.write_str("a time without a motion, or a motion without a time"),
            Self::NoTime([from, to]) => write!(f, "its time from {from} to {to} s is none"),
            Self::RegionLengths => f.write_str("its lengths are not those of its pieces"),

            Self::NoTable => f.write_str("there is no table in it: neither JSON nor a line that begins with pcr-table"),
            Self::Tables(count) => write!(f, "there are {count} tables in it"),
            Self::Cut => f.write_str("the table is cut: it has no end"),
            Self::UnknownVersion(version) => write!(f, "version {version} of tables is not known"),
            Self::UnknownFormat(name) => {
                write!(f, "{name} is no number format; known are f32, micro, q20, q16 and q12")
            }
            Self::NotFinite(bits) => write!(f, "{bits:08x} is no number"),
            Self::MissingWord => f.write_str("a word is missing"),
            Self::ExtraWord(word) => write!(f, "{word} is one word too many"),
            Self::NoCount(word) => write!(f, "{word} is no count"),
            Self::NotHexadecimal(word) => write!(f, "{word} is not eight hexadecimal digits"),
            Self::Unexpected { found, expected } => write!(f, "{found} where {expected} is expected"),
            Self::NoShare(word) => write!(f, "{word} is no share"),
            Self::RadiusNotPositive => f.write_str("a radius that is not above 0"),
            Self::Checksum { told, sum } => write!(f, "its check is {told:08x}, not {sum:08x}"),
        }
    }
}

impl std::error::Error for CertifyError {}
