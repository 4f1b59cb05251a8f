//! Layouts that change edge by edge: the locks are those of a table that is made anew, and few pairs are looked at.

use pcr_formats::import::{ElementId, ImportOptions, ImportedLayout, InputFormat, LayoutEdge, Warnings, layout};
use pcr_formats::scenario::PlacedSegment;
use pcr_planning::exclusion_table::{EdgeExclusion, ExclusionChange, ExclusionTable, IncrementalExclusions};
use std::collections::HashSet;

const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");
const FACTSHEET: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json");

fn warehouse(options: ImportOptions) -> ImportedLayout {
    layout(InputFormat::Nav2, WAREHOUSE, &options, &mut Warnings::default()).unwrap()
}

fn disc() -> ImportedLayout {
    warehouse(ImportOptions { radius: Some(0.4), ..ImportOptions::default() })
}

/// The table after a change.
fn changed(mut locks: Vec<EdgeExclusion>, change: &ExclusionChange) -> Vec<EdgeExclusion> {
    let void: HashSet<&ElementId> = change.edges.iter().collect();
    locks.retain(|lock| !void.contains(&lock.a) && !void.contains(&lock.b));
    locks.extend(change.locks.iter().cloned());
    let lengths = |lock: &EdgeExclusion| [lock.a_length, lock.b_length].map(|[from, _]| from);
    locks.sort_by(|a, b| (&a.a, &a.b, lengths(a)).partial_cmp(&(&b.a, &b.b, lengths(b))).expect("no NaN"));
    locks
}

#[track_caller]
fn same(ours: &[EdgeExclusion], imported: &ImportedLayout) {
    let anew = ExclusionTable::compute(imported, false).unwrap().locks;
    assert_eq!(ours.len(), anew.len());
    for (a, b) in ours.iter().zip(&anew) {
        let near = |a: [f64; 2], b: [f64; 2]| (0..2).all(|end| (a[end] - b[end]).abs() < 1e-9);
        assert_eq!((&a.a, &a.b), (&b.a, &b.b));
        assert!(near(a.a_length, b.a_length) && near(a.b_length, b.b_length), "{a:?} {b:?}");
    }
}

/// The edge, with its end moved.
fn moved(imported: &ImportedLayout, edge: &LayoutEdge) -> LayoutEdge {
    let [from, _] = edge.ends.map(|node| imported.layout.nodes[node].point);
    let far =
        imported.layout.nodes.iter().position(|node| (node.point[0] - from[0]).hypot(node.point[1] - from[1]) > 3.0);
    let to = far.unwrap();
    LayoutEdge {
        ends: [edge.ends[0], to],
        curve: vec![PlacedSegment::line(from, imported.layout.nodes[to].point)],
        deviation: 0.0,
        ..edge.clone()
    }
}

/// Of every so many-th edge.
fn runs_through_changes(imported: ImportedLayout, step_by: usize) {
    let mut locks = ExclusionTable::compute(&imported, false).unwrap().locks;
    let edges = imported.layout.edges.clone();
    let mut table = IncrementalExclusions::new(imported).unwrap();
    for edge in edges.iter().step_by(step_by) {
        for step in 0..3 {
            let change = match step {
                0 => table.remove(&edge.id).unwrap(),
                1 => table.insert(moved(table.imported(), edge)).unwrap(),
                _ => table.insert(edge.clone()).unwrap(),
            };
            locks = changed(locks, &change);
            same(&locks, table.imported());
        }
    }
}

#[test]
fn changes_of_discs_are_those_of_a_new_table() {
    runs_through_changes(disc(), 61);
}

#[test]
fn changes_of_outlines_renew_the_turns_at_both_ends() {
    runs_through_changes(warehouse(ImportOptions { fleet: Some(FACTSHEET.into()), ..ImportOptions::default() }), 172);
}

#[test]
fn what_is_no_edge_changes_nothing() {
    let imported = disc();
    let locks = ExclusionTable::compute(&imported, false).unwrap().locks;
    let edge = imported.layout.edges[5].clone();
    let mut table = IncrementalExclusions::new(imported).unwrap();
    assert!(table.remove(&ElementId::Text("nowhere".into())).is_err());
    assert!(table.insert(LayoutEdge { ends: [0, usize::MAX], ..edge.clone() }).is_err());
    let far = PlacedSegment::line([0.0, 0.0], [1e11, 0.0]);
    assert!(table.insert(LayoutEdge { curve: vec![far], ..edge }).is_err());
    same(&locks, table.imported());
}

/// A lattice of so many nodes on each side, with an edge to the right and one up from each: a table of a larger one costs no
/// more to change.
#[test]
fn a_change_looks_at_what_is_near_alone() {
    let looked = [10, 40].map(|side: usize| {
        let mut text = String::from("<graphml><graph edgedefault=\"undirected\">");
        for k in 0..side * side {
            text += &format!("<node id=\"n{k}\"><data>{},{}</data></node>", k / side, k % side);
        }
        for k in 0..side * side {
            let next = [(k % side + 1 < side).then_some(k + 1), (k / side + 1 < side).then_some(k + side)];
            for (way, to) in next.into_iter().enumerate().filter_map(|(way, to)| Some((way, to?))) {
                text += &format!("<edge id=\"e{k}-{way}\" source=\"n{k}\" target=\"n{to}\"/>");
            }
        }
        let options = ImportOptions { radius: Some(0.3), ..ImportOptions::default() };
        let imported =
            layout(InputFormat::Ccbs, &(text + "</graph></graphml>"), &options, &mut Warnings::default()).unwrap();
        let edge = imported.layout.edges[imported.layout.edges.len() / 2].clone();
        IncrementalExclusions::new(imported).unwrap().insert(edge).unwrap().looked
    });
    assert!(looked[0] > 5 && looked[0] == looked[1], "{looked:?}");
}
