//! Bytes put into the container of a format.
//!
//! A container with lengths and checksums keeps a fuzzer outside of it, and people cannot write it by hand. So what is
//! in the corpus of such a format is either a whole file, or what goes into one:
//!
//! | format | what |
//! |---|---|
//! | xlsx, JPK's archives, packed files | members, each behind a line `=== NAME` |
//! | xls | the records of a workbook |
//! | Parquet | the footer |
//! | Igor waves | a wave whose checksum is set right |
//! | MATLAB files | elements, each behind a line `===` |
//! | robot logs | `=== cdr ros2msg TYPE`, the definition, and each message behind a line `===` |

use std::io::{Cursor, Write};

use zip::{CompressionMethod, ZipWriter, write::SimpleFileOptions};

/// The reader that bytes are meant for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Text,
    JpkText,
    AfmTab,
    Xlsx,
    Xls,
    Parquet,
    Arrow,
    JpkForce,
    RobotLog,
    Packed,
    Igor,
    Matlab,
    Hdf5,
}

/// The file that `bytes` stand for.
pub(crate) fn packed(kind: Kind, bytes: &[u8]) -> Vec<u8> {
    let whole = |magic: &[u8]| bytes.starts_with(magic);
    match kind {
        Kind::Text | Kind::JpkText | Kind::AfmTab | Kind::Arrow | Kind::Hdf5 => bytes.to_vec(),
        Kind::Igor => with_checksum(bytes),
        Kind::Matlab if whole(b"===") => of_elements(members(bytes)),
        Kind::Xls if !whole(b"\xD0\xCF\x11\xE0") => compound("Workbook", bytes),
        Kind::Parquet if !whole(b"PAR1") => around_footer(bytes),
        Kind::RobotLog if whole(b"===") => log(&members(bytes)),
        Kind::Xlsx if whole(b"===") => archive(members(bytes), &WORKBOOK),
        Kind::JpkForce if whole(b"===") => archive(members(bytes), &[("header.properties", "")]),
        Kind::Packed if whole(b"===") => archive(members(bytes), &[]),
        Kind::Packed if !whole(b"PK") && !whole(b"\x1F\x8B") => gzip(bytes),
        _ => bytes.to_vec(),
    }
}

/// Names and bytes behind lines `=== NAME`.
fn members(bytes: &[u8]) -> Vec<(String, &[u8])> {
    let mark = b"===";
    let starts_at = |place: usize| bytes[place..].starts_with(mark) && (place == 0 || bytes[place - 1] == b'\n');
    let starts: Vec<usize> = (0..bytes.len()).filter(|place| starts_at(*place)).collect();
    let ends = starts.iter().skip(1).map(|next| next - 1).chain([bytes.len()]);
    let member = |(start, end): (&usize, usize)| {
        let all = &bytes[start + mark.len()..end.max(start + mark.len())];
        let (name, body) = match all.iter().position(|byte| *byte == b'\n') {
            Some(line) => (&all[..line], &all[line + 1..]),
            None => (all, &[][..]),
        };
        (String::from_utf8_lossy(name).trim().to_owned(), body)
    };
    starts.iter().zip(ends).map(member).collect()
}

/// What every workbook of one sheet has.
const WORKBOOK: [(&str, &str); 4] = [
    ("[Content_Types].xml", "<Types/>"),
    (
        "_rels/.rels",
        "<Relationships><Relationship Id=\"a\" Type=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships/officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>",
    ),
    (
        "xl/workbook.xml",
        "<workbook><sheets><sheet name=\"press\" sheetId=\"1\" r:id=\"s1\"/></sheets></workbook>",
    ),
    (
        "xl/_rels/workbook.xml.rels",
        "<Relationships><Relationship Id=\"s1\" Type=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet\" Target=\"worksheets/sheet1.xml\"/><Relationship Id=\"t\" Type=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships/sharedStrings\" Target=\"sharedStrings.xml\"/><Relationship Id=\"f\" Type=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships/styles\" Target=\"styles.xml\"/></Relationships>",
    ),
];

