//! Which column holds a quantity, going by its name and unit.

use palpate::units::Dimension;

use super::part::{ColumnInfo, ColumnKind};
use crate::naming::{
    AXIAL, BENDING, EXTENSOMETERS, OTHER_CHARACTERS, Quantity, RATES_OF_SHEAR, SHEAR, SHEAR_RATES, SIGNS_OF_LENGTH,
    STORAGE, STRAIN_GAUGES, STRAINS, VOCABULARY, is_listed, is_share, measured, measures_another, names_another,
    names_multiples_of, names_strain, names_true_measure, other_words, own_topics, rank_in_rheometry, rank_of_name,
    unit_factor, words,
};

/// The columns that name `quantity` best: one if it is clear, several if it is not, none if none does.
pub(crate) fn candidates(columns: &[ColumnInfo], quantity: Quantity) -> Vec<&ColumnInfo> {
    let names_well = |column: &ColumnInfo, quantity| rank(column, quantity).is_some_and(|rank| rank < 10);
    // A machine that pulls and turns has a travel; a rheometer has none, but a force along its axis and an angle.
    let travels = || columns.iter().any(|column| names_well(column, Quantity::Displacement));
    let sheared = |column: &ColumnInfo| is_of_shear(column) || names_well(column, Quantity::Stress);
    let in_shear =
        matches!(quantity, Quantity::Force | Quantity::Displacement) && columns.iter().any(sheared) && !travels();
    let is_angle =
        |column: &ColumnInfo| column.unit.as_deref().is_some_and(|unit| unit_factor(unit, Dimension::Angle).is_some());
    let ranked = columns.iter().filter(|column| {
        !in_shear || !(if quantity == Quantity::Force { has_word(column, AXIAL) } else { is_angle(column) })
    });
    let ranked: Vec<(u8, &ColumnInfo)> = ranked.filter_map(|column| Some((rank(column, quantity)?, column))).collect();
    let best = ranked.iter().map(|(rank, _)| *rank).min();
    let tied: Vec<&ColumnInfo> =
        ranked.into_iter().filter(|(rank, _)| Some(*rank) == best).map(|(_, column)| column).collect();
    if let [one] = tied[..]
        && quantity == Quantity::Displacement
        && has_word(one, "deflection")
    {
        // Beside the height of a microscope it is how far the cantilever bends, and the indentation is what lies between them: the height,
        // which is proposed, is nearer to it.
        return columns.iter().filter(|column| is_height(column)).chain([one]).collect();
    }
    // "Shear stress (sinusoidal)" is the shear stress with a remark: the one without goes before it.
    let plain = tied.iter().find(|plain| tied.iter().all(|other| remarks_on(other, plain)));
    plain.map_or(tied.clone(), |plain| vec![*plain])
}

/// Whether a column is where a microscope has its cantilever.
fn is_height(column: &ColumnInfo) -> bool {
    let is_length = column.unit.as_deref().is_some_and(|unit| unit_factor(unit, Dimension::Length).is_some());
    column.kind == ColumnKind::Number
        && is_length
        && has_word(column, "height piezo z zsensor zsnsr höhe hauteur altura")
}

/// Whether a column is another, or is named like it with a remark in brackets.
fn remarks_on(column: &ColumnInfo, plain: &ColumnInfo) -> bool {
    let (Some(name), Some(plain_name)) = (&column.name, &plain.name) else {
        return column.number == plain.number;
    };
    let behind = name.strip_prefix(plain_name.as_str());
    column.number == plain.number || behind.is_some_and(|behind| behind.trim_start().starts_with('('))
}

fn has_word(column: &ColumnInfo, known: &str) -> bool {
    column
        .name
        .as_deref()
        .is_some_and(|name| words(measured(name)).iter().any(|word| is_listed(word, known)))
}

/// Whether a column is one of a body in shear, which has a force along the axis of the machine as well.
fn is_of_shear(column: &ColumnInfo) -> bool {
    let torque = |unit: &str| unit_factor(unit, Dimension::Torque).is_some();
    has_word(column, SHEAR) || column.unit.as_deref().is_some_and(torque)
}

/// Whether one of the columns is named as a time.
pub(crate) fn names_time(columns: &[ColumnInfo]) -> bool {
    !candidates(columns, Quantity::Time).is_empty()
}

