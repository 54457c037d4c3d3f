//! Units above a table, scales in a header, shares, clocks of two fields, dates of a spreadsheet.

use palpate::units::scale;
use palpate_files::{naming::Quantity, record::Role};

use super::read;

const ROWS: &str = "0,0,0\n1,5,12\n2,5,9\n";

/// The force of the rows above under a header, less the lines above it.
fn force(text: &str) -> Result<Vec<f64>, String> {
    let read = read(text, "");
    read.map(|file| file.record.force().to_vec())
        .map_err(|error| format!("{error}\n{}", error.hint().unwrap_or_default()))
}

/// `Force unit: kN` above the names was passed over, and a hint proposed N.
#[test]
fn a_line_above_the_table_states_the_unit_of_a_column_without_one() {
    let header = "Time (s),Displacement (mm),Force\n";
    for (line, factor) in [
        ("Force unit: kN", 1e3),
        ("Force unit,kN", 1e3),
        ("# all forces in mN", 1e-3),
        ("Units: s, mm, kN", 1e3),
        ("Load in kN", 1e3),
    ] {
        let found = force(&format!("{line}\n{header}{ROWS}"));
        assert_eq!(found, Ok([0.0, 12.0, 9.0].map(|value| scale(value, factor)).to_vec()), "{line}");
    }
    let all = read(format!("Units: ms, um, mN\nTime,Displacement,Force\n{ROWS}"), "").unwrap();
    assert_eq!(all.record.time(), [0.0, 0.001, 0.002]);
    assert_eq!(all.record.displacement().unwrap()[1], 5e-6);
    let german = read("Einheit Kraft;kN\nZeit (s);Weg (mm);Kraft\n0;0;0\n1;5,5;12\n2;5,5;9\n", "").unwrap();
    assert_eq!(german.record.force(), [0.0, 12e3, 9e3]);
    for line in ["Load cell: 5 kN", "Force threshold,5,N", "Preload force: kN"] {
        let error = force(&format!("{line}\n{header}{ROWS}")).unwrap_err();
        assert!(error.contains("expected a unit for column 3 (Force)"), "{line}: {error}");
    }
}

/// `Load kN` was refused with the hint `force=Load kN:N`, which made the force a thousandth.
#[test]
fn the_last_word_of_a_header_is_its_unit() {
    for (names, factor, travel) in [
        ("Time s,Extension mm,Load kN", 1e3, 1e-3),
        ("Time s,Extension inch,Load lbf", 4.448_221_615_260_5, 0.0254),
        ("Zeit s,Weg um,Kraft mN", 1e-3, 1e-6),
        ("Time s,Position mm,Load N", 1.0, 1e-3),
    ] {
        let read = read(format!("{names}\n{ROWS}"), "").unwrap();
        let scaled = |values: [f64; 3], factor: f64| values.map(|value| scale(value, factor)).to_vec();
        assert_eq!(read.record.force(), scaled([0.0, 12.0, 9.0], factor), "{names}");
        assert_eq!(read.record.displacement().unwrap(), scaled([0.0, 5.0, 5.0], travel), "{names}");
    }
    // Words that are names as well are no units, but a hint may take them for some.
    for (names, hint) in [
        ("Time (s),Displacement (mm),Load cell", "force=Load cell:N"),
        ("Time (s),Displacement (mm),Force m", "force=Force m:N"),
        ("Time in,Displacement (mm),Force (N)", "time=Time in:s"),
        ("Time (s),Position in,Force (N)", "displacement=Position in:in"),
    ] {
        let error = force(&format!("{names}\n{ROWS}")).unwrap_err();
        assert!(error.contains(hint), "{names}: {error}");
    }
}

#[test]
fn a_line_above_that_contradicts_the_header_or_another_line_is_refused() {
    let error = force(&format!("Force unit: kN\nTime (s),Displacement (mm),Force (N)\n{ROWS}")).unwrap_err();
    assert!(error.contains("found kN in \"Force unit: kN\" above and N in the header"), "{error}");
    let error = force(&format!("Force unit: kN\nUnits: s, mm, N\nTime,Displacement,Force\n{ROWS}")).unwrap_err();
    assert!(error.contains("found kN in \"Force unit: kN\" above and N in \"Units: s, mm, N\" above"), "{error}");
    // What is stated holds.
    let stated = read(
        format!("Force unit: kN\nTime (s),Displacement (mm),Force (N)\n{ROWS}"),
        "[columns.force]\nunit = \"N\"",
    );
    assert_eq!(stated.unwrap().record.force(), [0.0, 12.0, 9.0]);
    let agrees = force(&format!("Force unit: mN\nTime (s),Displacement (mm),Force (10^-3 N)\n{ROWS}"));
    assert_eq!(agrees, Ok(vec![0.0, 0.012, 0.009]));
}

