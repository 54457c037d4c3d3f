//! Every error, with the place it names and what it suggests.

use palpate_files::{
    DecimalDoubt, FileError, FileProblem, Foreign,
    cell::{DecimalMark, Delimiter},
    formats::text::detect,
    input::Input,
    table::ReadOptions,
};

use super::{layout_with, read, written};

fn refused(bytes: impl AsRef<[u8]>) -> FileError {
    layout_with(bytes, &ReadOptions::default()).expect_err("no layout")
}

#[test]
fn missing_file_keeps_its_source() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("absent.csv");
    let error = Input::open(&path).expect_err("no file");
    assert!(matches!(error.problem, FileProblem::NotFound(_)));
    assert!(std::error::Error::source(&error).is_some_and(<dyn std::error::Error>::is::<std::io::Error>));
    assert!(error.to_string().contains("absent.csv"));
    assert!(error.hint().is_some());
}

#[test]
fn directory() {
    let folder = tempfile::tempdir().expect("a folder");
    let error = Input::open(folder.path()).expect_err("no file");
    assert!(matches!(error.problem, FileProblem::Directory));
}

#[test]
fn empty() {
    for bytes in [&b""[..], b"\n \r\n", b"\xEF\xBB\xBF", b"\xFF\xFE"] {
        assert!(matches!(refused(bytes).problem, FileProblem::Empty));
    }
}

#[test]
fn no_text() {
    for (bytes, expected) in [
        (&b"\x89PNG\r\n\x1A\n"[..], Foreign::Picture),
        (b"%PDF-1.7\n", Foreign::Pdf),
        (b"1,2\n\0\0\x01\x02 3,4\n\0", Foreign::Binary),
        (b"\x01\x02\x03\x04\x05\x06,1\n", Foreign::Binary),
        (b"{\"time\": [1, 2]}", Foreign::Json),
    ] {
        let error = refused(bytes);
        assert!(matches!(error.problem, FileProblem::Foreign(looks_like) if looks_like == expected), "{error}");
        assert!(error.hint().is_some());
    }
}

#[test]
fn one_column() {
    let error = refused("Force\n1.5\n2.5\n");
    assert!(matches!(&error.problem, FileProblem::OneColumn { line: 2, found, .. } if found == "1.5"));
    let options = ReadOptions {
        delimiter: Some(Delimiter::Tab),
        ..ReadOptions::default()
    };
    let error = layout_with("t,F\n0,1.5\n1,2.5\n", &options).expect_err("no tab");
    assert!(matches!(error.problem, FileProblem::OneColumn { line: 2, .. }));
    assert!(error.hint().is_some_and(|hint| hint.contains("tab")));
}

#[test]
fn names_but_no_rows() {
    let error = refused("Time,Force\n(s),(N)\n");
    assert!(matches!(
        error.problem,
        FileProblem::NoDataRows {
            header_line: Some(1),
            lines: 2,
            ..
        }
    ));
    let error = refused("Just some words.\n");
    assert!(matches!(error.problem, FileProblem::NoDataRows { header_line: None, .. }));
}

#[test]
fn uncertain_decimals() {
    for (text, expected) in [
        ("t,F\n0,01,0,52\n0,02,0,53\n", DecimalDoubt::CommaSplitsNumbers),
        ("1,234;5,678\n", DecimalDoubt::Thousands),
        ("Weg;Kraft\n0;3\n1.000;18.002\n", DecimalDoubt::PointThousands),
        ("1.5;2,25\n2.5;3,25\n", DecimalDoubt::Mixed),
    ] {
        let error = refused(text);
        assert!(matches!(error.problem, FileProblem::AmbiguousDecimal { doubt, .. } if doubt == expected), "{error}");
        assert!(error.hint().is_some());
    }
}

#[test]
fn text_in_a_column_of_numbers() {
    let error = read("t,F\n0,1.5\n1,overload\n2,2.5\n", &[1, 2]).expect_err("text");
    let FileProblem::TextInNumbers { place, found, .. } = &error.problem else {
        panic!("{error}");
    };
    assert_eq!((place.line, place.column), (3, 2));
    assert_eq!(place.name.as_deref(), Some("F"));
    assert_eq!(found, "overload");
    assert!(
        error
            .to_string()
            .ends_with("line 3, column 2 (F): expected a number with a decimal point, found `overload`")
    );
}

