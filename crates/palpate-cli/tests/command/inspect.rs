//! `palpate inspect` and `palpate convert`: what a file is, the cut into phases, a first description, a plain table.

use std::fs;
use std::path::Path;

use crate::common::{data, done, file, palpate, ramp_and_hold, refused};

/// The table of phases of a record.
fn phases(folder: &Path, arguments: &[&str]) -> String {
    let reported = done(folder, arguments);
    let (_, table) = reported.split_once("\nPhases\n").unwrap_or_else(|| panic!("{reported}"));
    // Up to the line below the rows; whether a first touch is sought depends on the description.
    let mut rules = table.match_indices("\n──");
    let end = rules.nth(1).map_or(table.len(), |(place, _)| place);
    table[..end].to_owned()
}

/// What an inspection reports, in one line.
fn inspected(folder: &Path, arguments: &[&str]) -> String {
    done(folder, &[&["inspect"], arguments].concat()).replace('\n', " ")
}

/// What stands on standard error where inspection failed, but showed what is in the file.
fn failed_but_reported(folder: &Path, arguments: &[&str]) -> String {
    let output = palpate(folder, arguments);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{error}");
    let reported = String::from_utf8_lossy(&output.stdout);
    assert!(reported.contains("Columns"), "{reported}");
    error
}

#[test]
fn the_cut_is_observed_at_a_glance() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let record = file(folder, "press.csv", ramp_and_hold(7.0, 20.0));
    let reported = done(folder, &["inspect", &record]);
    let line = |label: &str| {
        let line = reported.lines().find(|line| line.starts_with(label)).unwrap_or_else(|| panic!("{reported}"));
        line[label.len()..].trim().to_owned()
    };
    assert_eq!(line("displacement  ").chars().count(), 64);
    // One of eight seconds is a ramp.
    assert_eq!(line("phases  "), format!("{}{}", "/".repeat(8), "━".repeat(56)));
    let force = line("force  ");
    assert!(force.starts_with('▁') && force.contains('█') && !force.ends_with('█'), "{force}");
}

#[test]
fn the_cut_as_a_figure() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let record = file(folder, "press.csv", ramp_and_hold(7.0, 20.0));
    done(folder, &["inspect", &record, "--figure", "cut.svg"]);
    let figure = fs::read_to_string(folder.join("cut.svg")).unwrap();
    assert!(figure.contains("Displacement") && figure.contains("Force"), "{}", &figure[..300]);
    let error = refused(folder, &["inspect", &record, "--figure", "cut.eps"]);
    assert!(error.contains("expected a figure ending in .svg, .png or .pdf"), "{error}");
}

#[test]
fn a_first_description_gives_the_same_record() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let text = ramp_and_hold(7.0, 20.0);
    let german: String = text
        .lines()
        .map(|line| line.replace(',', ";").replace('.', ",") + "\r\n")
        .collect::<String>()
        .replace("time_s;displacement_mm;force_n", "Prüfzeit (s);Weg (mm);Kraft (N)");
    let latin: Vec<u8> = german.chars().map(|letter| letter as u8).collect();
    let doubled = text.replace("time_s,displacement_mm,force_n", "Force,time_s,displacement_mm,Force (N)");
    let doubled: String = doubled
        .lines()
        .enumerate()
        .map(|(i, line)| if i == 0 { format!("{line}\n") } else { format!("x,{line}\n") })
        .collect();
    for (index, bytes) in [text.into_bytes(), latin, doubled.into_bytes()].into_iter().enumerate() {
        let record = file(folder, &format!("{index}.csv"), bytes);
        let test = format!("{index}.toml");
        let before = phases(folder, &["inspect", &record, "--write-test", &test]);
        assert_eq!(phases(folder, &["inspect", &record, "--test", &test]), before);
        let written = fs::read_to_string(folder.join(&test)).unwrap();
        for expected in
            ["# guessed", "[columns.force]", "# from the file", "# Detected holds: 1.", "# radius = \"35 mm\""]
        {
            assert!(written.contains(expected), "{expected}: {written}");
        }
    }
}

