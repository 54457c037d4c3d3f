//! Every error says where, what was expected and what was found, and how to go on.

use palpate_files::{description::parse_test, record::ReadError};

use super::read;

#[track_caller]
fn says(bytes: &str, test: &str, message: &[&str], hint: &[&str]) -> ReadError {
    let error = read(bytes, test).expect_err("an error");
    let (text, help) = (error.to_string(), error.hint().unwrap_or_default());
    eprintln!("{text}\n   hint: {help}");
    assert!(text.contains("press.csv"), "{text}");
    for part in message {
        assert!(text.contains(part), "{text}\n  lacks {part}");
    }
    for part in hint {
        assert!(help.contains(part), "{help}\n  lacks {part}");
    }
    error
}

/// The lines of a hint behind its first are a description that can be used.
fn pasted(error: &ReadError) -> String {
    let hint = error.hint().expect("a hint");
    hint.split_once('\n').expect("lines to paste").1.to_owned()
}

#[test]
fn without_names_the_columns_are_shown() {
    let table = "0,0.5,0.0\n1,0.25,5.5\n2,0.125,4.5\n";
    let error = says(
        table,
        "",
        &[
            "expected a column of force, found no names of columns in 3 columns",
            "\n  column 1: 0",
            "\n  column 2: 0.5",
        ],
        &[
            "in a test description:\n[columns]\n",
            "time = { column = 1, unit = \"s\" }  # check: starts with 0\n",
            "displacement = { column = 2, unit = \"mm\" }  # check: starts with 0.5; omit if there is none",
            "force = { column = 3, unit = \"N\" }",
        ],
    );
    let file = read(table, &pasted(&error)).unwrap();
    assert_eq!(file.record.force(), [0.0, 5.5, 4.5]);
}

#[test]
fn names_that_say_nothing() {
    let table = "Zeit (s),U1 (V),Weg (mm)\n0,1,2\n1,2,3\n";
    says(
        table,
        "",
        &["expected a column of force, found no name for it in 3 columns", "column 2 (U1): 1"],
        &["time = { column = 1", "displacement = { column = 3", "force = { column = 2"],
    );
    says(
        "Last (N),Force (N)\n0,1\n1,2\n",
        "",
        &["expected a column of time"],
        &["# time: no candidate column remains", "force = { column = 2"],
    );
    // The one column beside the time was proposed as a displacement, with no force left.
    says("0,1\n0.1,2\n0.2,3\n", "", &["expected a column of"], &["--columns \"force=2:N,time=1:s\""]);
    says("Zeit (s),U (V)\n0,1\n1,2\n", "columns.stress = {}", &["expected a column of stress"], &[]);
}

#[test]
fn units_are_requested_for() {
    let table = "Time,Pos,Force,GoalForce\n0,1,2,3\n1,2,3,4\n";
    let error = says(
        table,
        "",
        &["expected a unit for column 1 (Time), column 2 (Pos), column 3 (Force), found none in the header"],
        &[
            "[columns.time]\nunit = \"s\"",
            "[columns.displacement]\nunit = \"mm\"",
            "[columns.force]\nunit = \"N\"",
        ],
    );
    let file = read(table, &pasted(&error)).unwrap();
    assert_eq!(file.record.displacement(), Some([0.001, 0.002].as_slice()));
    let clock = "[columns.force]\nclock = { column = 1 }";
    says(table, clock, &["column 1 (Time)"], &["[columns.force.clock]\ncolumn = 1\nunit = \"s\""]);
    says(
        "Time (s),Force (lbs)\n0,1\n1,2\n",
        "",
        &["column 2 (Force): \"lbs\" is not a unit of force (accepted: N, kN"],
        &["if \"lbs\" stands for lbf", "[columns.force]\nunit = \"lbf\""],
    );
}

/// Grams were refused without a line to write, and a torque over an angle was offered N and mm.
#[test]
fn units_of_other_machines_are_led_to_what_a_record_needs() {
    let grams = "Time (s),Distance (mm),Force (g)\n0,1,2\n1,2,3\n";
    let error = says(
        grams,
        "",
        &["\"g\" is not a unit of force"],
        &["if \"g\" stands for gf, state it", "force=Force:gf"],
    );
    assert_eq!(read(grams, &pasted(&error)).unwrap().record.force()[0], 2.0 * 9.806_65e-3);
    for text in [
        "Time (s),Angle (deg),Torque (Nm)\n0,1,2\n1,2,3\n",
        "Zeit (s),Winkel (°),Drehmoment (N·mm)\n0,1,2\n1,2,3\n",
        "Time (s),Travel (mm),Load (N m)\n0,1,2\n1,2,3\n",
    ] {
        says(
            text,
            "",
            &[],
            &[
                "a force and a length are needed",
                "with a lever arm, write columns",
                "1 N m is 20 N and 1° is 0.8727 mm",
            ],
        );
    }
    let gripper = "Time (s),Position (rad),Force (N)\n0,1,2\n1,2,3\n";
    let error = says(gripper, "", &["\"rad\" is not a unit of displacement"], &["travel_per_unit = \"50 mm\""]);
    let file = read(gripper, &pasted(&error)).unwrap();
    assert_eq!(file.record.displacement(), Some([0.05, 0.1].as_slice()));
}

