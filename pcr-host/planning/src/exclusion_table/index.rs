//! Tables of locks of any size in a file, in which an edge is found without reading the others (docs/reference/formats.md, "Lock
//! tables").

use super::area_pair_search::{AreaPairSearch, SyncProgressFn};
use super::edge_traversals::reversed;
use super::swept_areas::SweptLayout;
use crate::checksum::crc32;
use pcr_formats::import::{ElementId, ImportError};
use serde::Serialize;
use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

#[cfg(test)]
mod tests;

/// The first bytes of a file.
const MAGIC: [u8; 8] = *b"pcrlocks";

/// Version of the layout of the file; other versions are refused.
const VERSION: u32 = 2;

/// Size of the header, after which the records begin \[bytes\].
const HEADER: u64 = 128;

/// Size of a record: the other track, and lengths of both \[bytes\].
const RECORD: usize = 20;

/// Bits of a place.
const TURNED: u32 = 1;
const NODE: u32 = 2;
const NUMBER: u32 = 4;

/// The reason why a file is not read or written.
#[derive(Debug)]
pub enum ExclusionIndexError {
    /// An error of the system.
    Io(io::Error),
    /// The locks cannot be computed.
    Import(ImportError),
    /// The file is damaged.
    Damaged(IndexDamage),
}

/// What is wrong with a file that is to have a table of locks.
#[derive(Clone, Debug, PartialEq)]
pub enum IndexDamage {
    /// It does not begin like one.
    Magic,
    /// It has another version.
    Version(u32),
    /// The checksum of its header is wrong.
    HeaderChecksum,
    /// It is longer or shorter than its header says.
    Size,
    /// The checksum of its names is wrong.
    NamesChecksum,
    /// Its names are shorter than its numbers say.
    NamesTooShort,
    /// Its tracks do not follow one another.
    TrackOrder,
    /// An edge is not on its track.
    EdgeOffTrack,
    /// The length of an edge is no length.
    EdgeLength,
    /// Its tracks have not all of its locks and edges.
    TrackTotals,
    /// Its names do not follow one another.
    NameOrder,
    /// Its names are longer or shorter than they say.
    NamesLength,
    /// The locks of this edge or node are not in it.
    LocksMissing(String),
    /// The checksum of the locks of this edge or node is wrong.
    LocksChecksum(String),
    /// A lock of this edge or node is none.
    NoLock(String),
}

impl std::fmt::Display for IndexDamage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Magic => f.write_str("it does not begin like one"),
            Self::Version(version) => write!(f, "version {version}; known is {VERSION}"),
            Self::HeaderChecksum => f.write_str("the checksum of its header is wrong"),
            Self::Size => f.write_str("it is longer or shorter than its header says"),
            Self::NamesChecksum => f.write_str("the checksum of its names is wrong"),
            Self::NamesTooShort => f.write_str("its names are shorter than its numbers say"),
            Self::TrackOrder => f.write_str("its tracks do not follow one another"),
            Self::EdgeOffTrack => f.write_str("an edge is not on its track"),
            Self::EdgeLength => f.write_str("the length of an edge is no length"),
            Self::TrackTotals => f.write_str("its tracks have not all of its locks and edges"),
            Self::NameOrder => f.write_str("its names do not follow one another"),
            Self::NamesLength => f.write_str("its names are longer or shorter than they say"),
            Self::LocksMissing(name) => write!(f, "the locks of {name} are not in it"),
            Self::LocksChecksum(name) => write!(f, "the checksum of the locks of {name} is wrong"),
            Self::NoLock(name) => write!(f, "a lock of {name} is none"),
        }
    }
}

impl std::fmt::Display for ExclusionIndexError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Io(error) => error.fmt(f),
            Self::Import(error) => error.fmt(f),
            Self::Damaged(problem) => write!(f, "not a table of locks that can be read: {problem}"),
        }
    }
}

impl std::error::Error for ExclusionIndexError {}

impl From<io::Error> for ExclusionIndexError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<IndexDamage> for ExclusionIndexError {
    fn from(damage: IndexDamage) -> Self {
        Self::Damaged(damage)
    }
}

