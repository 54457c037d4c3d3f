//! Columns from a header or a description, and what is made of them.

use std::path::Path;

use palpate::record::{Clock, Correction};
use palpate_files::{description::parse_test, naming::Quantity, record::Role};

use super::read;

const PRESS: &str = "Time (s),Displacement (mm),Force (N)\n0,0,0\n0.5,5,12\n1,5,9\n";

#[test]
fn a_header_is_enough() {
    let file = read(PRESS, "").unwrap();
    assert_eq!(file.record.time(), [0.0, 0.5, 1.0]);
    assert_eq!(file.record.displacement(), Some([0.0, 0.005, 0.005].as_slice()));
    assert_eq!(file.record.force(), [0.0, 12.0, 9.0]);
    assert_eq!((file.rows, file.per_unit_area), (3, false));
    let roles: Vec<Role> = file.columns.iter().map(|column| column.role).collect();
    let all = [Quantity::Time, Quantity::Displacement, Quantity::Force];
    assert_eq!(roles, all.map(Role::Values));
    assert_eq!((file.columns[1].factor, file.columns[1].unit.as_str()), (1e-3, "mm"));
    assert_eq!(file.bytes, PRESS.len() as u64);
}

#[test]
fn the_description_goes_before_the_header() {
    let test = "[columns]\nforce = { column = 2, unit = \"kN\", sign = -1 }\ndisplacement = { column = \"Force\", unit = \"cm\" }\ntime = { unit = \"min\" }";
    let file = read(PRESS, test).unwrap();
    assert_eq!(file.record.time(), [0.0, 30.0, 60.0]);
    assert_eq!(file.record.displacement(), Some([0.0, 0.12, 0.09].as_slice()));
    assert_eq!(file.record.force(), [0.0, -5000.0, -5000.0]);
    assert!(file.record.force()[0].is_sign_positive());
    assert_eq!(file.columns[2].sign, -1.0);
}

/// A column called displacement was used, whatever a description stated.
#[test]
fn a_column_that_is_not_used_is_not_recognised_by_its_name() {
    for unused in ["2", "\"Displacement\""] {
        let file = read(PRESS, &format!("[columns]\nunused = [{unused}]")).unwrap();
        assert_eq!(file.record.displacement(), None);
        let roles: Vec<Role> = file.columns.iter().map(|column| column.role).collect();
        assert_eq!(roles, [Quantity::Time, Quantity::Force].map(Role::Values));
    }
    let error = read(PRESS, "[columns]\nunused = [3]").unwrap_err().to_string();
    assert!(error.contains("force"), "{error}");
    let error = read(PRESS, "[columns]\nunused = [\"Weg\"]").unwrap_err().to_string();
    assert!(error.contains("Weg"), "{error}");
    // Of two columns of one name the other is taken, which was ambiguous.
    let twice = "Time (s),Force (N),Force (N)\n0,0,1\n0.5,12,13\n1,9,10\n";
    assert_eq!(read(twice, "[columns]\nunused = [2]").unwrap().record.force(), [1.0, 13.0, 10.0]);
    // By its number and by its name.
    for stated in ["2", "\"Displacement\""] {
        let both = format!("[columns]\nunused = [2]\ndisplacement = {{ column = {stated} }}");
        let error = read(PRESS, &both).unwrap_err();
        let (text, hint) = (error.to_string(), error.hint().unwrap());
        assert!(text.contains("column 2 (Displacement): expected a column that is used"), "{text}");
        assert!(hint.contains("take it out of columns.unused"), "{hint}");
    }
}

