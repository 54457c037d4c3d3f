//! Times counted from 1970 in delimited text: distinguished by their size, stated in the result, relative in the record.

use std::path::Path;

use palpate_files::{
    description::parse_test,
    input::Input,
    open::Contents,
    record::{ColumnError, ReadError, RecordFile, read_part, read_record},
    table::ReadOptions,
};

fn record(text: &str, test: &str) -> Result<RecordFile, ReadError> {
    let test = parse_test(test, Path::new("test.toml")).unwrap_or_else(|error| panic!("{error}"));
    let contents = Contents::of(Input::from_bytes("log.csv", text.as_bytes())?, &ReadOptions::default())?;
    read_part(&contents, 0, Some(&test), &mut |_, _| Ok(()))
}

/// Four rows of a gripper whose time has this header and these cells.
fn rows(header: &str, cells: [&str; 4]) -> String {
    let mut text = format!("{header},Pos (mm),Force (N)\n");
    for (index, cell) in cells.iter().enumerate() {
        text.push_str(&format!("{cell},{},{}\n", 40 + index, 1.5 * index as f64));
    }
    text
}

const SECONDS: [&str; 4] = ["1724504945.1984644", "1724504945.2094889", "1724504945.2204", "1724504946.1984644"];

#[test]
fn seconds_lose_nothing_that_was_written() {
    for (header, test) in [
        ("Time (s)", ""),
        ("Time", "columns.time.unit = \"s\""),
        ("Time", "columns.time.unit = \"epoch\""),
        ("timestamp", ""),
        ("Timestamp", ""),
        ("unix_time", ""),
    ] {
        let file = record(&rows(header, SECONDS), test).unwrap_or_else(|error| panic!("{header}: {error}"));
        assert_eq!(file.start, Some(1_724_504_945.198_464_4), "{header}");
        let time = file.record.time();
        assert_eq!(time[0], 0.0);
        // What is left is the rounding of the cell itself: half of 2^-22 s each.
        assert!((time[1] - 0.011_024_5).abs() < 2.4e-7 && (time[3] - 1.0).abs() < 2.4e-7, "{time:?}");
        assert!(file.columns[0].epoch && file.columns[0].unit.starts_with('s'), "{:?}", file.columns[0]);
    }
}

#[test]
fn the_unit_is_reported_by_the_size_and_stated() {
    for (cells, unit) in [
        (["1724504945198", "1724504945209", "1724504945220", "1724504946198"], "ms since 1970"),
        (["1724504945198000", "1724504945209000", "1724504945220000", "1724504946198000"], "us since 1970"),
        (
            ["1724504945198000000", "1724504945209000000", "1724504945220000000", "1724504946198000000"],
            "ns since 1970",
        ),
    ] {
        for (header, test) in [("timestamp", ""), ("Time", "columns.time.unit = \"epoch\"")] {
            let file = record(&rows(header, cells), test).unwrap_or_else(|error| panic!("{unit}: {error}"));
            assert_eq!(file.columns[0].unit, unit);
            let off = file
                .record
                .time()
                .iter()
                .zip([0.0, 0.011, 0.022, 1.0])
                .map(|(time, true_time)| (time - true_time).abs());
            assert!(off.fold(0.0, f64::max) < 3e-7, "{unit}: {:?}", file.record.time());
        }
    }
}

#[test]
fn a_plain_time_of_that_size_is_requested_for_its_unit() {
    let error = record(&rows("Time", SECONDS), "").unwrap_err();
    assert!(
        matches!(
            &error,
            ReadError::Column {
                source: ColumnError::NoUnit { .. },
                ..
            }
        ),
        "{error}"
    );
    // Named as such a time, but in no unit of our days.
    let error = record(&rows("timestamp", ["0.1", "0.2", "0.3", "0.4"]), "").unwrap_err();
    assert!(
        matches!(
            &error,
            ReadError::Column {
                source: ColumnError::NoUnit { .. },
                ..
            }
        ),
        "{error}"
    );
    let stated = "columns.time.unit = \"epoch\"";
    let error = record(&rows("Time", ["0.1", "0.2", "0.3", "0.4"]), stated).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("column 1 (Time): expected a time since 1970 (of 2000 to 2100"), "{text}");
    assert!(text.ends_with("found 0.1") && error.hint().is_some(), "{text}");
}

#[test]
fn other_times_stay_as_they_are() {
    let file = record(&rows("Time (s)", ["2.0", "2.5", "3.0", "3.5"]), "").unwrap();
    assert_eq!((file.start, file.record.time()[0]), (None, 2.0));
    // A day's worth of microseconds is no time since 1970.
    let file = record(&rows("Time (us)", ["86400000000", "86400010000", "86400020000", "86400030000"]), "").unwrap();
    assert_eq!((file.start, file.record.time()[0]), (None, 86_400.0));
}

