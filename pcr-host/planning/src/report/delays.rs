//! Tables of unsafe delays, for programs and for reading.

use super::locks::ExclusionOutputError;
use super::text_table::TextTable;
use super::{VersionedReport, counted, json, printable, quoted};
use crate::exclusion_table::{
    DelayProof, EdgeDriving, ExclusionTable, ExclusionVehicle, ForbiddenDelays, SyncProgressFn, UnsafeDelayModel,
    UnsafeRelation,
};
use crate::figures::{given, outward_but_for_rounding, small, thousandths};
use crate::memory_budget;
use pcr_formats::import::{ElementId, ImportError};
use serde::Serialize;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::io::{self, Write};

/// The header line of [`delays_csv`].
pub const DELAYS_HEADER: &str = "a,a_direction,b,b_direction,from,to\n";

/// The unsafe delays of a layout.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnsafeDelayReport {
    /// Name of the layout.
    pub layout: String,
    /// The vehicle.
    pub vehicle: ExclusionVehicle,
    /// How edges are driven.
    #[serde(flatten)]
    pub driving: EdgeDriving,
    /// Sorted by `a`, then `b`; intervals of a pair are disjoint.
    pub delays: Vec<UnsafeDelay>,
    /// Times at which no vehicle may stand at a node, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nodes: Option<Vec<UnsafeNodeTimes>>,
    /// Nodes at which vehicles cannot stand at the same time, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub node_pairs: Option<Vec<[ElementId; 2]>>,
    /// The proof that all other delays are free, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<DelayProof>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

/// How much later than on `a` a vehicle may not set off on `b`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnsafeDelay {
    /// Edge, as in the layout.
    pub a: ElementId,
    /// Whether it is driven from its end.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub a_backward: bool,
    /// Edge, `a` or after it.
    pub b: ElementId,
    /// Whether it is driven from its end.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub b_backward: bool,
    /// From and to; less than 0 is earlier \[s\].
    pub delay: [f64; 2],
}

/// The times after a start on an edge at which no vehicle may stand at a node.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnsafeNodeTimes {
    /// Id of the node in the layout.
    pub node: ElementId,
    /// Edge.
    pub edge: ElementId,
    /// Whether it is driven from its end.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub backward: bool,
    /// From and to \[s\].
    pub time: [f64; 2],
}

impl VersionedReport for UnsafeDelayReport {
    const FORMAT: &'static str = "pcr-delays";
    const VERSION: u32 = super::LOCKS_VERSION;
}

impl UnsafeDelayReport {
    /// The whole table; `head` is the one of locks without its locks.
    ///
    /// # Errors
    /// Errors of [`UnsafeDelayModel::each`], and an error for a table that does not fit in memory.
    pub fn collect(
        head: ExclusionTable,
        driving: EdgeDriving,
        delays: &UnsafeDelayModel,
        told: SyncProgressFn<'_>,
    ) -> Result<Self, ImportError> {
        let ExclusionTable { layout, vehicle, nodes, node_pairs, warnings, .. } = head;
        let (nodes, node_pairs) = (nodes.map(|_| Vec::new()), node_pairs.map(|_| Vec::new()));
        let delays_found = Vec::new();
        let mut table =
            Self { layout, vehicle, driving, delays: delays_found, nodes, node_pairs, certificate: None, warnings };
        let mut held = 0;
        delays.each(told, &<[UnsafeRelation]>::to_vec, |found| {
            held += found.len() as u64 * (size_of::<UnsafeDelay>() + 64) as u64;
            if held > memory_budget::STEP {
                let count = table.delays.len();
                memory_budget::ask(held + 2 * (count * size_of::<UnsafeDelay>()) as u64, || {
                    format!("a table of over {count} delays")
                })
                .map_err(|large| ImportError::new(large.to_string()))?;
                held = 0;
            }
            found.into_iter().for_each(|found| table.add(delays, found));
            Ok::<(), ImportError>(())
        })?;
        Ok(table)
    }

