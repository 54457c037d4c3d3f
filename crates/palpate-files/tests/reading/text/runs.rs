//! Several tests below one line of names: a column names them, or the clock begins again.

use palpate_files::{
    FileError,
    description::{NamedColumns, TestDescription},
    input::Input,
    open::Contents,
    record::read_part,
    table::{Part, ReadOptions},
};

fn open(text: &str) -> Contents {
    let input = Input::from_bytes("runs.csv", text.as_bytes()).expect("bytes");
    Contents::of(input, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn titles(contents: &Contents) -> Vec<&str> {
    contents.parts.iter().map(Part::title).collect()
}

/// Force of a test at 0 to 9 s.
fn forces(contents: &Contents, part: usize) -> Vec<f64> {
    let read = read_part(contents, part, None, &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(read.record.time(), (0..10).map(f64::from).collect::<Vec<_>>());
    read.record.force().to_vec()
}

/// Rows `N;time;force` of tests, where `name` makes a test's first cell, its force falls from its number, and it begins at a time.
fn rows(tests: usize, name: impl Fn(usize) -> String, begins: impl Fn(usize) -> usize) -> String {
    let row = |test: usize, row: usize| format!("{};{},0;{},{row}\n", name(test), begins(test) + row, test + 1);
    (0..tests)
        .flat_map(|test| (0..10).map(move |at| (test, at)))
        .map(|(test, at)| row(test, at))
        .collect()
}

#[test]
fn specimens_in_a_column_are_tests() {
    let names = "Maschine;XY\nRadius;10,0;mm\n\nPrüfling;Zeit;Kraft\n;s;N\n";
    let text = format!("{names}{}", rows(3, |test| format!("K{test}"), |_| 0));
    let contents = open(&text);
    assert_eq!(titles(&contents), ["K0", "K1", "K2"]);
    assert_eq!(contents.parts.iter().map(|part| part.metadata.len()).collect::<Vec<_>>(), [2, 2, 2]);
    for part in 0..3 {
        assert_eq!(forces(&contents, part)[3], part as f64 + 1.3);
    }
    // A clock that goes on tells nothing of the specimens.
    assert_eq!(
        titles(&open(&format!("{names}{}", rows(2, |test| format!("K{test}"), |test| 40 * test)))),
        ["K0", "K1"]
    );
    // What cannot be read has the line that it has in the file.
    let broken = text.replace("K2;4,0;3,4", "K2;4,0;x");
    let error: FileError = open(&broken).read(2, &[2, 3], &mut |_, _| Ok(())).unwrap_err();
    assert!(error.to_string().contains("line 30"), "{error}");
}

#[test]
fn numbers_of_tests_stand_behind_the_name_of_their_column() {
    let text = format!("Test No;Time (s);Force (N)\n{}", rows(2, |test| format!("{}", test + 1), |_| 0));
    assert_eq!(titles(&open(&text)), ["Test No 1", "Test No 2"]);
}

#[test]
fn a_clock_that_begins_again_begins_a_test() {
    let text = format!("Batch;Time (s);Force (N)\n{}", rows(3, |_| "a".to_owned(), |_| 0));
    let contents = open(&text);
    assert_eq!(titles(&contents), ["run 1", "run 2", "run 3"]);
    assert_eq!(forces(&contents, 1)[9], 2.9);
    // What each has for itself names it, whatever its column is called.
    let text = format!("Gel;Time (s);Force (N)\n{}", rows(2, |test| ["soft", "stiff"][test].to_owned(), |_| 0));
    assert_eq!(titles(&open(&text)), ["soft", "stiff"]);
}

#[test]
fn what_is_one_test_stays_one() {
    let one = |text: String| assert_eq!(titles(&open(&text)), ["the file"], "{text}");
    // A clock that steps back elsewhere, passes midnight or falls; samples that are counted; a specimen that comes back.
    one(format!("a;Time (s);Force (N)\n{}", rows(2, |_| "a".to_owned(), |test| 6 - 3 * test)));
    let day = |test: usize| [86_390, 0][test];
    one(format!("a;Time (s);Force (N)\n{}", rows(2, |_| "a".to_owned(), day)));
    let falling: String = (0..20).map(|row| format!("a;{};{row}\n", 20 - row)).collect();
    one(format!("a;Time (s);Force (N)\n{falling}"));
    let counted: String = (0..20).map(|row| format!("{row};{row};{row}\n")).collect();
    one(format!("Test;Time (s);Force (N)\n{counted}"));
    one(format!(
        "Specimen;Time (s);Force (N)\n{}",
        rows(4, |test| format!("K{}", test % 2), |test| 10 * test)
    ));
    // Parts of one test, whose clock goes on.
    let part = |test: usize| ["Ramp", "Hold"][test].to_owned();
    one(format!("Test;Time (s);Force (N)\n{}", rows(2, part, |test| 10 * test)));
    one(format!("Specimen;Time (s);Force (N)\n{}", rows(1, |_| "K".to_owned(), |_| 0)));
}

/// Rows sorted by time, or of tests that come back, were read as one test with a clock that stands or steps back.
#[test]
fn rows_of_several_tests_may_be_mixed_in_a_text() {
    let rows = |order: &mut dyn Iterator<Item = (usize, usize)>| -> String {
        order.map(|(test, at)| format!("{at},T{test},{}.{at}\n", test + 1)).collect()
    };
    let by_time = rows(&mut (0..10).flat_map(|at| [2, 0, 1].map(|test| (test, at))));
    let revisited = rows(
        &mut [0, 5]
            .into_iter()
            .flat_map(|from| [2, 0, 1].map(|test| (test, from)))
            .flat_map(|(test, from)| (from..from + 5).map(move |at| (test, at))),
    );
    for rows in [by_time, revisited] {
        let text = format!("Radius,10,mm\nTime (s),test_id,Force (N)\n{rows}Remark,,\n");
        let contents = open(&text);
        assert_eq!(titles(&contents), ["T2", "T0", "T1"], "{text}");
        assert_eq!(contents.parts.iter().map(|part| part.metadata.len()).collect::<Vec<_>>(), [1, 1, 1]);
        for (part, load) in [(0, 3.0), (1, 1.0), (2, 2.0)] {
            assert_eq!(forces(&contents, part)[4], load + 0.4);
        }
        // Lines are those of the file.
        let line = text.lines().position(|line| line == "7,T0,1.7").expect("a row") + 1;
        let read = contents.read(1, &[1, 3], &mut |_, _| Ok(())).expect("columns");
        assert_eq!(read.line_of(7), Some(line));
        let error: FileError =
            open(&text.replace("7,T0,1.7", "7,T0,x")).read(1, &[1, 3], &mut |_, _| Ok(())).unwrap_err();
        assert!(error.to_string().contains(&format!("line {line}, column 3")), "{error}");
        // A row without a name belongs to none of the tests between which it stands.
        let lacking = open(&text.replace("7,T0,1.7", "7,,1.7"));
        assert_eq!(lacking.read(1, &[1], &mut |_, _| Ok(())).expect("columns").rows(), 9);
        assert!(
            lacking.skipped.iter().any(|rows| rows.reason == "nothing in column test_id"),
            "{:?}",
            lacking.skipped
        );
    }
    // An identity cuts where a mere word does not: the clock goes on.
    let goes_on = |name: &str| {
        let row = |at: usize| format!("{at};{};{at}.5\n", ["a", "b"][at / 10]);
        titles(&open(&format!("Time (s);{name};Force (N)\n{}", (0..20).map(row).collect::<String>()))).len()
    };
    assert_eq!((goes_on("specimen_id"), goes_on("Specimen")), (2, 1));
}

/// Of a text of several specimens whose first has more lines than a layout is found out from, all was one test.
#[test]
fn a_clock_that_begins_again_far_below_begins_a_test() {
    let rows = |load: usize| (0..4200).map(|at| format!("{at},{}\n", load * at)).collect::<String>();
    let contents = open(&format!("Time (s),Force (N)\n{}{}", rows(1), rows(2)));
    assert_eq!(titles(&contents), ["run 1", "run 2"]);
}

/// A second table with other names or units behind the lines looked at first was read with those of the first.
#[test]
fn a_late_table_with_names_of_its_own_is_no_run_of_the_first() {
    let rows = |count: usize| (0..count).map(|at| format!("{at},{},0\n", at % 7)).collect::<String>();
    let names = "Time (s),Force (N),Displacement (mm)\n";
    let late = |between: &str| open(&format!("{names}{}{between}{}", rows(5000), rows(300)));
    assert_eq!(late("").parts.len(), 2);
    assert_eq!(late(names).parts.len(), 2);
    for between in [
        "Time (s),Force (kN),Displacement (mm)\n",
        "Time (s),Displacement (mm),Force (N)\n",
        "Specimen,K2,\n",
    ] {
        let contents = late(between);
        assert_eq!(contents.parts.len(), 1, "{between}");
        assert!(read_part(&contents, 0, None, &mut |_, _| Ok(())).is_err(), "{between}");
    }
    // One wrong stamp is no test.
    let stamped = rows(5000).replace("\n4500,", "\n0,");
    assert_eq!(open(&format!("{names}{stamped}")).parts.len(), 1);
}

/// Groups of columns side by side: only the last was read, and a short specimen was refused.
#[test]
fn columns_side_by_side_are_tests() {
    let row = |at: usize| {
        let force = |test: usize| at as f64 / 10.0 + test as f64;
        let short = if at < 10 { format!("{at},{},0", force(3)) } else { ",,".to_owned() };
        format!("{at},{},0,,{at},{},0,,{short}\n", force(1), force(2))
    };
    let names = "Time,Force,Disp,,Time,Force,Disp,,Time,Force,Disp\ns,N,mm,,s,N,mm,,s,N,mm\n";
    let rows: String = (0..12).map(row).collect();
    let contents = open(&format!("Operator,XY\nPad 1,,,,Pad 2,,,,Pad 3,,\n{names}{rows}"));
    assert_eq!(titles(&contents), ["Pad 1", "Pad 2", "Pad 3"]);
    assert_eq!(contents.parts.iter().map(|part| part.metadata.len()).collect::<Vec<_>>(), [1, 1, 1]);
    assert_eq!(forces(&contents, 2), (0..10).map(|at| f64::from(at) / 10.0 + 3.0).collect::<Vec<_>>());
    let first = read_part(&contents, 0, None, &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((first.rows, first.record.force()[11], first.ignored.lacking.rows), (12, 2.1, 0));
    // Rows that end with the last specimen that goes on; numbers behind the names.
    let text = "Time 1 (s),Force 1 (N),Time 2 (s),Force 2 (N)\n".to_owned()
        + &(0..12)
            .map(|at| if at < 10 { format!("{at},1.5,{at},{at}.5\n") } else { format!("{at},1.5\n") })
            .collect::<String>();
    let contents = open(&text);
    assert_eq!(titles(&contents), ["columns 1–2", "columns 3–4"]);
    assert_eq!(forces(&contents, 1)[3], 3.5);
    // A number behind the unit, as pandas writes it: only the first was read.
    for (second, third) in [
        ("Time (s).1,Force (N).1", "Time (s).2,Force (N).2"),
        ("Time (s) (2),Force (N) (2)", "Time (s) (3),Force (N) (3)"),
    ] {
        let rows: String = (0..10).map(|at| format!("{at},1.5,{at},{at}.5,{at},2.5\n")).collect();
        let contents = open(&format!("Time (s),Force (N),{second},{third}\n{rows}"));
        assert_eq!(titles(&contents).len(), 3, "{second}");
        assert_eq!(forces(&contents, 1)[3], 3.5, "{second}");
    }
    // What cannot be read has the line that it has in the file.
    let error: FileError =
        open(&text.replace("7,1.5,7,7.5", "7,1.5,7,x")).read(1, &[1, 2], &mut |_, _| Ok(())).unwrap_err();
    assert!(error.to_string().contains("line 9, column 2 (Force 2)"), "{error}");
    // Two clocks of one test, and one clock of two fingers.
    for names in ["Time,Force,Time,Disp", "Time,Force 1,Force 2,Disp"] {
        assert_eq!(open(&format!("{names}\n0,1.5,2,3\n1,2.5,3,4\n")).parts.len(), 1, "{names}");
    }
}

/// The second group has no displacement: that of the first was read beside its force.
#[test]
fn a_displacement_beside_another_time_is_of_another_test() {
    let rows: String = (0..10).map(|at| format!("{at},1.5,{at},{at},{at}.5\n")).collect();
    let contents = open(&format!("Time (s),Force (N),Displacement (mm),Time (s),Force (N)\n{rows}"));
    assert_eq!(contents.parts.len(), 1);
    let read = |columns: &str| {
        let test = TestDescription {
            columns: NamedColumns::parse(columns).expect("columns").columns,
            ..TestDescription::default()
        };
        read_part(&contents, 0, Some(&test), &mut |_, _| Ok(()))
            .unwrap_or_else(|error| panic!("{error}"))
            .record
    };
    assert!(read("force=5,time=4").displacement().is_none());
    assert!(read("force=2,time=1").displacement().is_some());
    assert!(read("force=5,time=4,displacement=3").displacement().is_some());
}
