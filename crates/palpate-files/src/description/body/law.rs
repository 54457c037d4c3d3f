//! The table `[law]` to the law that a body obeys.

use std::fmt::Display;

use palpate::{
    contact::RateDependence,
    latency::LatencyLaw,
    simulate::{LinearLaw, LinearLawError, LinearTerm, Memory},
    units::Dimension,
};

use super::tables::{LawName, LawTable, MemoryName, ShareTable, TermTable};
use crate::description::text::{error::DescriptionError, quantity::QuantityText, source::Source};

/// A law, whichever it is.
pub(crate) enum Law {
    Latency(LatencyLaw, RateDependence),
    Linear(LinearLaw, Memory),
}

/// How far on either side of its own time a fractional law is good.
const FRACTIONAL_REACH: f64 = 1e6;

impl LawTable {
    /// The law, once its numbers are checked.
    pub(crate) fn law(&self, source: &Source<'_>) -> Result<Law, DescriptionError> {
        self.check_numbers(source)?;
        let above = |key: &str, number: Option<f64>| {
            let number = number.ok_or_else(|| source.missing(key, "a number above 0"))?;
            source.number(key, number, "a number above 0", |number| number > 0.0)
        };
        let quantity = |key: &str, text: Option<&QuantityText>, dimension| {
            let text = text.ok_or_else(|| source.missing(key, "a quantity with its unit"))?;
            source.positive(key, text, dimension)
        };
        let time = || quantity("law.time", self.time.as_ref(), Dimension::Time);
        let refused = |error: &dyn Display| source.value("law", "a law", &error.to_string());
        let linear = match self.name {
            LawName::Latency => {
                let exponent = above("law.exponent", self.exponent)?;
                let rate = quantity("law.rate_coefficient", self.rate_coefficient.as_ref(), Dimension::Rate)?;
                let dependence = self.rate_dependence(source)?;
                let law = LatencyLaw::new(exponent, rate).map_err(|error| refused(&error))?;
                return Ok(Law::Latency(law, dependence));
            }
            LawName::StandardLinearSolid => LinearLaw::standard(above("law.overshoot", self.overshoot)?, time()?),
            LawName::Prony => LinearLaw::new(&self.prony(source)?),
            LawName::Fung => LinearLaw::fung(&self.fung(source)?),
            LawName::FractionalZener => {
                let (overshoot, time) = (above("law.overshoot", self.overshoot)?, time()?);
                let reach = (time / FRACTIONAL_REACH, time * FRACTIONAL_REACH);
                LinearLaw::fractional(overshoot, time, self.order.unwrap_or(f64::NAN), reach)
            }
        };
        let memory = match (self.memory, self.name) {
            (Some(MemoryName::Force), _) | (None, LawName::Fung) => Memory::Force,
            _ => Memory::Strain,
        };
        linear.map(|law| Law::Linear(law, memory)).map_err(|error| match error {
            LinearLawError::Order { found } => source.value("law.order", "an order from 0.05 to below 1", &found),
            LinearLawError::Empty => source.missing(format!("law.{}", self.name.numbers()[0]), "one term or more"),
            LinearLawError::NotPositive { term: 0, found, .. } => {
                let expected = "shares with a sum below 1";
                source.value("law.shares", expected, &(1.0 - found))
            }
            LinearLawError::OutOfRange {
                term,
                name,
                unit,
                found,
                least,
                most,
            } => {
                let key = match (self.name, name) {
                    (LawName::Prony, "overshoot") => format!("law.terms[{term}].overshoot"),
                    (LawName::Prony, _) => format!("law.terms[{term}].time"),
                    (LawName::Fung, _) => format!("law.shares[{term}]"),
                    (_, "overshoot") => "law.overshoot".to_owned(),
                    _ => "law.time".to_owned(),
                };
                let what = if name == "rate" { "a rate, the inverse of the time, " } else { "an overshoot " };
                let expected = format!("{what}from {least:e} to {most:e}{unit}");
                source.value(key, expected, &format!("{found:e}{unit}"))
            }
            error => refused(&error),
        })
    }

