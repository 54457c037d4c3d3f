//! Quantities as people write them: `"35 mm"`, `"28 kPa"`, `"500 mm/min"`, `"2e4 /s"`.
//!
//! Inside the library every number is in SI. At the borders a quantity is a number and a unit; this
//! module holds the whole list of units that are understood. The list is strict: a unit that is not
//! in it is an error that names what would be accepted, never a guess.
//!
//! ```
//! use palpate::units::{Dimension, parse};
//! assert_eq!(parse("500 mm/min", Dimension::Speed)?, 0.5 / 60.0);
//! assert_eq!(parse("28 kPa", Dimension::Pressure)?, 28_000.0);
//! # Ok::<(), palpate::units::UnitError>(())
//! ```

use serde::{Deserialize, Serialize};

/// Dimension of a quantity; it decides which units are accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dimension {
    /// Length in m.
    Length,
    /// Area in m².
    Area,
    /// Time in s.
    Time,
    /// Force in N.
    Force,
    /// Stress, pressure or modulus in Pa.
    Pressure,
    /// Speed in m/s.
    Speed,
    /// Rate in 1/s (also the rate coefficient of the latency law, whose strain is dimensionless).
    Rate,
    /// Frequency in Hz.
    Frequency,
    /// Rate of a force in N/s.
    ForceRate,
    /// Way per force in m/N.
    Compliance,
    /// Force per way in N/m.
    Stiffness,
    /// Voltage of a sensor in V.
    Voltage,
    /// Mass in kg.
    Mass,
    /// Acceleration in m/s².
    Acceleration,
    /// Torque in N m.
    Torque,
    /// Share of a quantity.
    Share,
    /// Difference of temperature in K.
    Temperature,
    /// Relative change per kelvin, 1/K.
    PerKelvin,
    /// Angle in rad.
    Angle,
    /// Compliance of a material in 1/Pa: strain per stress.
    PerPressure,
}

impl Dimension {
    /// Name, an example, and the accepted units.
    fn row(self) -> (&'static str, &'static str, &'static [(&'static str, f64)]) {
        match self {
            Self::Length => ("length", "35 mm", LENGTH),
            Self::Area => ("area", "40 mm^2", AREA),
            Self::Time => ("time", "10 s", TIME),
            Self::Force => ("force", "5 N", FORCE),
            Self::Pressure => ("pressure or modulus", "28 kPa", PRESSURE),
            Self::Speed => ("speed", "500 mm/min", SPEED),
            Self::Rate => ("rate", "2e4 /s", RATE),
            Self::Frequency => ("frequency", "100 Hz", FREQUENCY),
            Self::ForceRate => ("rate of force", "10 N/s", FORCE_RATE),
            Self::Compliance => ("compliance", "0.5 um/N", COMPLIANCE),
            Self::Stiffness => ("stiffness", "0.04 N/m", STIFFNESS),
            Self::Voltage => ("voltage", "2.5 V", VOLTAGE),
            Self::Mass => ("mass", "150 g", MASS),
            Self::Acceleration => ("acceleration", "2 m/s^2", ACCELERATION),
            Self::Torque => ("torque", "5 N mm", TORQUE),
            Self::Share => ("share", "0.5 %", SHARE),
            Self::Temperature => ("difference of temperature", "0.5 K", &[("K", 1.0), ("mK", 1e-3)]),
            Self::PerKelvin => ("relative change per kelvin", "-0.4 %/K", PER_KELVIN),
            Self::Angle => ("angle", "35 deg", ANGLE),
            Self::PerPressure => ("compliance of a material", "0.5 1/kPa", PER_PRESSURE),
        }
    }

    /// The name used in messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// Accepted unit symbols with the factor that turns them to SI; the SI unit stands first.
    #[must_use]
    pub fn units(self) -> &'static [(&'static str, f64)] {
        self.row().2
    }

    /// The accepted symbols as one line for a message: `m, mm, µm, …`.
    #[must_use]
    pub fn accepted(self) -> String {
        let symbols: Vec<_> = self.units().iter().map(|(symbol, _)| *symbol).collect();
        symbols.join(", ")
    }
}

const INCH: f64 = 0.0254;
const POUND_FORCE: f64 = 4.448_221_615_260_5;
const KILOGRAM_FORCE: f64 = 9.806_65;
const POUND: f64 = 0.453_592_37;