#[test]
fn text_in_the_last_row_is_no_footer() {
    let error = read("t,F\n0,1.5\n1,2.5\n2,error\n", &[1, 2]).expect_err("text");
    assert!(matches!(error.problem, FileProblem::TextInNumbers { .. }), "{error}");
    let long = "x".repeat(500);
    let error = read(format!("t,F\n0,1.5\n1,{long}\n"), &[2]).expect_err("text");
    assert!(error.to_string().len() < 250);
}

#[test]
fn hints_at_decimal_marks() {
    let mut rows: String = (0..100).map(|row| format!("{row};0.5\n")).collect();
    rows.push_str("100;0,5\n");
    let error = read(&rows, &[2]).expect_err("comma");
    assert!(matches!(
        error.problem,
        FileProblem::TextInNumbers {
            decimal: DecimalMark::Point,
            ..
        }
    ));
    assert!(error.hint().is_some_and(|hint| hint.contains("comma")));
    let error = read("0;0.5\n1;0.5\n2;1'2345.5\n", &[2]).expect_err("thousands");
    assert!(error.hint().is_some_and(|hint| hint.contains("thousands")));
}

#[test]
fn not_finite() {
    for word in ["NaN", "-inf", "1e999", "#N/A", "1.#QNAN"] {
        let error = read(format!("t,F\n0,1.5\n1,{word}\n2,2.5\n"), &[1, 2]).expect_err("none");
        assert!(
            matches!(&error.problem, FileProblem::NotFinite { place, found } if place.line == 3 && found == word),
            "{error}"
        );
    }
    assert!(read("t,F,G\n0,NaN,1.5\n1,NaN,2.5\n", &[1, 3]).is_ok());
}

#[test]
fn empty_cell() {
    let error = read("t,F\n0,1.5\n1,\n2,2.5\n", &[1, 2]).expect_err("empty");
    assert!(matches!(error.problem, FileProblem::EmptyCell(place) if place.line == 3 && place.column == 2));
    let error = read("t,F\n0,1.5\n1,2.5\n2,\n", &[2]).expect_err("empty");
    assert!(matches!(error.problem, FileProblem::EmptyCell(_)));
}

#[test]
fn ragged_rows() {
    let error = read("t,d,F\n0,1.5,1\n1,2.5\n2,3.5,3\n", &[1, 2, 3]).expect_err("short");
    assert!(matches!(
        error.problem,
        FileProblem::CellCount {
            line: 3,
            expected: 3,
            found: 2,
            ..
        }
    ));
    let error = read("t,d,F\n0,1.5,1\n1,2.5,3\n2\n", &[1]).expect_err("cut off");
    assert!(matches!(error.problem, FileProblem::CellCount { line: 4, .. }));
    let error = read("t,d,F\n0,1.5,1\n1,2,5,3\n2,3.5,3\n3,4.5,5\n", &[1]).expect_err("long");
    assert!(matches!(
        error.problem,
        FileProblem::CellCount {
            line: 3,
            expected: 3,
            found: 4,
            ..
        }
    ));
}

#[test]
fn faulty_first_row_is_no_header() {
    let error = read("t,F\n0,start\n1,1.5\n2,2.5\n", &[1, 2]).expect_err("text");
    assert!(matches!(error.problem, FileProblem::TextInNumbers { place, .. } if place.line == 2));
}

