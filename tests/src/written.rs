//! Files with exclusions that are written from the layouts in `tests/data/real`, and vehicles that obey nothing else.

use crate::rules::{Run, run};
use pcr_exclusions::{self as exclusions, ExclusionFormat, WriteOptions, read, write};
use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout};
use std::error::Error;
use std::fmt;
use std::path::Path;

/// A file to be written.
#[derive(Clone, Copy, Debug)]
pub struct Written {
    /// The layout.
    pub file: &'static str,
    /// Of the discs \[m\].
    pub radius: f64,
    /// What is written.
    pub target: ExclusionFormat,
    /// Envelopes instead of blocks.
    pub envelopes: bool,
    /// Edges are cut to no more than this \[m\].
    pub split: Option<f64>,
}

const WAREHOUSE: &str = "nav2/warehouse_graph.geojson";
const AWS: &str = "nav2/aws_graph.geojson";
const SAMPLE: &str = "nav2/sample_graph.geojson";
const DEMO: &str = "opentcs/Demo-01.xml";
const OFFICE: &str = "rmf/office.building.yaml";
const TRIPLE_H: &str = "rmf/triple_H.building.yaml";
const BATTLE_ROYALE: &str = "rmf/battle_royale.building.yaml";
const HOTEL: &str = "rmf/hotel.building.yaml";
const TRIANGLE: &str = "lif/example_07.lif.json";
const CROSSING: &str = "lif/example_08.lif.json";
const TOWN_1: &str = "opendrive/Town01.planview.xodr";
const TOWN_2: &str = "opendrive/Town02.planview.xodr";
const ROADMAP: &str = "ccbs/sparse_map.xml";

const fn whole(file: &'static str, radius: f64, target: ExclusionFormat) -> Written {
    Written { file, radius, target, envelopes: false, split: None }
}

const fn cut(file: &'static str, radius: f64, target: ExclusionFormat, to: f64) -> Written {
    Written { split: Some(to), ..whole(file, radius, target) }
}

/// All of them.
pub const ALL: [Written; 40] = [
    whole(WAREHOUSE, 0.4, ExclusionFormat::Nav2),
    whole(AWS, 0.3, ExclusionFormat::Nav2),
    whole(SAMPLE, 0.3, ExclusionFormat::Nav2),
    cut(WAREHOUSE, 0.4, ExclusionFormat::Nav2, 1.5),
    whole(OFFICE, 0.45, ExclusionFormat::Rmf),
    whole(TRIPLE_H, 0.45, ExclusionFormat::Rmf),
    whole(BATTLE_ROYALE, 0.45, ExclusionFormat::Rmf),
    whole(HOTEL, 0.45, ExclusionFormat::Rmf),
    cut(OFFICE, 0.3, ExclusionFormat::Rmf, 1.0),
    whole(DEMO, 0.9, ExclusionFormat::OpenTcs),
    cut(DEMO, 0.9, ExclusionFormat::OpenTcs, 2.0),
    Written { envelopes: true, ..whole(DEMO, 0.9, ExclusionFormat::OpenTcs) },
    Written { envelopes: true, ..cut(DEMO, 0.9, ExclusionFormat::OpenTcs, 2.0) },
    whole(WAREHOUSE, 0.4, ExclusionFormat::Vda5050),
    whole(SAMPLE, 0.3, ExclusionFormat::Vda5050),
    cut(SAMPLE, 0.3, ExclusionFormat::Vda5050, 0.8),
    whole(AWS, 0.3, ExclusionFormat::Vda5050),
    whole(OFFICE, 0.3, ExclusionFormat::Vda5050),
    whole(TRIPLE_H, 0.45, ExclusionFormat::Vda5050),
    whole(BATTLE_ROYALE, 0.45, ExclusionFormat::Vda5050),
    whole(HOTEL, 0.45, ExclusionFormat::Vda5050),
    whole(DEMO, 0.9, ExclusionFormat::Vda5050),
    whole(TRIANGLE, 0.4, ExclusionFormat::Vda5050),
    whole(CROSSING, 0.4, ExclusionFormat::Vda5050),
    whole(TOWN_1, 1.0, ExclusionFormat::Vda5050),
    whole(TOWN_2, 1.0, ExclusionFormat::Vda5050),
    whole(ROADMAP, 0.5, ExclusionFormat::Vda5050),
    whole(WAREHOUSE, 0.4, ExclusionFormat::Pcr),
    whole(AWS, 0.3, ExclusionFormat::Pcr),
    whole(SAMPLE, 0.3, ExclusionFormat::Pcr),
    whole(OFFICE, 0.45, ExclusionFormat::Pcr),
    whole(TRIPLE_H, 0.45, ExclusionFormat::Pcr),
    whole(BATTLE_ROYALE, 0.45, ExclusionFormat::Pcr),
    whole(HOTEL, 0.45, ExclusionFormat::Pcr),
    whole(DEMO, 0.9, ExclusionFormat::Pcr),
    whole(TRIANGLE, 0.4, ExclusionFormat::Pcr),
    whole(CROSSING, 0.4, ExclusionFormat::Pcr),
    whole(TOWN_1, 1.0, ExclusionFormat::Pcr),
    whole(TOWN_2, 1.0, ExclusionFormat::Pcr),
    whole(ROADMAP, 0.5, ExclusionFormat::Pcr),
];

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.file, if self.envelopes { "envelopes".to_owned() } else { self.target.to_string() })?;
        self.split.map_or(Ok(()), |to| write!(f, ", cut to {to} m"))
    }
}

impl Written {
    /// Writes it, reads it again, and lets vehicles do so many random missions.
    ///
    /// # Errors
    /// Why it cannot be read or written.
    pub fn obeyed(&self, missions: usize, seed: u64) -> Result<(exclusions::WriteReport, Run), Box<dyn Error>> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/real").join(self.file);
        let text = std::fs::read_to_string(&path)?;
        let format = InputFormat::detect(&path, &text).ok_or("no layout")?;
        let options = ImportOptions { radius: Some(self.radius), ..ImportOptions::default() };
        let envelopes = self.envelopes.then(|| "pcr".to_owned());
        let settings = WriteOptions { target: self.target, split: self.split, envelopes };
        let (written, report, _) = write(format, &text, &options, "site", &settings)?;
        let geometry = if self.target.layout().is_some() { &written } else { &text };
        let mut imported = layout(format, geometry, &options, &mut Warnings::default())?;
        if imported.layout.name.is_empty() {
            imported.layout.name = "site".into();
        }
        let rules = read(self.target, &written, &imported)?;
        Ok((report, run(&imported, &rules, missions, seed)))
    }
}
