//! A file with the true positions of vehicles, and the proof that they never touched.
//!
//! The first line names the vehicles: `{"format":"pcr-record","version":2,"vehicles":[{"name":"sim/1","radius":0.4}]}`.
//! Each line after it is `[vehicle, time, x, y]`; vehicles are counted from 0, and the times \[s\] of a vehicle increase.
//! Between two of its lines a vehicle moves straight at a constant speed; before the first and after the last one it
//! stands. The last line of the file is `{"lines":N,"crc32":C}`, with the number of these lines and the checksum (as in
//! PNG) of all that is before it. A record without it, or with other numbers, is not as it was written, and proves
//! nothing.

mod certify;
mod read;
#[cfg(test)]
mod tests;

pub use certify::{RecordCertificate, VehicleContact, certify};
use crc32fast::Hasher;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};

/// Version of the format of records. Records of version 1 had no last line.
const VERSION: u32 = 2;

/// A vehicle of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RecordVehicle {
    /// Name of the vehicle.
    pub name: String,
    /// Radius of its disc \[m\].
    pub radius: f64,
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
    last: Vec<Option<[f64; 3]>>,
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
        let head = RecordHeader { format: "pcr-record".into(), version: VERSION, vehicles: vehicles.to_vec() };
        let (last, waits) = (vec![None; vehicles.len()], vec![false; vehicles.len()]);
        let mut own = Self { out, last, waits, lines: 0, sum: Hasher::new() };
        own.line(serde_json::to_string(&head)?)?;
        Ok(own)
    }

    /// Adds the position of a vehicle at a time \[s, m\].
    ///
    /// # Errors
    /// As the writer.
    pub(crate) fn push(&mut self, vehicle: usize, time: f64, [x, y]: [f64; 2]) -> io::Result<()> {
        let (Some(last), Some(waits)) = (self.last.get_mut(vehicle), self.waits.get_mut(vehicle)) else {
            return Ok(());
        };
        if let Some([_, x0, y0]) = *last
            && [x0, y0] == [x, y]
        {
            (*last, *waits) = (Some([time, x, y]), true);
            return Ok(());
        }
        let waited = last.filter(|_| std::mem::take(waits));
        *last = Some([time, x, y]);
        waited.into_iter().chain([[time, x, y]]).try_for_each(|point| self.write(vehicle, point))
    }

    fn write(&mut self, vehicle: usize, [time, x, y]: [f64; 3]) -> io::Result<()> {
        self.lines += 1;
        self.line(format!("[{vehicle},{time:?},{x:?},{y:?}]"))
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
