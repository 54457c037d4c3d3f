//! Parquet and Arrow: types, several tests in one table, damage.

use std::{collections::HashMap, sync::Arc};

use arrow_array::{
    ArrayRef, BooleanArray, Decimal128Array, DictionaryArray, Float32Array, Float64Array, Int64Array, ListArray,
    RecordBatch, StringArray, TimestampNanosecondArray, UInt8Array,
    types::{Float64Type, Int32Type},
};
use arrow_ipc::{
    CompressionType,
    writer::{FileWriter, IpcWriteOptions, StreamWriter},
};
use arrow_schema::{Field, Schema};
use palpate_files::{
    FileError,
    input::Input,
    open::{Contents, Format},
    record,
    table::{ColumnKind, Columns, ReadOptions},
};
use parquet::{arrow::ArrowWriter, basic::Compression, file::properties::WriterProperties};

fn batch(columns: Vec<(&str, ArrayRef)>) -> RecordBatch {
    RecordBatch::try_from_iter_with_nullable(columns.into_iter().map(|(name, array)| (name, array, true)))
        .expect("a batch")
}

fn parquet(batches: &[RecordBatch], compression: Compression) -> Vec<u8> {
    let options = WriterProperties::builder()
        .set_compression(compression)
        .set_max_row_group_row_count(Some(7))
        .build();
    let mut writer = ArrowWriter::try_new(Vec::new(), batches[0].schema(), Some(options)).expect("a writer");
    for batch in batches {
        writer.write(batch).expect("written");
    }
    writer.into_inner().expect("a file")
}

fn arrow(batches: &[RecordBatch], compression: Option<CompressionType>) -> Vec<u8> {
    let options = IpcWriteOptions::default().try_with_compression(compression).expect("options");
    let mut writer = FileWriter::try_new_with_options(Vec::new(), &batches[0].schema(), options).expect("a writer");
    for batch in batches {
        writer.write(batch).expect("written");
    }
    writer.into_inner().expect("a file")
}

fn stream(batches: &[RecordBatch]) -> Vec<u8> {
    let mut writer = StreamWriter::try_new(Vec::new(), &batches[0].schema()).expect("a writer");
    for batch in batches {
        writer.write(batch).expect("written");
    }
    writer.into_inner().expect("a stream")
}

/// The same table in every format and packing.
fn all(batches: &[RecordBatch]) -> Vec<(Format, Vec<u8>)> {
    let mut files = vec![(Format::ArrowIpc, stream(batches))];
    for compression in [None, Some(CompressionType::LZ4_FRAME), Some(CompressionType::ZSTD)] {
        files.push((Format::ArrowIpc, arrow(batches, compression)));
    }
    for compression in [
        Compression::UNCOMPRESSED,
        Compression::SNAPPY,
        Compression::GZIP(Default::default()),
        Compression::ZSTD(Default::default()),
        Compression::LZ4_RAW,
        Compression::BROTLI(Default::default()),
    ] {
        files.push((Format::Parquet, parquet(batches, compression)));
    }
    files
}

fn open(bytes: &[u8]) -> Result<Contents, FileError> {
    Contents::of(Input::from_bytes("table", bytes)?, &ReadOptions::default())
}

fn read(contents: &Contents, part: usize, columns: &[usize]) -> Result<Columns, FileError> {
    contents.read(part, columns, &mut |done, total| {
        assert!(done <= total);
        Ok(())
    })
}

fn wide() -> RecordBatch {
    let rows = 20;
    let time: ArrayRef = Arc::new(Float64Array::from_iter_values((0..rows).map(|row| f64::from(row) / 10.0)));
    let force: ArrayRef = Arc::new(Float32Array::from_iter_values((0..rows).map(|row| row as f32 * 0.5)));
    let way: ArrayRef = Arc::new(Int64Array::from_iter_values((0..rows).map(i64::from)));
    batch(vec![("time_s", time), ("force_n", force), ("displacement_mm", way)])
}