/// A creep logged as strain under one stress was given to check its load cell.
#[test]
fn a_strain_under_constant_stress_is_a_creep() {
    let table = "t\tstrain\tstress\ns\t-\tPa\n0\t0.01\t10\n1\t0.02\t10\n2\t0.025\t10\n";
    let file = read(table, "").unwrap();
    assert_eq!(file.record.displacement(), Some([0.01, 0.02, 0.025].as_slice()));
    assert_eq!(file.record.force(), [10.0; 3]);
}

#[test]
fn two_of_a_kind() {
    let table = "Time (s),Force 1 (N),Force 2 (N)\n0,1,2\n1,2,3\n";
    let error = says(
        table,
        "",
        &["expected one column of force, found column 2 (Force 1) and column 3 (Force 2)"],
        &["[columns.force]\ncolumn = 2"],
    );
    assert_eq!(read(table, &pasted(&error)).unwrap().record.force(), [1.0, 2.0]);
    says(
        table,
        "[columns]\nforce = { column = 2 }\ndisplacement = { column = 2, unit = \"mm\" }",
        &["column 2 (Force 1): expected one quantity in a column, found displacement and force"],
        &["columns.displacement or columns.force"],
    );
}

#[test]
fn columns_that_are_not_there() {
    let table = "Time (s),Force (N),Force (N)\n0,1,2\n1,2,3\n";
    says(
        table,
        "columns.force.column = 9",
        &[
            "columns.force.column: expected a number from 1 to 3 or a name that one column has (\"Time\" in s, \"Force\" in N, \"Force\" in N), found 9",
        ],
        &["count from 1"],
    );
    says(table, "columns.force.column = \"Last\"", &["found \"Last\""], &[]);
    says(table, "columns.force.column = \"Force\"", &["a name that one column has", "found \"Force\""], &[]);
    says(
        "0,1\n1,2\n",
        "columns.force = { column = \"Last\" }",
        &["a number from 1 to 2 (the columns have no names), found \"Last\""],
        &[],
    );
    let ball = "specimen = { shape = \"ball\", radius = \"35 mm\" }";
    says(
        "Time (s),Stress (Pa)\n0,1\n1,2\n",
        ball,
        &["column 2 (Stress): expected force and displacement for a body whose contact area changes"],
        &["describe the body as a strip"],
    );
}

#[test]
fn numbers_that_make_no_record_name_their_line() {
    let error = says(
        "Time (s),Force (N)\n0,1\n\n2,2\n1,3\n",
        "",
        &[
            "line 5: time must rise from row to row, found a clock that steps back by up to 1 s (1 of 3 rows",
            "to 1 s after 2 s",
        ],
        &["the file holds several tests: name each in a column test_id, or split it there"],
    );
    assert!(!error.to_string().contains("in row"), "{error}");
    says("Time (s),Force (N)\n0,1\n1,1\n", "", &["press.csv: the force is 1 N in all 2 rows"], &["load cell"]);
    says("Time (s),Force (N)\n0,1\n", "", &["a record needs 2 rows or more, found 1"], &[]);
    says("Time (s),Force (N)\n0,1\n1,x\n2,3\n", "", &["line 3, column 2 (Force): expected a number"], &[]);
    let clocks = "[columns]\ndisplacement = { column = 2, unit = \"mm\", clock = { column = 1, unit = \"s\" } }\nforce = { column = 4, unit = \"N\", clock = { column = 3, unit = \"s\" } }";
    says("0,1,0,1\n1,2,2,2\n2,3,1,3\n", clocks, &["line 3: time must rise"], &[]);
    says("Time (s),Force (N)\n1,1\n1,2\n", "", &["a record needs 2 rows or more, found 1"], &[]);
    says(
        "0,1,10,1\n1,2,11,2\n2,3,12,3\n",
        clocks,
        &["do not overlap in time"],
        &["units and columns of the two clocks"],
    );
}

#[test]
fn files_that_cannot_be_read_say_so() {
    says("", "", &["the file is empty"], &["export"]);
    let test = parse_test("", "test.toml".as_ref()).unwrap();
    let error = palpate_files::record::read_record("none.csv".as_ref(), Some(&test), &mut |_, _| Ok(()));
    let error = error.unwrap_err();
    assert_eq!(error.to_string(), "none.csv: no such file");
    assert!(error.hint().unwrap().contains("spelling"));
}

#[test]
fn a_unit_that_is_none_is_named() {
    let error = says(
        "Time (s),Force (furlong)\n0,1\n1,2\n2,1\n",
        "",
        &["column 2 (Force (furlong)): \"furlong\" is not a unit of force", "accepted: N, kN"],
        &["[columns.force]\nunit = \"N\"\ncolumn = 2"],
    );
    assert!(read("Time (s),Force (furlong)\n0,1\n1,2\n2,1\n", &pasted(&error)).is_ok());
    let table = "Time (mm),Force (N)\n0,1\n1,2\n2,1\n";
    let error = says(
        table,
        "",
        &["column 1 (Time): \"mm\" is not a unit of time"],
        &["[columns.time]\nunit = \"s\"\ncolumn = 1"],
    );
    assert!(read(table, &pasted(&error)).is_ok());
}

