//! The records of a bag in the container MCAP.
//!
//! A bag that was cut or damaged is an error: every chunk has its length and, as a rule, a checksum, the file ends in a footer, and the
//! summary before it says how many messages there are.

use super::super::super::ImportError;
use lz4_flex::frame::FrameDecoder as Lz4Decoder;
use mcap::records::{ChunkHeader, Record};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};
use ruzstd::decoding::StreamingDecoder;
use std::io::Read;

/// First bytes of such a file.
pub(crate) const MAGIC: &[u8] = mcap::MAGIC;

/// Most bytes that are asked for at once.
const PART: usize = 1 << 20;

/// Bytes of a record before its content: what it is, and how long.
const HEAD: usize = 9;

/// Calls `each` with every record, those of chunks in their place.
pub(super) fn read(
    source: &mut dyn Read,
    each: &mut dyn FnMut(Record<'_>) -> Result<(), ImportError>,
) -> Result<(), ImportError> {
    let mut count = MessageCount::default();
    let mut reader = LinearReader::new_with_options(
        LinearReaderOptions::default()
            .with_emit_chunks(true)
            .with_validate_data_section_crc(true)
            .with_validate_summary_section_crc(true)
            .with_check_finishes_after_end_magic(true),
    );
    while let Some(event) = reader.next_event() {
        match event.map_err(|error| damaged(&error))? {
            LinearReadEvent::ReadRequest(need) => {
                let part = reader.insert(need.clamp(1, PART));
                let filled = source.read(part).map_err(|error| ImportError::new(format!("cannot be read: {error}")))?;
                reader.notify_read(filled);
            }
            LinearReadEvent::Record { data, opcode } => {
                match parse_record(opcode, data).map_err(|error| damaged(&error))? {
                    Record::Chunk { header, data } => {
                        let content = content(&header, &data)?;
                        in_chunk(&content, &mut |record| {
                            count.add(&record)?;
                            each(record)
                        })?;
                    }
                    record => {
                        count.add(&record)?;
                        each(record)?;
                    }
                }
            }
        }
    }
    Ok(())
}

/// Messages that were read, and whether they are as many as the summary says.
#[derive(Default)]
struct MessageCount {
    messages: u64,
}

impl MessageCount {
    fn add(&mut self, record: &Record<'_>) -> Result<(), ImportError> {
        match record {
            Record::Message { .. } => self.messages += 1,
            Record::Statistics(said) if said.message_count != self.messages => {
                return Err(ImportError::new(format!(
                    "its summary says {} messages, and there are {}",
                    said.message_count, self.messages
                )));
            }
            _ => {}
        }
        Ok(())
    }
}

fn damaged(error: &McapError) -> ImportError {
    ImportError::new(match error {
        McapError::UnexpectedEof => {
            "the bag ends before its footer: it was cut, or the recording did not end; `mcap recover FILE -o NEW` \
                                     keeps the messages up to there"
                .to_owned()
        }
        McapError::Parse(why) => format!("the bag is damaged: {}", first_line(why)),
        other => format!("the bag is damaged: {}", first_line(other)),
    })
}

fn first_line(error: &dyn std::fmt::Display) -> String {
    error.to_string().lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default().to_owned()
}

/// The records in a chunk.
fn in_chunk(content: &[u8], each: &mut dyn FnMut(Record<'_>) -> Result<(), ImportError>) -> Result<(), ImportError> {
    let mut rest = content;
    while !rest.is_empty() {
        let cut = || ImportError::new("the bag is damaged: a chunk ends in the middle of a record");
        let (head, after) = rest.split_at_checked(HEAD).ok_or_else(cut)?;
        let (opcode, length) = head.split_first().ok_or_else(cut)?;
        let length = length.try_into().map(u64::from_le_bytes).ok().and_then(|length| usize::try_from(length).ok());
        let (body, after) = length.and_then(|length| after.split_at_checked(length)).ok_or_else(cut)?;
        each(parse_record(*opcode, body).map_err(|error| damaged(&error))?)?;
        rest = after;
    }
    Ok(())
}

/// What is in a chunk.
fn content(header: &ChunkHeader, data: &[u8]) -> Result<Vec<u8>, ImportError> {
    let wrong = |why: &dyn std::fmt::Display| ImportError::new(format!("the bag is damaged: a chunk: {why}"));
    // One byte more would be too many. What is not there takes no memory, whatever the header says.
    let most = header.uncompressed_size.saturating_add(1);
    let mut content = Vec::new();
    match header.compression.as_str() {
        "" => content.extend_from_slice(data),
        "lz4" => {
            Lz4Decoder::new(data).take(most).read_to_end(&mut content).map_err(|error| wrong(&error))?;
        }
        "zstd" => {
            let mut rest = data;
            while !rest.is_empty() && (content.len() as u64) < most {
                let mut frame = StreamingDecoder::new(&mut rest).map_err(|error| wrong(&error))?;
                let left = most - content.len() as u64;
                (&mut frame).take(left).read_to_end(&mut content).map_err(|error| wrong(&error))?;
                let decoder = &frame.decoder;
                if decoder.is_finished()
                    && let (Some(said), Some(is)) =
                        (decoder.get_checksum_from_data(), decoder.get_calculated_checksum())
                    && said != is
                {
                    return Err(wrong(&"its checksum differs"));
                }
            }
        }
        other => return Err(wrong(&format_args!("compression {other:?}, and lz4 and zstd are read"))),
    }
    if content.len() as u64 != header.uncompressed_size {
        let (has, said) = (content.len(), header.uncompressed_size);
        return Err(wrong(&format_args!("{has} bytes or more, and its header says {said}")));
    }
    // 0 stands for none.
    if header.uncompressed_crc != 0 && crc32fast::hash(&content) != header.uncompressed_crc {
        return Err(wrong(&"its checksum differs"));
    }
    Ok(content)
}
