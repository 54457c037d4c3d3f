//! Which machines and grippers name their columns as a file does.

use std::path::Path;

use super::{
    columns::ColumnChoice,
    convert::parse_test,
    preset::{MACHINES, Machine},
};
use crate::{
    naming::{Quantity, unit_factor},
    table::{ColumnInfo, Part},
};

/// The machines that name the columns of a test as its file does, all of them, with units that do not contradict it.
///
/// Several can: a squeeze and a stretch are distinguished by nobody but the person who made the test.
#[must_use]
pub fn machines_of(part: &Part) -> Vec<&'static Machine> {
    let fits = |machine: &&Machine| {
        let Ok(test) = parse_test(machine.text, Path::new(machine.name)) else {
            return false;
        };
        let choices = test.columns.all();
        let is_there = |(quantity, choice): &(Quantity, &ColumnChoice)| {
            let named = choice.column.iter().chain(&choice.also);
            let found: Option<Vec<&ColumnInfo>> = named.map(|name| part.column_of(name)).collect();
            found.is_some_and(|found| found.iter().all(|column| !contradicts(*quantity, choice, column)))
        };
        choices.iter().any(|(_, choice)| choice.column.is_some()) && choices.iter().all(is_there)
    };
    MACHINES.iter().filter(fits).collect()
}

/// Whether the header of a column gives another unit of its quantity than is stated of it.
pub(crate) fn contradicts(quantity: Quantity, choice: &ColumnChoice, column: &ColumnInfo) -> bool {
    let factor = |unit: Option<&str>| unit_factor(unit?, quantity.dimension());
    let (stated, written) = (factor(choice.unit.as_deref()), factor(column.unit.as_deref()));
    stated.is_some() && written.is_some() && stated != written
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::test::preset::machines;
    use crate::table::ColumnRef;

    #[test]
    fn every_preset_is_a_test_description_that_says_what_it_is() {
        for machine in machines() {
            let test = parse_test(&format!("machine.preset = \"{}\"", machine.name), Path::new("test.toml"));
            let test = test.unwrap_or_else(|error| panic!("{}: {error}", machine.name));
            assert!(test.columns.displacement.is_some(), "{}", machine.name);
            let about = machine.about();
            assert!((20..=88).contains(&about.chars().count()) && about.ends_with('.'), "{}: {about}", machine.name);
            parse_test(machine.text, Path::new(machine.name)).unwrap_or_else(|error| panic!("{error}"));
        }
        assert!(machines().is_sorted_by_key(|machine| machine.name));
    }

    #[test]
    fn the_test_itself_goes_before() {
        let text = "[machine]\npreset = \"franka-hand\"\n[columns.displacement]\ncolumn = 3\nsign = 1\n[columns]\n\
                    force = { column = \"ft\" }\n";
        let test = parse_test(text, Path::new("test.toml")).unwrap();
        let displacement = test.columns.displacement.unwrap();
        assert_eq!((displacement.column, displacement.sign), (Some(ColumnRef::Number(3)), 1.0));
        assert_eq!(displacement.also, Some(ColumnRef::Name("position[panda_finger_joint2]".to_owned())));
        assert_eq!(displacement.unit.as_deref(), Some("m"));
        let text = "machine.preset = \"robotiq-2f85\"\ncolumns.displacement.unit = \"mm\"\n";
        let displacement = parse_test(text, Path::new("test.toml")).unwrap().columns.displacement.unwrap();
        assert_eq!((displacement.unit.as_deref(), displacement.travel_per_unit), (Some("mm"), None));
    }

    #[test]
    fn an_unknown_name_is_answered_with_those_there_are() {
        let error = parse_test("[machine]\npreset = \"franka-hnd\"\n", Path::new("test.toml")).unwrap_err();
        let text = error.to_string();
        assert!(
            text.starts_with("test.toml, line 2: machine.preset: expected \"aurora-600a\", \"franka-hand\", "),
            "{text}"
        );
        assert_eq!(error.hint().as_deref(), Some("did you mean \"franka-hand\"?"));
    }
}