impl From<ImportError> for ExclusionIndexError {
    fn from(error: ImportError) -> Self {
        Self::Import(error)
    }
}

/// The interval in single precision, rounded outward.
fn outward([lo, hi]: [f64; 2]) -> [f32; 2] {
    let (below, above) = (lo as f32, hi as f32);
    let below = if f64::from(below) > lo { below.next_down() } else { below };
    [below, if f64::from(above) < hi { above.next_up() } else { above }]
}

/// Writes all locks of a layout, with its [`origin`](super::origin); returns the number of records.
///
/// # Errors
/// [`ExclusionIndexError`].
pub fn write_index(
    sweep: &SweptLayout,
    origin: u32,
    out: &mut File,
    told: SyncProgressFn<'_>,
) -> Result<u64, ExclusionIndexError> {
    let pass = AreaPairSearch::new(sweep);
    let mut writer = BufWriter::with_capacity(1 << 20, &mut *out);
    writer.write_all(&[0; HEADER as usize])?;
    let (mut tracks, mut members, mut records) = (Vec::new(), Vec::new(), 0_u64);
    let mut places = vec![[0_u8; 16]; sweep.ids().len()];
    let row = |track: usize| {
        let mut bytes = Vec::new();
        for (other, [own, their]) in pass.row(track, true)? {
            bytes.extend((other as u32).to_le_bytes());
            let numbers = [outward(own), outward(their)];
            bytes.extend(numbers.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
        }
        Ok((track, crc32(&bytes), bytes))
    };
    pass.each(told, &row, |(track, sum, bytes)| {
        let count = (bytes.len() / RECORD) as u32;
        let own = &sweep.tracks[track];
        tracks.extend(records.to_le_bytes());
        let numbers = [count, sum, (members.len() / 4) as u32, own.members.len() as u32];
        tracks.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        for &(place, turned) in &own.members {
            members.extend((place as u32).to_le_bytes());
            let number = matches!(sweep.ids()[place], ElementId::Number(_));
            let node = !sweep.is_edge(place);
            let flags = if turned { TURNED } else { 0 } | if node { NODE } else { 0 } | if number { NUMBER } else { 0 };
            let entry = [(track as u32).to_le_bytes(), flags.to_le_bytes()];
            places[place][..8].copy_from_slice(entry.as_flattened());
            places[place][8..].copy_from_slice(&own.length.to_le_bytes());
        }
        records += u64::from(count);
        writer.write_all(&bytes).map_err(ExclusionIndexError::Io)
    })?;
    let names: Vec<String> = sweep.ids().iter().map(ElementId::to_string).collect();
    let mut ends = vec![0_u64];
    names.iter().for_each(|name| ends.push(ends.last().unwrap_or(&0) + name.len() as u64));
    let directory = [
        places.concat(),
        tracks,
        members,
        ends.iter().flat_map(|end| end.to_le_bytes()).collect(),
        names.concat().into_bytes(),
    ]
    .concat();
    writer.write_all(&directory)?;
    writer.flush()?;
    drop(writer);
    let counts = [sweep.ids().len() as u64, sweep.tracks.len() as u64, records, directory.len() as u64];
    let mut rest: Vec<u8> = counts.iter().flat_map(|count| count.to_le_bytes()).collect();
    rest.extend([crc32(&directory), origin].iter().flat_map(|sum| sum.to_le_bytes()));
    rest.resize(HEADER as usize - 16, 0);
    let header = [&MAGIC[..], &VERSION.to_le_bytes(), &crc32(&rest).to_le_bytes(), &rest].concat();
    out.seek(SeekFrom::Start(0))?;
    out.write_all(&header)?;
    Ok(records)
}

/// A table of locks in a file. Its ids are in memory, its locks are not.
#[derive(Debug)]
pub struct ExclusionIndex {
    file: File,
    directory: Vec<u8>,
    /// Numbers of edges and nodes, of tracks, and of records.
    counts: [u64; 3],
    origin: u32,
}

/// An edge or node with which an edge or node has a lock.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExclusionPartner {
    /// Id of the other edge or node.
    pub name: ElementId,
    /// Whether it is a node.
    pub node: bool,
    /// Lengths on the requested edge, from its start \[m\].
    pub own: [f64; 2],
    /// Lengths on the other edge \[m\].
    pub other: [f64; 2],
}