#[test]
fn a_wide_table_is_one_test_in_every_format_and_packing() {
    let table = wide();
    for (format, bytes) in all(&[table.slice(0, 12), table.slice(12, 8)]) {
        let contents = open(&bytes).expect("a table");
        assert_eq!((contents.format, contents.parts.len(), &contents.parts[0].name), (format, 1, &None));
        let columns: Vec<(Option<&str>, Option<&str>)> = contents.parts[0]
            .columns
            .iter()
            .map(|column| (column.name.as_deref(), column.unit.as_deref()))
            .collect();
        assert_eq!(
            columns,
            [(Some("time"), Some("s")), (Some("force"), Some("n")), (Some("displacement"), Some("mm"))]
        );
        let columns = read(&contents, 0, &[3, 1, 3]).expect("columns");
        assert_eq!((columns.rows(), columns.values[0][19], columns.values[1][13]), (20, 19.0, 1.3));
        assert_eq!(columns.values[0], columns.values[2]);
        let file = record::read_part(&contents, 0, None, &mut |_, _| Ok(())).expect("a record");
        assert_eq!((file.record.force()[19], file.record.displacement().map(|all| all[19])), (9.5, Some(0.019)));
    }
}

#[test]
fn rows_of_several_tests_may_be_mixed() {
    let ids = ["b", "b", "a", "b", "a", "a", "c", "c", "c", "c"];
    let time: ArrayRef = Arc::new(Float64Array::from_iter_values((0..10).map(f64::from)));
    let force: ArrayRef = Arc::new(Float64Array::from_iter_values((0..10).map(|row| f64::from(row) * 2.0)));
    let texts: ArrayRef = Arc::new(StringArray::from(ids.to_vec()));
    let words: ArrayRef = Arc::new(DictionaryArray::<Int32Type>::from_iter(ids));
    let numbers: ArrayRef = Arc::new(UInt8Array::from_iter_values(ids.iter().map(|id| id.as_bytes()[0] - b'a')));
    for (name, id) in [("test_id", texts), ("Specimen_ID", words), ("test", numbers.clone())] {
        let table = batch(vec![(name, id), ("time_s", time.clone()), ("force_N", force.clone())]);
        for (_, bytes) in all(&[table.slice(0, 3), table.slice(3, 7)]) {
            let contents = open(&bytes).expect("tables");
            let found: Vec<(&str, Option<u64>)> = contents.parts.iter().map(|part| (part.title(), part.rows)).collect();
            let names = if name == "test" { ["1", "0", "2"] } else { ["b", "a", "c"] };
            assert_eq!(found, [(names[0], Some(3)), (names[1], Some(3)), (names[2], Some(4))]);
            for (part, times) in
                [vec![0.0, 1.0, 3.0], vec![2.0, 4.0, 5.0], vec![6.0, 7.0, 8.0, 9.0]].into_iter().enumerate()
            {
                let columns = read(&contents, part, &[2, 3]).expect("columns");
                assert_eq!(columns.values[0], times);
                assert!(columns.values[1].iter().zip(&times).all(|(force, time)| *force == 2.0 * time));
                assert_eq!(columns.line_of(2), Some(times[2] as usize + 1));
            }
        }
    }
}

#[test]
fn types_units_and_columns_that_are_passed_over() {
    let clock = TimestampNanosecondArray::from(vec![1_684_130_400_000_000_000, 1_684_130_400_500_000_000]);
    let tall = Decimal128Array::from(vec![12_345, -5]).with_precision_and_scale(10, 3).expect("a decimal");
    let list = ListArray::from_iter_primitive::<Float64Type, _, _>([Some(vec![Some(1.0)]), None]);
    let good: ArrayRef = Arc::new(BooleanArray::from(vec![true, false]));
    let table =
        batch(vec![("when", Arc::new(clock)), ("list", Arc::new(list)), ("good", good), ("load", Arc::new(tall))]);
    let mut fields: Vec<Field> = table.schema().fields().iter().map(|field| field.as_ref().clone()).collect();
    fields[3] = fields[3].clone().with_metadata(HashMap::from([("units".to_owned(), "[mN]".to_owned())]));
    let table = RecordBatch::try_new(Arc::new(Schema::new(fields)), table.columns().to_vec()).expect("a batch");
    for (_, bytes) in all(std::slice::from_ref(&table)) {
        let contents = open(&bytes).expect("a table");
        let part = &contents.parts[0];
        assert!(part.written.ends_with("skipped columns without single values: list"), "{}", part.written);
        let kinds: Vec<ColumnKind> = part.columns.iter().map(|column| column.kind).collect();
        assert_eq!(kinds, [ColumnKind::Number, ColumnKind::Text, ColumnKind::Number]);
        let units: Vec<Option<&str>> = part.columns.iter().map(|column| column.unit.as_deref()).collect();
        assert_eq!(units, [Some("s"), None, Some("mN")]);
        assert_eq!(part.columns[2].sample, "12.345");
        let columns = read(&contents, 0, &[1, 3]).expect("columns");
        assert_eq!(columns.values, [vec![1_684_130_400.0, 1_684_130_400.5], vec![12.345, -0.005]]);
        let text = read(&contents, 0, &[2]).expect_err("texts").to_string();
        assert_eq!(text, "table, column good: expected numbers, found texts");
    }
}