/// One line that began with `#` among the rows was refused with the advice to split the file.
#[test]
fn comments_between_rows_are_passed_over() {
    for comment in ["# paused", "#paused, restarted", "# 1.5,2.5", "  // paused", "% paused", "#"] {
        for at in 1..5 {
            let mut lines = vec!["Time (s),Force (N)", "0,1.5", "1,2.5", "2,3.5", "3,4.5"];
            lines.insert(at + usize::from(at < 2), comment);
            let text = format!("{}\n", lines.join("\n"));
            let read = read(&text, &[1, 2]).unwrap_or_else(|error| panic!("{text}{error}"));
            assert_eq!(read.values, [[0.0, 1.0, 2.0, 3.0], [1.5, 2.5, 3.5, 4.5]], "{text}");
            assert_eq!((read.ignored.comments, read.ignored.footer.is_some()), (1, false), "{text}");
        }
    }
    // The error of a spreadsheet is no comment, and a row of texts that begins so is none.
    let error = read("Time (s),Force (N)\n0,1.5\n#REF!,2.5\n2,3.5\n", &[1, 2]).expect_err("a row without a time");
    assert!(error.to_string().contains("line 3"), "{error}");
    let error = read("Mark,Time (s),Force (N)\n#1,0,1.5\n#2,x,2.5\n#3,2,3.5\n", &[2, 3]).expect_err("a faulty row");
    assert!(error.to_string().contains("line 3"), "{error}");
}

#[test]
fn junk_between_rows() {
    let error = read("t,F\n0,1.5\n1,2.5\nt,F\n0,3.5\n", &[1, 2]).expect_err("two records");
    assert!(
        matches!(&error.problem, FileProblem::Interrupted { line: 4, resumes: 5, found, .. } if found == "t,F"),
        "{error}"
    );
    assert!(std::error::Error::source(&error).is_some());
    let mut text = "t,F\n0,1.5\n1,2.5\n".to_owned();
    text.push_str(&"lost,lost\n".repeat(60));
    assert!(matches!(
        read(&text, &[1, 2]),
        Err(FileError {
            problem: FileProblem::TextInNumbers { .. },
            ..
        })
    ));
}

#[test]
fn no_such_column() {
    for column in [0, 3] {
        let error = read("0,1.5\n1,2.5\n", &[column]).expect_err("no column");
        assert!(matches!(error.problem, FileProblem::NoSuchColumn { columns: 2, .. }));
    }
}

#[test]
fn endless_line() {
    let text = vec![b'7'; 600_000];
    assert!(matches!(refused(&text).problem, FileProblem::LineTooLong { line: 1, .. }));
    let late = [b"0,1.5\n1,2.5\n".repeat(30_000), text].concat();
    let error = read(&late, &[1]).expect_err("a long line");
    assert!(matches!(error.problem, FileProblem::LineTooLong { line: 60_001, .. }), "{error}");
}

#[test]
fn text_in_utf16_is_shown_as_text() {
    let text = "t;F\n0;1,5\n1;größer\n2;2,5\n";
    let bytes: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let error = read(&bytes, &[1, 2]).expect_err("text");
    assert!(error.to_string().contains("größer"), "{error}");
    let latin: Vec<u8> = text.chars().map(|character| character as u8).collect();
    let error = read(&latin, &[1, 2]).expect_err("text");
    assert!(error.to_string().contains("größer"), "{error}");
}

#[test]
fn file_gone_between_looking_and_reading() {
    let file = written("0,1.5\n1,2.5\n");
    let input = Input::open(&file.path).expect("a file");
    let layout = detect(&input, &ReadOptions::default()).expect("a layout");
    std::fs::write(&file.path, "").expect("emptied");
    let error = palpate_files::formats::text::read_columns(&input, &layout, &[1], &mut |_, _| Ok(()));
    assert!(matches!(
        error,
        Err(FileError {
            problem: FileProblem::NoDataRows { .. },
            ..
        })
    ));
}

/// Only the first line was named, of however many.
#[test]
fn many_cells_without_a_number_are_counted_in_the_worst_column() {
    let row = |row: usize| {
        let force = if row % 5 == 4 { "" } else { "1.5" };
        let travel = if row == 2 { "n/a" } else { "0.5" };
        format!("{row},{travel},{force}\n")
    };
    let text = format!("t,d,F\n{}", (0..100).map(row).collect::<String>());
    let error = read(text, &[1, 2, 3]).expect_err("a fifth").to_string();
    let expected =
        "line 6, column 3 (F): expected a number in every row, found none in 20 of 100 (first lines: 6, 11, 16)";
    assert!(error.ends_with(expected), "{error}");
}