/// A cantilever of 0.04 N/m: by Hooke's law the force is 0.04 nN for each nm.
#[test]
fn a_deflection_times_the_spring_constant_is_the_force() {
    let table = "Time (s),Cantilever (nm),Piezo (nm)\n0,0,100\n1,50,200\n2,25,200\n";
    let height = "displacement = { column = \"Piezo\" }\n";
    let deflection = "deflection = { column = \"Cantilever\", spring_constant = \"0.04 N/m\" }\n";
    let file = read(table, &format!("[columns]\n{height}{deflection}")).unwrap();
    let same = |found: &[f64], expected: [f64; 3]| {
        assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-21), "{found:?}");
    };
    same(file.record.force(), [0.0, 2e-9, 1e-9]);
    same(file.record.displacement().unwrap(), [1e-7, 1.5e-7, 1.75e-7]);
    let roles: Vec<Role> = file.columns.iter().map(|column| column.role).collect();
    assert_eq!(roles[1..], [Role::Values(Quantity::Displacement), Role::Deflection, Role::Values(Quantity::Force)]);
    for more in ["unit = \"nm\", ", "sign = -1, "] {
        let deflection = deflection.replace("spring", &format!("{more}spring"));
        let other = read(table, &format!("[columns]\n{height}{deflection}")).unwrap();
        assert_eq!(other.record.force()[1].abs(), file.record.force()[1]);
    }
    // The file may have it, with its unit.
    let bare = "deflection = { column = \"Cantilever\" }\n";
    let stated = format!("k (N/m),0.04\n\n{table}");
    let file = read(&stated, &format!("[columns]\n{height}{bare}")).unwrap();
    same(file.record.force(), [0.0, 2e-9, 1e-9]);
    let error = read(table, &format!("[columns]\n{height}{bare}")).unwrap_err();
    assert!(error.to_string().contains("expected a column of force"), "{error}");
    // A column of force goes before it.
    let forces = "k (N/m),0.04\n\nTime (s),Cantilever (nm),Piezo (nm),Load (nN)\n0,0,100,0\n1,50,200,7\n2,25,200,6\n";
    let file = read(forces, &format!("[columns]\n{height}{bare}")).unwrap();
    same(file.record.force(), [0.0, 7e-9, 6e-9]);
}

#[test]
fn a_spring_constant_beside_a_force_is_refused() {
    let columns = "[columns]\nforce = { column = 2 }\ndisplacement = { column = 3 }\n\
        deflection = { column = 2, spring_constant = \"0.04 N/m\" }";
    let error = parse_test(columns, Path::new("test.toml")).unwrap_err().to_string();
    assert!(error.contains("columns.deflection.spring_constant") && error.contains("columns.force"), "{error}");
    let columns = columns.replace("force = { column = 2 }\n", "").replace("0.04 N/m", "-1 N/m");
    let error = parse_test(&columns, Path::new("test.toml")).unwrap_err().to_string();
    assert!(error.contains("expected a stiffness above 0 N/m"), "{error}");
}

#[test]
fn displacement_may_be_missing() {
    let file = read("t [ms];Kraft [kN]\n0;0,5\n1;0,25\n", "").unwrap();
    assert_eq!(file.record.displacement(), None);
    assert_eq!((file.record.time(), file.record.force()), ([0.0, 0.001].as_slice(), [500.0, 250.0].as_slice()));
}

#[test]
fn stress_becomes_force() {
    let table = "Time (s),Stress (MPa)\n0,0\n1,0.5\n2,0.25\n";
    let file = read(table, "").unwrap();
    assert!(file.per_unit_area);
    assert_eq!(file.record.force(), [0.0, 0.5e6, 0.25e6]);
    assert_eq!(file.columns[1].role, Role::Values(Quantity::Stress));
    let strip = "specimen = { shape = \"block\", area = \"40 mm^2\", length = \"2 cm\" }";
    let file = read(table, strip).unwrap();
    assert!(!file.per_unit_area);
    assert_eq!(file.record.force(), [0.0, 20.0, 10.0]);
    let both = "Time (s),Tensile stress (MPa),Load (N)\n0,0,0\n1,0.5,7\n";
    assert_eq!(read(both, "").unwrap().record.force(), [0.0, 7.0]);
    assert_eq!(read(both, "columns.stress = {}").unwrap().record.force(), [0.0, 5e5]);
}

#[test]
fn clocks_of_their_own() {
    let table = "0,0,-0.5,0\n1,-2,0.5,1\n2,-2,1.5,3\n3,-2,2.5,2\n";
    let test = "[file]\nheader = false\n[columns.displacement]\ncolumn = 2\nunit = \"mm\"\nsign = -1\nclock = { column = 1, unit = \"s\" }\n[columns.force]\ncolumn = 4\nunit = \"N\"\n";
    let file = read(table, &format!("{test}clock = {{ column = 3, unit = \"s\" }}")).unwrap();
    assert_eq!(file.record.time(), [0.5, 1.5, 2.5]);
    assert_eq!(file.record.displacement(), Some([0.001, 0.002, 0.002].as_slice()));
    assert_eq!(file.record.force(), [1.0, 3.0, 2.0]);
    assert_eq!((file.rows, file.columns.len()), (4, 4));
    let same = read(table, &format!("{test}clock = {{ column = 1, unit = \"s\" }}")).unwrap();
    assert_eq!(same.record.len(), 4);
    let one = format!("{test}[columns.time]\ncolumn = 3\nunit = \"s\"");
    assert_eq!(read(table, &one).unwrap().record.time(), [0.5, 1.5, 2.5]);
}

