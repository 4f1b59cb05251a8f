//! A file with the true positions of vehicles, and the proof that they never touched.
//!
//! The first line names the vehicles: `{"format":"pcr-record","version":2,"vehicles":[{"name":"sim/1","radius":0.4}]}`.
//! Each line after it is `[vehicle, time, x, y]`; vehicles are counted from 0, and the times \[s\] of a vehicle increase.
//! Between two of its lines a vehicle moves straight at a constant speed; before the first and after the last one it
//! stands. In version 3, which is written where a vehicle is no disc, a vehicle may have a `footprint` in place of the radius; its lines are
//! `[vehicle, time, x, y, heading]`. Between two of them it moves straight with its heading, then turns in place the shorter way: each takes half
//! of the time, or all of it where the other one is nothing. The last line of the file is `{"lines":N,"crc32":C}`, with the number of these lines and the checksum (as in
//! PNG) of all that is before it. A record without it, or with other numbers, is not as it was written, and proves
//! nothing.

mod certify;
mod outline_body;
mod read;
#[cfg(test)]
mod tests;

use super::vehicle::SimulatedVehicle;
pub use certify::{RecordCertificate, VehicleContact, certify};
use crc32fast::Hasher;
use pcr_formats::footprint::Footprint;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};

/// Versions of the format of records: of discs, and with footprints. Records of version 1 had no last line.
const VERSIONS: [u32; 2] = [2, 3];

/// A vehicle of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RecordVehicle {
    /// Name of the vehicle.
    pub name: String,
    /// Radius of its disc \[m\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Its outline, if it is no disc.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub footprint: Option<Footprint>,
}

impl RecordVehicle {
    /// A simulated vehicle.
    pub(crate) fn of(vehicle: &SimulatedVehicle) -> Self {
        let footprint = vehicle.abilities().footprint();
        let radius = footprint.is_none().then_some(vehicle.abilities().radius);
        Self { name: vehicle.key().to_string(), radius, footprint }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RecordHeader {
    format: String,
    version: u32,
    vehicles: Vec<RecordVehicle>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RecordTrailer {
    lines: u64,
    /// Optional, so that other programs can write records without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    crc32: Option<u32>,
}

/// A record in the making.
#[derive(Debug)]
pub(crate) struct RecordWriter<W: Write> {
    out: W,
    /// Whether each vehicle has a heading.
    headings: Vec<bool>,
    last: Vec<Option<[f64; 4]>>,
    /// For each vehicle whether its last position repeats an earlier one and is not written yet.
    waits: Vec<bool>,
    lines: u64,
    sum: Hasher,
}

impl<W: Write> RecordWriter<W> {
    /// A record of these vehicles.
    ///
    /// # Errors
    /// As the writer.
    pub(crate) fn new(out: W, vehicles: &[RecordVehicle]) -> io::Result<Self> {
        let headings: Vec<bool> = vehicles.iter().map(|vehicle| vehicle.footprint.is_some()).collect();
        let version = VERSIONS[usize::from(headings.contains(&true))];
        let head = RecordHeader { format: "pcr-record".into(), version, vehicles: vehicles.to_vec() };
        let (last, waits) = (vec![None; vehicles.len()], vec![false; vehicles.len()]);
        let mut own = Self { out, headings, last, waits, lines: 0, sum: Hasher::new() };
        own.line(serde_json::to_string(&head)?)?;
        Ok(own)
    }

    /// Adds the position of a vehicle, and its heading, at a time \[s, m, rad\].
    ///
    /// # Errors
    /// As the writer.
    pub(crate) fn push(&mut self, vehicle: usize, time: f64, [x, y]: [f64; 2], heading: f64) -> io::Result<()> {
        let heading = if self.headings.get(vehicle) == Some(&true) { heading } else { 0.0 };
        let (Some(last), Some(waits)) = (self.last.get_mut(vehicle), self.waits.get_mut(vehicle)) else {
            return Ok(());
        };
        if let Some([_, before @ ..]) = *last
            && before == [x, y, heading]
        {
            (*last, *waits) = (Some([time, x, y, heading]), true);
            return Ok(());
        }
        let waited = last.filter(|_| std::mem::take(waits));
        *last = Some([time, x, y, heading]);
        waited.into_iter().chain([[time, x, y, heading]]).try_for_each(|point| self.write(vehicle, point))
    }

    fn write(&mut self, vehicle: usize, [time, x, y, heading]: [f64; 4]) -> io::Result<()> {
        self.lines += 1;
        match self.headings[vehicle] {
            false => self.line(format!("[{vehicle},{time:?},{x:?},{y:?}]")),
            true => self.line(format!("[{vehicle},{time:?},{x:?},{y:?},{heading:?}]")),
        }
    }

    fn line(&mut self, mut text: String) -> io::Result<()> {
        text.push('\n');
        self.sum.update(text.as_bytes());
        self.out.write_all(text.as_bytes())
    }

    /// Writes what is left and the last line, which has a checksum.
    ///
    /// # Errors
    /// As the writer.
    pub(crate) fn finish(mut self) -> io::Result<W> {
        let standing = std::mem::take(&mut self.last).into_iter().zip(std::mem::take(&mut self.waits));
        for (vehicle, point) in
            standing.enumerate().filter_map(|(vehicle, (last, waits))| Some((vehicle, last.filter(|_| waits)?)))
        {
            self.write(vehicle, point)?;
        }
        let end = RecordTrailer { lines: self.lines, crc32: Some(self.sum.clone().finalize()) };
        self.line(serde_json::to_string(&end)?)?;
        self.out.flush()?;
        Ok(self.out)
    }
}