/// A file with the diameter and height of a cylinder was offered a ball of 35 mm.
#[test]
fn the_body_of_a_first_description_has_the_sizes_in_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let rows = ramp_and_hold(7.0, 20.0);
    for (number, (sizes, lines)) in [
        (
            "Sample diameter,20,mm\nSample height,1,cm\nProbe diameter,5,mm\n",
            &["shape = \"cylinder\"", "diameter = \"20 mm\"", "length = \"10 mm\""][..],
        ),
        (
            "Width,10,mm\nThickness,2,mm\nGauge length,50,mm\n",
            &["shape = \"strip\"", "width = \"10 mm\"", "thickness = \"2 mm\"", "length = \"50 mm\""],
        ),
        ("Durchmesser,60,mm\n", &["shape = \"ball\"", "radius = \"30 mm\""]),
        ("Probe diameter,5,mm\n", &["shape = \"ball\"", "radius = \"35 mm\""]),
    ]
    .into_iter()
    .enumerate()
    {
        let (record, test) =
            (file(folder, &format!("{number}.csv"), format!("{sizes}{rows}")), format!("{number}.toml"));
        done(folder, &["inspect", &record, "--write-test", &test]);
        let written = fs::read_to_string(folder.join(&test)).unwrap();
        assert!(lines.iter().all(|line| written.contains(&format!("\n# {line}"))), "{written}");
        // Uncommented, the table is one.
        let from = written.find("# [specimen]").unwrap();
        let body: Vec<&str> = written[from..].lines().take_while(|line| !line.is_empty()).collect();
        file(folder, "body.toml", body.join("\n").replace("\n# ", "\n").replacen("# ", "", 1));
        done(folder, &["inspect", &record, "--test", "body.toml"]);
    }
}

#[test]
fn what_the_file_does_not_say_is_requested_for_and_not_guessed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let text = ramp_and_hold(7.0, 20.0).replace("time_s,displacement_mm,force_n", "Time,Pos,Force");
    let record = file(folder, "gripper.csv", text);
    failed_but_reported(folder, &["inspect", &record, "--write-test", "t.toml"]);
    let written = fs::read_to_string(folder.join("t.toml")).unwrap();
    assert!(written.contains("unit = \"?\"    # the file gives no unit; one of N, kN"), "{written}");
    let error = refused(folder, &["inspect", &record, "--test", "t.toml"]);
    assert!(error.contains("\"?\" is not a unit of time"), "{error}");
    let answer = |text: String, unit: &str| text.replacen("unit = \"?\"", &format!("unit = \"{unit}\""), 1);
    let answered = answer(answer(answer(written, "s"), "mm"), "N");
    file(folder, "answered.toml", answered);
    assert!(phases(folder, &["inspect", &record, "--test", "answered.toml"]).contains("hold"));
}

#[test]
fn a_description_is_never_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let record = file(folder, "press.csv", ramp_and_hold(7.0, 20.0));
    file(folder, "t.toml", "# mine\n");
    let error = refused(folder, &["inspect", &record, "--write-test", "t.toml"]);
    assert!(error.contains("expected the name of a new file"), "{error}");
    assert_eq!(fs::read_to_string(folder.join("t.toml")).unwrap(), "# mine\n");
}