/// `Displacement (x10^-3 m)` was left out of the record, and hints took `Force (10^3 N)` and `Load (%)` for N.
#[test]
fn scales_are_applied_and_shares_are_refused() {
    let under = |names: &str| format!("{names}\n{ROWS}");
    for (name, factor) in [
        ("Force (x10^-3 N)", 1e-3),
        ("Force (10^3 N)", 1e3),
        ("Force [x1000 N]", 1e3),
        ("Force (N x 1e-3)", 1e-3),
        ("Force (×10⁻³ N)", 1e-3),
    ] {
        let found = force(&under(&format!("Time (s),Displacement (mm),{name}")));
        assert_eq!(found, Ok([0.0, 12.0, 9.0].map(|value| scale(value, factor)).to_vec()), "{name}");
    }
    let file = read(under("Time (x10^-3 s),Displacement (x10^-6 m),Force (N)"), "").unwrap();
    assert_eq!((file.record.time()[1], file.record.displacement().unwrap()[1]), (1e-3, 5e-6));
    for (names, expected, hint) in [
        ("Time (s),Displacement (mm),Load (%)", "\"%\" is not a unit of force", "force=Load:x5 N"),
        ("Time (s),Displacement (mm),Force (% FS)", "\"% FS\" is not a unit of force", "force=Force:x5 N"),
        ("Time (s),Displacement (mm),Force (100 N)", "\"100 N\" is not a unit of force", "force=Force:x100 N"),
        (
            "Time (s),Displacement (mm),Force x1000 (N)",
            "expected a scale beside the unit",
            "force=Force x1000:x10^-3 N",
        ),
        ("Time (s),Displacement (mm),Force (x 10^-3) (N)", "expected a scale beside the unit", "x10^-3 N"),
        (
            "Time (s),Displacement x1000 (mm),Force (N)",
            "expected a scale beside the unit",
            "displacement=Displacement x1000",
        ),
        (
            "Time (s),Displacement (%),Force (N)",
            "\"%\" is not a unit of displacement",
            "strain=Displacement:%",
        ),
        (
            "Time (s),Stroke (% FS),Force (N)",
            "\"% FS\" is not a unit of displacement",
            "displacement=Stroke:x5 mm",
        ),
        ("Time (%),Displacement (mm),Force (N)", "\"%\" is not a unit of time", "time=Time:x5 s"),
    ] {
        let error = force(&under(names)).unwrap_err();
        assert!(error.contains(expected) && error.contains(hint), "{names}: {error}");
    }
    let stated =
        read(under("Time (s),Displacement (mm),Load (%)"), "[columns.force]\nunit = \"x5 N\"\ncolumn = 3").unwrap();
    assert_eq!(stated.record.force(), [0.0, 60.0, 45.0]);
}

/// 45123.4567 and 45123.45670116 under `Time (s)` were a record of 45 µs.
#[test]
fn dates_of_a_spreadsheet_are_days() {
    let rows: String = (0..20)
        .map(|row| format!("{:.8},{row},{}\n", 45_123.456_7 + f64::from(row) / 86_400.0, row % 7))
        .collect();
    let error = force(&format!("Time (s),Displacement (mm),Force (N)\n{rows}")).unwrap_err();
    assert!(error.contains("like the dates of a spreadsheet, which count days: 45123.4567"), "{error}");
    assert!(error.contains("time=Time:d"), "{error}");
    let error = force(&format!("Time,Displacement (mm),Force (N)\n{rows}")).unwrap_err();
    assert!(error.contains("expected a unit for column 1 (Time)") && error.contains("time=Time:d"), "{error}");
    let named = read(format!("Time (days),Displacement (mm),Force (N)\n{rows}"), "").unwrap();
    assert!((named.record.time()[19] - 19.0).abs() < 2e-3, "{:?}", named.record.time());
    // 16 July 2023.
    assert_eq!(named.start.map(|start| (start / 86_400.0).floor()), Some(19_554.0));
    // Seconds since a machine was switched on.
    let seconds = read("Time (s),Force (N)\n45123.4,0\n45123.9,5\n45124.9,4\n", "").unwrap();
    assert_eq!(seconds.start, None);
    let stated = read(format!("Time (s),Displacement (mm),Force (N)\n{rows}"), "[columns.time]\nunit = \"s\"");
    assert!(stated.is_ok());
}

/// Clocks of minutes and seconds were texts.
#[test]
fn clocks_of_two_fields_are_minutes_and_seconds_or_what_is_stated() {
    let rows = |fraction: &str| format!("0:59{fraction},0,0\n1:00{fraction},5,12\n61:30{fraction},5,9\n");
    for header in ["Time", "Time (mm:ss)", "Time (s)"] {
        let file = read(format!("{header},Displacement (mm),Force (N)\n{}", rows(".5")), "").unwrap();
        assert_eq!(file.record.time(), [59.5, 60.5, 3690.5], "{header}");
    }
    let bare = format!("Time,Displacement (mm),Force (N)\n{}", rows(""));
    let error = force(&bare).unwrap_err();
    assert!(error.contains("found two of them: `0:59`") && error.contains("time=Time:s"), "{error}");
    let hours = read(&bare, "[columns.time]\nunit = \"min\"").unwrap();
    assert_eq!(hours.record.time(), [3540.0, 3600.0, 221_400.0]);
    assert_eq!(read(bare.replace("Time", "Time (mm:ss)"), "").unwrap().record.time(), [59.0, 60.0, 3690.0]);
}

/// `時間` without a unit was hours.
#[test]
fn a_name_that_is_also_a_unit_is_none() {
    let error = force(&format!("時間,変位(mm),荷重(N)\n{ROWS}")).unwrap_err();
    assert!(error.contains("expected a unit for column 1"), "{error}");
}

#[test]
fn an_extensometer_beside_the_crosshead_is_named() {
    let text = format!("Time (s),Crosshead (mm),Force (N),Extensometer (mm)\n{}", ROWS.replace('\n', ",1\n"));
    let file = read(&text, "").unwrap();
    assert_eq!(file.columns[1].role, Role::Values(Quantity::Displacement));
    let done: Vec<String> = file.record.corrections().iter().map(ToString::to_string).collect();
    assert_eq!(done, ["displacement read from \"Crosshead\", not from the extensometer \"Extensometer\""]);
    assert!(
        read(&text, "[columns.displacement]\ncolumn = \"Crosshead\"")
            .unwrap()
            .record
            .corrections()
            .is_empty()
    );
}
