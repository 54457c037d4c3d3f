//! The table `[instrument]` of a test: what is known of instrument and body, and how well.

use std::fmt;

use palpate::{
    analysis::Geometry,
    budget::{Distribution, Evaluation, InputQuantity},
    contact::{Shape, ShapeDimension},
    instrument::{Instrument, InstrumentInput, InstrumentQuantity},
    units::Dimension,
};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{
    Deserialize, Deserializer,
    de::{Error, MapAccess, Visitor, value::MapAccessDeserializer},
};

use crate::description::{
    body::tables::{ShapeName, SpecimenTable},
    text::{error::DescriptionError, quantity::QuantityText, source::Source},
    uncertainty::{CauseText, DistributionName, EvaluationName},
};

/// The uncertainty of the instrument and of the body, each an error that all samples have in common; what is left out counts as exact. A text
/// such as "0.2 N" states the limits ±0.2 N, a rectangular distribution.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Instrument")]
pub(crate) struct InstrumentTable {
    /// Zero of the force: what the tare leaves.
    force: Option<Uncertain>,
    /// Gain of the load cell, such as "0.5 %".
    force_gain: Option<Uncertain>,
    /// Zero of the displacement.
    displacement: Option<Uncertain>,
    /// Gain of the displacement, such as "0.1 %".
    displacement_gain: Option<Uncertain>,
    /// Compliance of machine and load cell, such as "0.1 um/N".
    compliance: Option<Uncertain>,
    /// First touch, as far as the record does not show it.
    touch: Option<Uncertain>,
    /// Gain of the clock, a share of all times, such as "0.1 %".
    clock: Option<Uncertain>,
    /// Radius of a ball, pad, spherical tip or flat punch.
    radius: Option<Uncertain>,
    /// Diameter of a cylinder.
    diameter: Option<Uncertain>,
    /// Width of a strip.
    width: Option<Uncertain>,
    /// Thickness of a strip, dumbbell or pad, or of the sample under a tip.
    thickness: Option<Uncertain>,
    /// Section of a block.
    area: Option<Uncertain>,
    /// Length of a strip, cylinder or block.
    length: Option<Uncertain>,
    /// Depth of a profile.
    depth: Option<Uncertain>,
    /// Half angle of a conical or pyramidal tip.
    half_angle: Option<Uncertain>,
    /// The given modulus.
    modulus: Option<Uncertain>,
    /// Temperature of the body, with what it changes.
    temperature: Option<Uncertain>,
}

/// An uncertainty: limits alone, or a table that states another.
#[derive(Debug, Clone)]
enum Uncertain {
    Limits(QuantityText),
    Stated(UncertaintyTable),
}

/// One of limits, standard and expanded.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Uncertainty")]
struct UncertaintyTable {
    /// Half the width of the limits: ±a.
    limits: Option<QuantityText>,
    /// Standard uncertainty.
    standard: Option<QuantityText>,
    /// Expanded uncertainty, with its coverage factor.
    expanded: Option<QuantityText>,
    /// Coverage factor of expanded, such as 2.
    #[schemars(extend("exclusiveMinimum" = 0))]
    coverage_factor: Option<f64>,
    /// Distribution. Default: rectangular of limits, normal of the others.
    distribution: Option<DistributionName>,
    /// Degrees of freedom; endless if omitted.
    #[schemars(extend("minimum" = 1))]
    freedom: Option<f64>,
    /// Evaluation: by the statistics of observations (A) or by other means (B, the default).
    #[serde(rename = "type")]
    evaluation: Option<EvaluationName>,
    /// Where several records are calibrated together: "record" (each has its own error), or the name of a cause, such as "load cell 1", which records
    /// that name it have in common. Default: records that state the same have it in common.
    cause: Option<CauseText>,
    /// Of temperature: relative change of the modulus per kelvin, such as "-0.4 %/K".
    modulus_per_k: Option<QuantityText>,
    /// Of temperature: relative change of all rates of relaxation per kelvin.
    rate_per_k: Option<QuantityText>,
}

impl JsonSchema for Uncertain {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Uncertain".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (limits, table) =
            (generator.subschema_for::<QuantityText>(), generator.subschema_for::<UncertaintyTable>());
        json_schema!({ "description": "Limits such as \"0.2 N\", or a table that states another uncertainty.", "anyOf": [limits, table] })
    }
}

impl<'de> Deserialize<'de> for Uncertain {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Written)
    }
}

struct Written;