#[test]
fn the_cut_of_a_real_record_can_be_drawn() {
    let Some(record) = data("foam/XtraSoft.csv") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let reported = done(folder.path(), &["inspect", record.to_str().unwrap(), "--figure", "cut.png"]);
    assert!(reported.contains("phases        ////━━━━"), "{reported}");
    assert!(fs::read(folder.path().join("cut.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn a_record_as_a_plain_table_is_the_same_record() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let record = file(folder, "press.csv", ramp_and_hold(7.0, 20.0));
    let before = phases(folder, &["inspect", &record]);
    for name in ["plain.csv", "plain.json", "plain.parquet"] {
        done(folder, &["convert", &record, "--out", name]);
    }
    let csv = fs::read_to_string(folder.join("plain.csv")).unwrap();
    let mut lines = csv.lines();
    let first = lines.next().unwrap();
    let origin = first.strip_prefix("# palpate_record: ").unwrap();
    let origin: serde_json::Value = serde_json::from_str(origin).unwrap();
    assert_eq!((origin["input"]["path"].as_str(), origin["input"]["rows"].as_u64()), (Some("press.csv"), Some(161)));
    assert_eq!(origin["input"]["sha256"].as_str().map(str::len), Some(64));
    assert_eq!(lines.next(), Some("time_s,displacement_m,force_n"));
    assert_eq!(lines.nth(20), Some("1,0.001,2"));
    assert_eq!(phases(folder, &["inspect", "plain.csv"]), before);
    let json: serde_json::Value = serde_json::from_slice(&fs::read(folder.join("plain.json")).unwrap()).unwrap();
    assert_eq!(json["schema"], "palpate.record/1");
    assert_eq!(json["force_n"].as_array().map(Vec::len), Some(161));
    let error = refused(folder, &["convert", &record, "--out", "plain.ods"]);
    assert!(error.contains("expected a file ending in .csv, .xlsx, .parquet or .json"), "{error}");
}

#[test]
fn machines_are_listed_and_suggested_but_never_taken() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let listed = done(folder, &["inspect", "--machines"]);
    let line = listed
        .lines()
        .find(|line| line.starts_with("instron-bluehill "))
        .unwrap_or_else(|| panic!("{listed}"));
    assert!(line.ends_with("`Extension` and `Load` fall in compression"), "{line}");
    assert!(listed.lines().all(|line| line.chars().count() <= 120), "{listed}");
    assert!(refused(folder, &["inspect"]).contains("<RECORD>"));
    refused(folder, &["inspect", "press.csv", "--machines"]);

    let text = ramp_and_hold(7.0, 20.0).replace("time_s,displacement_mm,force_n", "Time (s),Extension (mm),Load (N)");
    let record = file(folder, "press.csv", text);
    let before = phases(folder, &["inspect", &record, "--write-test", "t.toml"]);
    let written = fs::read_to_string(folder.join("t.toml")).unwrap();
    for machine in ["instron-bluehill", "instron-bluehill-tension"] {
        assert!(written.contains(&format!("# preset = \"{machine}\"    # Instron")), "{written}");
    }
    assert_eq!(phases(folder, &["inspect", &record, "--test", "t.toml"]), before);
    file(folder, "machine.toml", "machine.preset = \"instron-bluehill-tension\"\n");
    assert_eq!(phases(folder, &["inspect", &record, "--test", "machine.toml"]), before);
}

/// A description with these lines uncommented: the tables of holds.
fn with_holds(text: &str) -> String {
    let from = text.find("# [[phases.hold]]").unwrap_or_else(|| panic!("{text}"));
    let (before, holds) = text.split_at(from);
    format!(
        "{before}{}",
        holds
            .replace("# [[", "[[")
            .replace("# from =", "from =")
            .replace("# to", "to")
            .replace("# mode", "mode")
    )
}

#[test]
fn the_holds_of_a_first_description_can_be_given_and_moved() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let record = file(folder, "press.csv", ramp_and_hold(7.0, 20.0));
    let before = phases(folder, &["inspect", &record, "--write-test", "t.toml"]);
    let written = fs::read_to_string(folder.join("t.toml")).unwrap();
    assert!(written.contains("# to = \"8 s\"\n# mode = \"displacement\""), "{written}");
    file(folder, "given.toml", with_holds(&written));
    assert_eq!(phases(folder, &["inspect", &record, "--test", "given.toml"]), before);
    let moved = with_holds(&written).replace("to = \"8 s\"", "to = \"6 s\"");
    file(folder, "moved.toml", moved);
    let reported = phases(folder, &["inspect", &record, "--test", "moved.toml"]);
    let hold = reported.lines().find(|line| line.starts_with("hold")).unwrap_or_else(|| panic!("{reported}"));
    assert_eq!(hold.split_whitespace().nth(3), Some("6.00000"), "{reported}");
}

#[test]
fn a_given_hold_that_the_record_does_not_contain_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let record = file(folder, "press.csv", ramp_and_hold(7.0, 20.0));
    file(folder, "given.toml", "[[phases.hold]]\nfrom = \"2 s\"\nto = \"80 s\"\n");
    let error = failed_but_reported(folder, &["inspect", &record, "--test", "given.toml"]);
    assert!(error.contains("given hold 1 is from 2 s to 80 s, the record from 0 s to 8.00000 s"), "{error}");
}

