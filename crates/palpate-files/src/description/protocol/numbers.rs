//! The numbers of a protocol that can be replaced.

use palpate::units::Dimension;

use super::tables::ProtocolTables;
use crate::description::text::quantity::QuantityText;

/// Where a number stands.
pub(crate) enum Slot<'t> {
    /// A number without a unit.
    Bare(&'t mut f64),
    /// A quantity with its unit.
    Quantity(&'t mut QuantityText, Dimension),
}

/// All numbers that stand in the tables, in their order, by their paths, such as `law.exponent` or `step[2].rate`.
pub(crate) fn numbers(tables: &mut ProtocolTables) -> Vec<(String, Slot<'_>)> {
    let mut found = Vec::new();
    let (law, specimen) = (&mut tables.law, &mut tables.specimen);
    for (path, number) in [
        ("law.exponent", &mut law.exponent),
        ("law.strain_factor", &mut law.strain_factor),
        ("law.unloading_factor", &mut law.unloading_factor),
        ("law.overshoot", &mut law.overshoot),
        ("law.order", &mut law.order),
        ("contact.layers", &mut tables.contact.layers),
        ("specimen.poisson_ratio", &mut specimen.poisson_ratio),
    ] {
        if let Some(number) = number {
            found.push((path.to_owned(), Slot::Bare(number)));
        }
    }
    for (index, term) in law.terms.iter_mut().flatten().enumerate() {
        let path = |name: &str| format!("law.terms[{}].{name}", index + 1);
        found.push((path("overshoot"), Slot::Bare(&mut term.overshoot)));
        found.push((path("time"), Slot::Quantity(&mut term.time, Dimension::Time)));
    }
    for (index, term) in law.shares.iter_mut().flatten().enumerate() {
        let path = |name: &str| format!("law.shares[{}].{name}", index + 1);
        found.push((path("share"), Slot::Bare(&mut term.share)));
        found.push((path("rate"), Slot::Quantity(&mut term.rate, Dimension::Rate)));
    }
    let mut quantity = |path: String, text, dimension| found.push((path, Slot::Quantity(text, dimension)));
    for (path, text, dimension) in [
        ("law.rate_coefficient", &mut law.rate_coefficient, Dimension::Rate),
        ("law.time", &mut law.time, Dimension::Time),
        ("specimen.radius", &mut specimen.radius, Dimension::Length),
        ("specimen.diameter", &mut specimen.diameter, Dimension::Length),
        ("specimen.width", &mut specimen.width, Dimension::Length),
        ("specimen.thickness", &mut specimen.thickness, Dimension::Length),
        ("specimen.area", &mut specimen.area, Dimension::Area),
        ("specimen.length", &mut specimen.length, Dimension::Length),
        ("specimen.depth", &mut specimen.depth, Dimension::Length),
        ("specimen.modulus", &mut specimen.modulus, Dimension::Pressure),
        ("contact.layer_thickness", &mut tables.contact.layer_thickness, Dimension::Length),
        ("output.sample_rate", &mut tables.output.sample_rate, Dimension::Frequency),
    ] {
        if let Some(text) = text {
            quantity(path.to_owned(), text, dimension);
        }
    }
    for (index, time) in tables.output.times.iter_mut().flatten().enumerate() {
        quantity(format!("output.times[{}]", index + 1), time, Dimension::Time);
    }
    for (index, step) in tables.step.iter_mut().enumerate() {
        for (name, text, dimension) in [
            ("to", &mut step.to, Dimension::Length),
            ("to_force", &mut step.to_force, Dimension::Force),
            ("rate", &mut step.rate, Dimension::Speed),
            ("force_rate", &mut step.force_rate, Dimension::ForceRate),
            ("hold", &mut step.hold, Dimension::Time),
            ("hold_force", &mut step.hold_force, Dimension::Time),
        ] {
            if let Some(text) = text {
                quantity(format!("step[{}].{name}", index + 1), text, dimension);
            }
        }
    }
    found
}