/// A column of texts that is named after `quantity`.
pub(crate) fn text_named(columns: &[ColumnInfo], quantity: Quantity) -> Option<&ColumnInfo> {
    let vocabulary = VOCABULARY.iter().find(|words| words.quantity == quantity)?;
    let named = |column: &&ColumnInfo| {
        let name = column.name.as_deref();
        column.kind == ColumnKind::Text && name.is_some_and(|name| rank_of_name(name, vocabulary).is_some())
    };
    columns.iter().find(named)
}

/// Names of columns that hold dates with times of day, beside the words for time.
const DATES: [&str; 3] = ["date", "datetime", "datum"];

/// How well a column names a quantity; 0 is best.
fn rank(column: &ColumnInfo, quantity: Quantity) -> Option<u8> {
    // The section of the body as described makes no force of a true stress, nor its length a displacement of a true strain.
    let is_other_measure = || {
        matches!(quantity, Quantity::Stress | Quantity::Strain)
            && column.name.as_deref().is_some_and(names_true_measure)
    };
    rank_as_named(column, quantity).filter(|_| !is_other_measure())
}

fn rank_as_named(column: &ColumnInfo, quantity: Quantity) -> Option<u8> {
    let is_date = column.kind == ColumnKind::DateTime && quantity == Quantity::Time;
    if column.kind != ColumnKind::Number && !is_date {
        return None;
    }
    let name = column.name.as_deref()?;
    if let Some(own) = own_topics::holds(name) {
        return (own == Some(quantity)).then_some(0);
    }
    let Some(vocabulary) = VOCABULARY.iter().find(|words| words.quantity == quantity) else {
        return rank_in_rheometry(name, column.unit.as_deref(), quantity);
    };
    if is_date {
        // The clock on the wall serves where no column of numbers does.
        let called_so = || words(name).iter().any(|word| DATES.contains(&word.as_str()));
        return Some(20 + rank_of_name(name, vocabulary).or_else(|| called_so().then_some(5))?);
    }
    let by_name = rank_of_name(name, vocabulary)?;
    match column.unit.as_deref() {
        // "Time_force" is the time of a force.
        None if quantity != Quantity::Time && named_plainly(name, Quantity::Time) => None,
        None => Some(by_name),
        Some(unit) if unit_factor(unit, quantity.dimension()).is_some() => Some(by_name),
        Some(unit) if measures_another(unit, quantity) => None,
        // Perhaps a unit that is not understood: better one with a good unit, but better this than none.
        Some(_) => Some(by_name + 10),
    }
}

/// Whether a column is named after a quantity, and its unit does not contradict it.
pub(crate) fn names(column: &ColumnInfo, quantity: Quantity) -> bool {
    rank(column, quantity).is_some()
}

/// Whether a name has a word that means a quantity and nothing else.
pub(crate) fn named_plainly(name: &str, quantity: Quantity) -> bool {
    let vocabulary = VOCABULARY.iter().find(|words| words.quantity == quantity);
    vocabulary.is_some_and(|vocabulary| rank_of_name(name, vocabulary).is_some_and(|rank| rank < 2))
}

/// Whether a column could hold a quantity for all that its unit and name say: what a message may propose.
pub(crate) fn may_be(column: &ColumnInfo, quantity: Quantity) -> bool {
    let of = |unit: &str, dimension: Dimension| unit_factor(unit, dimension).is_some();
    let another = |unit: &str| measures_another(unit, quantity) || of(unit, Dimension::Angle);
    let names_it = |unit: &str| of(unit, quantity.dimension());
    let (name, unit) = (column.name.as_deref(), column.unit.as_deref());
    column.kind == ColumnKind::Number
        && !unit.is_some_and(another)
        && !is_bending(column)
        && (unit.is_some_and(names_it) || !name.is_some_and(|name| names_another(name, quantity)))
}

/// Columns that are named after `quantity` but have the unit of another, and that unit.
pub(crate) fn misfits(columns: &[ColumnInfo], quantity: Quantity) -> impl Iterator<Item = (&ColumnInfo, &str)> {
    let vocabulary = VOCABULARY.iter().find(|words| words.quantity == quantity);
    columns.iter().filter(|column| column.kind == ColumnKind::Number).filter_map(move |column| {
        let (name, unit) = (column.name.as_deref()?, column.unit.as_deref()?);
        let plainly = rank_of_name(name, vocabulary?).is_some_and(|rank| rank < 2);
        (plainly && measures_another(unit, quantity)).then_some((column, unit))
    })
}