#[test]
fn a_column_is_named_as_in_the_header_with_or_without_its_unit() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let text = ramp_and_hold(7.0, 20.0).replace("force_n", "Load (N)").replace("displacement_mm", "Load (mm)");
    let record = file(folder, "press.csv", &text);
    let both = |displacement: &str, force: &str| {
        let stated = format!("columns.displacement.column = \"{displacement}\"\ncolumns.force.column = \"{force}\"\n");
        file(folder, "columns.toml", stated);
    };
    both("Load (mm)", "Load (N)");
    let reported = done(folder, &["inspect", &record, "--test", "columns.toml"]);
    assert!(reported.contains("displacement 0 to 1.000 mm\nforce 0 to 2.000 N"), "{reported}");
    both("Load (mm)", "Load");
    let error = failed_but_reported(folder, &["inspect", &record, "--test", "columns.toml"]);
    assert!(error.contains("columns.force.column") && error.contains("found \"Load\""), "{error}");
}

/// The ramp of a test in one file and its hold in another: neither shows both.
#[test]
fn a_test_goes_on_in_a_second_file() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let header = "time_s,displacement_mm,force_n\n";
    let ramp: String = (0..100).map(|i| 0.1 * f64::from(i)).map(|t| format!("{t:.1},{t:.1},{t:.1}\n")).collect();
    let relaxed = |t: f64| 6.0 + 4.0 / (1.0 + 0.1 * t);
    let hold = |from: f64| -> String {
        (0..600)
            .map(|i| 0.1 * f64::from(i))
            .map(|t| format!("{:.1},9.9,{:.5}\n", from + t, relaxed(t)))
            .collect()
    };
    file(folder, "ramp.csv", format!("{header}{ramp}"));
    file(folder, "hold.csv", format!("{header}{}", hold(0.0)));
    file(folder, "later.csv", format!("{header}{}", hold(12.0)));
    assert!(done(folder, &["inspect", "ramp.csv"]).contains("no hold found"));
    let reported = inspected(folder, &["ramp.csv", "--then", "hold.csv"]);
    assert!(
        reported.contains("700 rows over 69.9") && reported.contains("10.0000 s were added to its times"),
        "{reported}"
    );
    let reported = inspected(folder, &["ramp.csv", "--then", "later.csv"]);
    assert!(reported.contains("on the same clock and unchanged"), "{reported}");
    let document = done(folder, &["analyze", "ramp.csv", "--then", "hold.csv", "--no-compare", "--format", "json"]);
    assert!(document.contains("\"then_sha256\": \"") && document.contains("\"fit_start_rule\": \"extreme\""));
    let refused = refused(folder, &["analyze", "ramp.csv", "hold.csv", "--then", "later.csv"]);
    assert!(refused.contains("later.csv continues one record, found 2 of them"), "{refused}");
}

