//! Mutual exclusion rules in layout files of fleet software (groups, blocks, zones and lists of closed edges): read,
//! written and audited.
//!
//! Every format is read as [`ExclusionRules`]: the resources that a vehicle takes on an edge or at a node, and those that it
//! bars for others. The rules follow the program that loads the file:
//!
//! | format | a vehicle on an edge from u to v | a vehicle at a node |
//! |---|---|---|
//! | nav2 | takes the edge, bars those of its list | bars those of its list |
//! | openTCS | takes u, the path, v, and all blocks in which one of them is | takes the point and its blocks |
//! | Open-RMF | takes the groups of the lane and of v, no longer that of u | takes the group of the vertex |
//! | VDA 5050 | takes the RELEASE zones that its contour is sure to touch | the same |
//! | pcr | takes the locks of the stretch it is on | bars the stretches of its locks |
//!
//! ```text
//! directed_edge    an edge in one direction, and the resources of its stretches
//! nearest          the least distance of two stretches
//! curve_proximity  where on a curve a polygon is near
//! token_conflicts  tokens by which two edges can exclude each other
//! audit            contacts that are not excluded, and exclusions that are not needed
//! clique_cover     covers of a graph by cliques, and a lower bound of their number
//! text_edits       changes of a text at spans; the rest is kept byte for byte
//! kept             a written layout is the one before, with its edges cut
//! selection        which edges and nodes an audit is about
//! options          options and warnings of writers
//! stamp            for which vehicle a file was written
//! convex_outline   polygons around corridors
//! write            exclusions written into the file of a format
//! nav2             nav2 route graphs
//! opentcs          openTCS plant models
//! rmf              Open-RMF buildings
//! vda5050          zones of VDA 5050
//! lock_file        the lock table of this tool
//! report           results of writing and of audits, as text
//! ```

mod audit;
mod clique_cover;
mod convex_outline;
mod curve_proximity;
mod directed_edge;
mod kept;
mod lock_file;
mod nav2;
mod nearest;
mod opentcs;
mod options;
pub mod report;
mod rmf;
mod selection;
mod stamp;
mod text_edits;
mod token_conflicts;
mod vda5050;
mod write;

pub use audit::{ExclusionAudit, LayoutElementId, MissingExclusion, NeedlessExclusion};
pub use directed_edge::{ClaimSpan, DirectedEdgeRules, TokenSpan};
pub use nearest::{NearestPoints, nearest, stretch};
pub use options::WriteOptions;
pub use selection::Selection;
pub use stamp::VehicleStamp;
pub use write::{WriteReport, sized, write};

use pcr_formats::import::{ImportError, ImportedLayout, InputFormat};
use pcr_formats::warning::WarningCode;
use pcr_planning::exclusion_table::ExclusionTable;
use pcr_planning::memory_budget::MemoryDemand;
use std::fmt;

/// The table from which exclusions are made, or against which they are checked: all of it has to fit in memory.
///
/// # Errors
/// Errors of [`ExclusionTable::compute`]; and an error in advance for a table whose rules would take more memory than there is.
pub fn table(imported: &ImportedLayout) -> Result<ExclusionTable, ImportError> {
    let locks = ExclusionTable::compute(imported, true)?;
    MemoryDemand::Exclusions(locks.locks.len()).ask().map_err(|large| ImportError::new(large.to_string()))?;
    Ok(locks)
}

/// Formats of exclusions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum ExclusionFormat {
    /// Route graph of nav2: for each edge and node the edges to be closed while a vehicle is there
    Nav2,
    /// Building of Open-RMF: mutex groups of vertices and lanes
    Rmf,
    /// Plant model of openTCS: blocks of paths and points, or envelopes
    #[cfg_attr(feature = "clap", value(name = "opentcs"))]
    OpenTcs,
    /// Zone set of VDA 5050 (3.0): RELEASE zones
    Vda5050,
    /// For each edge and node the stretches of others that it locks
    Pcr,
}

impl ExclusionFormat {
    /// The layout format whose files contain such exclusions themselves.
    pub fn layout(self) -> Option<InputFormat> {
        match self {
            Self::Nav2 => Some(InputFormat::Nav2),
            Self::Rmf => Some(InputFormat::Rmf),
            Self::OpenTcs => Some(InputFormat::OpenTcs),
            Self::Vda5050 | Self::Pcr => None,
        }
    }

    /// The exclusions in layout files of a format.
    pub fn of_layout(format: InputFormat) -> Option<Self> {
        [Self::Nav2, Self::Rmf, Self::OpenTcs].into_iter().find(|target| target.layout() == Some(format))
    }

    /// The exclusions in a file beside a layout, told from its text.
    pub fn of_text(text: &str) -> Option<Self> {
        if lock_file::is_locks(text) { Some(Self::Pcr) } else { vda5050::is_zones(text).then_some(Self::Vda5050) }
    }
}