    /// Adds the proof that with no delay but those of the table two vehicles touch, as far as there is one.
    ///
    /// # Errors
    /// [`ImportError`] for a row whose edge `delays` does not have, for a motion that the checker refuses, and for what does not fit in
    /// memory.
    pub fn certify(&mut self, delays: &UnsafeDelayModel, told: SyncProgressFn<'_>) -> Result<(), ImportError> {
        let ways: HashMap<(&ElementId, bool), usize> =
            delays.ways().iter().enumerate().map(|(place, way)| ((&way.edge, way.backward), place)).collect();
        let way = |edge: &ElementId, backward: bool| {
            let found = ways.get(&(edge, backward)).copied();
            found.ok_or_else(|| ImportError::new(format!("there is no edge {edge} in this direction")))
        };
        let mut forbidden = ForbiddenDelays::new();
        for row in &self.delays {
            let [a, b] = [way(&row.a, row.a_backward)?, way(&row.b, row.b_backward)?];
            let [from, to] = row.delay;
            let (ways, interval) = if a <= b { ([a, b], [from, to]) } else { ([b, a], [-to, -from]) };
            forbidden.entry(ways).or_default().push(interval);
        }
        forbidden.values_mut().for_each(|intervals| intervals.sort_by(|a, b| a[0].total_cmp(&b[0])));
        self.certificate = Some(delays.proof(&forbidden, told)?);
        Ok(())
    }

    fn add(&mut self, of: &UnsafeDelayModel, found: UnsafeRelation) {
        let node = |place: usize| of.nodes()[place].clone();
        match found {
            UnsafeRelation::Delays(ways, delay) => {
                let [a, b] = ways.map(|place| of.ways()[place].clone());
                let (a_backward, b_backward) = (a.backward, b.backward);
                self.delays.push(UnsafeDelay { a: a.edge, a_backward, b: b.edge, b_backward, delay });
            }
            UnsafeRelation::Times(at, way, time) => {
                let way = of.ways()[way].clone();
                let times = UnsafeNodeTimes { node: node(at), edge: way.edge, backward: way.backward, time };
                self.nodes.get_or_insert_default().push(times);
            }
            UnsafeRelation::Nodes(pair) => self.node_pairs.get_or_insert_default().push(pair.map(node)),
        }
    }
}

/// A line a delay. A node is `node` and its name, as `a`; two nodes have no times.
///
/// # Errors
/// Errors of the writer, and of [`UnsafeDelayModel::each`].
pub fn delays_csv(
    delays: &UnsafeDelayModel,
    told: SyncProgressFn<'_>,
    out: &mut dyn Write,
) -> Result<(), ExclusionOutputError> {
    out.write_all(DELAYS_HEADER.as_bytes())?;
    let direction = |backward| if backward { "backward" } else { "forward" };
    let way = |way: &crate::exclusion_table::DirectedEdge| {
        format!("{},{}", quoted(&way.edge.to_string()), direction(way.backward))
    };
    let ways: Vec<String> = delays.ways().iter().map(way).collect();
    let node = |node: &ElementId| format!("{},", quoted(&format!("node {node}")));
    let nodes: Vec<String> = delays.nodes().iter().map(node).collect();
    let lines = |found: &[UnsafeRelation]| {
        let mut text = String::with_capacity(80 * found.len());
        for found in found {
            // Writing to a `String` does not fail.
            let _ = match *found {
                UnsafeRelation::Delays([a, b], [from, to]) => writeln!(text, "{},{},{from},{to}", ways[a], ways[b]),
                UnsafeRelation::Times(at, way, [from, to]) => writeln!(text, "{},{},{from},{to}", nodes[at], ways[way]),
                UnsafeRelation::Nodes([a, b]) => writeln!(text, "{},{},,", nodes[a], nodes[b]),
            };
        }
        text
    };
    delays.each(told, &lines, |text| Ok::<(), ExclusionOutputError>(out.write_all(text.as_bytes())?))
}

/// The first line of [`delays_lines`].
#[derive(Serialize)]
struct DelayReportHeader<'a> {
    layout: &'a str,
    vehicle: &'a ExclusionVehicle,
    #[serde(flatten)]
    driving: EdgeDriving,
    warnings: &'a [String],
}

impl VersionedReport for DelayReportHeader<'_> {
    const FORMAT: &'static str = "pcr-delay-lines";
    const VERSION: u32 = super::LOCKS_VERSION;
}