/// A column of an extensometer, in a length or as a strain.
pub(crate) fn extensometer(columns: &[ColumnInfo]) -> Option<&ColumnInfo> {
    let measures = |unit: &str| is_share(unit) || unit_factor(unit, Dimension::Length).is_some();
    let is_one = |column: &&ColumnInfo| has_word(column, EXTENSOMETERS) && column.unit.as_deref().is_some_and(measures);
    columns.iter().filter(|column| column.kind == ColumnKind::Number).find(is_one)
}

/// A column of numbers whose name says multiples of a quantity.
pub(crate) fn multiples(columns: &[ColumnInfo], quantity: Quantity) -> Option<&ColumnInfo> {
    let says = |column: &&ColumnInfo| column.name.as_deref().is_some_and(|name| names_multiples_of(name, quantity));
    columns.iter().filter(|column| column.kind == ColumnKind::Number).find(says)
}

/// A column that is named after the displacement and holds shares, of a full scale or of a length, or a ratio, with their unit.
pub(crate) fn share_of_displacement(columns: &[ColumnInfo]) -> Option<(&ColumnInfo, &str)> {
    let vocabulary = VOCABULARY.iter().find(|words| words.quantity == Quantity::Displacement)?;
    columns.iter().filter(|column| column.kind == ColumnKind::Number).find_map(|column| {
        let (name, unit) = (column.name.as_deref()?, column.unit.as_deref()?);
        let is_ratio = is_share(unit) || unit_factor(unit, Dimension::Share).is_some();
        (is_ratio && rank_of_name(name, vocabulary)? < 4).then_some((column, unit))
    })
}

/// Columns that may well hold a displacement, though no word of theirs says so: those with a unit of length, and those
/// without a unit whose name is a letter that usually stands for one.
pub(crate) fn possible_displacements(columns: &[ColumnInfo]) -> impl Iterator<Item = &ColumnInfo> {
    let possible = |column: &&ColumnInfo| {
        let (true, Some(name)) = (column.kind == ColumnKind::Number, column.name.as_deref()) else {
            return false;
        };
        let words = words(measured(name));
        // What is stated per finger is a displacement all the same.
        let other = other_words(&words).any(|word| !is_listed(word, STRAINS) && word != "per")
            || OTHER_CHARACTERS.split_whitespace().any(|part| name.contains(part))
            || BENDING.contains(&name.trim());
        let sign = || SIGNS_OF_LENGTH.split_whitespace().any(|sign| sign.to_lowercase() == name.trim().to_lowercase());
        match column.unit.as_deref() {
            Some(unit) => !other && unit_factor(unit, Dimension::Length).is_some(),
            None => sign(),
        }
    };
    columns.iter().filter(possible)
}

/// A column of numbers that is named as a strain.
pub(crate) fn strain(columns: &[ColumnInfo]) -> Option<&ColumnInfo> {
    let named = |name: &str| words(measured(name)).iter().any(|word| is_listed(word, STRAINS));
    let is_strain = |column: &&ColumnInfo| column.name.as_deref().is_some_and(named);
    columns.iter().filter(|column| column.kind == ColumnKind::Number).find(is_strain)
}

/// A column of a true stress or a true strain.
pub(crate) fn true_measure(columns: &[ColumnInfo], quantity: Quantity) -> Option<&ColumnInfo> {
    let is_one = |column: &&ColumnInfo| {
        let Some(name) = column.name.as_deref().filter(|name| names_true_measure(name)) else {
            return false;
        };
        let without_unit = || quantity == Quantity::Strain && column.unit.is_none() && names_strain(name);
        rank_as_named(column, quantity).is_some() || without_unit()
    };
    columns.iter().filter(|column| column.kind == ColumnKind::Number).find(is_one)
}

/// Columns of strains whose header gives no unit, or none that is known.
pub(crate) fn strains_without_unit(columns: &[ColumnInfo]) -> Vec<&ColumnInfo> {
    let of_another = |unit: &str| {
        let others = [Dimension::Voltage, Dimension::Rate, Dimension::Angle, Dimension::PerPressure];
        measures_another(unit, Quantity::Strain) || others.iter().any(|other| unit_factor(unit, *other).is_some())
    };
    let is_one = |column: &&ColumnInfo| {
        let name = column.name.as_deref().filter(|name| own_topics::holds(name).is_none());
        name.is_some_and(|name| names_strain(name) && !names_true_measure(name))
            && !column.unit.as_deref().is_some_and(of_another)
            && !has_word(column, STRAIN_GAUGES)
    };
    columns.iter().filter(|column| column.kind == ColumnKind::Number).filter(is_one).collect()
}