impl fmt::Display for ExclusionFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Nav2 => "nav2",
            Self::Rmf => "rmf",
            Self::OpenTcs => "opentcs",
            Self::Vda5050 => "vda5050",
            Self::Pcr => "pcr",
        })
    }
}

/// Tokens that a vehicle takes, and tokens that it bars for all others: indices in ascending order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ResourceClaim {
    /// Tokens that no other vehicle may bar while it has them.
    pub acquired: Vec<usize>,
    /// Tokens that no other vehicle may take while it is there.
    pub blocked: Vec<usize>,
    /// Whether no vehicle may be there at all.
    pub closed: bool,
}

impl ResourceClaim {
    /// The claim of tokens that only one vehicle at a time can have.
    pub(crate) fn exclusive(mut tokens: Vec<usize>) -> Self {
        tokens.sort_unstable();
        tokens.dedup();
        Self { acquired: tokens.clone(), blocked: tokens, closed: false }
    }

    /// Whether a vehicle with this claim keeps another one from making `other`.
    pub fn keeps_out(&self, other: &Self) -> bool {
        if other.closed {
            return true;
        }
        let (mut bars, mut takes) = (self.blocked.iter().peekable(), other.acquired.iter().peekable());
        while let (Some(bar), Some(take)) = (bars.peek(), takes.peek()) {
            match bar.cmp(take) {
                std::cmp::Ordering::Less => bars.next(),
                std::cmp::Ordering::Greater => takes.next(),
                std::cmp::Ordering::Equal => return true,
            };
        }
        false
    }

    /// Whether two vehicles cannot have these claims at the same time, in either sequence.
    pub fn excludes(&self, other: &Self) -> bool {
        self.closed || other.closed || (self.keeps_out(other) && other.keeps_out(self))
    }
}

/// A group, block, zone or list of a file.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct ExclusionGroup {
    /// Name in the file.
    pub name: String,
    /// Edges of its members.
    pub edges: Vec<String>,
    /// Nodes of its members.
    pub nodes: Vec<String>,
    /// Corners of a zone \[m\]; empty for other groups.
    pub outline: Vec<[f64; 2]>,
    /// Level of a zone.
    pub level: usize,
}

/// The rules that vehicles have to keep.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExclusionRules {
    /// For each edge of the layout the way in its direction, and the way back.
    pub edges: Vec<[DirectedEdgeRules; 2]>,
    /// For each node of the layout the claim of a vehicle that stands there.
    pub nodes: Vec<ResourceClaim>,
    /// The groups of the file, with their names there.
    pub groups: Vec<ExclusionGroup>,
    /// Parts of the file that have no effect, with the reasons.
    pub warnings: Vec<String>,
    /// For which vehicle the file was written, where it says so.
    pub stamp: Option<VehicleStamp>,
    /// For each token the level on which it holds, for vehicles that can be on one of several levels; empty if levels do not
    /// matter.
    pub levels: Vec<usize>,
}

impl ExclusionRules {
    /// Rules of whole edges, alike in both directions.
    pub(crate) fn of_edges(imported: &ImportedLayout, edges: Vec<ResourceClaim>, nodes: Vec<ResourceClaim>) -> Self {
        let ways = edges.into_iter().map(|claim| [claim.clone(), claim]).collect();
        Self::of_ways(imported, ways, nodes)
    }

    /// Rules of whole edges, each forward and backward.
    pub(crate) fn of_ways(imported: &ImportedLayout, ways: Vec<[ResourceClaim; 2]>, nodes: Vec<ResourceClaim>) -> Self {
        let edges = imported.layout.edges.iter().zip(ways).map(|(edge, claims)| {
            [false, true].map(|back| DirectedEdgeRules::whole(edge.length(), back, &claims[usize::from(back)]))
        });
        Self { edges: edges.collect(), nodes, ..Self::default() }
    }

    /// The rules with what their file says of the vehicle that they are for, if it says anything.
    pub(crate) fn stamped(mut self, said: Option<&str>) -> Self {
        self.stamp = said.and_then(VehicleStamp::read);
        if let (Some(said), None) = (said, &self.stamp) {
            let text = format_args!("for which vehicle the exclusions were written cannot be read: {said}");
            self.warnings.push(WarningCode::UnreadField.text(text));
        }
        self
    }
}

/// Reads the exclusions of a file: the layout itself, or a file beside it.
///
/// # Errors
/// [`ImportError`] if the file has another format, or names something that is not in the layout.
pub fn read(target: ExclusionFormat, text: &str, imported: &ImportedLayout) -> Result<ExclusionRules, ImportError> {
    match target {
        ExclusionFormat::Nav2 => nav2::read(text, imported),
        ExclusionFormat::Rmf => rmf::read(text, imported),
        ExclusionFormat::OpenTcs => opentcs::read(text, imported),
        ExclusionFormat::Vda5050 => vda5050::read(text, imported),
        ExclusionFormat::Pcr => lock_file::read(text, imported),
    }
}
