//! For which vehicle exclusions were written, and by what: it stands in the written file, and audits compare it.
//!
//! | format | where |
//! |---|---|
//! | nav2, Open-RMF | a member `pcr_vehicle` of the whole file, which their loaders pass over |
//! | openTCS | the property `pcr:vehicle` of the model; up to version 0.0.2, whose models have none, a comment |
//! | VDA 5050 | `zoneSetDescriptor`, a text for readers |
//! | pcr | `written` |

use pcr_formats::import::{ImportedLayout, SizeSource};
use pcr_formats::warning::WarningCode;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The member of a file that holds it.
pub(crate) const MEMBER: &str = "pcr_vehicle";

/// The property of a model that holds it.
pub(crate) const PROPERTY: &str = "pcr:vehicle";

/// Sizes that differ by no more are equal \[m\].
const SAME: f64 = 1e-9;

/// The vehicle for which exclusions were written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VehicleStamp {
    /// The program that wrote them, with its version.
    pub by: String,
    /// Radius of the disc \[m\]; of an outline that of the disc around all of it.
    pub radius: f64,
    /// Margin around it \[m\].
    pub margin: f64,
    /// Where the size came from: `option`, `fleet` or `file`.
    pub source: String,
    /// Corners of the outline \[m\], ahead and to the left; of a disc none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outline: Vec<[f64; 2]>,
}

impl VehicleStamp {
    /// That of what is written for a layout and its vehicle.
    pub fn of(imported: &ImportedLayout) -> Self {
        let vehicle = &imported.vehicle;
        let source = match vehicle.size {
            SizeSource::Option => "option",
            SizeSource::Fleet => "fleet",
            SizeSource::File => "file",
            SizeSource::Assumed => "assumed",
        };
        Self {
            by: format!("pcr {}", env!("CARGO_PKG_VERSION")),
            radius: vehicle.radius,
            margin: vehicle.margin,
            source: source.to_owned(),
            outline: vehicle.footprint.as_ref().map_or_else(Vec::new, |outline| outline.polygon().to_vec()),
        }
    }

    /// It as JSON, which is YAML as well. Its texts hold no hyphens, so it may stand in comments of XML, too.
    pub(crate) fn text(&self) -> String {
        let Self { by, radius, margin, source, outline } = self;
        let outline = match &outline[..] {
            [] => String::new(),
            corners => {
                let corners = corners.iter().map(|[ahead, left]| format!("[{ahead}, {left}]")).collect::<Vec<_>>();
                format!(", \"outline\": [{}]", corners.join(", "))
            }
        };
        format!("{{\"by\": \"{by}\", \"radius\": {radius}, \"margin\": {margin}, \"source\": \"{source}\"{outline}}}")
    }

    /// What a text says; `None` if it is none.
    pub(crate) fn read(text: &str) -> Option<Self> {
        serde_json::from_str(text).ok()
    }

    /// Says for what it was written, where that is another vehicle than the one of an audit.
    pub(crate) fn difference(&self, audited: &ImportedLayout) -> Option<String> {
        let now = Self::of(audited);
        let is_near = |a: f64, b: f64| (a - b).abs() <= SAME;
        let has_same_outline = self.outline.len() == now.outline.len()
            && self.outline.iter().flatten().zip(now.outline.iter().flatten()).all(|(a, b)| is_near(*a, *b));
        let is_same = is_near(self.radius, now.radius) && is_near(self.margin, now.margin) && has_same_outline;
        let text = format!("the exclusions were written for {self}, by {}; they are audited for {now}", self.by);
        (!is_same).then(|| WarningCode::OtherVehicle.text(text))
    }
}

impl fmt::Display for VehicleStamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { radius, margin, outline, .. } = self;
        match outline.len() {
            0 => write!(f, "radius {radius} m"),
            corners => write!(f, "an outline of {corners} corners within {radius} m"),
        }?;
        if *margin > 0.0 { write!(f, " and margin {margin} m") } else { Ok(()) }
    }
}
