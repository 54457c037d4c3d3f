//! Names of columns that repeat while the clock goes on.

use palpate_files::open::Contents;
use palpate_files::table::ReadOptions;

use super::written;

const NAMES: &str = "Time (s),Displacement (mm),Force (N)\n";

fn rows(from: usize, until: usize) -> String {
    (from..until).map(|row| format!("{:.1},{}.5,{row}.25\n", row as f64 / 10.0, row % 10)).collect()
}

/// The times of each part.
fn parts(text: &str) -> Vec<(Option<String>, Vec<f64>)> {
    let contents = Contents::open(&written(text).path, &ReadOptions::default()).expect("contents");
    let part = |(index, part): (usize, &palpate_files::table::Part)| {
        let read = contents.read(index, &[1], &mut |_, _| Ok(())).expect("columns");
        (part.name.clone(), read.values[0].clone())
    };
    contents.parts.iter().enumerate().map(part).collect()
}

/// A record with names again after a pause was cut into two tests.
#[test]
fn names_that_repeat_while_the_clock_goes_on_are_one_record() {
    let units = "Time,Displacement,Force\ns,mm,N\n";
    for text in [
        format!("{NAMES}{}{NAMES}{}", rows(0, 30), rows(30, 60)),
        format!("Operator: me\n{NAMES}{}\n{NAMES}{}", rows(0, 30), rows(40, 70)),
        format!("{NAMES}{}{NAMES}{}", rows(9000, 9030), rows(9030, 9060)),
        format!("{units}{}{units}{}{units}{}", rows(0, 20), rows(20, 40), rows(40, 60)),
    ] {
        let found = parts(&text);
        assert_eq!((found.len(), &found[0].0, found[0].1.len()), (1, &None, 60), "{text}");
        assert!(found[0].1.is_sorted());
    }
    let text = format!("{NAMES}{}{NAMES}{}", rows(0, 30), rows(30, 60));
    let contents = Contents::open(&written(&text).path, &ReadOptions::default()).expect("contents");
    assert!(contents.parts[0].written.contains("names repeated 1 time"), "{}", contents.parts[0].written);
    let read = contents.read(0, &[1, 2, 3], &mut |_, _| Ok(())).expect("columns");
    assert_eq!((read.line_of(29), read.line_of(30), read.ignored.blank), (Some(31), Some(33), 0));
}

/// The three blocks of one test on an MTS were three tests, since the time above each is another.
#[test]
fn lines_that_differ_in_times_and_counts_alone_part_no_record() {
    let mts = |time: &str| {
        let names = "Axial Count\tRunning Time\tAxial Displacement\tAxial Force\nsegments\tSec\tmm\tkN";
        format!("Data Acquisition\tTimed Data\t\t\tTime:\t{time}\tSec\n{names}\n")
    };
    let rows = |from: u32| -> String {
        (from..from + 30).map(|row| format!("0\t{}.5\t0.{row}\t0.{}\n", row, row % 7)).collect()
    };
    let (first, second, third) = (mts("29.500"), mts("59.500"), mts("89.500"));
    let text = format!("MTS793|MPT|ENU|1|2|.\n\n{first}{}\n{second}{}\n{third}{}", rows(0), rows(30), rows(60));
    let contents = Contents::open(&written(&text).path, &ReadOptions::default()).expect("contents");
    let found = contents.read(0, &[2], &mut |_, _| Ok(())).expect("columns");
    assert_eq!((contents.parts.len(), found.values[0].len()), (1, 90));
}

#[test]
fn only_numbers_of_times_and_counts_may_differ_above_one_record() {
    let of = |line: [&str; 2]| {
        let [first, second] = line;
        parts(&format!("{first}\n{NAMES}{}{second}\n{NAMES}{}", rows(0, 30), rows(30, 60))).len()
    };
    for line in [
        ["Time: 3.000 Sec", "Time: 6.000 Sec"],
        ["Cycle 1", "Cycle 2"],
        ["Cycle number,1", "Cycle number,2"],
        ["Scans: 30, Elapsed time: 00:00:03", "Scans: 60, Elapsed time: 00:00:06"],
        ["Specimen 3; Zyklus Nr. 1", "Specimen 3; Zyklus Nr. 2"],
    ] {
        assert_eq!(of(line), 1, "{line:?}");
    }
    for line in [
        ["Specimen 1", "Specimen 2"],
        ["Test number 1", "Test number 2"],
        ["Specimen 1; cycle 3", "Specimen 2; cycle 3"],
        ["Cycle 1 of test 1", "Cycle 1 of test 2"],
        ["Width: 10.2 mm", "Width: 10.4 mm"],
        ["rubber_1.dat", "rubber_2.dat"],
        ["1", "2"],
        ["Time 3 s, loading", "Time 6 s, creep"],
    ] {
        assert_eq!(of(line), 2, "{line:?}");
    }
}

#[test]
fn tables_with_other_units_a_title_between_or_a_clock_of_their_own_are_several() {
    let kilo = NAMES.replace("(N)", "(kN)");
    for text in [
        format!("{NAMES}{}{NAMES}{}", rows(0, 30), rows(0, 30)),
        format!("{NAMES}{}{kilo}{}", rows(0, 30), rows(30, 60)),
        format!("{NAMES}{}Specimen 2\n{NAMES}{}", rows(0, 30), rows(30, 60)),
        format!("{NAMES}{}{NAMES}{}", rows(0, 30), rows(90, 120)),
        // A clock on the wall goes on from test to test.
        format!("{NAMES}{}{NAMES}{}", rows(9000, 9030), rows(9040, 9070)),
    ] {
        assert_eq!(parts(&text).len(), 2, "{text}");
    }
}