/// An edge or a node.
#[derive(Clone, Copy)]
struct IndexRecord {
    track: u32,
    flags: u32,
    length: f64,
}

impl ExclusionIndex {
    /// Opens a file and reads the names in it.
    ///
    /// # Errors
    /// [`ExclusionIndexError`] for a file that is no index, of another version, or damaged.
    pub fn open(file: &Path) -> Result<Self, ExclusionIndexError> {
        let mut file = File::open(file)?;
        let size = file.metadata()?.len();
        let mut header = [0; HEADER as usize];
        if size < HEADER || file.read_exact(&mut header).is_err() || header[..8] != MAGIC {
            return Err(IndexDamage::Magic.into());
        }
        let word = |at: usize| header.get(at..at + 4).map_or(0, le32);
        if word(8) != VERSION {
            return Err(IndexDamage::Version(word(8)).into());
        }
        if word(12) != crc32(&header[16..]) {
            return Err(IndexDamage::HeaderChecksum.into());
        }
        let [places, tracks, records, length] = [16, 24, 32, 40].map(|at| header.get(at..at + 8).map_or(0, le64));
        let begin = records.checked_mul(RECORD as u64).and_then(|bytes| bytes.checked_add(HEADER));
        if begin.and_then(|begin| begin.checked_add(length)) != Some(size) {
            return Err(IndexDamage::Size.into());
        }
        let mut directory = Vec::new();
        file.seek(SeekFrom::Start(size - length))?;
        (&file).take(length).read_to_end(&mut directory)?;
        if crc32(&directory) != word(48) {
            return Err(IndexDamage::NamesChecksum.into());
        }
        let index = Self { file, directory, counts: [places, tracks, records], origin: word(52) };
        index.check()?;
        Ok(index)
    }

    /// Checks that the directory is as long as its numbers say, and that these fit one another: tracks have all records and all places
    /// between them, one after the other.
    fn check(&self) -> Result<(), IndexDamage> {
        let [places, tracks, records] = self.counts;
        let length = self.directory.len() as u64;
        if places.max(tracks) > length || self.names_at() > length {
            return Err(IndexDamage::NamesTooShort);
        }
        let (mut record, mut member) = (0, 0);
        let mut seen = vec![false; usize::try_from(places).unwrap_or_default()];
        for track in 0..tracks {
            let (first, [count, _, begin, members]) = self.track(track as u32);
            if first != record || u64::from(begin) != member || member + u64::from(members) > places {
                return Err(IndexDamage::TrackOrder);
            }
            record += u64::from(count);
            for _ in 0..members {
                let place = self.member(member);
                let own = self.record(place);
                let is_new = usize::try_from(place).ok().and_then(|place| seen.get_mut(place));
                if u64::from(own.track) != track || is_new.is_none_or(|seen| std::mem::replace(seen, true)) {
                    return Err(IndexDamage::EdgeOffTrack);
                }
                if !(own.length >= 0.0 && own.length.is_finite()) {
                    return Err(IndexDamage::EdgeLength);
                }
                member += 1;
            }
        }
        if (record, member) != (records, places) {
            return Err(IndexDamage::TrackTotals);
        }
        self.check_names()
    }

    /// Checks that names follow one another up to the end.
    fn check_names(&self) -> Result<(), IndexDamage> {
        let places = self.counts[0];
        let mut before = 0;
        for place in 0..=places {
            let end = self.name_end(place);
            if end < before || place == 0 && end != 0 {
                return Err(IndexDamage::NameOrder);
            }
            before = end;
        }
        if self.names_at() + before != self.directory.len() as u64 {
            return Err(IndexDamage::NamesLength);
        }
        Ok(())
    }