const LENGTH: &[(&str, f64)] = &[
    ("m", 1.0),
    ("cm", 1e-2),
    ("mm", 1e-3),
    ("µm", 1e-6),
    ("um", 1e-6),
    ("nm", 1e-9),
    ("in", INCH),
    ("mil", INCH * 1e-3),
    ("ft", 12.0 * INCH),
];
const AREA: &[(&str, f64)] = &[
    ("m²", 1.0),
    ("m^2", 1.0),
    ("m2", 1.0),
    ("cm²", 1e-4),
    ("cm^2", 1e-4),
    ("cm2", 1e-4),
    ("mm²", 1e-6),
    ("mm^2", 1e-6),
    ("mm2", 1e-6),
    ("µm²", 1e-12),
    ("um^2", 1e-12),
    ("in²", INCH * INCH),
    ("in^2", INCH * INCH),
    ("in2", INCH * INCH),
];
const TIME: &[(&str, f64)] = &[
    ("s", 1.0),
    ("sec", 1.0),
    ("ms", 1e-3),
    ("µs", 1e-6),
    ("us", 1e-6),
    ("min", 60.0),
    ("h", 3600.0),
    ("d", 86_400.0),
];
const FORCE: &[(&str, f64)] = &[
    ("N", 1.0),
    ("kN", 1e3),
    ("daN", 10.0),
    ("cN", 1e-2),
    ("mN", 1e-3),
    ("µN", 1e-6),
    ("uN", 1e-6),
    ("nN", 1e-9),
    ("pN", 1e-12),
    ("gf", KILOGRAM_FORCE * 1e-3),
    ("kgf", KILOGRAM_FORCE),
    ("tf", KILOGRAM_FORCE * 1e3),
    ("lbf", POUND_FORCE),
    ("kip", POUND_FORCE * 1e3),
    ("ozf", POUND_FORCE / 16.0),
];
const PRESSURE: &[(&str, f64)] = &[
    ("Pa", 1.0),
    ("kPa", 1e3),
    ("MPa", 1e6),
    ("GPa", 1e9),
    ("N/mm²", 1e6),
    ("N/mm^2", 1e6),
    ("N/mm2", 1e6),
    ("N/m^2", 1.0),
    ("bar", 1e5),
    ("psi", POUND_FORCE / (INCH * INCH)),
    ("ksi", 1e3 * POUND_FORCE / (INCH * INCH)),
];
const SPEED: &[(&str, f64)] = &[
    ("m/s", 1.0),
    ("m/min", 1.0 / 60.0),
    ("cm/s", 1e-2),
    ("mm/s", 1e-3),
    ("mm/min", 1e-3 / 60.0),
    ("µm/s", 1e-6),
    ("um/s", 1e-6),
    ("nm/s", 1e-9),
    ("in/s", INCH),
    ("in/min", INCH / 60.0),
];
const RATE: &[(&str, f64)] =
    &[("/s", 1.0), ("1/s", 1.0), ("s^-1", 1.0), ("s⁻¹", 1.0), ("/min", 1.0 / 60.0), ("1/min", 1.0 / 60.0)];