#[test]
fn clocks_that_differ_are_reported_in_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Three stairs, of which the force comes 60 ms after the displacement.
    let at = |t: f64| {
        let (step, rest) = ((t / 5.0).floor(), t % 5.0);
        (step + rest.min(1.0)).clamp(0.0, 3.0)
    };
    let rows: String = (0..750)
        .map(|i| 0.02 * f64::from(i))
        .map(|t| format!("{t:.3},{:.5},{:.3},{:.5}\n", at(t), t + 0.001, 3.0 * at((t - 0.06).max(0.0))))
        .collect();
    let record = file(folder, "stairs.csv", format!("time_s,displacement_mm,stamp_s,force_n\n{rows}"));
    let clocks = "[columns.displacement]\ncolumn = 2\nclock = { column = 1, unit = \"s\" }\n\
                  [columns.force]\ncolumn = 4\nclock = { column = 3, unit = \"s\" }\n";
    file(folder, "two.toml", clocks);
    let reported = inspected(folder, &[&record, "--test", "two.toml"]);
    assert!(reported.contains("ms later than the displacement; set skew = \"auto\" in [clock]"), "{reported}");
    file(folder, "auto.toml", format!("{clocks}[clock]\nskew = \"auto\"\n"));
    let reported = done(folder, &["inspect", &record, "--test", "auto.toml"]);
    assert!(
        !reported.contains("later than the displacement") && reported.contains("done: force shifted by "),
        "{reported}"
    );
}

#[test]
fn hundreds_of_named_values_are_counted_and_not_listed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let named: String = (0..40).map(|i| format!("# setting {i}: {i}\n")).collect();
    let record = file(folder, "press.csv", named + &ramp_and_hold(7.0, 20.0));
    let reported = done(folder, &["inspect", &record]);
    assert!(reported.contains("setting 14") && !reported.contains("setting 15"), "{reported}");
    assert!(reported.contains("… and 25 more named values"), "{reported}");
}

/// A weight in g was stated not to be in the file, and pounds were to become N.
#[test]
fn a_unit_that_is_none_of_force_is_reported_with_what_was_meant() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (unit, meant) in [("g", "gf"), ("kg", "kgf"), ("lbs", "lbf")] {
        let text = ramp_and_hold(7.0, 20.0).replace("force_n", &format!("Force ({unit})"));
        file(folder, "press.csv", text);
        let error = failed_but_reported(folder, &["inspect", "press.csv", "--write-test", &format!("{unit}.toml")]);
        assert!(error.contains(&format!("unit = \"{meant}\"")), "{error}");
        let written = fs::read_to_string(folder.join(format!("{unit}.toml"))).unwrap();
        assert!(
            written
                .contains(&format!("the file gives \"{unit}\", which is no unit of force; \"{meant}\", or one of N")),
            "{written}"
        );
    }
}

/// The corrections of a description were left out of the table, though it named the description.
#[test]
fn a_plain_table_is_corrected_as_described() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    file(folder, "press.csv", ramp_and_hold(7.0, 20.0));
    file(folder, "test.toml", "[machine]\ncompliance = \"100 um/N\"\n");
    done(folder, &["convert", "press.csv", "--out", "raw.csv"]);
    let output = palpate(folder, &["convert", "press.csv", "--test", "test.toml", "--out", "net.csv"]);
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("of machine compliance subtracted from the displacement")
    );
    let cells = |name: &str| -> Vec<Vec<f64>> {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        text.lines()
            .skip(2)
            .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
            .collect()
    };
    let (raw, net) = (cells("raw.csv"), cells("net.csv"));
    assert_eq!(raw.len(), net.len());
    for (raw, net) in raw.iter().zip(&net) {
        assert!((raw[1] - 1e-4 * raw[2] - net[1]).abs() < 1e-15 && raw[2] == net[2], "{raw:?} {net:?}");
    }
    let text = fs::read_to_string(folder.join("net.csv")).unwrap();
    assert!(text.lines().next().unwrap().contains("compliance_removed"), "{text:.300}");
}

