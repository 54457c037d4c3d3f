//! What makes force and displacement of the quantities that a file gives in their place.

use palpate::{
    contact::Shape,
    record::{Correction, SourceQuantity},
};

use super::{chooser::Found, error::ColumnError};
use crate::{
    cell::{DecimalMark, number},
    description::{TestDescription, Torsion},
    naming::Quantity,
    table::Metadata,
};

/// Factors from the columns in SI to force and displacement.
///
/// A stress times the section of the body is its force, a strain times its length its displacement. Without a body the record is that
/// of 1 m² and 1 m: N stands for Pa, and m for a strain of 1. Torque and angle become the force and the displacement of the shear stress
/// and the shear strain at the rim.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Conversion {
    /// Of what becomes the force.
    pub(super) load: f64,
    /// Of what becomes the displacement.
    pub(super) travel: f64,
    /// The force throughout, N, where the file gives a compliance or a strain alone.
    pub(super) constant_force: Option<f64>,
    /// Stress without a section.
    pub(super) per_unit_area: bool,
    /// What a record is stated to be made of.
    pub(super) done: Vec<Correction>,
}

/// What makes force and displacement of torque and angle: by the sizes of the sample that are described, else by the stress and strain
/// constants that TRIOS states of its geometry.
pub(super) fn torsion(test: &TestDescription, metadata: &[Metadata]) -> Option<Torsion> {
    let constant = |name: &str, unit: &str| {
        let letters = |text: &str| text.chars().filter(|letter| letter.is_alphanumeric()).collect::<String>();
        let has_unit = |entry: &Metadata| entry.unit.as_deref().is_some_and(|own| letters(own) == unit);
        let entry = metadata.iter().find(|entry| entry.name.eq_ignore_ascii_case(name) && has_unit(entry))?;
        let value = number::parse(entry.value.as_bytes(), DecimalMark::Point);
        value
            .or_else(|| number::parse(entry.value.as_bytes(), DecimalMark::Comma))
            .filter(|value| *value > 0.0)
    };
    test.torsion.or_else(|| {
        let (area, length) = section(test);
        Some(Torsion {
            force_per_torque: constant("stress constant", "PaNm")? * area,
            travel_per_angle: constant("strain constant", "1rad")? * length,
        })
    })
}

/// Section in m² and length in m of the body: 1 and 1 of one that is not described, or has none.
fn section(test: &TestDescription) -> (f64, f64) {
    match test.analysis.geometry.as_ref().map(|body| &body.shape) {
        Some(Shape::Prism { area, length }) => (*area, *length),
        _ => (1.0, 1.0),
    }
}

impl Conversion {
    /// For these columns of a test.
    pub(super) fn of(
        test: &TestDescription,
        torsion: Option<Torsion>,
        (load, travel): (Option<&Found<'_>>, Option<&Found<'_>>),
    ) -> Result<Self, ColumnError> {
        let (load_of, travel_of) = (load.map(|load| load.role.measured()), travel.map(|travel| travel.role.measured()));
        let shape = test.analysis.geometry.as_ref().map(|body| &body.shape);
        let (area, length) = section(test);
        let on_section = |quantity| matches!(quantity, Quantity::Stress | Quantity::Modulus);
        let by_length = |quantity| matches!(quantity, Quantity::Strain | Quantity::Compliance);
        let needs = load
            .filter(|_| load_of.is_some_and(on_section))
            .or(travel.filter(|_| travel_of.is_some_and(by_length)));
        if let (Some(found), Some(shape)) = (needs, shape)
            && !matches!(shape, Shape::Prism { .. })
        {
            return Err(ColumnError::NoSection(found.column.into()));
        }
        let turned = [(load, Quantity::Torque), (travel, Quantity::Angle)];
        let turned =
            turned.into_iter().find_map(|(found, turned)| found.filter(|found| found.role.measured() == turned));
        let torsion = match (turned, torsion) {
            (Some(found), None) => return Err(ColumnError::NoTorsion(found.column.into())),
            (_, torsion) => torsion.unwrap_or_default(),
        };
        let mut done = Vec::new();
        let mut read_as = |quantity, factor| {
            done.push(Correction::ReadAs { quantity, factor });
            factor
        };
        let per_unit_area = load_of == Some(Quantity::Stress) && shape.is_none();
        let load = match load_of {
            Some(Quantity::Stress) => area,
            Some(Quantity::Modulus) => read_as(SourceQuantity::Modulus, area),
            Some(Quantity::Torque) => read_as(SourceQuantity::Torque, torsion.force_per_torque),
            _ => 1.0,
        };
        let travel = match travel_of {
            Some(Quantity::Strain) if load_of.is_none() => read_as(SourceQuantity::CreepStrain, length),
            Some(Quantity::Strain) => read_as(SourceQuantity::Strain, length),
            Some(Quantity::Compliance) => read_as(SourceQuantity::Compliance, length),
            Some(Quantity::Angle) => read_as(SourceQuantity::Angle, torsion.travel_per_angle),
            _ => 1.0,
        };
        if per_unit_area {
            done.insert(0, Correction::StressAsForce);
        }
        Ok(Self {
            load,
            travel,
            constant_force: load_of.is_none().then_some(area),
            per_unit_area,
            done,
        })
    }
}
