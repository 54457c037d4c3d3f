//! Pages of texts that begin with the lengths of the texts (`DELTA_LENGTH_BYTE_ARRAY` and `DELTA_BYTE_ARRAY`).
//!
//! The lengths are differences, packed in blocks: a head of three numbers (values of a block, parts of a block, and how
//! many lengths there are) and the first length, then each block with its least difference, the bits of a difference in
//! each part, and the differences. The second encoding has such blocks twice, for the bytes shared with the text before
//! and for those behind them.

use std::sync::Arc;

use parquet::{
    basic::Encoding,
    column::page::{Page, PageReader},
    file::{metadata::ColumnChunkMetaData, reader::ChunkReader, serialized_reader::SerializedPageReader},
    schema::types::ColumnDescriptor,
};

use super::{PageProblem, number};

/// Bytes that `parquet` takes for a length.
const BYTES_OF_LENGTH: u64 = 4;

/// Checks that no page of the column states more lengths than it has values, or than `most` bytes hold.
///
/// The pages are unpacked, so that what they unpack to has to be checked before.
pub(super) fn check_lengths<R: ChunkReader + 'static>(
    file: &Arc<R>,
    column: &ColumnChunkMetaData,
    most: u64,
) -> Result<(), PageProblem> {
    let mut pages = SerializedPageReader::new(file.clone(), column, 0, None).map_err(PageProblem::Unread)?;
    while let Some(page) = pages.get_next_page().map_err(PageProblem::Unread)? {
        let twice = page.encoding() == Encoding::DELTA_BYTE_ARRAY;
        if !twice && page.encoding() != Encoding::DELTA_LENGTH_BYTE_ARRAY {
            continue;
        }
        let values = u64::from(page.num_values());
        let most = values.min(most / BYTES_OF_LENGTH);
        let lengths = texts(&page, column.column_descr()).and_then(|bytes| {
            let behind = behind_lengths(bytes, most)?;
            if twice { behind_lengths(behind, most).map(drop) } else { Some(()) }
        });
        if lengths.is_none() {
            return Err(PageProblem::Damaged {
                at: column.byte_range().0,
                expected: format!("pages with at most {most} lengths of texts"),
                found: "other bytes".to_owned(),
            });
        }
    }
    Ok(())
}

/// The values of a page, which follow its levels.
fn texts<'a>(page: &'a Page, column: &ColumnDescriptor) -> Option<&'a [u8]> {
    let bytes = page.buffer();
    match page {
        Page::DataPage {
            num_values,
            def_level_encoding,
            rep_level_encoding,
            ..
        } => {
            let values = u64::from(*num_values);
            let behind = behind_levels(bytes, column.max_rep_level(), *rep_level_encoding, values)?;
            behind_levels(behind, column.max_def_level(), *def_level_encoding, values)
        }
        Page::DataPageV2 {
            def_levels_byte_len,
            rep_levels_byte_len,
            ..
        } => bytes.get(def_levels_byte_len.checked_add(*rep_levels_byte_len)? as usize..),
        Page::DictionaryPage { .. } => None,
    }
}

/// What follows the levels that begin a page of the first version; there are none where they cannot differ.
fn behind_levels(bytes: &[u8], greatest: i16, encoding: Encoding, values: u64) -> Option<&[u8]> {
    if greatest <= 0 {
        return Some(bytes);
    }
    if encoding == Encoding::RLE {
        let (length, behind) = bytes.split_first_chunk::<4>()?;
        return behind.get(u32::from_le_bytes(*length) as usize..);
    }
    // The other encoding there is packs each level in as many bits as the greatest has.
    let bits = values * u64::from(i16::BITS - greatest.leading_zeros());
    bytes.get(usize::try_from(bits.div_ceil(8)).ok()?..)
}

/// What follows the lengths that begin `bytes`; `None` where they are more than `most`, or are no such.
fn behind_lengths(bytes: &[u8], most: u64) -> Option<&[u8]> {
    let mut behind = bytes;
    let [block, parts, count] = [number(&mut behind)?, number(&mut behind)?, number(&mut behind)?];
    let _first = number(&mut behind)?;
    let in_part = block.checked_div(parts)?;
    if count > most || in_part == 0 {
        return None;
    }
    let mut left = count.saturating_sub(1);
    while left > 0 {
        let _least = number(&mut behind)?;
        let (bits, differences) = behind.split_at_checked(usize::try_from(parts).ok()?)?;
        let mut size = 0_u64;
        for bits in bits {
            // The bits of parts behind the last difference may be any.
            if left > 0 {
                size = size.checked_add(u64::from(*bits).checked_mul(in_part)? / 8)?;
            }
            left = left.saturating_sub(in_part);
        }
        behind = differences.get(usize::try_from(size).ok()?..)?;
    }
    Some(behind)
}
