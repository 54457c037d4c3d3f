//! What files cost: each in proportion to its size, and four times as many tests, columns or topics about four times as much.

use std::{io::Write, time::Duration};

use palpate_files::{input::Input, open::Contents, parquet_table::TableReader, table::ReadOptions};
use parquet::basic::{Compression, ZstdLevel};

use crate::{
    any_file::{self, Kind},
    budget::{self, MEMORY_A_BYTE, MEMORY_AT_LEAST, TIME_A_BYTE, TIME_AT_LEAST, Taken, bounded, measured},
    corpus, made,
};

/// How much more four times as much may cost: less than half of what it does where the cost grows with the square.
const MOST_TIMES: u32 = 7;

/// Added to what is measured, against the coarse clock of the system.
const SLACK: Duration = Duration::from_millis(40);

#[test]
fn every_file_of_the_corpus_keeps_to_its_budget() {
    let mut dearest = Taken {
        time: Duration::ZERO,
        memory: 0,
    };
    for example in corpus::all() {
        // The budget is that of the file, not of what it unpacks to.
        let size = example.file().len();
        let (_, taken) = measured(|| example.read_freely());
        let memory = MEMORY_AT_LEAST + MEMORY_A_BYTE * size;
        let time = TIME_AT_LEAST + TIME_A_BYTE * size as u32;
        assert!(taken.memory <= memory && taken.time <= time, "{}: {taken:?} for {size} bytes", example.place);
        dearest.time = dearest.time.max(taken.time);
        dearest.memory = dearest.memory.max(taken.memory);
    }
    println!("at most {} ms and {} KiB", dearest.time.as_millis(), dearest.memory >> 10);
}

#[test]
#[should_panic(expected = "KiB of memory for a file of 10 bytes")]
fn memory_is_measured() {
    let room = bounded(10, || Vec::<u8>::with_capacity(MEMORY_AT_LEAST + 1024));
    assert!(room.is_empty());
}

#[test]
fn processor_time_is_measured() {
    let spin = |wanted: Duration| {
        let began = std::time::Instant::now();
        let mut sum = 0_u64;
        while began.elapsed() < wanted {
            sum = std::hint::black_box(sum.wrapping_add(1));
        }
    };
    // Of a busy machine the thread may have but a part.
    let (_, taken) = measured(|| spin(Duration::from_millis(200)));
    assert!(taken.time > Duration::from_millis(5) && taken.time < Duration::from_millis(400), "{taken:?}");
    let (_, taken) = measured(|| std::thread::sleep(Duration::from_millis(100)));
    assert!(taken.time < Duration::from_millis(50), "{taken:?}");
}

/// Reads all parts of a file: how many there are.
fn read_parts(file: &[u8]) -> usize {
    let input = Input::from_bytes("many", file).expect("bytes");
    let contents = Contents::of(input, &ReadOptions::default()).expect("tests");
    for (index, part) in contents.parts.iter().enumerate() {
        let columns: Vec<usize> = (1..=part.columns.len().min(3)).rev().take(2).collect();
        contents.read(index, &columns, &mut |_, _| Ok(())).expect("numbers");
    }
    contents.parts.len()
}

/// Checks that what is made of `count` and of four times as many costs in proportion.
fn in_proportion(what: &str, count: usize, make: impl Fn(usize) -> Vec<u8>, read: impl Fn(&[u8])) {
    let cost = |file: &[u8]| {
        let once = || measured(|| read(file)).1;
        let (one, other) = (once(), once());
        (one.time.min(other.time), one.memory)
    };
    let (few, many) = (make(count), make(4 * count));
    let ((short, little), (long, much)) = (cost(&few), cost(&many));
    assert!(
        long <= MOST_TIMES * (short + SLACK),
        "{what}: {short:?} for {count}, {long:?} for four times as many"
    );
    let most = (MEMORY_AT_LEAST / 8).max(6 * little);
    assert!(much <= most, "{what}: {little} bytes of memory for {count}, {much} for four times as many");
}

#[test]
fn sheets_and_tables_of_a_workbook_cost_in_proportion() {
    let all = |tests: usize| move |file: &[u8]| assert!(read_parts(file) >= tests);
    in_proportion("sheets", 60, made::sheets, all(60));
    in_proportion("tables side by side", 100, |count| made::tables_side_by_side(count, false), all(100));
    let titled = |count| made::tables_side_by_side(count, true);
    in_proportion("tables below named values", 100, titled, all(100));
    in_proportion("tables one below the other", 50, made::tables_stacked, all(50));
}

#[test]
fn tests_of_a_table_cost_in_proportion() {
    let all = |tests: usize| move |file: &[u8]| assert!(read_parts(file) >= tests);
    in_proportion("tests of an Arrow stream", 250, made::tests_of_arrow, all(250));
    in_proportion("tests of Parquet", 250, |count| made::tests_of_parquet(count, false), all(250));
    in_proportion("tests in one batch", 250, |count| made::tests_of_parquet(count, true), all(250));
}