#[test]
fn what_was_wrong_with_the_stamps_is_repaired_and_reported() {
    let mut table = String::from("Time (s),Displacement (mm),Force (N)\n");
    let rows: Vec<u32> = (0..100)
        .map(|i| {
            if i == 60 {
                61
            } else if i == 61 {
                60
            } else {
                i
            }
        })
        .collect();
    for row in rows {
        table.push_str(&format!("{:.1},{},{}\n", 0.1 * f64::from(row), row.min(50), 100 - row));
    }
    table.push_str("9.9,50,3\n");
    let file = read(&table, "").unwrap();
    assert_eq!((file.rows, file.record.len(), file.record.force()[99]), (101, 100, 2.0));
    assert!(file.record.time().windows(2).all(|pair| pair[1] > pair[0]));
    let stamps = &file.signals.stamps;
    assert_eq!((stamps.repeated, stamps.reversals.count, stamps.reversals.late_rows), (1, 1, 1));
    let done = file.record.corrections();
    assert!(
        matches!(
            done[0],
            Correction::StampsSorted {
                rows: 1,
                clock: Clock::Common,
                ..
            }
        ),
        "{done:?}"
    );
    assert!(
        matches!(
            done[1],
            Correction::StampsMerged {
                rows: 101,
                merged: 1,
                identical: 0,
                ..
            }
        ),
        "{done:?}"
    );
    assert_eq!(read(PRESS, "").unwrap().record.corrections(), []);
}

#[test]
fn volts_are_scaled_and_shifted() {
    let table = "Time (s),Displacement (mm),Force (V)\n0,0,0.5\n1,5,-1\n2,5,2\n";
    let test = "columns.force = { scale = \"12.5 N/V\", offset = \"0.25 N\", sign = -1 }";
    let file = read(table, test).unwrap();
    assert_eq!(file.record.force(), [-6.5, 12.25, -25.25]);
    assert_eq!((file.columns[2].unit.as_str(), file.columns[2].factor, file.columns[2].offset), ("V", 12.5, 0.25));
    let error = read(table, "").unwrap_err();
    assert!(error.hint().unwrap().contains("[columns.force]\nunit = \"V\"\nscale = \"1 N/V\""), "{error}");
    let offset = read(PRESS, "columns.force.offset = \"1 kN\"").unwrap();
    assert_eq!(offset.record.force(), [1000.0, 1012.0, 1009.0]);
}

#[test]
fn round_numbers_stay_round() {
    let file = read("Time_S,Displacement_mm,Size_mm,Force_mN\n0,35,1,3\n0.1,4.375,2,7\n", "").unwrap();
    assert_eq!(file.record.displacement(), Some([0.035, 0.004_375].as_slice()));
    assert_eq!(file.record.force(), [0.003, 0.007]);
}

#[test]
fn units_in_the_brackets_of_japan() {
    for header in [
        "時間【s】,変位（mm）,荷重［N］",
        "時間（秒）,ストローク［ｍｍ］,試験力〔Ｎ〕",
        "時間,変位,荷重\n［s］,［mm］,［N］",
    ] {
        let file = read(format!("{header}\n0,0,0\n0.5,1,2\n1,1,1.5\n"), "").unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(file.record.displacement().unwrap()[2], 1e-3, "{header}");
        assert_eq!((file.record.time()[1], file.record.force()[1]), (0.5, 2.0), "{header}");
    }
}

