//! Parquet and Arrow: tables of columns with types.

use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, Int64Array, ListArray, RecordBatch, StringArray, types::Float64Type};
use arrow_ipc::{
    CompressionType,
    writer::{FileWriter, IpcWriteOptions, StreamWriter},
};
use parquet::{
    arrow::ArrowWriter,
    basic::{BrotliLevel, Compression, Encoding, GzipLevel},
    file::properties::{EnabledStatistics, WriterProperties},
};

use super::{Made, place, with};

fn table(columns: Vec<(&str, ArrayRef)>) -> RecordBatch {
    let nullable = columns.into_iter().map(|(name, column)| (name, column, true));
    RecordBatch::try_from_iter_with_nullable(nullable).expect("a batch")
}

fn numbers(values: &[Option<f64>]) -> ArrayRef {
    Arc::new(Float64Array::from_iter(values.iter().copied()))
}

/// Four rows of time and the force that is requested.
fn press(force: [Option<f64>; 4]) -> RecordBatch {
    table(vec![("time_s", numbers(&[0.0, 0.1, 0.2, 0.3].map(Some))), ("force_N", numbers(&force))])
}

fn good() -> RecordBatch {
    press([0.5, 4.5, 3.5, 3.0].map(Some))
}

/// Tables that are whole and hold what is no test; the format's own damage comes on top.
fn tables() -> Vec<(&'static str, RecordBatch)> {
    let force = numbers(&[0.5, 4.5, 3.5, 3.0].map(Some));
    let list = ListArray::from_iter_primitive::<Float64Type, _, _>([Some([Some(1.0)]), Some([Some(2.0)])]);
    let words = StringArray::from(vec!["0.5", "4.5", "overload", "3.0"]);
    let ids = StringArray::from(vec!["a", "a", "b", "b"]);
    let back = numbers(&[0.0, 0.2, 0.1, 0.3].map(Some));
    let counts = Int64Array::from(vec![0, i64::MAX, i64::MIN, 1]);
    vec![
        ("good", good()),
        (
            "good_tests",
            table(vec![
                ("test_id", Arc::new(ids)),
                ("time_s", numbers(&[0.0, 0.1, 0.0, 0.1].map(Some))),
                ("force_N", force.clone()),
            ]),
        ),
        ("no_rows", good().slice(0, 0)),
        ("nothing_in_a_cell", press([Some(0.5), None, Some(3.5), Some(3.0)])),
        ("nothing_at_all", press([None; 4])),
        ("not_a_number", press([Some(0.5), Some(f64::NAN), Some(3.5), Some(3.0)])),
        ("infinity", press([Some(0.5), Some(f64::NEG_INFINITY), Some(3.5), Some(3.0)])),
        ("time_goes_back", table(vec![("time_s", back), ("force_N", force.clone())])),
        ("time_of_huge_counts", table(vec![("time_s", Arc::new(counts)), ("force_N", force.clone())])),
        ("force_of_texts", table(vec![("time_s", force.clone()), ("force_N", Arc::new(words))])),
        ("only_lists", table(vec![("samples", Arc::new(list))])),
        ("names_with_controls", table(vec![("time_s", force.clone()), ("fo\u{1b}[2Jrce", force)])),
    ]
}

fn parquet_of(batch: &RecordBatch) -> Vec<u8> {
    let mut writer = ArrowWriter::try_new(Vec::new(), batch.schema(), None).expect("a writer");
    writer.write(batch).expect("rows");
    writer.into_inner().expect("a file")
}