    /// Whether a file begins with the magic bytes of an index. What is no file, of which these bytes would be gone, is none.
    pub fn is_one(file: &Path) -> bool {
        let mut begin = [0; MAGIC.len()];
        let is_file = std::fs::metadata(file).is_ok_and(|there| there.is_file());
        is_file && File::open(file).and_then(|mut file| file.read_exact(&mut begin)).is_ok() && begin == MAGIC
    }

    /// The [`origin`](super::origin) of the layout and the vehicle whose locks it holds.
    pub fn origin(&self) -> u32 {
        self.origin
    }

    /// Whether it holds nodes, too. Edges come before nodes.
    pub fn has_nodes(&self) -> bool {
        self.counts[0].checked_sub(1).is_some_and(|last| self.record(last).flags & NODE != 0)
    }

    /// Number of edges and nodes, and number of records.
    pub fn counts(&self) -> [u64; 2] {
        [self.counts[0], self.counts[2]]
    }

    fn bytes(&self, at: u64, count: usize) -> &[u8] {
        let at = usize::try_from(at).unwrap_or(usize::MAX);
        self.directory.get(at..at.saturating_add(count)).unwrap_or_default()
    }

    fn record(&self, place: u64) -> IndexRecord {
        let bytes = self.bytes(16 * place, 16);
        let part = |at: usize, count: usize| bytes.get(at..at + count).unwrap_or_default();
        IndexRecord { track: le32(part(0, 4)), flags: le32(part(4, 4)), length: f64::from_bits(le64(part(8, 8))) }
    }

    /// Index of the first record, number of records, checksum, index of the first member, number of members.
    fn track(&self, track: u32) -> (u64, [u32; 4]) {
        let bytes = self.bytes(16 * self.counts[0] + 24 * u64::from(track), 24);
        let part = |at: usize, count: usize| bytes.get(at..at + count).unwrap_or_default();
        (le64(part(0, 8)), [8, 12, 16, 20].map(|at| le32(part(at, 4))))
    }

    /// The place that is a member of a track.
    fn member(&self, member: u64) -> u64 {
        u64::from(le32(self.bytes(16 * self.counts[0] + 24 * self.counts[1] + 4 * member, 4)))
    }

    /// Where the ends of the names begin, and the names themselves, in the directory.
    fn ends_at(&self) -> u64 {
        let [places, tracks, _] = self.counts;
        20 * places + 24 * tracks
    }

    fn names_at(&self) -> u64 {
        self.ends_at() + 8 * (self.counts[0] + 1)
    }

    fn name_end(&self, at: u64) -> u64 {
        le64(self.bytes(self.ends_at() + 8 * at, 8))
    }

    fn name(&self, place: u64) -> ElementId {
        let [from, to] = [place, place + 1].map(|at| self.name_end(at));
        let text = String::from_utf8_lossy(self.bytes(self.names_at() + from, to.saturating_sub(from) as usize));
        let text = text.into_owned();
        match text.parse() {
            Ok(number) if self.record(place).flags & NUMBER != 0 => ElementId::Number(number),
            _ => ElementId::Text(text),
        }
    }

    /// The indices of an id: an edge, a node, or one of each.
    fn places(&self, name: &str) -> Vec<u64> {
        let ids = [name.parse().ok().map(ElementId::Number), Some(ElementId::Text(name.to_owned()))];
        let nodes = partition(0, self.counts[0], |place| self.record(place).flags & NODE == 0);
        let found = |id: &ElementId, [from, to]: [u64; 2]| {
            let place = partition(from, to, |place| self.name(place) < *id);
            (place < to && self.name(place) == *id).then_some(place)
        };
        let ranges = [[0, nodes], [nodes, self.counts[0]]];
        ids.iter().flatten().flat_map(|id| ranges.map(|range| found(id, range))).flatten().collect()
    }

