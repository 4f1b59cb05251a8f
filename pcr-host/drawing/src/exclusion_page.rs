//! The page of a layout and its locks; a selected edge shows the lengths that it blocks.

use super::layout::{STEPS, bounds, line, swept_area};
use super::template::PageTemplate;
use pcr_exclusions::{ExclusionAudit, ExclusionRules};
use pcr_formats::import::{ElementId, ImportedLayout};
use pcr_formats::scenario::PlacedSegment;
use pcr_planning::exclusion_table::{EdgeTraversals, ExclusionTable, corridor};
use serde_json::{Value, json};
use std::collections::HashMap;

const PAGE: PageTemplate = PageTemplate {
    kind: "locks",
    connect: "",
    body: include_str!("locks/locks.html"),
    style: concat!(include_str!("locks/locks.css"), include_str!("locks/layers.css")),
    script: concat!(include_str!("locks/locks.js"), include_str!("locks/layers.js"), include_str!("locks/print.js")),
};

/// The page.
pub(super) fn page(imported: &ImportedLayout, locks: &ExclusionTable) -> String {
    let name = if imported.layout.name.is_empty() { "Layout" } else { &imported.layout.name };
    PAGE.fill(name, &data(imported, locks))
}

/// The page with what an audit has found, as layers: groups as written, what they leave out, and what they exclude in vain.
pub(super) fn page_of_audit(
    imported: &ImportedLayout,
    locks: &ExclusionTable,
    rules: &ExclusionRules,
    audit: &ExclusionAudit,
) -> String {
    let name = if imported.layout.name.is_empty() { "Layout" } else { &imported.layout.name };
    let mut all = data(imported, locks);
    all["audit"] = super::audit::layers(imported, rules, audit);
    PAGE.fill(name, &all)
}

/// Numbers of the page: lengths of edges in metres, all else in steps of a millimetre, y up.
fn data(imported: &ImportedLayout, locks: &ExclusionTable) -> Value {
    let (layout, vehicle) = (&imported.layout, &locks.vehicle);
    let steps = |point: [f64; 2]| point.map(|x| x * STEPS);
    let rides = EdgeTraversals::new(imported);
    let edges = layout.edges.iter().map(|edge| {
        let ends = edge.ends.map(|node| layout.nodes.get(node).map(|node| node.id.to_string()).unwrap_or_default());
        let back: Vec<PlacedSegment> = edge.curve.iter().rev().map(PlacedSegment::reversed).collect();
        let corridor = corridor(&rides.on_edge(edge)).into_iter();
        json!({
            "id": edge.id.to_string(),
            "ends": ends,
            "level": layout.level(edge),
            "length": edge.length(),
            "corridor": corridor.map(|shape| swept_area(&shape)).collect::<Vec<_>>(),
            "path": line(&edge.curve),
            "back": line(&back),
        })
    });
    let corners =
        imported.vehicle.footprint.iter().flat_map(|footprint| footprint.polygon()).map(|corner| steps(*corner));
    let nodes = layout.nodes.iter().map(|node| {
        let [x, y] = steps(node.point);
        json!({ "id": node.id.to_string(), "level": node.level, "x": x, "y": y })
    });
    let places: HashMap<&ElementId, usize> = layout.edges.iter().enumerate().map(|(k, edge)| (&edge.id, k)).collect();
    // Six numbers a lock, in one list: a roadmap has a million of them.
    let locks = locks.locks.iter().filter_map(|lock| {
        let [a, b] = [places.get(&lock.a)?, places.get(&lock.b)?].map(|&place| place as u64);
        Some([[a, b], outward(lock.a_length), outward(lock.b_length)])
    });
    let [x, y] = bounds(layout, None, vehicle.radius);
    let bounds = [x.lo, -y.hi, x.length(), y.length()].map(|length| length * STEPS);
    json!({
        "radius": vehicle.radius,
        "footprint": corners.collect::<Vec<_>>(),
        "levels": layout.levels,
        "bounds": bounds,
        "edges": edges.collect::<Vec<_>>(),
        "nodes": nodes.collect::<Vec<_>>(),
        "locks": locks.collect::<Vec<_>>().as_flattened().as_flattened(),
    })
}

/// Lengths in millimetres, outward.
fn outward([from, to]: [f64; 2]) -> [u64; 2] {
    // What rounding adds is no millimetre; a cast saturates.
    [(from * STEPS + 1e-6).floor() as u64, (to * STEPS - 1e-6).ceil() as u64]
}

#[cfg(test)]
mod tests {
    use super::super::layout::LayoutLevelView;
    #[cfg(feature = "png")]
    use super::super::write_locks;
    use super::*;
    use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout};

    /// A layout that others made. It is in the repository, and not in the package of this crate.
    fn real(name: &str) -> String {
        let file = format!("{}/../../tests/data/real/{name}", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(&file).expect(&file)
    }

    fn imported(format: InputFormat, text: &str) -> ImportedLayout {
        let options = ImportOptions { radius: Some(0.4), ..ImportOptions::default() };
        layout(format, text, &options, &mut Warnings::default()).unwrap()
    }

    #[test]
    fn the_page_holds_every_edge_and_lock_and_asks_for_nothing() {
        let text = real("nav2/warehouse_graph.geojson");
        let imported = imported(InputFormat::Nav2, &text.replace("warehouse_graph", "</script><script>alert(1)"));
        let locks = ExclusionTable::compute(&imported, false).unwrap();
        let page = page(&imported, &locks);
        assert_eq!((page.matches("</script>").count(), page.matches("<script>alert").count()), (2, 0));
        for request in ["src=", "href=", "@import", "url(", "fetch(", "import("] {
            assert!(!page.contains(request), "{request}");
        }
        let (_, rest) = page.split_once(r#"<script type="application/json" id="data">"#).unwrap();
        let data: Value = serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap();
        assert_eq!(data["edges"].as_array().unwrap().len(), 172);
        assert_eq!(data["locks"].as_array().unwrap().len(), 6 * locks.locks.len());
        assert!(!locks.locks.is_empty());
    }

    #[test]
    fn curves_are_drawn_with_true_arcs() {
        let imported = imported(InputFormat::Lif, &real("lif/example_17.lif.json"));
        let svg = LayoutLevelView { imported: &imported, level: 0 }.picture();
        let document = roxmltree::Document::parse(&svg).unwrap();
        let arcs = document.descendants().filter_map(|node| node.attribute("d")).map(|data| data.matches('A').count());
        // Corridor and line of each edge.
        let pieces: usize = imported.layout.edges.iter().map(|edge| edge.curve.len()).sum();
        assert_eq!(arcs.sum::<usize>(), 2 * pieces);
        assert!(!svg.contains("NaN"));
    }

    #[cfg(feature = "png")]
    #[test]
    fn files_are_written_for_every_level() {
        let imported = imported(InputFormat::Lif, &real("lif/example_05.lif.json"));
        let locks = ExclusionTable::compute(&imported, false).unwrap();
        let directory = std::env::temp_dir().join(format!("pcr-locks-{}", std::process::id()));
        let files = write_locks(&imported, &locks, &directory).unwrap().files;
        let names: Vec<_> = files.iter().map(|file| file.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(names, ["layout.svg", "layout.png", "layout-2.svg", "layout-2.png", "locks.html"]);
        std::fs::remove_dir_all(directory).unwrap();
    }
}
