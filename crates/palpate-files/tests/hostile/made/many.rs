//! Files with many tests, tables, topics or curves.

use std::{
    fmt::Write as _,
    io::{Cursor, Write as _},
    sync::Arc,
};

use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray};
use arrow_ipc::writer::StreamWriter;
use parquet::{arrow::ArrowWriter, file::properties::WriterProperties};
use zip::{CompressionMethod, ZipWriter, write::SimpleFileOptions};

/// Rows of a test.
const ROWS: usize = 6;

fn archive(members: impl IntoIterator<Item = (String, Vec<u8>)>) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (name, bytes) in members {
        zip.start_file(name, stored).expect("a member");
        zip.write_all(&bytes).expect("a member in memory");
    }
    zip.finish().expect("an archive in memory").into_inner()
}

/// The letters of a column, from 0.
fn letters(column: usize) -> String {
    let before = column.checked_sub(26).map_or_else(String::new, |beyond| letters(beyond / 26));
    format!("{before}{}", char::from(b'A' + (column % 26) as u8))
}

/// The cells of a row that hold the names or the numbers of tables, each with its first column.
fn row(xml: &mut String, row: usize, tables: impl Iterator<Item = usize>, number: Option<usize>) {
    write!(xml, "<row r=\"{row}\">").expect("a text in memory");
    for first in tables {
        for (place, name) in ["Time (s)", "Force (N)"].iter().enumerate() {
            let cell = format!("{}{row}", letters(first + place));
            match number {
                None => write!(xml, "<c r=\"{cell}\" t=\"inlineStr\"><is><t>{name}</t></is></c>"),
                Some(number) => write!(xml, "<c r=\"{cell}\"><v>{number}</v></c>"),
            }
            .expect("a text in memory");
        }
    }
    xml.push_str("</row>");
}

fn book(sheets: &[String]) -> Vec<u8> {
    const KIND: &str = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let relation = |id: &str, kind: &str, target: &str| {
        format!("<Relationship Id=\"{id}\" Type=\"{KIND}/{kind}\" Target=\"{target}\"/>")
    };
    let (mut named, mut related) = (String::new(), String::new());
    for number in 0..sheets.len() {
        write!(named, "<sheet name=\"s{number}\" sheetId=\"{}\" r:id=\"s{number}\"/>", number + 1).expect("a text");
        related.push_str(&relation(&format!("s{number}"), "worksheet", &format!("worksheets/sheet{number}.xml")));
    }
    let document = relation("a", "officeDocument", "xl/workbook.xml");
    let mut members = vec![
        ("[Content_Types].xml".to_owned(), b"<Types/>".to_vec()),
        ("_rels/.rels".to_owned(), format!("<Relationships>{document}</Relationships>").into_bytes()),
        ("xl/workbook.xml".to_owned(), format!("<workbook><sheets>{named}</sheets></workbook>").into_bytes()),
        (
            "xl/_rels/workbook.xml.rels".to_owned(),
            format!("<Relationships>{related}</Relationships>").into_bytes(),
        ),
    ];
    for (number, rows) in sheets.iter().enumerate() {
        let xml = format!("<worksheet><sheetData>{rows}</sheetData></worksheet>");
        members.push((format!("xl/worksheets/sheet{number}.xml"), xml.into_bytes()));
    }
    archive(members)
}

/// A workbook of so many sheets.
pub(crate) fn sheets(count: usize) -> Vec<u8> {
    let mut rows = String::new();
    row(&mut rows, 1, [0].into_iter(), None);
    (0..ROWS).for_each(|number| row(&mut rows, number + 2, [0].into_iter(), Some(number)));
    book(&vec![rows; count])
}

/// A workbook of one sheet with so many tables side by side, perhaps with a named value above each.
pub(crate) fn tables_side_by_side(count: usize, named: bool) -> Vec<u8> {
    let tables = || (0..count).map(|table| 3 * table);
    let mut rows = String::new();
    if named {
        let cell = |table: usize| format!("<c r=\"{}1\" t=\"inlineStr\"><is><t>a=1</t></is></c>", letters(table));
        write!(rows, "<row r=\"1\">{}</row>", tables().map(cell).collect::<String>()).expect("a text in memory");
    }
    row(&mut rows, 2, tables(), None);
    (0..ROWS).for_each(|number| row(&mut rows, number + 3, tables(), Some(number)));
    book(&[rows])
}

