//! What the pages of a Parquet file state, gone over before room is made for it.
//!
//! The crate `parquet` makes room for as many bytes as a head says its page unpacks to, for as many values as a head says
//! its dictionary has, and for as many texts as the values of a page say they are. What gzip and Brotli unpack it keeps
//! however much there is, and looks at the size afterwards. So each is checked here first.

mod head;
mod lengths;

use std::{
    io::{self, Read},
    sync::Arc,
};

use flate2::read::MultiGzDecoder;
use parquet::{
    basic::{Compression, Type},
    errors::ParquetError,
    file::{metadata::ColumnChunkMetaData, reader::ChunkReader},
};

use self::{head::Head, lengths::check_lengths};

/// Bytes that the head of a page mostly has, and most that it may have (16 MiB).
const USUAL_HEAD: u64 = 4096;
/// See [`USUAL_HEAD`].
const MOST_OF_HEAD: u64 = 16 << 20;

/// Why the pages of a column are not read.
#[derive(Debug)]
pub(crate) enum PageProblem {
    /// A page unpacks to more than may be unpacked.
    Beyond,
    /// A page is not as the format has it.
    Damaged {
        /// Where its head begins.
        at: u64,
        /// What the format has there.
        expected: String,
        /// What is there.
        found: String,
    },
    /// The bytes cannot be read.
    Unread(ParquetError),
}

/// Checks what the pages of a column of a row group state; each may unpack to `most` bytes.
///
/// Panics where the column begins before the file, as `parquet` does.
pub(crate) fn check_pages<R: ChunkReader + 'static>(
    file: &Arc<R>,
    column: &ColumnChunkMetaData,
    most: u64,
) -> Result<(), PageProblem> {
    let packed = column.compression() != Compression::UNCOMPRESSED;
    let (mut start, length) = column.byte_range();
    let end = start.saturating_add(length).min(file.len());
    let mut lengths_first = false;
    while start < end {
        let in_next = |most: u64| {
            let bytes = file.get_bytes(start, (end - start).min(most) as usize).map_err(PageProblem::Unread)?;
            Ok(Head::of(&bytes))
        };
        // The least and greatest value of a page of texts stand in its head.
        let head = match in_next(USUAL_HEAD)? {
            None if end - start > USUAL_HEAD => in_next(MOST_OF_HEAD)?,
            head => head,
        };
        let damaged = |expected: String, found: String| PageProblem::Damaged {
            at: start,
            expected,
            found,
        };
        let head = head.ok_or_else(|| damaged("the head of a page".to_owned(), "other bytes".to_owned()))?;
        if packed && head.unpacked > most {
            return Err(PageProblem::Beyond);
        }
        let left = (end - start).saturating_sub(head.length);
        if head.packed > left {
            return Err(damaged(format!("a page of at most {left} bytes"), head.packed.to_string()));
        }
        let size = if packed { head.unpacked } else { head.packed };
        if head.dictionary > size / least_width(column) {
            return Err(damaged(format!("a dictionary of {size} bytes"), format!("one of {} values", head.dictionary)));
        }
        let behind = start.saturating_add(head.length);
        if packed && !head.stored {
            let bytes = file.get_bytes(behind, head.packed as usize).map_err(PageProblem::Unread)?;
            let (packed, size) = (bytes.get(head.plain as usize..), head.unpacked.saturating_sub(head.plain));
            if unpacks_beyond(packed.unwrap_or_default(), column.compression(), size) {
                return Err(damaged(format!("a page that unpacks to {} bytes", head.unpacked), "more".to_owned()));
            }
        }
        lengths_first |= head.lengths_first;
        start = behind.saturating_add(head.packed);
    }
    if lengths_first { check_lengths(file, column, most) } else { Ok(()) }
}

/// Whether `packed` unpacks to more than `size` bytes where `parquet` does not stop there; of what is damaged, what comes
/// before the damage counts.
fn unpacks_beyond(packed: &[u8], compression: Compression, size: u64) -> bool {
    let beyond = |bytes: &mut dyn Read| {
        let mut one_more = bytes.take(size.saturating_add(1));
        let mut count = 0;
        let mut buffer = [0; 1 << 14];
        loop {
            match one_more.read(&mut buffer) {
                Ok(0) => return count > size,
                Ok(read) => count += read as u64,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(_) => return count > size,
            }
        }
    };
    match compression {
        Compression::GZIP(_) => beyond(&mut MultiGzDecoder::new(packed)),
        Compression::BROTLI(_) => beyond(&mut brotli::Decompressor::new(packed, 1 << 14)),
        // Snappy, Zstandard and raw LZ4 unpack into room that is made before; LZ4 makes at most 255 bytes of one.
        _ => false,
    }
}

/// Seven bits a byte, lowest first.
fn number(bytes: &mut &[u8]) -> Option<u64> {
    let mut number = 0;
    for place in 0..10 {
        let (byte, behind) = bytes.split_first()?;
        *bytes = behind;
        number |= u64::from(byte & 0x7F) << (7 * place);
        if byte & 0x80 == 0 {
            return Some(number);
        }
    }
    None
}

/// Fewest bytes of a value in a dictionary of a column.
fn least_width(column: &ColumnChunkMetaData) -> u64 {
    match column.column_type() {
        Type::BOOLEAN => 1,
        // The length of a text takes four bytes.
        Type::INT32 | Type::FLOAT | Type::BYTE_ARRAY => 4,
        Type::INT64 | Type::DOUBLE => 8,
        Type::INT96 => 12,
        Type::FIXED_LEN_BYTE_ARRAY => u64::try_from(column.column_descr().type_length()).unwrap_or(0).max(1),
    }
}
