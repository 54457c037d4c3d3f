//! A protocol: a body, its law, and the motion of the jaw, for a simulation.

use std::path::Path;

use palpate::{
    contact::{Layers, Specimen},
    latency::LatencyLaw,
    simulate::{self, ContactModel, Motion, ProtocolStep, Sampling},
    units::Dimension,
};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    contact::{self, SidesName},
    error::DescriptionError,
    quantity::QuantityText,
    source::{self, Source},
    specimen::{self, SpecimenTable},
};

/// Layers where nothing is said, as in the paper.
const USUAL_LAYERS: f64 = 8.0;
/// Samples per second where nothing is said.
const USUAL_SAMPLE_RATE: f64 = 100.0;

/// A checked protocol, everything in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Protocol {
    /// Title, if it has one.
    pub title: Option<String>,
    /// The motion of the jaw.
    pub motion: Motion,
    /// The body and its contact.
    pub model: ContactModel,
    /// When to report.
    pub sampling: Sampling,
    /// The steps that the motion is made of.
    pub steps: Vec<ProtocolStep>,
}

/// A squeeze-and-hold protocol: the body, its law, and the steps of the jaw. Quantities are texts with a unit.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "palpate protocol", rename = "Protocol")]
pub(super) struct ProtocolTables {
    /// A title for figures and reports.
    title: Option<String>,
    specimen: SpecimenTable,
    law: LawTable,
    #[serde(default)]
    contact: ContactTable,
    /// Steps of the jaw in order, starting at first touch at time 0.
    #[schemars(extend("minItems" = 1))]
    step: Vec<StepTable>,
    #[serde(default)]
    output: OutputTable,
}

/// The law that strain follows.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Law")]
struct LawTable {
    #[expect(dead_code, reason = "there is one law, and the table names it")]
    name: LawName,
    /// Exponent n, any number above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    exponent: f64,
    /// Rate coefficient v, such as "2e4 /s".
    rate_coefficient: QuantityText,
}

#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum LawName {
    /// The nonlinear latency law: strain rate = −v · sign(excess strain) · |excess strain|ⁿ.
    Latency,
}

/// How the jaw meets the body.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Contact", extend("not" = { "required": ["layers", "layer_thickness"] }))]
struct ContactTable {
    /// Number of layers, any number of 1 or more; 8 unless layer_thickness is given.
    #[schemars(extend("minimum" = 1))]
    layers: Option<f64>,
    /// Thickness of one layer, instead of their number.
    layer_thickness: Option<QuantityText>,
    /// Two sides for a ball, one side for other shapes, unless said otherwise.
    squeezed_from: Option<SidesName>,
    /// true (the default): the jaw can only push and leaves the body when the force reaches zero.
    /// false: body and jaw are bonded, and the force may become tension.
    separation: Option<bool>,
}

/// Go to a displacement at constant speed, then stay.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Step")]
struct StepTable {
    /// Travel of the jaw since first touch at the end of the ramp; loading is positive.
    to: QuantityText,
    /// Speed of the jaw in the ramp, always above 0.
    rate: QuantityText,
    /// Time at the new displacement; none if left out.
    hold: Option<QuantityText>,
}

/// When to report: at a rate, or at times.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Output", extend("not" = { "required": ["sample_rate", "times"] }))]
struct OutputTable {
    /// Samples per second; "100 Hz" unless times are given. Every kink of the motion is reported as well.
    sample_rate: Option<QuantityText>,
    /// These times and no others, rising, inside the motion.
    #[schemars(extend("minItems" = 1))]
    times: Option<Vec<QuantityText>>,
}

/// Reads and checks the protocol in the file at `path`.
///
/// # Errors
/// [`DescriptionError`] where the file cannot be read, is no TOML, or holds a key or value that makes no
/// protocol; it names the key.
pub fn read_protocol(path: &Path) -> Result<Protocol, DescriptionError> {
    parse_protocol(&source::read(path)?, path)
}

/// Checks a protocol that was read already; `path` is used in messages alone.
///
/// ```
/// use std::path::Path;
/// use palpate_files::description::parse_protocol;
/// let text = r#"
///     specimen = { shape = "ball", radius = "35 mm", modulus = "28 kPa" }
///     law = { name = "latency", exponent = 5, rate_coefficient = "2e4 /s" }
///     step = [{ to = "5 mm", rate = "500 mm/min", hold = "10 s" }]
/// "#;
/// let protocol = parse_protocol(text, Path::new("squeeze.toml"))?;
/// assert_eq!(protocol.motion.displacement_at(5.0), 0.005);
///
/// let without_unit = text.replace("35 mm", "35");
/// let error = parse_protocol(&without_unit, Path::new("squeeze.toml")).unwrap_err();
/// assert_eq!(error.key(), Some("specimen.radius"));
/// # Ok::<(), palpate_files::description::DescriptionError>(())
/// ```
///
/// # Errors
/// As for [`read_protocol`], less those of the file.
pub fn parse_protocol(text: &str, path: &Path) -> Result<Protocol, DescriptionError> {
    let source = Source { path, text };
    let tables: ProtocolTables = source.tables()?;
    let model = model(&source, &tables)?;
    let steps = steps(&source, &tables.step, &model)?;
    let motion = simulate::protocol(&steps).map_err(|error| {
        let found = error.to_string();
        source.value("step", "steps that make a motion", &found)
    })?;
    let sampling = sampling(&source, &tables.output, &motion)?;
    Ok(Protocol {
        title: tables.title,
        motion,
        model,
        sampling,
        steps,
    })
}