/// A storage modulus in numbers: the rows are those of an oscillation.
pub(crate) fn storage_modulus(columns: &[ColumnInfo]) -> Option<&ColumnInfo> {
    let is_modulus = |unit: &str| unit_factor(unit, Dimension::Pressure).is_some();
    let is_storage = |column: &&ColumnInfo| has_word(column, STORAGE) && column.unit.as_deref().is_some_and(is_modulus);
    columns.iter().filter(|column| column.kind == ColumnKind::Number).find(is_storage)
}

/// A shear rate in numbers, and the factor of its unit to 1/s.
pub(crate) fn shear_rate(columns: &[ColumnInfo]) -> Option<(&ColumnInfo, f64)> {
    let is_rate = |column: &&ColumnInfo| {
        has_word(column, SHEAR_RATES) || has_word(column, SHEAR) && has_word(column, RATES_OF_SHEAR)
    };
    let numbers = columns.iter().filter(|column| column.kind == ColumnKind::Number);
    numbers
        .filter(is_rate)
        .find_map(|column| Some((column, unit_factor(column.unit.as_deref()?, Dimension::Rate)?)))
}

/// Whether a column is the gap between the plates of a rheometer.
pub(crate) fn is_gap(column: &ColumnInfo) -> bool {
    has_word(column, "gap spalt spaltweite entrefer")
}

