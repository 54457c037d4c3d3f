//! A minimal writer of `.xls`: BIFF8 records in a compound file.

const SECTOR: usize = 512;

pub(crate) fn record(kind: u16, bytes: &[u8]) -> Vec<u8> {
    let length = u16::try_from(bytes.len()).expect("a short record");
    [&kind.to_le_bytes()[..], &length.to_le_bytes(), bytes].concat()
}

fn place(row: u16, column: u16, style: u16) -> Vec<u8> {
    [row, column, style].iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn beginning(kind: u16) -> Vec<u8> {
    record(0x0809, &[&0x0600_u16.to_le_bytes()[..], &kind.to_le_bytes(), &[0; 12]].concat())
}

pub(crate) fn number(row: u16, column: u16, value: f64) -> Vec<u8> {
    record(0x0203, &[&place(row, column, 0)[..], &value.to_le_bytes()].concat())
}

pub(crate) fn moment(row: u16, column: u16, days: f64) -> Vec<u8> {
    record(0x0203, &[&place(row, column, 1)[..], &days.to_le_bytes()].concat())
}

pub(crate) fn shared(row: u16, column: u16, text: u32) -> Vec<u8> {
    record(0x00FD, &[&place(row, column, 0)[..], &text.to_le_bytes()].concat())
}

/// Whole numbers side by side, each in 30 bits and taken for hundredths.
pub(crate) fn hundredths(row: u16, column: u16, values: &[i32]) -> Vec<u8> {
    let mut bytes = place(row, column, 0)[..4].to_vec();
    for value in values {
        bytes.extend(0_u16.to_le_bytes());
        bytes.extend(((value << 2) | 3).to_le_bytes());
    }
    bytes.extend(u16::try_from(usize::from(column) + values.len() - 1).expect("few").to_le_bytes());
    record(0x00BD, &bytes)
}

/// A formula with the number, the fault (by code) or the text it gave.
pub(crate) fn formula(row: u16, column: u16, value: Result<f64, u8>) -> Vec<u8> {
    let value = match value {
        Ok(number) => number.to_le_bytes(),
        Err(code) => [2, 0, code, 0, 0, 0, 0xFF, 0xFF],
    };
    record(0x0006, &[&place(row, column, 0)[..], &value, &[0; 8]].concat())
}

pub(crate) fn formula_text(row: u16, column: u16, text: &str) -> Vec<u8> {
    let mut bytes = record(0x0006, &[&place(row, column, 0)[..], &[0, 0, 0, 0, 0, 0, 0xFF, 0xFF], &[0; 8]].concat());
    let letters: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let length = u16::try_from(text.encode_utf16().count()).expect("short");
    bytes.extend(record(0x0207, &[&length.to_le_bytes()[..], &[1], &letters].concat()));
    bytes
}

/// Shared texts; the second goes on in a record of its own, where its letters are of another width.
fn texts(texts: &[&str]) -> Vec<u8> {
    let count = u32::try_from(texts.len()).expect("few");
    let mut bytes = [count.to_le_bytes(), count.to_le_bytes()].concat();
    let mut records = Vec::new();
    for (index, text) in texts.iter().enumerate() {
        let units: Vec<u16> = text.encode_utf16().collect();
        bytes.extend(u16::try_from(units.len()).expect("short").to_le_bytes());
        let wide = |units: &[u16]| units.iter().flat_map(|unit| unit.to_le_bytes()).collect::<Vec<u8>>();
        let narrow = |units: &[u16]| units.iter().map(|unit| unit.to_le_bytes()[0]).collect::<Vec<u8>>();
        if index == 1 {
            let (here, there) = units.split_at(units.len() / 2);
            bytes.push(0);
            bytes.extend(narrow(here));
            records.extend(record(if records.is_empty() { 0x00FC } else { 0x003C }, &bytes));
            bytes = vec![1];
            bytes.extend(wide(there));
        } else {
            // With one run of another font, and something spoken.
            bytes.push(1 | 8 | 4);
            bytes.extend(1_u16.to_le_bytes());
            bytes.extend(2_u32.to_le_bytes());
            bytes.extend(wide(&units));
            bytes.extend([0; 6]);
        }
    }
    records.extend(record(if records.is_empty() { 0x00FC } else { 0x003C }, &bytes));
    records
}

/// The stream of a workbook of sheets, each the records of its cells.
pub(crate) fn stream(shared: &[&str], sheets: &[(&str, Vec<Vec<u8>>)], protected: bool) -> Vec<u8> {
    let mut format = 164_u16.to_le_bytes().to_vec();
    let code = "hh:mm:ss";
    format.extend((code.len() as u16).to_le_bytes());
    format.push(0);
    format.extend(code.bytes());
    let style = |format: u16| record(0x00E0, &[&[0, 0][..], &format.to_le_bytes(), &[0; 16]].concat());
    let mut globals = beginning(5);
    if protected {
        globals.extend(record(0x002F, &[0; 6]));
    }
    globals.extend([record(0x041E, &format), style(0), style(164)].concat());
    let behind = texts(shared);
    let names: usize = sheets.iter().map(|(name, _)| 4 + 8 + name.len()).sum();
    let mut start = globals.len() + names + behind.len() + 4;
    let mut bodies = Vec::new();
    for (name, cells) in sheets {
        let mut bytes = (start as u32).to_le_bytes().to_vec();
        bytes.extend([0, 0, name.len() as u8, 0]);
        bytes.extend(name.bytes());
        globals.extend(record(0x0085, &bytes));
        let body = [beginning(0x10), cells.concat(), record(0x000A, &[])].concat();
        start += body.len();
        bodies.extend(body);
    }
    [globals, behind, record(0x000A, &[]), bodies].concat()
}

/// A compound file with one stream.
pub(crate) fn compound(name: &str, stream: &[u8]) -> Vec<u8> {
    let sectors = stream.len().div_ceil(SECTOR).max(8);
    let word = |number: u32| number.to_le_bytes();
    let mut header = b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1".to_vec();
    header.resize(SECTOR, 0);
    let mut put = |place: usize, bytes: &[u8]| header[place..place + bytes.len()].copy_from_slice(bytes);
    put(24, &[0x3E, 0, 3, 0, 0xFE, 0xFF, 9, 0, 6, 0]);
    put(44, &word(1));
    put(48, &word(1));
    put(56, &word(4096));
    put(60, &word(0xFFFF_FFFE));
    put(68, &word(0xFFFF_FFFE));
    put(76, &[0xFF; 436]);
    put(76, &word(0));
    // Sector 0 is the table, 1 the directory, the stream begins at 2.
    let mut table = [word(0xFFFF_FFFD), word(0xFFFF_FFFE)].concat();
    for sector in 0..sectors {
        let last = sector + 1 == sectors;
        table.extend(word(if last { 0xFFFF_FFFE } else { sector as u32 + 3 }));
    }
    assert!(table.len() <= SECTOR, "one sector of table");
    table.resize(SECTOR, 0xFF);
    let entry = |name: &str, kind: u8, start: u32, size: usize| {
        let mut bytes: Vec<u8> = name.encode_utf16().flat_map(u16::to_le_bytes).collect();
        bytes.resize(128, 0);
        bytes[64..66].copy_from_slice(&(2 * name.len() as u16 + 2).to_le_bytes());
        bytes[66] = kind;
        bytes[116..120].copy_from_slice(&word(start));
        bytes[120..124].copy_from_slice(&word(size as u32));
        bytes
    };
    let mut directory = [entry("Root Entry", 5, 0xFFFF_FFFE, 0), entry(name, 2, 2, sectors * SECTOR)].concat();
    directory.resize(SECTOR, 0);
    let mut body = stream.to_vec();
    body.resize(sectors * SECTOR, 0);
    [header, table, directory, body].concat()
}

/// A workbook of two tests and a sheet without.
pub(crate) fn example() -> Vec<u8> {
    let test = |faulty: bool| {
        let mut cells = vec![shared(0, 0, 0), shared(0, 1, 1), formula_text(0, 2, "Weg (mm)")];
        for row in 1..4_u16 {
            // Not in the order of the sheet.
            cells.push(hundredths(row, 1, &[150 * i32::from(row), -25]));
            cells.push(number(row, 0, f64::from(row) / 10.0));
        }
        cells.push(number(4, 0, 0.4));
        cells.push(formula(4, 1, if faulty { Err(0x2A) } else { Ok(7.5) }));
        cells.push(number(4, 2, 0.5));
        cells
    };
    let clock = (0..3_u16).flat_map(|row| [moment(row + 1, 0, f64::from(row) / 86_400.0), number(row + 1, 1, 1.0)]);
    let clock = [vec![shared(0, 0, 0), shared(0, 1, 1)], clock.collect()].concat();
    let sheets = [("good", test(false)), ("notes", vec![shared(0, 0, 2)]), ("bad", test(true)), ("clock", clock)];
    let stream = stream(&["Zeit (s)", "Kraft (N)", "Bemerkung Ω"], &sheets, false);
    compound("Workbook", &stream)
}