#[test]
fn many_columns_are_not_all_shown() {
    let names: Vec<String> = (1..=30).map(|i| format!("c{i}")).collect();
    let row = vec!["1"; 30].join(",");
    let table = format!("{}\n{row}\n{row}\n{row}\n", names.join(","));
    let error = says(&table, "", &["in 30 columns", "column 8 (c8)", "… and 22 more"], &[]);
    assert!(!error.to_string().contains("(c9)"));
}

/// A column in mm of a name that was not known was left aside, and the record passed for one of force alone.
#[test]
fn a_length_of_unknown_name_is_requested_about() {
    let table = "Zeit [s];Vorschub [mm];Kraft [N]\n0;0,5;1,5\n1;1,5;2,5\n2;1,5;2,1\n";
    let error = says(
        table,
        "",
        &["expected a name that indicates whether column 2 (Vorschub) is the displacement, found no known name"],
        &["[columns.displacement]\ncolumn = 2\nunit = \"mm\"", "[columns.force]\ncolumn = 3"],
    );
    let hint = error.hint().unwrap();
    let (with, without) = hint.split_once("\nor, if it is not, name the force alone:\n").unwrap();
    let with = read(table, with.split_once('\n').unwrap().1).unwrap();
    assert_eq!(with.record.displacement(), Some([0.5e-3, 1.5e-3, 1.5e-3].as_slice()));
    let without = read(table, without).unwrap();
    assert_eq!(without.record.displacement(), None);
    // A letter that usually stands for a length is in question as well; what no length can be is not.
    says(
        "t,z,F\n0,1,1\n1,2,2\n2,2,1\n",
        "columns.time.unit = \"s\"\ncolumns.force.unit = \"N\"",
        &["column 2 (z) is the displacement"],
        &[],
    );
    assert!(read("Time (s),Temperature (°C),Force (N)\n0,20,1\n1,20,2\n2,20,1\n", "").is_ok());
    assert!(read("Time (s),Max displacement (mm),Force (N)\n0,20,1\n1,20,2\n2,20,1\n", "").is_ok());
}

/// The row of units won over the unit in the name: forces a thousand times too large, and nothing stated.
#[test]
fn two_units_for_one_column_are_requested_about() {
    let table = "Time (s),Force (N)\ns,kN\n0,1\n1,2\n2,1\n";
    let error = says(
        table,
        "",
        &["column 2 (Force (N)): expected one unit, found N in its name and kN beside it"],
        &["[columns.force]\nunit = \"kN\"\ncolumn = 2"],
    );
    assert_eq!(read(table, error.hint().unwrap().split_once('\n').unwrap().1).unwrap().record.force()[1], 2000.0);
    assert!(read("Time (s),Force (N)\ns,N\n0,1\n1,2\n2,1\n", "").is_ok());
}

/// Units that no list knows, in a column that nobody needs, were taken for the names of the columns (MTS TestSuite).
#[test]
fn a_row_of_units_is_known_by_most_of_them() {
    let table = "Axial Count\tRunning Time\tAxial Displacement\tAxial Force\nturns\tSec\tmm\tdaN\n1\t0\t0\t0\n2\t1\t1\t2\n3\t2\t1\t1\n";
    let file = read(table, "").unwrap();
    assert_eq!(file.record.force(), [0.0, 20.0, 10.0]);
    assert_eq!(file.columns[1].name.as_deref(), Some("Axial Displacement"));
}

/// "Found no name for it", of a column called Force.
#[test]
fn numbers_written_as_texts_are_named() {
    let minus = "Time (s),Weg (mm),Force (N)\n0,0,\u{2212}1\n1,1,\u{2212}2\n2,1,\u{2212}1\n";
    says(minus, "", &["column 3 (Force): expected numbers in every row, found `\u{2212}1`"], &["U+2212"]);
    let thousands = "Time (s);Weg (mm);Force (N)\n0;0;1\n1;1;1 02,5\n2;1;1 01,5\n";
    says(thousands, "", &["column 3 (Force)", "found `1 02,5`"], &["without thousands separators"]);
    // A displacement was left out.
    let travel = "Time (s),Weg (mm),Force (N)\n0,\u{2212}0,1\n1,\u{2212}1,2\n2,\u{2212}1,1\n";
    says(travel, "", &["column 2 (Weg): expected numbers"], &["U+2212"]);
}

#[test]
fn a_scale_is_for_volts() {
    says(
        "Time (s),Force (N)\n0,1\n1,2\n2,1\n",
        "columns.force.scale = \"2 N/V\"",
        &["column 2 (Force): expected volts for `scale`, found N"],
        &["remove `scale`", "unit = \"V\""],
    );
}
