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
