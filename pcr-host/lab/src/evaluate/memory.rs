//! The memory that is needed for a collision, and the bytes to transmit it.

use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness};
use crate::methods::methods;
use pcr_comparing::compare::MethodAnswer;
use pcr_comparing::compare::{ComparisonInput, MethodQuestion};
use pcr_planning::figures::bytes;
use pcr_planning::regions::{self, RegionOptions};
use std::fmt::Write as _;

pub(super) fn section(fleets: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let mut text = String::from("## Memory, and bytes on the wire\n\nThe paper's 12 agents.\n\n");
    let Some(fleet) = fleets.paper12() else { return Ok(DocumentSection { text, pictures: Vec::new() }) };
    text.push_str("| what | all of it | a region |\n|---|---:|---:|\n");
    let answer = regions::RegionsReport::compute::<f64>(&fleet.scenario, RegionOptions::default())?;
    let count = answer.regions.len() as f64;
    let mut row = |what: &str, size: usize| {
        let _ = writeln!(text, "| {what} | {} | {} |", bytes(size), bytes((size as f64 / count).round() as usize));
    };
    let input = ComparisonInput::new(&fleet.scenario)?;
    let field = input.field();
    let kept = match extent {
        Thoroughness::Full => {
            &["pcr f64", "pcr f32", "pcr q16", "sampled map 0.1 s, boxes", "sampled map 0.01 s, boxes"][..]
        }
        Thoroughness::Quick => &["pcr f64", "sampled map 0.1 s, boxes"],
    };
    for method in methods().iter().filter(|method| method.question() == MethodQuestion::Regions) {
        if let (true, Ok(MethodAnswer::Regions(regions))) = (kept.contains(&&*method.name()), method.answer(&field)) {
            row(&format!("{}, as kept", method.name()), regions.bytes());
        }
    }
    // Nine numbers: the paper's table says seven, but an arc against an arc needs nine.
    let crossings: usize =
        answer.regions.iter().flat_map(|region| &region.pieces).map(|piece| piece.crossings.len()).sum();
    row("the paper's descriptors, nine `f32` a crossing", crossings * 9 * size_of::<f32>());
    let json = |value: Result<String, serde_json::Error>| value.map_or(0, |text| text.len());
    row("`pcr regions --format json`", json(serde_json::to_string(&answer)));
    row("the scenario, from which any receiver computes them", fleet.scenario.to_json().len());
    text.push_str(
        "\nA region is stored once for both directions of a pair and counts twice here. firmware/README.md has the bytes of single \
        regions and pieces in the serial protocol.\n",
    );
    Ok(DocumentSection { text, pictures: Vec::new() })
}