/// Whether a column is the bending of a cantilever.
pub(crate) fn is_bending(column: &ColumnInfo) -> bool {
    column.name.as_deref().is_some_and(|name| BENDING.contains(&name.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(header: &[(&str, Option<&str>)]) -> Vec<ColumnInfo> {
        let column = |(index, (name, unit)): (usize, &(&str, Option<&str>))| ColumnInfo {
            number: index + 1,
            name: Some((*name).to_owned()),
            unit: unit.map(str::to_owned),
            kind: ColumnKind::Number,
            sample: "0".to_owned(),
        };
        header.iter().enumerate().map(column).collect()
    }

    fn found(header: &[(&str, Option<&str>)], quantity: Quantity) -> Vec<usize> {
        let columns = columns(header);
        let found = candidates(&columns, quantity);
        found.into_iter().map(|column| column.number).collect()
    }

    #[test]
    fn every_language() {
        for header in [
            ["Time", "Displacement", "Force"],
            ["TIME", "Crosshead", "Load"],
            ["Prüfzeit", "Standardweg", "Standardkraft"],
            ["Zeit", "Weg", "Kraft"],
            ["Temps", "Déplacement", "Force"],
            ["Tiempo", "Desplazamiento", "Fuerza"],
            ["时间", "位移", "力"],
            ["试验时间", "位移", "试验力"],
            ["時間", "変位", "荷重"],
            ["t", "Stroke", "F"],
        ] {
            let named = header.map(|name| (name, None));
            assert_eq!(found(&named, Quantity::Time), [1], "{header:?}");
            assert_eq!(found(&named, Quantity::Displacement), [2], "{header:?}");
            assert_eq!(found(&named, Quantity::Force), [3], "{header:?}");
            assert!(found(&named, Quantity::Stress).is_empty(), "{header:?}");
        }
        for name in ["Tensile stress", "Spannung", "应力", "Contrainte"] {
            assert_eq!(found(&[(name, None)], Quantity::Stress), [1], "{name}");
            assert!(found(&[(name, None)], Quantity::Force).is_empty(), "{name}");
        }
    }

    #[test]
    fn commands_and_derived_quantities_are_no_measurements() {
        let gripper = [("Time", None), ("Force", None), ("GoalForce", None), ("goal_force", None)];
        assert_eq!(found(&gripper, Quantity::Force), [2]);
        let foam = [("Size", Some("mm")), ("Displacement", Some("mm")), ("Displacement rate", None)];
        assert_eq!(found(&foam, Quantity::Displacement), [2]);
        let bluehill = [
            ("Extension", Some("mm")),
            ("Tensile extension", Some("mm")),
            ("Tensile strain (Extension)", Some("mm/mm")),
        ];
        assert_eq!(found(&bluehill, Quantity::Displacement), [1]);
        let both = [("Extension", Some("mm")), ("Displacement", Some("mm"))];
        assert_eq!(found(&both, Quantity::Displacement), [2]);
    }

    /// Setpoints of German machines, values a finger and multiples were taken for the measurement itself.
    #[test]
    fn words_that_change_what_a_name_means_are_not_passed_over() {
        for name in [
            "Sollkraft",
            "Kraft (soll)",
            "Force threshold",
            "Force per finger",
            "Force x1000",
            "Kraft*10",
            "Load ×10",
        ] {
            assert!(found(&[(name, Some("N"))], Quantity::Force).is_empty(), "{name}");
        }
        assert!(found(&[("Sollweg", Some("mm"))], Quantity::Displacement).is_empty());
        assert_eq!(found(&[("Force x", Some("N"))], Quantity::Force), [1]);
        assert_eq!(found(&[("Solenoid force", Some("N"))], Quantity::Force), [1]);
    }

    #[test]
    fn units_decide_where_names_do_not() {
        let clocks = [("Force time", Some("s")), ("Force", Some("N"))];
        assert_eq!(found(&clocks, Quantity::Force), [2]);
        assert_eq!(found(&clocks, Quantity::Time), [1]);
        let pounds = [("Force", Some("lbs")), ("Force (filtered)", Some("N"))];
        assert_eq!(found(&pounds, Quantity::Force), [2]);
        assert_eq!(found(&pounds[..1], Quantity::Force), [1]);
        assert!(found(&[("Weg", Some("%"))], Quantity::Displacement).is_empty());
    }

    #[test]
    fn the_bending_of_a_cantilever_is_no_displacement() {
        let curve = [("force", Some("N")), ("cantilever deflection", Some("m")), ("vDeflection", Some("V"))];
        assert!(found(&curve, Quantity::Displacement).is_empty());
        assert_eq!(found(&[("Beam deflection", Some("mm"))], Quantity::Displacement), [1]);
        // With its height beside it nobody knows which is meant: the deflection of 40 nm was taken for the indentation.
        let table = [("Piezo", Some("um")), ("Deflection", Some("nm")), ("Force", Some("nN"))];
        assert_eq!(found(&table, Quantity::Displacement), [1, 2]);
    }

    #[test]
    fn fields_of_topics_tell_and_topics_do_not() {
        let log = [
            ("/gripper_cmd/feedback.feedback.position", None),
            ("/gripper_cmd/feedback.feedback.reached_goal", None),
            ("/force_torque.wrench.torque.z", None),
            ("/load.data", None),
            ("/load_target.data", None),
        ];
        assert_eq!(found(&log, Quantity::Displacement), [1]);
        assert_eq!(found(&log, Quantity::Force), [4]);
        let joints = [("/joint_states.position[force_joint]", None), ("/joint_states.velocity[force_joint]", None)];
        assert!(found(&joints, Quantity::Force).is_empty());
        assert_eq!(found(&joints, Quantity::Displacement), [1]);
    }

    #[test]
    fn of_an_own_log_only_readings_are_measurements() {
        let log = [
            ("/palpate/joint_states.position[finger]", Some("m")),
            ("/palpate/joint_states.effort[finger]", Some("N")),
            ("/palpate/wrench.wrench.force.x", Some("N")),
            ("/palpate/wrench.wrench.force.z", Some("N")),
            ("/palpate/contact_displacement_m.data", Some("m")),
            ("/palpate/equilibrium_force_n.data", Some("N")),
            ("/palpate/strain.data", None),
            ("/palpate/time_to_slip_s.data", Some("s")),
        ];
        assert_eq!(found(&log, Quantity::Displacement), [1]);
        assert_eq!(found(&log, Quantity::Force), [4]);
        assert!(found(&log, Quantity::Strain).is_empty() && found(&log, Quantity::Time).is_empty());
        // Estimates that a node publishes beside what a gripper measures do not replace it.
        let bag = [("/ft.wrench.force.z", Some("N")), ("/palpate/equilibrium_force_n.data", None)];
        assert_eq!(found(&bag, Quantity::Force), [1]);
    }

    #[test]
    fn two_of_a_kind_are_both_reported() {
        let two = [("Force 1", Some("N")), ("Force 2", Some("N"))];
        assert_eq!(found(&two, Quantity::Force), [1, 2]);
    }
}