/// A force stamped 0.1 s late made the displacement look clipped in every hold.
#[test]
fn clocks_that_differ_are_no_saturation_and_signs_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut text = "Time (s),Displacement (mm),Stamp (s),Force (N)\n".to_owned();
    let travel = |t: f64| if t < 40.0 { t.clamp(0.0, 5.0) } else { (45.0 - t).clamp(2.0, 5.0) };
    for i in 0..3500 {
        let t = 0.02 * f64::from(i) - 2.0;
        let late = t - 0.1;
        let relaxing = if (5.0..40.0).contains(&late) { 20.0 * (-(late - 5.0) / 6.0).exp() } else { 0.0 };
        let rising = if late < 5.0 { 4.0 * late.max(0.0) } else { 0.0 };
        let rest = if late < 40.0 { relaxing + rising } else { 0.0 };
        let ripple = 0.01 * (f64::from(i) * 7.3).sin() + 0.01 * (f64::from(i) * 3.1).cos();
        let stamp = t + 0.001;
        text.push_str(&format!("{t:.2},{:.6},{stamp:.3},{:.6}\n", travel(t), 10.0 * travel(late) + rest + ripple));
    }
    file(folder, "press.csv", &text);
    let clocks = "[columns.displacement]\ncolumn = 2\nclock = { column = 1, unit = \"s\" }\n\
                  [columns.force]\ncolumn = 4\nclock = { column = 3, unit = \"s\" }\n";
    file(folder, "two.toml", clocks);
    let reported = inspected(folder, &["press.csv", "--test", "two.toml"]);
    assert!(reported.contains("later than the displacement") && !reported.contains("clipped"), "{reported}");
    let document = done(folder, &["analyze", "press.csv", "--test", "two.toml", "--no-compare", "--format", "json"]);
    assert!(document.contains("clocks_skewed") && !document.contains("\"saturated\""));
    let turned = text.lines().map(|line| match line.rsplit_once(',') {
        Some((before, force)) if !force.contains('F') => format!("{before},{}\n", -force.parse::<f64>().unwrap()),
        _ => format!("{line}\n"),
    });
    file(folder, "turned.csv", turned.collect::<String>());
    let reported = done(folder, &["inspect", "turned.csv", "--test", "two.toml"]);
    assert!(reported.contains("sign"), "{reported}");
}

/// The message named a column `Load`, whatever the file has, and the draft description left the sign as it was.
#[test]
fn a_reversed_sign_is_turned_by_the_option_and_by_the_draft() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let turned = ramp_and_hold(7.0, 20.0).lines().skip(1).fold(
        "Zeit (s),Weg (mm),Standardkraft (N)\n".to_owned(),
        |text, line| {
            let (before, force) = line.rsplit_once(',').unwrap();
            format!("{text}{before},{}\n", -force.parse::<f64>().unwrap())
        },
    );
    let record = file(folder, "press.csv", turned);
    let option = "--columns \"force=Standardkraft:-N\"";
    let reported = inspected(folder, &[&record, "--write-test", "press.toml"]);
    assert!(
        reported.contains("the sign of the force may be reversed") && reported.contains(option),
        "{reported}"
    );
    assert!(fs::read_to_string(folder.join("press.toml")).unwrap().contains("sign = -1"));
    let described = inspected(folder, &[&record, "--test", "press.toml"]);
    assert!(!described.contains("may be reversed"), "{described}");
    let noted = palpate(folder, &["analyze", &record, "--no-compare"]);
    assert!(String::from_utf8_lossy(&noted.stderr).contains(option), "{noted:?}");
}

/// Rules for first touch ran over 190 columns.
#[test]
fn lines_of_an_inspection_fit_a_terminal() {
    let Some(record) = data("tendon/fresh_1.csv") else {
        return;
    };
    let reported = done(Path::new("."), &["inspect", record.to_str().unwrap()]);
    let widest = reported.lines().skip(1).map(|line| line.chars().count()).max();
    assert!(widest.is_some_and(|widest| widest <= 100), "{reported}");
}