pub(super) fn parquet() -> Vec<Made> {
    let name = |name: &str| format!("{name}.parquet").leak() as &'static str;
    let mut files: Vec<Made> = tables().iter().map(|(own, table)| (name(own), parquet_of(table))).collect();
    let whole = parquet_of(&good());
    let end = whole.len();
    let length = |length: u32| with(&whole, end - 8, &length.to_le_bytes());
    let footer = end - 8 - u32::from_le_bytes(*whole[end - 8..].first_chunk().expect("a length")) as usize;
    files.extend([
        ("only_magic.parquet", b"PAR1".to_vec()),
        ("cut_in_the_rows.parquet", whole[..60].to_vec()),
        ("cut_in_the_footer.parquet", whole[..footer + 40].to_vec()),
        ("cut_at_the_end.parquet", whole[..end - 3].to_vec()),
        ("lying_length_of_the_footer.parquet", length(u32::MAX)),
        ("footer_of_no_length.parquet", length(0)),
        ("footer_too_short.parquet", length(40)),
        ("encrypted_footer.parquet", with(&whole, end - 4, b"PARE")),
        ("other_magic_at_the_end.parquet", with(&whole, end - 4, b"PAR2")),
        ("footer_overwritten.parquet", with(&whole, footer, &[0xFF; 24])),
        ("rows_overwritten.parquet", with(&whole, 4, &[0xFF; 40])),
        ("lying_length_of_a_packed_page.parquet", page_lying_about_unpacking()),
        ("lying_length_of_a_page_with_a_text_for_its_checksum.parquet", page_with_a_text_for_its_checksum()),
        ("lying_count_of_a_dictionary.parquet", dictionary_lying_about_its_values()),
        (
            "page_unpacks_to_more_by_brotli.parquet",
            page_that_unpacks_to_more(Compression::BROTLI(BrotliLevel::try_new(9).expect("a level")), (1 << 24) - 1),
        ),
        (
            "page_unpacks_to_more_by_gzip.parquet",
            page_that_unpacks_to_more(Compression::GZIP(GzipLevel::default()), 1 << 18),
        ),
        (
            "more_lengths_than_texts.parquet",
            texts_lying_about_their_lengths(Encoding::DELTA_LENGTH_BYTE_ARRAY),
        ),
        (
            "more_shared_lengths_than_texts.parquet",
            texts_lying_about_their_lengths(Encoding::DELTA_BYTE_ARRAY),
        ),
        ("good_texts_after_their_lengths.parquet", texts_after_lengths(Encoding::DELTA_LENGTH_BYTE_ARRAY)),
        ("good_texts_after_shared_lengths.parquet", texts_after_lengths(Encoding::DELTA_BYTE_ARRAY)),
        ("footer_of_words.footer", b"this is no footer at all".to_vec()),
        ("footer_of_a_lying_list.footer", vec![0x15, 2, 0x19, 0xFC, 0xFF, 0xFF, 0xFF, 0xFF, 0x0F, 0, 0]),
        (
            "footer_of_a_lying_text.footer",
            vec![0x15, 2, 0x19, 0x1C, 0x48, 0xFF, 0xFF, 0xFF, 0xFF, 0x0F, b'a', 0],
        ),
    ]);
    files
}

/// A Parquet file of so many rows that are all the same, with or without dictionaries.
pub(crate) fn rows_of_one_value(rows: usize, packing: Compression, dictionary: bool) -> Vec<u8> {
    let batch = table(vec![("time_s", numbers(&vec![Some(0.5); rows])), ("force_N", numbers(&vec![Some(1.5); rows]))]);
    let properties = WriterProperties::builder().set_compression(packing).set_dictionary_enabled(dictionary).build();
    let mut writer = ArrowWriter::try_new(Vec::new(), batch.schema(), Some(properties)).expect("a writer");
    writer.write(&batch).expect("rows");
    writer.into_inner().expect("a file")
}

fn file_of(batch: &RecordBatch) -> Vec<u8> {
    let mut writer = FileWriter::try_new(Vec::new(), &batch.schema()).expect("a writer");
    writer.write(batch).expect("rows");
    writer.into_inner().expect("a file")
}

fn stream_of(batch: &RecordBatch) -> Vec<u8> {
    let mut writer = StreamWriter::try_new(Vec::new(), &batch.schema()).expect("a writer");
    writer.write(batch).expect("rows");
    writer.into_inner().expect("a stream")
}

