//! A protocol: a body, its law, and the motion of the jaw, for a simulation.

use std::path::Path;

use palpate::{
    simulate::{Contact, Drive, Motion, ProgramStep, Sampling, step_ends},
    units::Dimension,
};

use super::{
    named_body::{names_material, protocol_tables, tables_with},
    steps::{Steps, steps},
    tables::{OutputTable, ProtocolTables},
};
use crate::description::{
    body::model::model,
    material::MaterialFile,
    text::{
        error::DescriptionError,
        kind::DescriptionKind,
        quantity::QuantityText,
        source::{self, Source},
    },
};

/// Samples per second where nothing is stated.
const USUAL_SAMPLE_RATE: f64 = 100.0;

/// A checked protocol, everything in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Protocol {
    /// Title, if it has one.
    pub title: Option<String>,
    /// What the jaw does, step by step; holds are steps of their own.
    pub steps: Vec<ProgramStep>,
    /// Number of the `[[step]]` table, from 1, that each of `steps` was written in.
    pub written: Vec<usize>,
    /// The motion of the jaw, if all steps prescribe displacements.
    pub motion: Option<Motion>,
    /// The body and its contact.
    pub contact: Contact,
    /// Output times.
    pub sampling: Sampling,
    /// Whether the file has a table `[sweep]`, which a single simulation ignores.
    pub has_sweep: bool,
}

impl Protocol {
    /// What drives the contact: the motion if there is one, else the steps.
    #[must_use]
    pub fn drive(&self) -> Drive<'_> {
        self.motion.as_ref().map_or(Drive::Program(&self.steps), Drive::Motion)
    }
}

/// The longest protocol that is read, in bytes: a million steps of one line for each number.
const LONGEST: u64 = 64 << 20;

/// The text of a protocol or a sweep, or of standard input where `path` is `-`; of at most 64 MiB.
///
/// # Errors
/// [`DescriptionError`] where it cannot be read, is longer, or is not text in UTF-8.
pub fn read_protocol_text(path: &Path) -> Result<String, DescriptionError> {
    source::read(path, LONGEST)
}

/// Reads and checks the protocol in the file at `path`, of at most 64 MiB: more than a million steps, which take some 2 GiB of memory.
///
/// # Errors
/// [`DescriptionError`] where the file cannot be read, is no TOML, or holds a key or value that makes no
/// protocol; it names the key.
pub fn read_protocol(path: &Path) -> Result<Protocol, DescriptionError> {
    parse_protocol(&read_protocol_text(path)?, path)
}

/// Reads the protocol in the file at `path` for a calibrated body: the body of the protocol is ignored.
///
/// # Errors
/// As for [`read_protocol`].
pub fn read_protocol_of(path: &Path, material: &MaterialFile) -> Result<Protocol, DescriptionError> {
    parse_protocol_of(&read_protocol_text(path)?, path, material)
}

/// As [`read_protocol_of`], of a text that was read already; `path` is used in messages alone.
///
/// # Errors
/// As for [`parse_protocol`].
pub fn parse_protocol_of(text: &str, path: &Path, material: &MaterialFile) -> Result<Protocol, DescriptionError> {
    let source = Source { path, text };
    source.refuse(&[DescriptionKind::Test, DescriptionKind::Material], DescriptionKind::Protocol)?;
    check(&source, &tables_with(&source, &material.to_toml())?)
}

/// Reads title, body, law and contact of the protocol in the file at `path`, whatever its steps: for a contact that a record drives.
///
/// # Errors
/// As for [`read_protocol`], less those of steps and output.
pub fn read_scene(path: &Path) -> Result<(Option<String>, Contact), DescriptionError> {
    parse_scene(&read_protocol_text(path)?, path)
}