    /// What the rate coefficient depends on: strain or direction, not both.
    fn rate_dependence(&self, source: &Source<'_>) -> Result<RateDependence, DescriptionError> {
        let above = |key: &str, factor: f64| source.number(key, factor, "a number above 0", |factor| factor > 0.0);
        match (self.strain_factor, self.unloading_factor) {
            (None, None) => Ok(RateDependence::Constant),
            (Some(factor), None) => above("law.strain_factor", factor).map(|factor| RateDependence::Strain { factor }),
            (None, Some(factor)) => {
                above("law.unloading_factor", factor).map(|factor| RateDependence::Direction { factor })
            }
            (Some(_), Some(_)) => {
                let reason = "with strain_factor: v depends on only one of them";
                Err(source.unused("law.unloading_factor", reason, "remove strain_factor or unloading_factor"))
            }
        }
    }

    fn prony(&self, source: &Source<'_>) -> Result<Vec<LinearTerm>, DescriptionError> {
        let term = |(index, term): (usize, &TermTable)| {
            let key = |name: &str| format!("law.terms[{}].{name}", index + 1);
            let overshoot = source.number(&key("overshoot"), term.overshoot, "a number above 0", |g| g > 0.0)?;
            let rate = 1.0 / source.positive(&key("time"), &term.time, Dimension::Time)?;
            Ok(LinearTerm { overshoot, rate })
        };
        self.terms.iter().flatten().enumerate().map(term).collect()
    }

    fn fung(&self, source: &Source<'_>) -> Result<Vec<(f64, f64)>, DescriptionError> {
        let term = |(index, term): (usize, &ShareTable)| {
            let key = |name: &str| format!("law.shares[{}].{name}", index + 1);
            let share = source.number(&key("share"), term.share, "a share above 0", |share| share > 0.0)?;
            Ok((share, source.positive(&key("rate"), &term.rate, Dimension::Rate)?))
        };
        self.shares.iter().flatten().enumerate().map(term).collect()
    }

    /// All parameters of the law must be there, and no other but those it may have.
    fn check_numbers(&self, source: &Source<'_>) -> Result<(), DescriptionError> {
        let wanted = self.name.numbers();
        let is_latency = self.name == LawName::Latency;
        let given = [
            ("exponent", self.exponent.is_some(), "a number above 0, such as 5"),
            ("rate_coefficient", self.rate_coefficient.is_some(), "a rate, such as \"2e4 /s\""),
            ("strain_factor", self.strain_factor.is_some() && !is_latency, ""),
            ("unloading_factor", self.unloading_factor.is_some() && !is_latency, ""),
            ("overshoot", self.overshoot.is_some(), "a number above 0, such as 3"),
            ("time", self.time.is_some(), "a time, such as \"2 s\""),
            ("order", self.order.is_some(), "an order from 0.05 to below 1, such as 0.5"),
            ("terms", self.terms.is_some(), "terms, such as [{ overshoot = 3, time = \"2 s\" }]"),
            ("shares", self.shares.is_some(), "shares, such as [{ share = 0.3, rate = \"0.5 /s\" }]"),
        ];
        for (name, is_given, expected) in given {
            let key = format!("law.{name}");
            match (is_given, wanted.contains(&name)) {
                (true, false) => {
                    let reason = format!("with name = \"{}\", which takes {}", self.name, wanted.join(", "));
                    return Err(source.unused(key, reason, format!("remove {name}")));
                }
                (false, true) => return Err(source.missing(key, expected)),
                _ => {}
            }
        }
        if self.memory.is_some() && is_latency {
            let reason = "with name = \"latency\", whose memory is its layers";
            return Err(source.unused("law.memory", reason, "remove memory"));
        }
        Ok(())
    }
}
