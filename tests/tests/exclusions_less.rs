//! Files from which one exclusion is taken out: the audit names what can touch then, and vehicles that obey what is left do touch. So
//! the tests that nothing touches can fail, for every format.

use pcr_exclusions::{ExclusionAudit, ExclusionFormat, ExclusionRules, WriteOptions, read, write};
use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Warnings, layout};
use pcr_planning::exclusion_table::ExclusionTable;
use pcr_tests::rules::run;
use serde_json::Value;

const SAMPLE: &str = include_str!("../data/real/nav2/sample_graph.geojson");
const DEMO: &str = include_str!("../data/real/opentcs/Demo-01.xml");
const OFFICE: &str = include_str!("../data/real/rmf/office.building.yaml");

/// A written file, its layout, and how it is read.
struct File {
    target: ExclusionFormat,
    text: String,
    imported: ImportedLayout,
    locks: ExclusionTable,
}

impl File {
    fn of(format: InputFormat, text: &str, radius: f64, target: ExclusionFormat, envelopes: Option<&str>) -> Self {
        let options = ImportOptions { radius: Some(radius), ..ImportOptions::default() };
        let settings = WriteOptions { target, split: None, envelopes: envelopes.map(str::to_owned) };
        let (written, _, audit) = write(format, text, &options, "site", &settings).unwrap();
        assert!(audit.suffices());
        let geometry = if target.layout().is_some() { &written } else { text };
        let mut imported = layout(format, geometry, &options, &mut Warnings::default()).unwrap();
        if imported.layout.name.is_empty() {
            imported.layout.name = "site".into();
        }
        let locks = ExclusionTable::compute(&imported, true).unwrap();
        Self { target, text: written, imported, locks }
    }

    fn rules(&self, text: &str) -> ExclusionRules {
        read(self.target, text, &self.imported).unwrap()
    }

    /// Of texts with one exclusion less, how many leave something that can touch; of those, vehicles drive by every `step`th until two of them touch.
    fn missed(&self, less: &[String], step: usize) -> usize {
        let found = |text: &&String| {
            assert_ne!(**text, self.text);
            !ExclusionAudit::run(&self.imported, &self.locks, &self.rules(text), self.target).unwrap().suffices()
        };
        let open: Vec<&String> = less.iter().filter(found).collect();
        let touch =
            open.iter().step_by(step).any(|text| !run(&self.imported, &self.rules(text), 1000, 7).contacts.is_empty());
        assert!(touch, "{}: vehicles keep apart without what is taken out", self.target);
        open.len()
    }
}

#[test]
fn every_entry_of_a_list_of_closed_edges_is_missed() {
    let file = File::of(InputFormat::Nav2, SAMPLE, 0.3, ExclusionFormat::Nav2, None);
    let root: Value = serde_json::from_str(&file.text).unwrap();
    let mut less = Vec::new();
    for (k, feature) in root["features"].as_array().unwrap().iter().enumerate() {
        let list = feature["properties"]["metadata"]["closed_edges"].as_array().unwrap();
        for entry in 0..list.len() {
            let mut root = root.clone();
            root["features"][k]["properties"]["metadata"]["closed_edges"].as_array_mut().unwrap().remove(entry);
            less.push(root.to_string());
        }
    }
    assert!(less.len() > 100);
    assert_eq!(file.missed(&less, 10), less.len());
}

#[test]
fn the_group_of_every_lane_and_vertex_is_missed() {
    let file = File::of(InputFormat::Rmf, OFFICE, 0.45, ExclusionFormat::Rmf, None);
    let groups: Vec<(usize, &str)> = file.text.match_indices("mutex: [1, \"pcr/").collect();
    let less: Vec<String> = groups
        .iter()
        .map(|&(at, start)| {
            let end = at + file.text[at..].find("\"]").unwrap();
            format!("{}{}", &file.text[..at + start.len() - "pcr/".len()], &file.text[end..])
        })
        .collect();
    assert!(less.len() > 80);
    // The two lanes between two vertices that have one group have it of the vertex ahead as well.
    assert_eq!(file.missed(&less, 10), less.len() - 2);
}

#[test]
fn every_block_is_missed() {
    let file = File::of(InputFormat::OpenTcs, DEMO, 0.9, ExclusionFormat::OpenTcs, None);
    let blocks: Vec<(usize, &str)> = file.text.match_indices("<block name=\"pcr-block-").collect();
    let less: Vec<String> = blocks
        .iter()
        .map(|&(at, _)| {
            let end = at + file.text[at..].find("</block>").unwrap() + "</block>".len();
            format!("{}{}", &file.text[..at], &file.text[end..])
        })
        .collect();
    // Three more places are excluded by the blocks and envelopes that the file has itself.
    assert_eq!((less.len(), file.missed(&less, 1)), (3, 3));
    // A block of another type is none.
    let other: Vec<String> = blocks
        .iter()
        .map(|&(at, _)| {
            format!("{}{}", &file.text[..at], file.text[at..].replacen("SINGLE_VEHICLE_ONLY", "SAME_DIRECTION_ONLY", 1))
        })
        .collect();
    assert_eq!(file.missed(&other, 1), other.len());
}

#[test]
fn envelopes_and_zones_are_missed() {
    let file = File::of(InputFormat::OpenTcs, DEMO, 0.9, ExclusionFormat::OpenTcs, Some("pcr"));
    // Envelopes of points and paths do for one another where they overlap; without the key nobody has one.
    let envelopes: Vec<(usize, &str)> = file.text.match_indices("<vehicleEnvelope key=\"pcr\">").collect();
    let cut = |at: usize| {
        let end = at + file.text[at..].find("</vehicleEnvelope>").unwrap() + "</vehicleEnvelope>".len();
        format!("{}{}", &file.text[..at], &file.text[end..])
    };
    let less: Vec<String> = envelopes.iter().map(|&(at, _)| cut(at)).collect();
    let none = file.text.replacen("envelopeKey=\"pcr\"", "envelopeKey=\"other\"", 1);
    assert!(less.len() > 60);
    assert!(file.missed(&[less, vec![none]].concat(), 1) > 3);
    // Neither has anybody one where no envelope and no vehicle names a key.
    let nameless =
        file.text.replace(" envelopeKey=\"pcr\"", "").replace("<vehicleEnvelope key=\"pcr\">", "<vehicleEnvelope>");
    assert_eq!(file.missed(&[nameless], 1), 1);

    let file = File::of(InputFormat::Nav2, SAMPLE, 0.3, ExclusionFormat::Vda5050, None);
    let root: Value = serde_json::from_str(&file.text).unwrap();
    let without = |k: usize| {
        let mut root = root.clone();
        root["zoneSet"]["zones"].as_array_mut().unwrap().remove(k);
        root.to_string()
    };
    let less: Vec<String> = (0..root["zoneSet"]["zones"].as_array().unwrap().len()).map(without).collect();
    assert!(2 * file.missed(&less, 1) > less.len());
}