#[test]
fn dates_with_times_of_day_are_times() {
    for (header, cells) in [
        (
            "Time",
            [
                "2024-08-24T13:09:05.5Z",
                "2024-08-24T13:09:05.511Z",
                "2024-08-24T13:09:05.522Z",
                "2024-08-24T13:09:06.5Z",
            ],
        ),
        (
            "timestamp",
            [
                "2024-08-24 13:09:05.5",
                "2024-08-24 13:09:05.511",
                "2024-08-24 13:09:05.522",
                "2024-08-24 13:09:06.5",
            ],
        ),
        (
            "datetime",
            [
                "\"2024-08-24 15:09:05,5+02:00\"",
                "\"2024-08-24 15:09:05,511+02:00\"",
                "\"2024-08-24 15:09:05,522+02:00\"",
                "\"2024-08-24 15:09:06,5+02:00\"",
            ],
        ),
    ] {
        let file = record(&rows(header, cells), "").unwrap_or_else(|error| panic!("{header}: {error}"));
        assert_eq!((file.start, file.columns[0].unit.as_str()), (Some(1_724_504_945.5), "date and time"), "{header}");
        let off = file
            .record
            .time()
            .iter()
            .zip([0.0, 0.011, 0.022, 1.0])
            .map(|(time, reported)| (time - reported).abs());
        assert!(off.fold(0.0, f64::max) < 3e-7, "{header}: {:?}", file.record.time());
    }
    // A column of numbers goes before the clock on the wall.
    let both = "Time,Elapsed (s),Pos (mm),Force (N)\n2024-08-24 13:09:05,0.5,1,2\n2024-08-24 13:09:06,1.5,2,3\n2024-08-24 13:09:07,2.5,2,2\n";
    let file = record(both, "").unwrap();
    assert_eq!((file.columns[0].number, file.record.time()[0]), (2, 0.5));
    let file = record(both, "columns.time.column = 1").unwrap();
    assert_eq!((file.columns[0].number, file.record.time()), (1, [0.0, 1.0, 2.0].as_slice()));
}

#[test]
fn a_date_that_is_none_is_named_with_its_line() {
    let mut text = "Time,Pos (mm),Force (N)\n".to_owned();
    for row in 0..5000 {
        let second = if row == 4500 { "99".to_owned() } else { format!("{:02}.{:03}", row / 1000 % 60, row % 1000) };
        text.push_str(&format!("2024-08-24 13:09:{second},{row},{}\n", row % 7));
    }
    let error = record(&text, "").unwrap_err().to_string();
    assert!(error.starts_with("log.csv: line 4502, column 1: expected a date and time such as"), "{error}");
    assert!(error.ends_with("found `2024-08-24 13:09:99`"), "{error}");
}

#[test]
fn two_clocks_count_from_the_same_instant() {
    let mut text = "t1,Pos (mm),t2 (ms),Force (N)\n".to_owned();
    for step in 0..20 {
        let milliseconds = 1_724_504_945_000_u64 + 100 * step;
        text.push_str(&format!(
            "{}.{:03},{step},{},{}\n",
            milliseconds / 1000,
            milliseconds % 1000,
            milliseconds + 50,
            2 * step
        ));
    }
    let test = r#"
        columns.displacement = { unit = "mm", clock = { column = "t1", unit = "epoch" } }
        columns.force.clock = { column = "t2" }
    "#;
    let file = record(&text, test).unwrap();
    assert_eq!(file.start, Some(1_724_504_945.0));
    let (time, travel) = (file.record.time(), file.record.displacement().unwrap());
    assert!((time[0] - 0.05).abs() < 1e-6 && (travel[0] - 0.000_5).abs() < 1e-8, "{} {}", time[0], travel[0]);
}

#[test]
fn a_real_gripper() {
    let folder = std::env::var_os("PALPATE_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), std::path::PathBuf::from);
    let path = folder.join("gripper-fruit/banana_ForceData_20240824_210940_refined.csv");
    if !path.is_file() {
        eprintln!("SKIPPED: no {}; set PALPATE_DATA to the folder of real records", path.display());
        return;
    }
    let units = "columns = { time.unit = \"epoch\", displacement.unit = \"mm\", force.unit = \"N\" }";
    let test = parse_test(units, Path::new("test.toml")).unwrap();
    let file = read_record(&path, Some(&test), &mut |_, _| Ok(())).unwrap();
    assert_eq!((file.start, file.record.time()[0], file.rows), (Some(1_724_504_945.198_464_4), 0.0, 3552));
    assert_eq!(file.columns[0].unit, "s since 1970");
}

/// Past midnight the time of day went back to zero.
#[test]
fn date_and_time_of_day_in_two_columns_are_one_time() {
    let text = "Datum;Uhrzeit;Kraft (N)\n24.11.2026;23:59:59,5;1\n25.11.2026;00:00:00,0;2\n25.11.2026;00:00:00,5;3\n";
    let input = Input::from_bytes("press.csv", text.as_bytes()).expect("bytes");
    let contents = Contents::of(input, &ReadOptions::default()).expect("a file");
    let file = read_part(&contents, 0, None, &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(file.record.time(), [0.0, 0.5, 1.0]);
    assert_eq!(file.start, Some(1_795_564_799.5));
}