/// A file of packed columns whose first page says that it unpacks to nearly 2 GiB.
fn page_lying_about_unpacking() -> Vec<u8> {
    let batch = table(vec![("time_s", numbers(&[Some(0.5); 400])), ("force_N", numbers(&[Some(1.5); 400]))]);
    let packed = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_dictionary_enabled(false)
        .build();
    let mut writer = ArrowWriter::try_new(Vec::new(), batch.schema(), Some(packed)).expect("a writer");
    writer.write(&batch).expect("rows");
    let mut file = writer.into_inner().expect("a file");
    // Behind the magic word: the kind of the page, its unpacked size (a number of seven bits a byte), its packed size.
    let end = 7 + file[7..].iter().position(|byte| byte & 0x80 == 0).expect("the end of a number");
    assert_eq!((file[4], file[6]), (0x15, 0x15));
    let more = 5 - (end - 6);
    file.splice(7..=end, [0xFE, 0xFF, 0xFF, 0xFF, 0x0F]);
    // The page takes its room from the one behind it.
    file.drain(4 + 200..4 + 200 + more);
    file
}

/// The same file, whose first page has a text where its checksum belongs: one reader passes over it, another takes its length for the checksum.
fn page_with_a_text_for_its_checksum() -> Vec<u8> {
    let mut file = page_lying_about_unpacking();
    // Behind the unpacked size: the packed size, then the structure two fields on.
    let next = 13 + place(&file[13..], &[0x2C, 0x15]);
    file.splice(next..=next, [0x18, 0x7F, 0x1C]);
    file.drain(4 + 200..4 + 202);
    file
}

/// A file whose first column has a dictionary that says that it has 2³¹ − 1 values.
fn dictionary_lying_about_its_values() -> Vec<u8> {
    let mut file =
        parquet_of(&table(vec![("time_s", numbers(&[Some(0.5); 400])), ("force_N", numbers(&[Some(1.5); 400]))]));
    // The kind of the page, its sizes, and the structure of a dictionary four fields on, whose first field is the count.
    let count = place(&file, &[0x15, 4, 0x15, 16, 0x15, 16, 0x4C, 0x15, 2]) + 8;
    file.splice(count..=count, [0xFE, 0xFF, 0xFF, 0xFF, 0x0F]);
    // The pages behind it are as long as before, and four bytes further on.
    file
}

/// A file of two columns of so many equal numbers, packed, whose first page says that it unpacks to 8 bytes.
fn page_that_unpacks_to_more(compression: Compression, rows: usize) -> Vec<u8> {
    let column = |value: f64| -> ArrayRef { Arc::new(Float64Array::from(vec![value; rows])) };
    let batch = table(vec![("time_s", column(0.5)), ("force_N", column(1.5))]);
    let packed = WriterProperties::builder()
        .set_compression(compression)
        .set_dictionary_enabled(false)
        .set_statistics_enabled(EnabledStatistics::None)
        .set_data_page_size_limit(1 << 30)
        .set_data_page_row_count_limit(usize::MAX)
        .set_write_batch_size(rows)
        .set_max_row_group_row_count(None)
        .build();
    let mut writer = ArrowWriter::try_new(Vec::new(), batch.schema(), Some(packed)).expect("a writer");
    writer.write(&batch).expect("rows");
    let mut file = writer.into_inner().expect("a file");
    // Behind the magic word: the kind of the page and its unpacked size, seven bits a byte; 8 may be written with as many.
    assert_eq!((file[4], file[6]), (0x15, 0x15));
    let end = 7 + file[7..].iter().position(|byte| byte & 0x80 == 0).expect("the end of a number");
    file[7..end].fill(0x80);
    (file[7], file[end]) = (0x90, 0);
    file
}