#[test]
fn displacements_by_the_names_that_machines_give_them() {
    for name in [
        "Distance",
        "Extensión",
        "Eindringtiefe",
        "Elongation",
        "Deformation",
        "Penetration",
        "Compression",
        "Verformung",
        "Stauchung",
        "Déformation",
        "Enfoncement",
        "Posición",
        "伸び",
        "押込み量",
        "disp_",
    ] {
        let table = format!("Time (s),{name} (mm),Force (N)\n0,1,1\n1,2,2\n2,2,1\n");
        let read = read(&table, "").unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(read.record.displacement(), Some([1e-3, 2e-3, 2e-3].as_slice()), "{name}");
    }
    // The force under a compression is a force.
    let read = read("Time (s),Compression force (N)\n0,1\n1,2\n2,1\n", "").unwrap();
    assert_eq!((read.record.displacement(), read.record.force()), (None, [1.0, 2.0, 1.0].as_slice()));
}

#[test]
fn times_of_day_and_german_dates_are_times() {
    for (first, second, third) in [
        ("12.03.2024 10:11:12.000", "12.03.2024 10:11:12.100", "12.03.2024 10:11:12.200"),
        ("12.03.2024 10:11:12", "12.03.2024 10:11:12.1", "12.03.2024 10:11:12.2"),
        ("2024-03-12T10:11:12", "2024-03-12T10:11:12.1", "2024-03-12T10:11:12.2"),
    ] {
        let table = format!("Timestamp;Weg (mm);Kraft (N)\n{first};0;1\n{second};1;2\n{third};1;1.5\n");
        let file = read(&table, "").unwrap();
        assert_eq!(file.record.time(), [0.0, 0.1, 0.2], "{first}");
        assert_eq!(file.start, Some(1_710_238_272.0));
    }
    let table = "Date,Time,Force (N)\n2024-03-12,0:00:00.5,1\n2024-03-12,0:00:01.5,2\n2024-03-12,0:00:02.5,1\n";
    let file = read(table, "").unwrap();
    assert_eq!((file.record.time(), file.start), ([0.5, 1.5, 2.5].as_slice(), None));
    assert_eq!(file.columns[0].unit, "time of day");
    let table = "Timestamp,Force (N)\n03/04/2024 10:11:12,1\n03/04/2024 10:11:13,2\n03/04/2024 10:11:14,1\n";
    let error = read(table, "").unwrap_err();
    assert!(
        error
            .to_string()
            .ends_with("column 1 (Timestamp): expected a time, found texts such as \"03/04/2024 10:11:12\"")
    );
    assert!(error.hint().unwrap().contains("12.03.2024 10:11:12.5"));
}

/// `Tempo`, `Forza` and `Corsa` were no names, and `Zeitstempel` no time; two rows with Excel's `#NV` stopped the reading.
#[test]
fn headers_in_italian_and_errors_of_a_spreadsheet_in_german() {
    let italian = "Tempo (s);Corsa (mm);Forza (N);Velocità (mm/s)\n0,0;0;1,5;0\n0,5;1;2,5;2\n1,0;1;2,0;0\n";
    let found = read(italian, "").unwrap();
    assert_eq!(found.record.displacement().unwrap(), [0.0, 1e-3, 1e-3]);
    assert_eq!(found.record.force(), [1.5, 2.5, 2.0]);
    let table =
        "Zeitstempel;Weg (mm);Kraft (N)\n12.03.2024 10:11:12;0;1\n12.03.2024 10:11:13;1;2\n12.03.2024 10:11:14;1;1,5\n";
    assert_eq!(read(table, "").unwrap().record.time(), [0.0, 1.0, 2.0]);
    let rows: String = (0..80)
        .map(|i| format!("{i};{}\n", if i == 40 { "#NV".to_owned() } else { format!("1,{i}") }))
        .collect();
    let found = read(format!("Zeit (s);Kraft (N)\n{rows}"), "").unwrap();
    assert_eq!(found.record.time().len(), 79);
}

/// A column that is called by its unit needed one more: the hint was seconds for "Minutes".
#[test]
fn a_clock_called_by_what_it_counts_has_its_unit() {
    for (name, last) in [("Minutes", 60.0), ("Sekunden", 1.0), ("Hours", 3600.0)] {
        let text = format!("{name},Disp (millimeters),Force (N)\n0,0,0\n0.5,1,2\n1,2,3\n");
        let found = read(text, "").unwrap().record;
        assert_eq!(found.time()[2] - found.time()[0], last, "{name}");
        assert_eq!(found.displacement().unwrap()[2], 2e-3, "{name}");
    }
}