#[test]
fn many_rows_of_one_value_are_read_from_a_small_file() {
    for (packing, dictionary) in [
        (Compression::UNCOMPRESSED, true),
        (Compression::SNAPPY, true),
        (Compression::ZSTD(ZstdLevel::default()), false),
    ] {
        let file = made::rows_of_one_value(1_000_000, packing, dictionary);
        let input = Input::from_bytes("many", &file[..]).expect("bytes");
        let contents = Contents::of(input, &ReadOptions::default()).expect("a test");
        let (read, taken) = measured(|| contents.read(0, &[1, 2], &mut |_, _| Ok(())).expect("numbers"));
        assert_eq!(read.rows(), 1_000_000);
        // Beside the numbers: two, and the number of its line, for every row.
        let most = MEMORY_AT_LEAST + MEMORY_A_BYTE * file.len() + 24 * read.rows();
        assert!(taken.memory <= most, "{packing}: {taken:?} for {} bytes", file.len());
        println!("{packing}: {} bytes, {taken:?}", file.len());
    }
}

#[test]
fn pages_of_a_table_of_results_are_checked_before_they_are_unpacked() {
    let all = corpus::all();
    for (name, expected) in [
        (
            "lying_length_of_a_page_of_a_sweep.parquet",
            "page at byte 4: expected the head of a page, found other bytes",
        ),
        ("lying_length_of_a_packed_page.parquet", "a page unpacks to more than 256 times the file"),
        (
            "lying_count_of_a_dictionary.parquet",
            "page at byte 4: expected a dictionary of 8 bytes, found one of",
        ),
    ] {
        let example = all.iter().find(|example| example.name() == name).expect("a file");
        let mut file = tempfile::tempfile().expect("a file");
        file.write_all(&example.bytes).expect("a file");
        let (found, taken) = measured(|| TableReader::new(file).and_then(|table| table.read(0)));
        let message = found.expect_err("damage").to_string();
        assert!(message.contains(expected) && taken.memory < MEMORY_AT_LEAST, "{name}: {message}, {taken:?}");
        println!("{name}: {message}, {taken:?}");
    }
}

#[test]
fn topics_and_curves_cost_in_proportion() {
    in_proportion("topics", 3000, |count| made::log(count, 1), |file| assert_eq!(read_parts(file), 1));
    in_proportion("messages", 2000, |count| made::log(2, count), |file| assert_eq!(read_parts(file), 1));
    in_proportion("curves", 150, made::curves, |file| assert!(read_parts(file) >= 150));
}

#[test]
fn columns_lines_and_remarks_of_a_text_cost_in_proportion() {
    let look = |file: &[u8]| {
        let input = Input::from_bytes("many", file).expect("bytes");
        drop(Contents::of(input, &ReadOptions::default()));
    };
    let columns = |count: usize| format!("{}\n", vec!["1"; count].join(",")).repeat(5).into_bytes();
    in_proportion("columns", 3000, columns, look);
    let points = |count: usize| format!("{}\n", vec!["1.5"; count].join(",")).repeat(5).into_bytes();
    in_proportion("columns of decimals", 3000, points, look);
    let rows = |count: usize| (0..count).map(|row| format!("{row},0.5\n")).collect::<String>().into_bytes();
    in_proportion("rows", 5000, rows, |file| assert_eq!(read_parts(file), 1));
    let step = |number: usize| format!("[step]\nStep - {number}\nTime\tStress\ns\tPa\n0\t1\n1\t2\n\n");
    let steps = |count: usize| (0..count).map(step).collect::<String>().into_bytes();
    in_proportion("steps", 100, steps, |file| assert!(read_parts(file) >= 100));
    let empty_keys = |count: usize| {
        let end = "# segment: extend\n# columns: height vDeflection\n# units: m N\n1 2\n2 3\n";
        format!("{}{end}", "# columns:\n".repeat(count)).into_bytes()
    };
    in_proportion("empty keys", 3000, empty_keys, look);
}

#[test]
fn packed_blank_lines_end_early() {
    // Long lines, which cost an unoptimised build less.
    let blank = format!("{}\n", " ".repeat(60_000));
    let text = format!("Time (s),Force (N)\n0,1\n1,2\n2,3\n{}", blank.repeat(400));
    let file = any_file::packed(Kind::Packed, text.as_bytes());
    drop(text);
    let size = file.len();
    let complaint = budget::bounded(size, || any_file::read_all("blank.csv.gz", &file)).expect_err("refused");
    assert!(complaint.message.contains("expected rows of numbers, found more than 16 MiB"), "{complaint:?}");
}

#[test]
fn a_cell_of_a_workbook_has_a_limit() {
    let cell = |letters: usize| {
        let text = "a".repeat(letters);
        format!(
            "=== xl/worksheets/sheet1.xml\n<worksheet><sheetData><row r=\"1\"><c r=\"A1\" t=\"inlineStr\"><is><t>{text}</t></is></c></row></sheetData></worksheet>"
        )
    };
    let file = any_file::packed(Kind::Xlsx, cell(17 << 20).as_bytes());
    let complaint = any_file::read_all("book.xlsx", &file).expect_err("refused");
    assert!(complaint.message.contains("a tag of the workbook exceeds the limit of 16 MiB"), "{complaint:?}");
}

#[test]
fn a_message_names_the_first_of_many() {
    let names: Vec<String> = (0..5000).map(|number| format!("Force {number} (N)")).collect();
    let row = format!("{}\n", vec!["1"; 5001].join(","));
    let file = format!("Time (s),{}\n{}", names.join(","), row.repeat(3));
    let complaint = any_file::read_all("many.csv", file.as_bytes()).expect_err("refused");
    assert!(complaint.message.ends_with("column 9 (Force 7), and 4992 more"), "{complaint:?}");
    assert!(complaint.message.len() < 400);
}