fn model(source: &Source<'_>, tables: &ProtocolTables) -> Result<ContactModel, DescriptionError> {
    let shape = tables.specimen.known_shape(source)?;
    let modulus = tables
        .specimen
        .modulus(source)?
        .ok_or_else(|| source.missing("specimen.modulus", "Young's modulus, such as \"28 kPa\""))?;
    let sides = tables.contact.squeezed_from.map(Into::into);
    let sides = sides.unwrap_or_else(|| specimen::usual_sides(&shape));
    let refused = |key: &str, error: &dyn std::error::Error| source.value(key, "a body", error);
    let specimen = Specimen::new(shape, modulus, sides).map_err(|error| refused("specimen", &error))?;
    let exponent = source.number("law.exponent", tables.law.exponent, "a number above 0", |exponent| exponent > 0.0)?;
    let key = "law.rate_coefficient";
    let rate = source.positive(key, &tables.law.rate_coefficient, Dimension::Rate)?;
    let law = LatencyLaw::new(exponent, rate).map_err(|error| refused("law", &error))?;
    let contact = &tables.contact;
    let thickness = contact.layer_thickness.as_ref();
    let choice = contact::layers(source, contact.layers, thickness, specimen.depth())?;
    let layers = match choice {
        Some(choice) => choice.layers(specimen.depth()).ok(),
        None => Layers::new(USUAL_LAYERS).ok(),
    };
    Ok(ContactModel {
        specimen,
        law,
        layers: layers.ok_or_else(|| source.missing("contact.layers", "a number of 1 or more"))?,
        separation: contact::separation(contact.separation.unwrap_or(true)),
    })
}

fn steps(
    source: &Source<'_>,
    tables: &[StepTable],
    model: &ContactModel,
) -> Result<Vec<ProtocolStep>, DescriptionError> {
    if tables.is_empty() {
        return Err(source.missing("step", "one or more [[step]] tables with to and rate"));
    }
    let mut at = 0.0;
    let mut steps = Vec::with_capacity(tables.len());
    for (index, table) in tables.iter().enumerate() {
        let key = |name: &str| format!("step[{}].{name}", index + 1);
        let to = source.si(&key("to"), &table.to, Dimension::Length)?;
        check_displacement(source, &key("to"), &table.to, to, model)?;
        let rate = source.positive(&key("rate"), &table.rate, Dimension::Speed)?;
        let hold = match &table.hold {
            None => 0.0,
            Some(written) => {
                let hold = source.si(&key("hold"), written, Dimension::Time)?;
                if hold < 0.0 {
                    return Err(source.value(key("hold"), "a time of 0 s or more", written));
                }
                hold
            }
        };
        if to == at && hold == 0.0 {
            let expected = "another displacement than before, or a hold";
            return Err(source.value(key("to"), expected, &table.to));
        }
        at = to;
        steps.push(ProtocolStep { to, rate, hold });
    }
    Ok(steps)
}

/// The body must be able to take the displacement.
fn check_displacement(
    source: &Source<'_>,
    key: &str,
    written: &QuantityText,
    to: f64,
    model: &ContactModel,
) -> Result<(), DescriptionError> {
    let specimen = &model.specimen;
    let bonded = model.separation == simulate::Separation::Bonded;
    let contact_displacement = specimen.contact_displacement(to);
    if specimen.check_contact_displacement(contact_displacement, bonded).is_ok() {
        return Ok(());
    }
    let most = specimen.depth() / specimen.contact_displacement(1.0) * 1e3;
    let expected = if to < 0.0 {
        "a displacement of 0 mm or more for a bonded ball".to_owned()
    } else {
        format!("a displacement below {most} mm, where nothing of the body would be left")
    };
    Err(source.value(key, expected, written))
}

fn sampling(source: &Source<'_>, output: &OutputTable, motion: &Motion) -> Result<Sampling, DescriptionError> {
    match (&output.sample_rate, &output.times) {
        (Some(_), Some(_)) => Err(source.both("output.sample_rate", "output.times")),
        (None, None) => Ok(Sampling::Rate(USUAL_SAMPLE_RATE)),
        (Some(rate), None) => {
            let rate = source.positive("output.sample_rate", rate, Dimension::Frequency)?;
            Ok(Sampling::Rate(rate))
        }
        (None, Some(written)) => Ok(Sampling::Times(times(source, written, motion)?)),
    }
}

fn times(source: &Source<'_>, written: &[QuantityText], motion: &Motion) -> Result<Vec<f64>, DescriptionError> {
    if written.is_empty() {
        return Err(source.value("output.times", "one time or more", "an empty list"));
    }
    let mut times: Vec<f64> = Vec::with_capacity(written.len());
    for (index, written) in written.iter().enumerate() {
        let key = format!("output.times[{}]", index + 1);
        let mut time = source.si(&key, written, Dimension::Time)?;
        // The end of a motion is a sum of quotients: "66 s" must hit one of 65.999999999999986 s.
        if (time - motion.end()).abs() <= 1e-9 * motion.end() {
            time = motion.end();
        }
        if !(motion.start()..=motion.end()).contains(&time) {
            let expected = format!("a time from 0 s to {} s, the end of the motion", motion.end());
            return Err(source.value(key, expected, written));
        }
        if times.last().is_some_and(|before| time < *before) {
            return Err(source.value(key, "a time after the one before it", written));
        }
        times.push(time);
    }
    Ok(times)
}