/// Two tests, distinguished by texts that stand behind their lengths.
fn texts_after_lengths(encoding: Encoding) -> Vec<u8> {
    let ids = StringArray::from_iter_values((0..400).map(|row| if row < 200 { "first" } else { "second" }));
    let numbers = |scale: f64| numbers(&(0..400).map(|row| Some(scale * f64::from(row % 200))).collect::<Vec<_>>());
    let batch = table(vec![("test_id", Arc::new(ids)), ("time_s", numbers(0.1)), ("force_N", numbers(0.5))]);
    let lengths = WriterProperties::builder()
        .set_dictionary_enabled(false)
        .set_column_encoding("test_id".into(), encoding)
        .build();
    let mut writer = ArrowWriter::try_new(Vec::new(), batch.schema(), Some(lengths)).expect("a writer");
    writer.write(&batch).expect("rows");
    writer.into_inner().expect("a file")
}

/// The same, where the texts are stated to be 2³⁴ − 1.
fn texts_lying_about_their_lengths(encoding: Encoding) -> Vec<u8> {
    let mut file = texts_after_lengths(encoding);
    // 128 lengths to a block, of four parts; 400 of them.
    let count = place(&file, &[0x80, 1, 4, 0x90, 3]) + 3;
    file.splice(count..count + 2, [0xFF, 0xFF, 0xFF, 0xFF, 0x3F]);
    // The page takes its room from its texts.
    file.drain(count + 60..count + 63);
    file
}

/// A stream of packed columns, of which the first says that it unpacks to 1.5 GiB.
fn lying_about_unpacking() -> Vec<u8> {
    let numbers = |start: f64| numbers(&(0..200).map(|row| Some(start + f64::from(row / 50))).collect::<Vec<_>>());
    let batch = table(vec![("time_s", numbers(0.0)), ("force_N", numbers(5.0))]);
    let packed = IpcWriteOptions::default().try_with_compression(Some(CompressionType::LZ4_FRAME)).expect("options");
    let mut writer = StreamWriter::try_new_with_options(Vec::new(), &batch.schema(), packed).expect("a writer");
    writer.write(&batch).expect("rows");
    let stream = writer.into_inner().expect("a stream");
    let stated = place(&stream, &1600_u64.to_le_bytes());
    with(&stream, stated, &(3_u64 << 29).to_le_bytes())
}

pub(super) fn arrow() -> Vec<Made> {
    let name = |name: &str| format!("{name}.arrows").leak() as &'static str;
    let mut files: Vec<Made> = tables().iter().map(|(own, table)| (name(own), stream_of(table))).collect();
    let (file, stream) = (file_of(&good()), stream_of(&good()));
    // The second message is the batch: its mark, the length of its description, the description.
    let mark = [0xFF; 4];
    let batch = 4 + place(&stream[4..], &mark);
    let stated = u32::from_le_bytes(*stream[batch + 4..].first_chunk().expect("a length")) as usize;
    files.extend([
        ("good.arrow", file.clone()),
        ("only_magic.arrow", b"ARROW1".to_vec()),
        ("cut_at_the_end.arrow", file[..file.len() - 3].to_vec()),
        ("cut_in_the_middle.arrow", file[..file.len() / 2].to_vec()),
        ("lying_length_of_the_schema.arrow", with(&file, place(&file, &mark) + 4, &[0xFF, 0xFF, 0xFF, 0x7F])),
        ("schema_cut.arrows", stream[..60].to_vec()),
        ("schema_overwritten.arrows", with(&stream, 20, &[0xFF; 16])),
        ("only_schema.arrows", stream[..batch].to_vec()),
        ("cut_in_a_length.arrows", stream[..batch + 6].to_vec()),
        ("cut_in_a_description.arrows", stream[..batch + 20].to_vec()),
        ("cut_in_a_batch.arrows", stream[..batch + 8 + stated + 20].to_vec()),
        ("lying_length_of_a_description.arrows", with(&stream, batch + 4, &[0xFF, 0xFF, 0xFF, 0x03])),
        ("description_overwritten.arrows", with(&stream, batch + 12, &[0xFF; 24])),
        ("lying_length_of_a_packed_column.arrows", lying_about_unpacking()),
        ("schema_in_place_of_a_batch.arrows", [&stream[..batch], &stream[..]].concat()),
    ]);
    files
}