/// As [`read_scene`], of a text that was read already; `path` is used in messages alone.
///
/// # Errors
/// As for [`parse_protocol`], less those of steps and output.
pub fn parse_scene(text: &str, path: &Path) -> Result<(Option<String>, Contact), DescriptionError> {
    let source = Source { path, text };
    let tables: ProtocolTables = protocol_tables(&source)?;
    let model = model(&source, &tables.specimen, &tables.law, &tables.contact)?;
    Ok((tables.title, model))
}

/// The name of the law in a text that [`parse_scene`] reads, `None` where it names none itself.
#[must_use]
pub fn law_named(text: &str) -> Option<String> {
    let tables: toml::Table = text.parse().ok()?;
    tables.get("law")?.get("name")?.as_str().map(str::to_owned)
}

/// The text of a protocol with the body of the material file that it names, if any: a self-contained protocol.
///
/// # Errors
/// As for [`read_material`](crate::description::read_material), and where the text is no TOML.
pub fn self_contained(text: &str, path: &Path) -> Result<String, DescriptionError> {
    let source = Source { path, text };
    // A key can only be spelled otherwise by escapes.
    if !text.contains("material") && !text.contains('\\') || !names_material(&source.root()?) {
        return Ok(text.to_owned());
    }
    let tables: toml::Table = protocol_tables(&source)?;
    Ok(tables.to_string())
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
/// assert_eq!(protocol.motion.unwrap().displacement_at(5.0), 0.005);
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
    source.refuse(&[DescriptionKind::Material], DescriptionKind::Protocol)?;
    check(&source, &protocol_tables(&source)?)
}

/// Checks the tables of a protocol, all that is wrong with which is stated of places in `source`.
pub(crate) fn check(source: &Source<'_>, tables: &ProtocolTables) -> Result<Protocol, DescriptionError> {
    let contact = model(source, &tables.specimen, &tables.law, &tables.contact)?;
    let Steps {
        program,
        motion,
        tables: written,
    } = steps(source, &tables.step, &contact)?;
    let end = match &motion {
        Some(motion) => motion.end(),
        None => {
            let ends = step_ends(&program, &contact).map_err(|error| {
                let found = error.in_step(|number| written[number - 1]);
                source.value("step", "valid steps of a simulation", &found)
            })?;
            ends.last().map_or(0.0, |end| end.time)
        }
    };
    let sampling = sampling(source, &tables.output, end)?;
    Ok(Protocol {
        title: tables.title.clone(),
        steps: program,
        written,
        motion,
        contact,
        sampling,
        has_sweep: tables.sweep.is_some(),
    })
}

fn sampling(source: &Source<'_>, output: &OutputTable, end: f64) -> Result<Sampling, DescriptionError> {
    match (&output.sample_rate, &output.times) {
        (Some(_), Some(_)) => Err(source.both("output.sample_rate", "output.times")),
        (None, None) => Ok(Sampling::Rate(USUAL_SAMPLE_RATE)),
        (Some(rate), None) => source.positive("output.sample_rate", rate, Dimension::Frequency).map(Sampling::Rate),
        (None, Some(written)) => times(source, written, end).map(Sampling::Times),
    }
}

fn times(source: &Source<'_>, written: &[QuantityText], end: f64) -> Result<Vec<f64>, DescriptionError> {
    if written.is_empty() {
        return Err(source.value("output.times", "one time or more", "an empty list"));
    }
    let mut times: Vec<f64> = Vec::with_capacity(written.len());
    for (index, written) in written.iter().enumerate() {
        let key = format!("output.times[{}]", index + 1);
        let mut time = source.si(&key, written, Dimension::Time)?;
        // The end of a motion is a sum of quotients: "66 s" must hit one of 65.999999999999986 s.
        if (time - end).abs() <= 1e-9 * end {
            time = end;
        }
        if !(0.0..=end).contains(&time) {
            let expected = format!("a time from 0 s to {end} s, the end of the motion");
            return Err(source.value(key, expected, written));
        }
        if times.last().is_some_and(|before| time < *before) {
            return Err(source.value(key, "a time after the one before it", written));
        }
        times.push(time);
    }
    Ok(times)
}