const FORCE_RATE: &[(&str, f64)] = &[
    ("N/s", 1.0),
    ("N/min", 1.0 / 60.0),
    ("kN/s", 1e3),
    ("mN/s", 1e-3),
    ("µN/s", 1e-6),
    ("uN/s", 1e-6),
    ("nN/s", 1e-9),
    ("lbf/s", POUND_FORCE),
];
const COMPLIANCE: &[(&str, f64)] = &[
    ("m/N", 1.0),
    ("mm/N", 1e-3),
    ("µm/N", 1e-6),
    ("um/N", 1e-6),
    ("nm/N", 1e-9),
    ("mm/kN", 1e-6),
    ("µm/kN", 1e-9),
    ("um/kN", 1e-9),
    ("µm/mN", 1e-3),
    ("um/mN", 1e-3),
    ("nm/mN", 1e-6),
    ("nm/nN", 1.0),
    ("nm/pN", 1e3),
    ("in/lbf", INCH / POUND_FORCE),
];
const STIFFNESS: &[(&str, f64)] = &[
    ("N/m", 1.0),
    ("N/mm", 1e3),
    ("mN/m", 1e-3),
    ("µN/m", 1e-6),
    ("uN/m", 1e-6),
    ("nN/nm", 1.0),
    ("pN/nm", 1e-3),
    ("nN/µm", 1e-3),
    ("nN/um", 1e-3),
    ("lbf/in", POUND_FORCE / INCH),
];
const VOLTAGE: &[(&str, f64)] = &[("V", 1.0), ("mV", 1e-3), ("µV", 1e-6), ("uV", 1e-6)];
const MASS: &[(&str, f64)] = &[
    ("kg", 1.0),
    ("g", 1e-3),
    ("mg", 1e-6),
    ("µg", 1e-9),
    ("ug", 1e-9),
    ("lb", POUND),
    ("oz", POUND / 16.0),
];
const ACCELERATION: &[(&str, f64)] = &[
    ("m/s²", 1.0),
    ("m/s^2", 1.0),
    ("m/s2", 1.0),
    ("cm/s²", 1e-2),
    ("cm/s^2", 1e-2),
    ("mm/s²", 1e-3),
    ("mm/s^2", 1e-3),
    ("g", KILOGRAM_FORCE),
];
const TORQUE: &[(&str, f64)] = &[
    ("N m", 1.0),
    ("Nm", 1.0),
    ("N·m", 1.0),
    ("N mm", 1e-3),
    ("Nmm", 1e-3),
    ("N·mm", 1e-3),
    ("mN m", 1e-3),
    ("mNm", 1e-3),
    ("mN·m", 1e-3),
    ("µN m", 1e-6),
    ("µNm", 1e-6),
    ("µN·m", 1e-6),
    ("uN m", 1e-6),
    ("nN m", 1e-9),
    ("nN·m", 1e-9),
];
const SHARE: &[(&str, f64)] = &[("1", 1.0), ("%", 1e-2), ("‰", 1e-3), ("ppm", 1e-6)];
const PER_KELVIN: &[(&str, f64)] = &[("1/K", 1.0), ("/K", 1.0), ("%/K", 1e-2), ("ppm/K", 1e-6)];
const DEGREE: f64 = std::f64::consts::PI / 180.0;
const ANGLE: &[(&str, f64)] = &[("rad", 1.0), ("deg", DEGREE), ("°", DEGREE)];
const PER_PRESSURE: &[(&str, f64)] = &[
    ("1/Pa", 1.0),
    ("/Pa", 1.0),
    ("Pa^-1", 1.0),
    ("Pa⁻¹", 1.0),
    ("1/kPa", 1e-3),
    ("1/MPa", 1e-6),
    ("1/GPa", 1e-9),
];
const FREQUENCY: &[(&str, f64)] = &[("Hz", 1.0), ("kHz", 1e3), ("/s", 1.0), ("1/s", 1.0)];

/// Why a quantity could not be read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum UnitError {
    /// The text does not start with a number.
    #[error("expected a {dimension} such as \"{example}\", found \"{found}\"", dimension = .dimension.name(), example = .dimension.row().1)]
    NotANumber {
        /// What was requested.
        dimension: Dimension,
        /// What stood there.
        found: String,
    },
    /// A number without a unit.
    #[error("expected a unit after the number in \"{found}\" (a {dimension}: {accepted})", dimension = .dimension.name(), accepted = .dimension.accepted())]
    MissingUnit {
        /// What was requested.
        dimension: Dimension,
        /// What stood there.
        found: String,
    },
    /// A unit that this quantity does not take.
    #[error("\"{unit}\" is not a unit of {dimension} (accepted: {accepted})", dimension = .dimension.name(), accepted = .dimension.accepted())]
    UnknownUnit {
        /// What was requested.
        dimension: Dimension,
        /// The unit that stood there.
        unit: String,
    },
    /// The number is NaN or infinite.
    #[error("expected a finite {dimension}, found \"{found}\"", dimension = .dimension.name())]
    NotFinite {
        /// What was requested.
        dimension: Dimension,
        /// What stood there.
        found: String,
    },
}

/// The factor that turns a unit symbol into SI, or `None` if the symbol is not a unit of `dimension`.
///
/// Greek mu (U+03BC) and the micro sign (U+00B5) are one letter here; case matters (`mN` is not `MN`).
#[must_use]
pub fn factor(unit: &str, dimension: Dimension) -> Option<f64> {
    let unit = unit.trim().replace('\u{3bc}', "\u{b5}");
    dimension.units().iter().find(|(symbol, _)| *symbol == unit).map(|(_, factor)| *factor)
}