    /// All locks of an edge, or of a node if no edge has this id; `None` if neither has it. Reads the locks of this edge only.
    ///
    /// # Errors
    /// [`ExclusionIndexError`] if the file cannot be read, or is damaged there.
    pub fn partners(&mut self, name: &str) -> Result<Option<Vec<ExclusionPartner>>, ExclusionIndexError> {
        let Some(&place) = self.places(name).first() else { return Ok(None) };
        let own = self.record(place);
        let (first, [count, sum, ..]) = self.track(own.track);
        if first.saturating_add(u64::from(count)) > self.counts[2] {
            return Err(IndexDamage::LocksMissing(name.to_owned()).into());
        }
        let mut bytes = vec![0; count as usize * RECORD];
        self.file.seek(SeekFrom::Start(HEADER + first * RECORD as u64))?;
        self.file.read_exact(&mut bytes)?;
        if crc32(&bytes) != sum {
            return Err(IndexDamage::LocksChecksum(name.to_owned()).into());
        }
        let mut partners = Vec::new();
        for record in bytes.chunks_exact(RECORD) {
            let number = |k: usize| f64::from(f32::from_bits(le32(&record[4 + 4 * k..8 + 4 * k])));
            let lengths = [[number(0), number(1)], [number(2), number(3)]];
            let track = le32(&record[..4]);
            let is_range = |[from, to]: [f64; 2]| from.is_finite() && to.is_finite() && from <= to;
            if u64::from(track) >= self.counts[1] || !lengths.into_iter().all(is_range) {
                return Err(IndexDamage::NoLock(name.to_owned()).into());
            }
            let (_, [_, _, begin, members]) = self.track(track);
            for k in 0..u64::from(members) {
                let other = self.member(u64::from(begin) + k);
                if other != place {
                    let their = self.record(other);
                    let on = |place: IndexRecord, lengths| {
                        if place.flags & TURNED != 0 { reversed(place.length, lengths) } else { lengths }
                    };
                    let (own, node) = (on(own, lengths[0]), their.flags & NODE != 0);
                    partners.push(ExclusionPartner { name: self.name(other), node, own, other: on(their, lengths[1]) });
                }
            }
        }
        sort(&mut partners);
        Ok(Some(partners))
    }
}

/// Sorts by kind (edges first), id, and lengths.
fn sort(partners: &mut [ExclusionPartner]) {
    partners.sort_by(|a, b| (a.node, &a.name).cmp(&(b.node, &b.name)).then(a.own[0].total_cmp(&b.own[0])));
}

impl SweptLayout {
    /// All locks of an edge, or of a node if no edge has this id; `None` if neither has it.
    ///
    /// # Errors
    /// [`ImportError`] for a pair that does not fit in memory.
    pub fn partners(&self, name: &str) -> Result<Option<Vec<ExclusionPartner>>, ImportError> {
        let named = |place: usize| self.ids()[place].to_string() == name;
        let found = (0..self.ids().len()).find(|&place| named(place));
        let track = |place| self.tracks.iter().position(|track| track.members.iter().any(|member| member.0 == place));
        let Some((place, track)) = found.and_then(|place| Some((place, track(place)?))) else { return Ok(None) };
        let own = &self.tracks[track];
        let turned = own.members.contains(&(place, true));
        let mut partners = Vec::new();
        for (other, [lengths, other_lengths]) in self.row_of(track)?.0 {
            let their = &self.tracks[other];
            partners.extend(their.members.iter().filter(|member| member.0 != place).map(|&(there, other_turned)| {
                ExclusionPartner {
                    name: self.ids()[there].clone(),
                    node: !self.is_edge(there),
                    own: own.on_member(lengths, turned),
                    other: their.on_member(other_lengths, other_turned),
                }
            }));
        }
        sort(&mut partners);
        Ok(Some(partners))
    }
}

fn le32(bytes: &[u8]) -> u32 {
    bytes.try_into().map_or(0, u32::from_le_bytes)
}

fn le64(bytes: &[u8]) -> u64 {
    bytes.try_into().map_or(0, u64::from_le_bytes)
}

/// The first index for which `holds` is false.
fn partition(mut from: u64, mut to: u64, holds: impl Fn(u64) -> bool) -> u64 {
    while from < to {
        let middle = from + (to - from) / 2;
        if holds(middle) { from = middle + 1 } else { to = middle }
    }
    from
}
