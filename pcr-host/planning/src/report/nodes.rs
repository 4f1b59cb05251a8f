//! Nodes and edges of a layout as text.

use super::columns::Columns;
use super::figures::thousandths;
use super::{counted, heading, printable, quoted};
use crate::nodes::Listing;
use std::io::{self, Write};

/// A line a node, then a line an edge: numbers that read back exactly.
///
/// # Errors
/// Those of the writer.
pub fn nodes_csv(listing: &Listing<'_>, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "kind,id,names,level,x,y,from,to,length,two_way,speed")?;
    let text = |text: &dyn ToString| quoted(&text.to_string()).into_owned();
    for node in &listing.nodes {
        let ([x, y], names) = (node.at, text(&node.names.join(" ")));
        writeln!(out, "node,{},{names},{},{x},{y},,,,,", text(node.id), text(&node.level))?;
    }
    for edge in &listing.edges {
        let speed = edge.speed.map(|speed| speed.to_string()).unwrap_or_default();
        let (two_way, length) = (u8::from(edge.two_way), edge.length);
        writeln!(out, "edge,{},,,,,{},{},{length},{two_way},{speed}", text(edge.id), text(edge.from), text(edge.to))?;
    }
    Ok(())
}

/// The same in columns.
///
/// # Errors
/// Those of the writer.
pub fn nodes_table(listing: &Listing<'_>, out: &mut impl Write) -> io::Result<()> {
    let (nodes, edges) = (counted(listing.nodes.len(), "node"), counted(listing.edges.len(), "edge"));
    writeln!(out, "{}: {nodes}, {edges}", heading(listing.layout))?;
    let lists = [("levels", listing.levels), ("vehicle types", listing.vehicle_types), ("vehicles", listing.vehicles)];
    for (what, names) in lists {
        let names: Vec<String> = names.iter().filter(|name| !name.is_empty()).map(|name| printable(name)).collect();
        if !names.is_empty() {
            writeln!(out, "{what}: {}", names.join(", "))?;
        }
    }
    let mut columns = Columns::new(&["<node", "<names", "<level", "x [m]", "y [m]"]);
    for node in &listing.nodes {
        let [x, y] = node.at.map(thousandths);
        let names = printable(&node.names.join(" "));
        columns.row(vec![printable(&node.id.to_string()), names, printable(node.level), x, y]);
    }
    columns.write(out)?;
    writeln!(out)?;
    let mut columns = Columns::new(&["<edge", "<from", "<to", "length [m]", "<ways", "speed [m/s]"]);
    for edge in &listing.edges {
        let [id, from, to] = [edge.id, edge.from, edge.to].map(|id| printable(&id.to_string()));
        let speed = edge.speed.map_or_else(|| "-".to_owned(), thousandths);
        let ways = if edge.two_way { "both" } else { "one" };
        columns.row(vec![id, from, to, thousandths(edge.length), ways.to_owned(), speed]);
    }
    columns.write(out)
}