/// A zip archive of members, and of those that are not among them but must be there.
fn archive(mut members: Vec<(String, &[u8])>, usual: &[(&str, &'static str)]) -> Vec<u8> {
    for (name, text) in usual {
        if !members.iter().any(|(own, _)| own == name) {
            members.push(((*name).to_owned(), text.as_bytes()));
        }
    }
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in members {
        let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        // A name that stands there twice.
        if zip.start_file(name, stored).is_ok() {
            zip.write_all(bytes).expect("a member in memory");
        }
    }
    zip.finish().expect("an archive in memory").into_inner()
}

/// A wave whose header adds up to nothing, as it must.
fn with_checksum(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let (lowest_first, version) = match bytes.first_chunk() {
        Some([version, 0]) => (true, *version),
        Some([0, version]) => (false, *version),
        _ => return bytes,
    };
    let (length, at) = match version {
        1 => (118, 6),
        2 => (126, 14),
        3 => (130, 18),
        _ => (384, 2),
    };
    if let Some(header) = bytes.get_mut(..length) {
        header[at..at + 2].fill(0);
        let short = |pair: &[u8]| match lowest_first {
            true => u16::from_le_bytes([pair[0], pair[1]]),
            false => u16::from_be_bytes([pair[0], pair[1]]),
        };
        let sum = header.chunks_exact(2).fold(0_u16, |sum, pair| sum.wrapping_add(short(pair))).wrapping_neg();
        header[at..at + 2].copy_from_slice(&if lowest_first { sum.to_le_bytes() } else { sum.to_be_bytes() });
    }
    bytes
}

/// A MATLAB file of elements, each packed.
fn of_elements(elements: Vec<(String, &[u8])>) -> Vec<u8> {
    let mut file = [&[b' '; 116][..], &[0; 8], &[0, 1, b'I', b'M']].concat();
    for (_, element) in elements {
        let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        packer.write_all(element).expect("packed in memory");
        let packed = packer.finish().expect("packed in memory");
        file.extend(15_u32.to_le_bytes());
        file.extend((packed.len() as u32).to_le_bytes());
        file.extend(packed);
    }
    file
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(bytes).expect("packed in memory");
    packer.finish().expect("packed in memory")
}

fn around_footer(footer: &[u8]) -> Vec<u8> {
    let length = u32::try_from(footer.len()).unwrap_or(u32::MAX).to_le_bytes();
    [b"PAR1", footer, &length, b"PAR1"].concat()
}

/// A log of one topic, in records that lie open.
fn log(members: &[(String, &[u8])]) -> Vec<u8> {
    let text = |text: &str| [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat();
    let record = |kind: u8, parts: &[&[u8]]| {
        let content = parts.concat();
        [&[kind][..], &(content.len() as u64).to_le_bytes(), &content].concat()
    };
    let Some(((about, definition), messages)) = members.split_first() else {
        return Vec::new();
    };
    let mut words = about.splitn(3, ' ');
    let mut word = || words.next().unwrap_or_default();
    let (encoding, schema_encoding, kind) = (word(), word(), word());
    let one = 1_u16.to_le_bytes();
    let mut file = b"\x89MCAP0\r\n".to_vec();
    file.extend(record(1, &[&text("ros2"), &text("palpate")]));
    let length = (definition.len() as u32).to_le_bytes();
    file.extend(record(3, &[&one, &text(kind), &text(schema_encoding), &length, definition]));
    file.extend(record(4, &[&one, &one, &text("/ft"), &text(encoding), &[0; 4]]));
    for (number, (_, message)) in messages.iter().enumerate() {
        let time = (1_700_000_000_000_000_000 + 10_000_000 * number as u64).to_le_bytes();
        file.extend(record(5, &[&one, &[0; 4], &time, &time, message]));
    }
    file.extend(record(15, &[&[0; 4]]));
    file.extend(record(2, &[&[0; 20]]));
    file.extend(b"\x89MCAP0\r\n");
    file
}

const SECTOR: usize = 512;
/// As many sectors as fit into one of the table, less the table and the directory.
const MOST_SECTORS: usize = SECTOR / 4 - 2;
const LAST: u32 = 0xFFFF_FFFE;

/// A compound file with one stream.
pub(crate) fn compound(name: &str, stream: &[u8]) -> Vec<u8> {
    let stream = &stream[..stream.len().min(MOST_SECTORS * SECTOR)];
    let sectors = stream.len().div_ceil(SECTOR).max(8);
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let mut header = b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1".to_vec();
    header.resize(24, 0);
    header.extend([0x3E, 0, 3, 0, 0xFE, 0xFF, 9, 0, 6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    header.extend(words(&[1, 1, 0, 4096, LAST, 0, LAST, 0, 0]));
    header.resize(SECTOR, 0xFF);
    // Sector 0 is the table, 1 the directory, the stream begins at 2.
    let mut table = words(&[0xFFFF_FFFD, LAST]);
    table.extend((1..sectors as u32).flat_map(|sector| (sector + 2).to_le_bytes()));
    table.extend(words(&[LAST]));
    table.resize(SECTOR, 0xFF);
    let entry = |name: &str, kind: u8, start: u32, size: usize| {
        let mut bytes: Vec<u8> = name.encode_utf16().flat_map(u16::to_le_bytes).collect();
        bytes.resize(128, 0);
        bytes[64..66].copy_from_slice(&(2 * name.len() as u16 + 2).to_le_bytes());
        bytes[66] = kind;
        bytes[116..120].copy_from_slice(&start.to_le_bytes());
        bytes[120..124].copy_from_slice(&(size as u32).to_le_bytes());
        bytes
    };
    let mut directory = [entry("Root Entry", 5, LAST, 0), entry(name, 2, 2, sectors * SECTOR)].concat();
    directory.resize(SECTOR, 0);
    let mut body = stream.to_vec();
    body.resize(sectors * SECTOR, 0);
    [header, table, directory, body].concat()
}