/// JSON Lines: what the table is, then a line a delay as in the document `pcr-delays`, then how many there were: what has no such
/// line was cut off.
///
/// # Errors
/// As [`delays_csv`].
pub fn delays_lines(
    head: &ExclusionTable,
    driving: EdgeDriving,
    delays: &UnsafeDelayModel,
    told: SyncProgressFn<'_>,
    out: &mut dyn Write,
) -> Result<(), ExclusionOutputError> {
    json(&DelayReportHeader { layout: &head.layout, vehicle: &head.vehicle, driving, warnings: &head.warnings }, out)?;
    let names = |ids: &mut dyn Iterator<Item = &ElementId>| {
        ids.map(serde_json::to_string).collect::<Result<Vec<String>, _>>().map_err(io::Error::from)
    };
    let nodes = names(&mut delays.nodes().iter())?;
    let ways = names(&mut delays.ways().iter().map(|way| &way.edge))?;
    let turned = |way: usize, field: &str| {
        if delays.ways()[way].backward { format!(r#","{field}":true"#) } else { String::new() }
    };
    let lines = |found: &[UnsafeRelation]| {
        let mut text = String::with_capacity(100 * found.len());
        for found in found {
            let _ = match *found {
                UnsafeRelation::Delays([a, b], [from, to]) => {
                    let (a_turned, b_turned) = (turned(a, "a_backward"), turned(b, "b_backward"));
                    let (a, b) = (&ways[a], &ways[b]);
                    writeln!(text, r#"{{"a":{a}{a_turned},"b":{b}{b_turned},"delay":[{from:?},{to:?}]}}"#)
                }
                UnsafeRelation::Times(at, way, [from, to]) => {
                    let (node, edge, turned) = (&nodes[at], &ways[way], turned(way, "backward"));
                    writeln!(text, r#"{{"node":{node},"edge":{edge}{turned},"time":[{from:?},{to:?}]}}"#)
                }
                UnsafeRelation::Nodes([a, b]) => writeln!(text, r#"{{"nodes":[{},{}]}}"#, nodes[a], nodes[b]),
            };
        }
        (found.len(), text)
    };
    let mut count = 0;
    delays.each(told, &lines, |(lines, text)| {
        count += lines;
        Ok::<(), ExclusionOutputError>(out.write_all(text.as_bytes())?)
    })?;
    Ok(writeln!(out, r#"{{"delays":{count}}}"#)?)
}

/// The delays in columns, times outward to the millisecond.
///
/// # Errors
/// Errors of the writer.
pub fn delays_table(table: &UnsafeDelayReport, out: &mut dyn Write) -> io::Result<()> {
    let name = if table.layout.is_empty() { "layout" } else { &table.layout };
    let (count, EdgeDriving { speed, acceleration }) = (table.delays.len(), table.driving);
    let how = match acceleration {
        Some(acceleration) => format!("from rest to rest with {speed} m/s and {acceleration} m/s²"),
        None => format!("at {speed} m/s"),
    };
    let (name, radius) = (printable(name), given(table.vehicle.radius));
    writeln!(out, "{name}: {} of unsafe delays, radius {radius} m, {how}", counted(count, "interval"))?;
    let text = |id: &ElementId, backward: bool| printable(&format!("{id}{}", if backward { " backward" } else { "" }));
    if count > 0 {
        let mut columns = TextTable::new(&["<a", "<b", "b later by [s]", "to"]);
        for UnsafeDelay { a, a_backward, b, b_backward, delay } in &table.delays {
            columns.row([[text(a, *a_backward), text(b, *b_backward)], outward_but_for_rounding(*delay)].concat());
        }
        columns.write(out)?;
    }
    if let Some(nodes) = &table.nodes {
        writeln!(out, "{} of times at nodes", counted(nodes.len(), "interval"))?;
        let mut columns = TextTable::new(&["<node", "<edge", "from [s]", "to"]);
        for UnsafeNodeTimes { node, edge, backward, time } in nodes {
            columns.row([[text(node, false), text(edge, *backward)], outward_but_for_rounding(*time)].concat());
        }
        columns.write(out)?;
    }
    for [a, b] in table.node_pairs.iter().flatten() {
        writeln!(out, "  nodes {} and {}", text(a, false), text(b, false))?;
    }
    if let Some(proof) = &table.certificate {
        writeln!(out, "{}", delay_proof_line(proof))?;
    }
    Ok(())
}

/// A line about a proof of delays.
fn delay_proof_line(proof: &DelayProof) -> String {
    let pairs = counted(proof.pairs, "pair");
    let (count, kind) = match proof.verdict {
        "proved" => return format!("certificate: no contact at any other delay, proved ({pairs} of edges)"),
        "refuted" => (proof.refuted, "contact"),
        _ => (proof.undecided, "not decided"),
    };
    let first = proof.open.first().map_or(String::new(), |first| {
        let name =
            |id: &ElementId, backward: bool| printable(&format!("{id}{}", if backward { " backward" } else { "" }));
        let (a, b) = (name(&first.a, first.a_backward), name(&first.b, first.b_backward));
        let clearance =
            if first.clearance.is_nan() { "unknown".into() } else { format!("{} m", small(first.clearance)) };
        let (delay, time) = (thousandths(first.delay), thousandths(first.time));
        format!(", such as {a} and {b}, {delay} s later: clearance {clearance} at {time} s")
    });
    format!("certificate: {kind}, {count} of {pairs} of edges{first}")
}