/// Reads a quantity with its unit and returns it in SI.
///
/// # Errors
/// [`UnitError`] when there is no number, no unit, a unit of another kind, or a value that is not finite.
pub fn parse(text: &str, dimension: Dimension) -> Result<f64, UnitError> {
    let (number, unit) = split_number(text.trim());
    let (unit, found) = (unit.to_owned(), text.to_owned());
    let Ok(value) = number.parse::<f64>() else {
        return Err(UnitError::NotANumber { dimension, found });
    };
    if unit.is_empty() {
        return Err(UnitError::MissingUnit { dimension, found });
    }
    match factor(&unit, dimension).map(|factor| scale(value, factor)) {
        None => Err(UnitError::UnknownUnit { dimension, unit }),
        Some(scaled) if scaled.is_finite() => Ok(scaled),
        Some(_) => Err(UnitError::NotFinite { dimension, found }),
    }
}

/// Multiplies by `factor`, dividing instead where the factor is 1/k for a whole k: 35 mm is then
/// exactly the double 0.035, which 35 × 0.001 is not.
#[must_use]
pub fn scale(value: f64, factor: f64) -> f64 {
    let inverse = (1.0 / factor).round();
    if factor < 1.0 && inverse < 1e15 && 1.0 / inverse == factor {
        value / inverse
    } else {
        value * factor
    }
}

