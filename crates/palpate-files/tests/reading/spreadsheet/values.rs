//! What cells hold.

use palpate_files::{cell::DecimalMark, input::Input, open::Contents, record::read_record, table::ReadOptions};

use super::{
    message, names, open, read,
    xls_book::{compound, moment, number, shared, stream},
    xlsx_book::{
        Book,
        C::{self, E, N, S, T, X},
    },
};

fn of_column(cells: &[C]) -> Book {
    let mut table = vec![vec![T("Time (s)"), T("Force (N)"), T("Displacement (mm)")]];
    table.extend(cells.iter().enumerate().map(|(row, cell)| vec![N(row as f64), *cell, N(0.0)]));
    Book::of(&[("Foo", &table)])
}

#[test]
fn a_faulty_cell_is_an_error_that_names_it() {
    for (cell, found) in [
        (X("<c r=\"PLACE\" t=\"e\"><v>#DIV/0!</v></c>"), "a number, found #DIV/0!"),
        (X("<c r=\"PLACE\" t=\"e\"><v>#N/A</v></c>"), "a number, found #N/A"),
        (X("<c r=\"PLACE\" t=\"b\"><v>1</v></c>"), "a number, found TRUE"),
        (E, "a number, found an empty cell"),
        // 12.3 that a spreadsheet took for a day of March: 3,950,899,200 N.
        (S(45_728.0, 2), "a number, found a date or a time of day"),
        (T("n.a."), "a number with a decimal point, found `n.a.`"),
    ] {
        let mut book = of_column(&[N(1.0), N(2.0), cell, N(4.0)]);
        book.formats = vec!["yyyy-mm-dd", "d-mmm"];
        let contents = open(&book.bytes()).expect("a workbook");
        let error = read(&contents, 0, &[1, 2]).expect_err("a faulty cell");
        assert_eq!(
            error.to_string(),
            format!("book: sheet Foo, cell B4: expected {found}").replace("book: ", "book, ")
        );
        assert!(error.hint().is_some());
        // A column that is not requested may hold anything.
        assert_eq!(read(&contents, 0, &[1, 3]).expect("other columns").rows(), 4);
    }
}

#[test]
fn numbers_kept_as_texts() {
    let contents = open(&of_column(&[T("1,5"), T("2,25"), T("3"), N(4.0)]).bytes()).expect("a workbook");
    assert_eq!(read(&contents, 0, &[2]).expect("columns").values, [vec![1.5, 2.25, 3.0, 4.0]]);
    let contents = open(&of_column(&[T("1.5"), T(" -2e3 ")]).bytes()).expect("a workbook");
    assert_eq!(read(&contents, 0, &[2]).expect("columns").values, [vec![1.5, -2000.0]]);

    let doubtful = of_column(&[T("1,500"), T("2,250"), N(4.0)]).bytes();
    let text = message(read(&open(&doubtful).expect("a workbook"), 0, &[2]));
    assert!(
        text.starts_with("book, sheet Foo, cell B2: expected a number with one clear decimal mark, found `1,500`"),
        "{text}"
    );
    let options = ReadOptions {
        decimal: Some(DecimalMark::Comma),
        ..ReadOptions::default()
    };
    let input = Input::from_bytes("book", doubtful).expect("bytes");
    let contents = Contents::of(input, &options).expect("a workbook");
    assert_eq!(read(&contents, 0, &[2]).expect("columns").values, [vec![1.5, 2.25, 4.0]]);
}

#[test]
fn times_become_seconds() {
    let table = |first: f64, style: usize| {
        let mut table = vec![vec![T("Zeit"), T("Kraft (N)")]];
        table.extend((0..3).map(|row| vec![S(first + f64::from(row) / 86_400.0, style), N(1.0)]));
        table
    };
    // 15 May 2023, 06:00 UTC is 1684130400 s after the epoch.
    for (first, style, from_1904, start) in [
        (45_061.25, 1, false, 1_684_130_400.0),
        (45_061.25 - 1462.0, 1, true, 1_684_130_400.0),
        (0.25, 1, false, 21_600.0),
        (1.5, 2, false, 129_600.0),
    ] {
        let mut book = Book::of(&[("clock", &table(first, style))]);
        book.formats = vec!["yyyy-mm-dd hh:mm:ss", "[h]:mm:ss"];
        book.from_1904 = from_1904;
        let contents = open(&book.bytes()).expect("a workbook");
        assert_eq!(names(&contents.parts[0]), [("Zeit", "s"), ("Kraft", "N")]);
        let columns = read(&contents, 0, &[1]).expect("columns");
        for (row, value) in columns.values[0].iter().enumerate() {
            // Days near 45000 are kept to 0.6 µs.
            assert!((value - start - row as f64).abs() < 1e-6, "{value}");
        }
    }
    let mut table = vec![vec![T("Time"), T("Force (N)")]];
    let cell = |xml: &'static str| X(xml);
    table.push(vec![cell("<c r=\"PLACE\" t=\"d\"><v>2023-05-15T06:00:00Z</v></c>"), N(1.0)]);
    table.push(vec![cell("<c r=\"PLACE\" t=\"d\"><v>2023-05-15T06:00:01.5Z</v></c>"), N(1.0)]);
    let contents = open(&Book::of(&[("iso", &table)]).bytes()).expect("a workbook");
    let values = read(&contents, 0, &[1]).expect("columns").values;
    assert!((values[0][1] - 1_684_130_401.5).abs() < 1e-6, "{values:?}");
}

/// Dates were read as seconds since 1970 and stayed that, with the rounding of such large numbers.
#[test]
fn dates_of_a_workbook_count_from_the_first_row() {
    let cells = (0..4_u16).flat_map(|row| {
        let days = 45_000.5 + 0.05 * f64::from(row) / 86_400.0;
        [moment(row + 1, 0, days), number(row + 1, 1, f64::from(row % 3))]
    });
    let cells = [vec![shared(0, 0, 0), shared(0, 1, 1)], cells.collect()].concat();
    let book = compound("Workbook", &stream(&["Time", "Force (N)"], &[("run", cells)], false));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.xls");
    std::fs::write(&path, book).unwrap();
    let read = read_record(&path, None, &mut |_, _| Ok(())).unwrap();
    assert_eq!(read.record.time(), [0.0, 0.05, 0.1, 0.15]);
    assert!((read.start.unwrap() - 1_678_881_600.0).abs() < 1e-6);
    assert!(read.columns[0].epoch);
}