#[test]
fn a_row_without_values_is_passed_over_and_one_value_missing_is_an_error() {
    let time: ArrayRef = Arc::new(Float64Array::from(vec![Some(0.0), None, Some(2.0), Some(3.0)]));
    let force: ArrayRef = Arc::new(Float64Array::from(vec![Some(1.0), None, Some(1.0), None]));
    let way: ArrayRef = Arc::new(Float64Array::from(vec![1.0, f64::NAN, 1.0, f64::INFINITY]));
    let table = batch(vec![("time_s", time), ("force_n", force), ("way_mm", way)]);
    for (_, bytes) in all(std::slice::from_ref(&table)) {
        let contents = open(&bytes).expect("a table");
        let columns = read(&contents, 0, &[1]).expect("times");
        assert_eq!((columns.values[0].len(), columns.ignored.blank, columns.line_of(1)), (3, 1, Some(3)));
        let text = read(&contents, 0, &[1, 2]).expect_err("no force").to_string();
        assert_eq!(text, "table, column force_n, row 4: expected a number, found none");
        let text = read(&contents, 0, &[1, 3]).expect_err("no number").to_string();
        assert_eq!(text, "table, column way_mm, row 4: expected a number, found inf");
    }
}

fn read_all(bytes: &[u8]) -> Result<usize, FileError> {
    let contents = open(bytes)?;
    let numbers = |part: &palpate_files::table::Part| -> Vec<usize> {
        part.columns
            .iter()
            .filter(|column| column.kind == ColumnKind::Number)
            .map(|column| column.number)
            .collect()
    };
    let read = |(index, part)| Ok(read(&contents, index, &numbers(part))?.rows());
    contents.parts.iter().enumerate().map(read).sum()
}

#[test]
fn cut_off_or_overwritten_anywhere_is_no_panic() {
    std::panic::set_hook(Box::new(|_| {}));
    let ids: ArrayRef = Arc::new(StringArray::from(vec!["a", "b", "a"]));
    let force: ArrayRef = Arc::new(Float64Array::from(vec![1.0, 2.0, 3.0]));
    let table = batch(vec![("test_id", ids), ("force_n", force)]);
    let kept = [
        parquet(std::slice::from_ref(&table), Compression::SNAPPY),
        arrow(std::slice::from_ref(&table), Some(CompressionType::LZ4_FRAME)),
        stream(std::slice::from_ref(&table)),
    ];
    for (index, whole) in kept.iter().enumerate() {
        assert_eq!(read_all(whole).expect("whole"), 3);
        for length in 0..whole.len() {
            let cut = read_all(&whole[..length]);
            // A stream may end behind any message.
            assert!(cut.is_err() || index == 2, "{length} of {}", whole.len());
        }
        for place in 0..whole.len() {
            for change in [0xFF, 0x40] {
                let mut bytes = whole.clone();
                bytes[place] ^= change;
                let _ = read_all(&bytes);
            }
        }
    }
    let _ = std::panic::take_hook();
}

#[test]
fn packed_tables_and_tables_without_rows() {
    use std::io::Write;
    let table = wide();
    for (format, whole) in all(std::slice::from_ref(&table)) {
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        packed.write_all(&whole).expect("bytes");
        let contents = open(&packed.finish().expect("a file")).expect("a table");
        assert_eq!((contents.format, read(&contents, 0, &[1, 2]).expect("columns").rows()), (format, 20));
    }
    for (_, bytes) in all(&[table.slice(0, 0)]) {
        let contents = open(&bytes).expect("a table");
        let text = read(&contents, 0, &[1]).expect_err("no rows").to_string();
        assert_eq!(text, "table: expected a test, found none: the table: no rows");
    }
}