/// Units of a quantity from small to large: symbol, size in SI, and from which size in SI values are read in it.
type Ladder = [(&'static str, f64, f64)];

/// The ladders, by their units in SI and those that reports were laid out in.
const LADDERS: [(&[(&str, f64)], &Ladder); 6] = [
    (
        &[("N", 1.0), ("mN", 1e-3)],
        &[("nN", 1e-9, 0.0), ("µN", 1e-6, 1e-6), ("mN", 1e-3, 1e-3), ("N", 1.0, 0.1), ("kN", 1e3, 1e4)],
    ),
    (
        &[("m", 1.0), ("mm", 1e-3), ("µm", 1e-6)],
        &[("nm", 1e-9, 0.0), ("µm", 1e-6, 1e-6), ("mm", 1e-3, 1e-4), ("m", 1.0, 1.0)],
    ),
    (
        &[("m/s", 1.0), ("mm/s", 1e-3), ("µm/s", 1e-6)],
        &[("nm/s", 1e-9, 0.0), ("µm/s", 1e-6, 1e-6), ("mm/s", 1e-3, 1e-4), ("m/s", 1.0, 1.0)],
    ),
    (
        &[("Pa", 1.0), ("kPa", 1e3)],
        &[("Pa", 1.0, 0.0), ("kPa", 1e3, 1e3), ("MPa", 1e6, 1e6), ("GPa", 1e9, 1e9)],
    ),
    (
        &[("s", 1.0)],
        &[
            ("µs", 1e-6, 0.0),
            ("ms", 1e-3, 1e-3),
            ("s", 1.0, 0.1),
            ("min", 60.0, 600.0),
            ("h", 3600.0, 36_000.0),
            ("d", 86_400.0, 864_000.0),
        ],
    ),
    (
        &[("J", 1.0), ("mJ", 1e-3)],
        &[("nJ", 1e-9, 0.0), ("µJ", 1e-6, 1e-6), ("mJ", 1e-3, 1e-3), ("J", 1.0, 0.1), ("kJ", 1e3, 1e4)],
    ),
];

/// The unit in which people read values of `unit` up to this size, and the factor to it: nN to kN, nm to m, Pa to GPa, µs to days.
/// Any other unit stays.
///
/// ```
/// use palpate::units::suited;
/// assert_eq!(suited("N", 4e-9), ("nN", 1e9));
/// assert_eq!(suited("m", 0.015), ("mm", 1e3));
/// assert_eq!(suited("s", 1800.0), ("min", 1.0 / 60.0));
/// assert_eq!(suited("1/s", 1e9), ("1/s", 1.0));
/// ```
#[must_use]
pub fn suited(unit: &str, largest: f64) -> (&str, f64) {
    let known = |(units, ladder): &(&[(&str, f64)], &'static Ladder)| {
        let (_, size) = units.iter().find(|(symbol, _)| *symbol == unit)?;
        Some((*size, *ladder))
    };
    let Some((own, ladder)) = LADDERS.iter().find_map(known) else {
        return (unit, 1.0);
    };
    let si = largest.abs() * own * (1.0 + 1e-9);
    let found = ladder.iter().rev().find(|(.., from)| si >= *from && si > 0.0 && si.is_finite());
    let Some((symbol, size, _)) = found else {
        return (unit, 1.0);
    };
    // 1e3 and not 1/0.001 = 1000.0000000000001 where that would be no whole number.
    let factor = own / size;
    (symbol, if factor > 1.0 { factor.round() } else { factor })
}

/// The name of a parameter without the unit that it ends in: `rate_coefficient` of `rate_coefficient_per_s`.
///
/// ```
/// use palpate::units::without_unit;
/// assert_eq!(["time_constant_1_s", "modulus_pa", "exponent"].map(without_unit), ["time_constant_1", "modulus", "exponent"]);
/// ```
#[must_use]
pub fn without_unit(name: &str) -> &str {
    ["_per_s", "_pa", "_n", "_m", "_s"]
        .into_iter()
        .find_map(|unit| name.strip_suffix(unit))
        .unwrap_or(name)
}

/// A value of this unit in words, in the unit that suits its size: `284 mN`.
///
/// ```
/// use palpate::units::quantity;
/// assert_eq!(quantity(0.0284, "N", 3), "28.4 mN");
/// assert_eq!(quantity(0.0, "N", 3), "0 N");
/// ```
#[cfg(feature = "std")]
#[must_use]
pub fn quantity(value: f64, unit: &str, digits: usize) -> String {
    let (symbol, factor) = suited(unit, value);
    format!("{} {symbol}", crate::number::significant(value * factor, digits)).trim_end().to_owned()
}

/// Splits `"2e4 /s"` into the longest leading text that reads as a number and the rest.
#[must_use]
pub fn split_number(text: &str) -> (&str, &str) {
    let mut end = 0;
    for (index, character) in text.char_indices() {
        let next = index + character.len_utf8();
        if text[..next].parse::<f64>().is_ok() {
            end = next;
        } else if !(character.is_ascii_digit() || matches!(character, '.' | '+' | '-' | 'e' | 'E')) {
            break;
        }
    }
    (&text[..end], text[end..].trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_as_people_write_them() {
        for (text, dimension, si) in [
            ("35 mm", Dimension::Length, 0.035),
            ("4.375mm", Dimension::Length, 0.004_375),
            ("28 kPa", Dimension::Pressure, 28e3),
            ("2e4 /s", Dimension::Rate, 2e4),
            ("2E+4 s^-1", Dimension::Rate, 2e4),
            ("10 s", Dimension::Time, 10.0),
            ("3 \u{3bc}m", Dimension::Length, 3e-6),
            ("-1.5 N", Dimension::Force, -1.5),
            ("1 lbf", Dimension::Force, 4.448_221_615_260_5),
            ("100 Hz", Dimension::Frequency, 100.0),
            ("1 gf", Dimension::Force, 9.806_65e-3),
            ("1 kgf", Dimension::Force, 9.806_65),
            ("1 in", Dimension::Length, 0.0254),
            ("0.5 um/N", Dimension::Compliance, 0.5e-6),
            ("20 nm/nN", Dimension::Compliance, 20.0),
            ("3 mV", Dimension::Voltage, 3e-3),
            ("0.15kg", Dimension::Mass, 0.15),
            ("150 g", Dimension::Mass, 0.15),
            ("0.5 g", Dimension::Acceleration, 4.903_325),
            ("5 N mm", Dimension::Torque, 5e-3),
        ] {
            assert_eq!(parse(text, dimension), Ok(si), "{text}");
        }
        for (text, dimension, si) in [
            ("1 psi", Dimension::Pressure, 6_894.757_293_168_361),
            ("1 ksi", Dimension::Pressure, 6_894_757.293_168_361),
            ("10 mil", Dimension::Length, 2.54e-4),
            ("2 ft", Dimension::Length, 0.609_6),
            ("1 in²", Dimension::Area, 6.451_6e-4),
            ("1 kip", Dimension::Force, 4_448.221_615_260_5),
            ("1 tf", Dimension::Force, 9_806.65),
            ("1 lbf/in", Dimension::Stiffness, 175.126_835_246_476),
        ] {
            assert!(parse(text, dimension).is_ok_and(|found| (found / si - 1.0).abs() < 1e-14), "{text}");
        }
    }

    #[test]
    fn wrong_quantities_say_what_is_accepted() {
        let missing = parse("35", Dimension::Length).unwrap_err().to_string();
        assert!(missing.contains("m, cm, mm"), "{missing}");
        let unknown = parse("35 furlong", Dimension::Length).unwrap_err().to_string();
        assert!(unknown.contains("furlong") && unknown.contains("mm"), "{unknown}");
        assert!(parse("wide", Dimension::Length).is_err());
        assert!(parse("", Dimension::Length).is_err());
        assert!(parse("inf m", Dimension::Length).is_err());
        assert!(parse("nan m", Dimension::Length).is_err());
        assert!(parse("28 mm", Dimension::Pressure).is_err());
    }
}
