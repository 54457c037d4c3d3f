//! A compound file around one stream, for a reader that takes nothing else.

const SECTOR: usize = 4096;
/// The end of a chain of sectors.
const END: u32 = 0xFFFF_FFFE;
/// Most bytes of a stream whose table of sectors the header lists as a whole.
pub(super) const MOST_OF_STREAM: usize = 109 * (SECTOR / 4 - 1) * SECTOR;

/// The bytes of a compound file with a stream of this name.
pub(super) fn around(name: &str, stream: &[u8]) -> Vec<u8> {
    let sectors = stream.len().div_ceil(SECTOR).max(1);
    let tables = (sectors + 1).div_ceil(SECTOR / 4 - 1);
    let word = |number: usize| (number as u32).to_le_bytes();
    let mut file = vec![0_u8; SECTOR];
    file[..8].copy_from_slice(super::compound::SIGNATURE);
    file[76..512].fill(0xFF);
    let mut put = |place: usize, bytes: &[u8]| file[place..place + bytes.len()].copy_from_slice(bytes);
    put(24, &[0x3E, 0, 4, 0, 0xFE, 0xFF, 12, 0, 6, 0]);
    put(44, &word(tables));
    put(48, &word(tables));
    put(56, &word(4096));
    put(60, &END.to_le_bytes());
    put(68, &END.to_le_bytes());
    for table in 0..tables {
        put(76 + 4 * table, &word(table));
    }
    // Sectors of the table, the directory, the stream.
    let mut next: Vec<u32> = vec![0xFFFF_FFFD; tables];
    next.push(END);
    next.extend((1..sectors).map(|sector| (tables + 1 + sector) as u32));
    next.push(END);
    next.resize(tables * SECTOR / 4, 0xFFFF_FFFF);
    file.extend(next.into_iter().flat_map(u32::to_le_bytes));
    let directory = file.len();
    file.extend(entry("Root Entry", 5, 0, 0));
    file.extend(entry(name, 2, tables + 1, sectors * SECTOR));
    file.resize(directory + SECTOR, 0);
    file.extend(stream);
    file.resize(directory + SECTOR * (1 + sectors), 0);
    file
}

fn entry(name: &str, kind: u8, start: usize, size: usize) -> [u8; 128] {
    let mut bytes = [0; 128];
    for (two, unit) in bytes.chunks_exact_mut(2).zip(name.encode_utf16()) {
        two.copy_from_slice(&unit.to_le_bytes());
    }
    bytes[64] = 2 * name.len() as u8 + 2;
    bytes[66] = kind;
    bytes[116..120].copy_from_slice(&(start as u32).to_le_bytes());
    bytes[120..128].copy_from_slice(&(size as u64).to_le_bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::spreadsheet::xls::compound::Compound;

    #[test]
    fn a_stream_of_any_length_comes_back() {
        // The last needs two sectors of table.
        for length in [0, 1, SECTOR, SECTOR + 1, 1023 * SECTOR, 1500 * SECTOR + 7] {
            let stream: Vec<u8> = (0..length).map(|place| (place % 251) as u8).collect();
            let file = around("Workbook", &stream);
            let compound = Compound::of(&file).expect("a compound file");
            let back = compound.stream("Workbook").expect("a stream");
            assert_eq!(&back[..length], stream);
            assert!(back[length..].iter().all(|byte| *byte == 0) && back.len() < length + 2 * SECTOR);
        }
    }
}