/// A workbook of one sheet with so many tables one below the other.
pub(crate) fn tables_stacked(count: usize) -> Vec<u8> {
    let mut rows = String::new();
    for table in 0..count {
        let first = table * (ROWS + 1) + 1;
        row(&mut rows, first, [0].into_iter(), None);
        (0..ROWS).for_each(|number| row(&mut rows, first + 1 + number, [0].into_iter(), Some(number)));
    }
    book(&[rows])
}

/// So many tests, each a batch of its own.
fn batches(count: usize) -> impl Iterator<Item = RecordBatch> {
    (0..count).map(|test| {
        let numbers = || -> ArrayRef { Arc::new(Float64Array::from_iter((0..ROWS).map(|row| Some(row as f64)))) };
        let ids: ArrayRef = Arc::new(StringArray::from(vec![format!("test {test}"); ROWS]));
        RecordBatch::try_from_iter([("test_id", ids), ("time_s", numbers()), ("force_N", numbers())]).expect("a batch")
    })
}

/// An Arrow stream of so many tests, each a batch.
pub(crate) fn tests_of_arrow(count: usize) -> Vec<u8> {
    let mut batches = batches(count).peekable();
    let schema = batches.peek().expect("a test").schema();
    let mut writer = StreamWriter::try_new(Vec::new(), &schema).expect("a writer");
    batches.for_each(|batch| writer.write(&batch).expect("rows"));
    writer.into_inner().expect("a stream")
}

/// A Parquet file of so many tests, all in one group of rows or each in its own.
pub(crate) fn tests_of_parquet(count: usize, together: bool) -> Vec<u8> {
    let mut batches = batches(count).peekable();
    let schema = batches.peek().expect("a test").schema();
    let most = if together { 1 << 20 } else { ROWS };
    let properties = WriterProperties::builder().set_max_row_group_row_count(Some(most)).build();
    let mut writer = ArrowWriter::try_new(Vec::new(), schema, Some(properties)).expect("a writer");
    batches.for_each(|batch| writer.write(&batch).expect("rows"));
    writer.into_inner().expect("a file")
}

/// A log of so many topics, with so many messages each.
pub(crate) fn log(topics: usize, messages: usize) -> Vec<u8> {
    let text = |text: &str| [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat();
    let mut file = b"\x89MCAP0\r\n".to_vec();
    let mut record = |kind: u8, parts: &[&[u8]]| {
        let content = parts.concat();
        file.push(kind);
        file.extend((content.len() as u64).to_le_bytes());
        file.extend(content);
    };
    record(1, &[&text("ros2"), &text("palpate")]);
    let one = 1_u16.to_le_bytes();
    record(3, &[&one, &text("a/B"), &text("ros2msg"), &text("float64 x\n")]);
    for topic in 0..topics as u16 {
        record(4, &[&topic.to_le_bytes(), &one, &text(&format!("/t{topic}")), &text("cdr"), &[0; 4]]);
    }
    for number in 0..messages as u64 {
        let time = (1_000_000_000 * number).to_le_bytes();
        for topic in 0..topics as u16 {
            record(5, &[&topic.to_le_bytes(), &[0; 4], &time, &time, &[0, 1, 0, 0], &1.5_f64.to_le_bytes()]);
        }
    }
    record(15, &[&[0; 4]]);
    record(2, &[&[0; 20]]);
    file.extend(b"\x89MCAP0\r\n");
    file
}

/// A map of so many force curves.
pub(crate) fn curves(count: usize) -> Vec<u8> {
    let mut header =
        "force-segment-header.num-points=4\nforce-segment-header.duration=1\nchannels.list=height\n".to_owned();
    header.push_str("channel.height.data.type=float-data\nchannel.height.unit.unit=m\n");
    let numbers: Vec<u8> = [1_f32, 2.0, 3.0, 4.0].iter().flat_map(|number| number.to_be_bytes()).collect();
    let curve = |number: usize| {
        let folder = format!("index/{number}/segments/0");
        [
            (format!("{folder}/segment-header.properties"), header.clone().into_bytes()),
            (format!("{folder}/channels/height.dat"), numbers.clone()),
        ]
    };
    archive([("header.properties".to_owned(), Vec::new())].into_iter().chain((0..count).flat_map(curve)))
}
