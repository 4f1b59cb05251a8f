//! Nodes and edges of a layout as text.

use super::text_table::TextTable;
use super::{counted, heading, printable, quoted};
use crate::figures::thousandths;
use crate::nodes::{EdgeEntry, LayoutReport};
use std::io::{self, Write};

/// A line a node, then a line an edge: numbers that read back exactly.
///
/// # Errors
/// Errors of the writer.
pub fn nodes_csv(listing: &LayoutReport<'_>, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "kind,id,names,level,x,y,from,to,length,two_way,speed,speed_back,closed,backward")?;
    let text = |text: &dyn ToString| quoted(&text.to_string()).into_owned();
    for node in &listing.nodes {
        let ([x, y], names) = (node.at, text(&node.names.join(" ")));
        writeln!(out, "node,{},{names},{},{x},{y},,,,,,,,", text(node.id), text(&node.level))?;
    }
    for edge in &listing.edges {
        let [speed, back] =
            [edge.speed, edge.speed_back].map(|speed| speed.map_or_else(String::new, |it| it.to_string()));
        let ([id, from, to], length) = ([edge.id, edge.from, edge.to].map(|id| text(id)), edge.length);
        let [two_way, closed, backward] = [edge.two_way, edge.closed, edge.backward].map(u8::from);
        writeln!(out, "edge,{id},,,,,{from},{to},{length},{two_way},{speed},{back},{closed},{backward}")?;
    }
    Ok(())
}

/// Writes the nodes and edges of a layout as tables for people.
///
/// # Errors
/// Errors of the writer.
pub fn nodes_table(listing: &LayoutReport<'_>, out: &mut dyn Write) -> io::Result<()> {
    let (nodes, edges) = (counted(listing.nodes.len(), "node"), counted(listing.edges.len(), "edge"));
    writeln!(out, "{}: {nodes}, {edges}", heading(listing.layout))?;
    let lists = [("levels", listing.levels), ("vehicle types", listing.vehicle_types), ("vehicles", listing.vehicles)];
    for (what, names) in lists {
        let names: Vec<String> = names.iter().filter(|name| !name.is_empty()).map(|name| printable(name)).collect();
        if !names.is_empty() {
            writeln!(out, "{what}: {}", names.join(", "))?;
        }
    }
    let mut columns = TextTable::new(&["<node", "<names", "<level", "x [m]", "y [m]"]);
    for node in &listing.nodes {
        let [x, y] = node.at.map(thousandths);
        let names = printable(&node.names.join(" "));
        columns.row(vec![printable(&node.id.to_string()), names, printable(node.level), x, y]);
    }
    columns.write(out)?;
    writeln!(out)?;
    let mut columns = TextTable::new(&["<edge", "<from", "<to", "length [m]", "<ways", "speed [m/s]"]);
    for edge in &listing.edges {
        let [id, from, to] = [edge.id, edge.from, edge.to].map(|id| printable(&id.to_string()));
        let mut speed = edge.speed.map_or_else(|| "-".to_owned(), thousandths);
        if let Some(back) = edge.speed_back {
            speed = format!("{speed}, back {}", thousandths(back));
        }
        let ways = match edge {
            EdgeEntry { closed: true, .. } => "none",
            EdgeEntry { two_way: true, .. } => "both",
            EdgeEntry { backward: true, .. } => "back",
            _ => "one",
        };
        columns.row(vec![id, from, to, thousandths(edge.length), ways.to_owned(), speed]);
    }
    columns.write(out)
}