impl<'de> Visitor<'de> for Written {
    type Value = Uncertain;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("limits with their unit, such as \"0.2 N\", or a table such as { standard = \"0.1 N\" }")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Uncertain, E> {
        Ok(Uncertain::Limits(QuantityText::of(text)))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Uncertain, E> {
        Ok(Uncertain::Limits(QuantityText::bare(&number)))
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Uncertain, E> {
        Ok(Uncertain::Limits(QuantityText::bare(&number)))
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<Uncertain, A::Error> {
        UncertaintyTable::deserialize(MapAccessDeserializer::new(table)).map(Uncertain::Stated)
    }
}

/// A key of the table: what it is an uncertainty of, and how many SI units of that one of its own is.
type Key = (&'static str, InstrumentQuantity, Dimension, f64);

/// The instrument of a test with this body.
pub(super) fn checked(
    source: &Source<'_>,
    (table, specimen): (Option<&InstrumentTable>, Option<&SpecimenTable>),
    geometry: Option<&Geometry>,
) -> Result<Instrument, DescriptionError> {
    let Some(table) = table else {
        return Ok(Instrument::default());
    };
    let body = |dimension| InstrumentQuantity::Body { dimension };
    let shape = geometry.map(|geometry| &geometry.shape);
    // A strip, a dumbbell and a cylinder have a section that follows from what was measured of them.
    let is_flat = matches!(specimen.map(|table| table.shape), Some(ShapeName::Strip | ShapeName::Dumbbell));
    let section = |text: Option<&QuantityText>, key: &str, power: f64| -> Result<f64, DescriptionError> {
        let area = shape.and_then(|shape| shape.dimension(ShapeDimension::Area)).unwrap_or(0.0);
        let size = source.positive_if(&format!("specimen.{key}"), text, Dimension::Length)?;
        Ok(size.map_or(1.0, |size| power * area / size))
    };
    let width = section(specimen.and_then(|table| table.width.as_ref()), "width", 1.0)?;
    let thickness = section(specimen.and_then(|table| table.thickness.as_ref()).filter(|_| is_flat), "thickness", 1.0)?;
    let diameter = section(specimen.and_then(|table| table.diameter.as_ref()), "diameter", 2.0)?;
    let of_thickness = if is_flat { ShapeDimension::Area } else { ShapeDimension::Thickness };
    let entries: [(&Option<Uncertain>, Key); 17] = [
        (&table.force, ("force", InstrumentQuantity::Force, Dimension::Force, 1.0)),
        (&table.force_gain, ("force_gain", InstrumentQuantity::ForceGain, Dimension::Share, 1.0)),
        (&table.displacement, ("displacement", InstrumentQuantity::Displacement, Dimension::Length, 1.0)),
        (
            &table.displacement_gain,
            ("displacement_gain", InstrumentQuantity::DisplacementGain, Dimension::Share, 1.0),
        ),
        (&table.compliance, ("compliance", InstrumentQuantity::Compliance, Dimension::Compliance, 1.0)),
        (&table.touch, ("touch", InstrumentQuantity::Touch, Dimension::Length, 1.0)),
        (&table.clock, ("clock", InstrumentQuantity::Clock, Dimension::Share, 1.0)),
        (&table.radius, ("radius", body(ShapeDimension::Radius), Dimension::Length, 1.0)),
        (&table.diameter, ("diameter", body(ShapeDimension::Area), Dimension::Length, diameter)),
        (&table.width, ("width", body(ShapeDimension::Area), Dimension::Length, width)),
        (&table.thickness, ("thickness", body(of_thickness), Dimension::Length, thickness)),
        (&table.area, ("area", body(ShapeDimension::Area), Dimension::Area, 1.0)),
        (&table.length, ("length", body(ShapeDimension::Length), Dimension::Length, 1.0)),
        (&table.depth, ("depth", body(ShapeDimension::Depth), Dimension::Length, 1.0)),
        (&table.half_angle, ("half_angle", body(ShapeDimension::HalfAngle), Dimension::Angle, 1.0)),
        (&table.modulus, ("modulus", InstrumentQuantity::Modulus, Dimension::Pressure, 1.0)),
        (&table.temperature, ("temperature", temperature(source, table)?, Dimension::Temperature, 1.0)),
    ];
    let mut inputs = Vec::new();
    for (uncertain, key) in entries {
        let Some(uncertain) = uncertain else {
            continue;
        };
        belongs(source, key, geometry, specimen)?;
        inputs.push(InstrumentInput {
            quantity: key.1,
            uncertainty: believable(source, key, uncertain.checked(source, key)?, geometry)?,
        });
    }
    Ok(Instrument { inputs })
}

/// Refuses an uncertainty that no instrument has: a slip of the exponent or of the unit.
fn believable(
    source: &Source<'_>,
    (name, quantity, ..): Key,
    input: InputQuantity,
    geometry: Option<&Geometry>,
) -> Result<InputQuantity, DescriptionError> {
    let shape = geometry.map(|geometry| &geometry.shape);
    let most = match quantity {
        InstrumentQuantity::Body { dimension } => shape.and_then(|shape| shape.dimension(dimension)),
        InstrumentQuantity::Modulus => geometry.and_then(|geometry| geometry.modulus),
        InstrumentQuantity::Force | InstrumentQuantity::ForceDrift { .. } => Some(1e6),
        InstrumentQuantity::ForceGain
        | InstrumentQuantity::DisplacementGain
        | InstrumentQuantity::Compliance
        | InstrumentQuantity::Clock
        | InstrumentQuantity::Displacement
        | InstrumentQuantity::Touch => Some(1.0),
        InstrumentQuantity::Temperature { .. } => Some(1e3),
    };
    let most = most.unwrap_or(f64::INFINITY);
    if input.standard_uncertainty < most {
        return Ok(input);
    }
    let unit = quantity.unit();
    let expected = format!("a standard uncertainty below {most} {unit}");
    let found = format!("{} {unit}", input.standard_uncertainty);
    Err(source.value(format!("instrument.{name}"), expected, &found))
}

/// Refuses what the body of the test does not have.
fn belongs(
    source: &Source<'_>,
    (name, quantity, ..): Key,
    geometry: Option<&Geometry>,
    specimen: Option<&SpecimenTable>,
) -> Result<(), DescriptionError> {
    let key = format!("instrument.{name}");
    let remedy = format!("remove {key}, or describe the body in [specimen]");
    let of_body = matches!(quantity, InstrumentQuantity::Body { .. } | InstrumentQuantity::Modulus);
    let Some(geometry) = geometry else {
        return if of_body {
            Err(source.unused(key, "without a [specimen] that has a shape", remedy))
        } else {
            Ok(())
        };
    };
    if quantity == InstrumentQuantity::Modulus && geometry.modulus.is_none() {
        return Err(source.unused(key, "without a given modulus", "remove it: an estimated modulus has its own"));
    }
    let given = specimen.is_none_or(|specimen| match name {
        "diameter" => specimen.diameter.is_some(),
        "width" => specimen.width.is_some(),
        "area" => specimen.area.is_some(),
        _ => true,
    });
    if given && quantity.belongs_to(&geometry.shape) {
        return Ok(());
    }
    let sizes = sizes(&geometry.shape);
    Err(source.unused(key, format!("for this body, whose sizes are {sizes}"), format!("remove it, or state {sizes}")))
}

/// What a body is described by, in words.
fn sizes(shape: &Shape) -> &'static str {
    match shape {
        Shape::Ball { .. } => "radius",
        Shape::Pad { .. } => "radius and thickness",
        Shape::Prism { .. } => "width, thickness and length, diameter and length, or area and length",
        Shape::Profile { .. } => "depth",
        Shape::Indenter { .. } => "those of the tip (radius or half_angle) and thickness",
    }
}

/// The temperature with its effects; those are needed where its uncertainty is stated.
fn temperature(source: &Source<'_>, table: &InstrumentTable) -> Result<InstrumentQuantity, DescriptionError> {
    let stated = table.temperature.as_ref().and_then(|uncertain| match uncertain {
        Uncertain::Stated(table) => Some(table),
        Uncertain::Limits(_) => None,
    });
    let per_k = |text: Option<&QuantityText>, name: &str| {
        let key = format!("instrument.temperature.{name}");
        text.map(|text| source.si(&key, text, Dimension::PerKelvin)).transpose()
    };
    let modulus = per_k(stated.and_then(|table| table.modulus_per_k.as_ref()), "modulus_per_k")?;
    let rate = per_k(stated.and_then(|table| table.rate_per_k.as_ref()), "rate_per_k")?;
    if table.temperature.is_some() && modulus.is_none() && rate.is_none() {
        let expected = "what it changes, such as modulus_per_k = \"-0.4 %/K\" or rate_per_k = \"5 %/K\"";
        return Err(source.missing("instrument.temperature.modulus_per_k", expected));
    }
    Ok(InstrumentQuantity::Temperature {
        modulus_per_k: modulus.unwrap_or(0.0),
        rate_per_k: rate.unwrap_or(0.0),
    })
}

impl Uncertain {
    /// The uncertainty in SI.
    fn checked(&self, source: &Source<'_>, key: Key) -> Result<InputQuantity, DescriptionError> {
        let (name, quantity, dimension, factor) = key;
        let own = format!("instrument.{name}");
        let title = if factor == 1.0 { quantity.title().to_owned() } else { format!("area, by the {name}") };
        let stated = match self {
            Self::Stated(table) => return table.checked(source, key, &title),
            Self::Limits(text) => text,
        };
        let size = factor * source.si(&own, stated, dimension)?;
        InputQuantity::limits(title, quantity.unit(), 0.0, size, Distribution::Rectangular)
            .map_err(|_| source.value(own, POSITIVE, stated))
    }
}

/// What an uncertainty is expected to be.
const POSITIVE: &str = "an uncertainty of 0 or more";

impl UncertaintyTable {
    fn checked(
        &self,
        source: &Source<'_>,
        (name, quantity, dimension, factor): Key,
        title: &str,
    ) -> Result<InputQuantity, DescriptionError> {
        let key = |rest: &str| format!("instrument.{name}.{rest}");
        let is_temperature = matches!(quantity, InstrumentQuantity::Temperature { .. });
        for (stated, rest) in [(&self.modulus_per_k, "modulus_per_k"), (&self.rate_per_k, "rate_per_k")] {
            if stated.is_some() && !is_temperature {
                let remedy = "move it to [instrument.temperature]";
                return Err(source.unused(key(rest), "for another quantity than the temperature", remedy));
            }
        }
        let (text, rest) = self.stated(source, name)?;
        let size = factor * source.si(&key(rest), text, dimension)?;
        if size < 0.0 {
            return Err(source.value(key(rest), POSITIVE, text));
        }
        let coverage = match (rest, self.coverage_factor) {
            ("expanded", Some(coverage)) => {
                source
                    .number(&key("coverage_factor"), coverage, "a number above 0, such as 2", |factor| factor > 0.0)?
            }
            ("expanded", None) => {
                return Err(source.missing(key("coverage_factor"), "the coverage factor of expanded, such as 2"));
            }
            (_, Some(_)) => {
                let remedy = "remove it, or give expanded in place of what is given";
                return Err(source.unused(key("coverage_factor"), "without expanded", remedy));
            }
            (_, None) => 1.0,
        };
        let distribution = self.distribution.map(Distribution::from);
        let limits = |distribution| InputQuantity::limits(title, quantity.unit(), 0.0, size, distribution);
        let standard = || InputQuantity::standard(title, quantity.unit(), 0.0, size / coverage);
        let input = match (rest, distribution) {
            ("limits", Some(Distribution::Normal)) => {
                let expected = "\"rectangular\", \"triangular\" or \"arcsine\", which have limits";
                return Err(source.value(key("distribution"), expected, "\"normal\""));
            }
            ("limits", distribution) => limits(distribution.unwrap_or(Distribution::Rectangular)),
            (_, distribution) => standard().map(|input| InputQuantity {
                distribution: distribution.unwrap_or_default(),
                ..input
            }),
        };
        let input = input.map_err(|_| source.value(key(rest), POSITIVE, text))?;
        let freedom = match self.freedom {
            None => f64::INFINITY,
            Some(freedom) => source.number(&key("freedom"), freedom, "1 or more", |freedom| freedom >= 1.0)?,
        };
        Ok(InputQuantity {
            freedom,
            evaluation: self.evaluation.map_or(Evaluation::B, Evaluation::from),
            cause: CauseText::cause(self.cause.as_ref()),
            ..input
        })
    }

    /// What is stated of limits, standard and expanded.
    fn stated(&self, source: &Source<'_>, name: &str) -> Result<(&QuantityText, &'static str), DescriptionError> {
        let stated = [(&self.limits, "limits"), (&self.standard, "standard"), (&self.expanded, "expanded")];
        let mut stated = stated.into_iter().filter_map(|(text, rest)| Some((text.as_ref()?, rest)));
        let key = |rest: &str| format!("instrument.{name}.{rest}");
        match (stated.next(), stated.next()) {
            (Some(only), None) => Ok(only),
            (Some((_, first)), Some((_, second))) => Err(source.both(key(first), key(second))),
            (None, _) => {
                let expected = "limits, standard or expanded, such as { standard = \"0.1 N\" }";
                Err(source.missing(format!("instrument.{name}"), expected))
            }
        }
    }
}
