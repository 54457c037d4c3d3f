//! A protocol: a body, its law, and the motion of the jaw, for a simulation.

use std::path::Path;

use palpate::{
    contact::{Layers, RateDependence, SpecimenError},
    simulate::{
        self, Contact, ContactModel, Drive, LinearContact, Motion, ProgramStep, ProtocolStep, Sampling, VaryingContact,
        step_ends,
    },
    units::Dimension,
};
use schemars::JsonSchema;
use serde::{Deserialize, de::IgnoredAny};

use super::{
    contact::{self, SidesName},
    error::DescriptionError,
    law::{Law, LawTable, Model},
    material::{MaterialFile, protocol_tables, tables_with},
    quantity::QuantityText,
    source::{self, Source},
    specimen::SpecimenTable,
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
    /// What the jaw does, step by step; holds are steps of their own.
    pub steps: Vec<ProgramStep>,
    /// Number of the `[[step]]` table, from 1, that each of `steps` was written in.
    pub written: Vec<usize>,
    /// The motion of the jaw, if displacements alone are asked for.
    pub motion: Option<Motion>,
    /// The body and its contact.
    pub model: Model,
    /// When to report.
    pub sampling: Sampling,
    /// Whether the file has a table `[sweep]`, which a single simulation leaves aside.
    pub has_sweep: bool,
}

impl Protocol {
    /// The body, as simulations take it.
    #[must_use]
    pub fn contact(&self) -> Contact<'_> {
        self.model.contact()
    }

    /// What drives the contact: the motion if there is one, else the steps.
    #[must_use]
    pub fn drive(&self) -> Drive<'_> {
        self.motion.as_ref().map_or(Drive::Program(&self.steps), Drive::Motion)
    }
}

/// A squeeze-and-hold protocol: the body, its law, and the steps of the jaw. Quantities are texts with a unit.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "palpate protocol", rename = "Protocol", extend("required" = [], "anyOf" = [
    { "required": ["specimen", "law"] },
    { "required": ["material"] }
]))]
pub(super) struct ProtocolTables {
    /// A title for figures and reports.
    title: Option<String>,
    pub(super) specimen: SpecimenTable,
    pub(super) law: LawTable,
    #[serde(default)]
    pub(super) contact: ContactTable,
    /// Steps of the jaw in order, starting at first touch at time 0; none where a record drives the contact.
    #[serde(default)]
    pub(super) step: Vec<StepTable>,
    #[serde(default)]
    pub(super) output: OutputTable,
    /// Numbers to replace by many, for `palpate sweep`; left aside otherwise.
    #[serde(default)]
    #[schemars(with = "Option<super::sweep::SweepSchema>")]
    sweep: Option<IgnoredAny>,
    /// Path of a material file, from this file on, in place of specimen, law and contact.
    #[serde(default, rename = "material")]
    #[schemars(with = "Option<String>")]
    _material: Option<IgnoredAny>,
    /// Of a material file, whose body is taken as any other.
    #[serde(default, rename = "calibration")]
    #[schemars(skip)]
    _calibration: Option<IgnoredAny>,
}

/// How the jaw meets the body.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Contact", extend("not" = { "required": ["layers", "layer_thickness"] }))]
pub(super) struct ContactTable {
    /// Number of layers, any number of 1 or more; 8 unless layer_thickness is given.
    #[schemars(extend("minimum" = 1))]
    pub(super) layers: Option<f64>,
    /// Thickness of one layer, instead of their number.
    pub(super) layer_thickness: Option<QuantityText>,
    /// Two sides for a ball, one side for other shapes, unless said otherwise.
    squeezed_from: Option<SidesName>,
    /// true (the default): the jaw can only push and leaves the body when the force reaches zero.
    /// false: body and jaw are bonded, and the force may become tension.
    separation: Option<bool>,
}

/// Go to a displacement or to a force, then stay there or keep the force; either part may be left out.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Step", extend("not" = { "anyOf": [
    { "required": ["to", "to_force"] },
    { "required": ["rate", "force_rate"] },
    { "required": ["hold", "hold_force"] }
] }))]
pub(super) struct StepTable {
    /// Travel of the jaw since first touch at the end of the ramp; loading is positive. Needs rate.
    pub(super) to: Option<QuantityText>,
    /// Force to go to, by moving the jaw at rate until it is met or by raising the force at force_rate.
    pub(super) to_force: Option<QuantityText>,
    /// Speed of the jaw in the ramp, always above 0.
    pub(super) rate: Option<QuantityText>,
    /// Rate at which the force goes to to_force, always above 0.
    pub(super) force_rate: Option<QuantityText>,
    /// Time for which the jaw then stays where it is; none if left out.
    pub(super) hold: Option<QuantityText>,
    /// Time for which the force is then kept as it is.
    pub(super) hold_force: Option<QuantityText>,
}

/// When to report: at a rate, or at times.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Output", extend("not" = { "required": ["sample_rate", "times"] }))]
pub(super) struct OutputTable {
    /// Samples per second; "100 Hz" unless times are given. Every kink of the motion is reported as well.
    pub(super) sample_rate: Option<QuantityText>,
    /// These times and no others, rising, inside the motion.
    #[schemars(extend("minItems" = 1))]
    pub(super) times: Option<Vec<QuantityText>>,
}

/// The longest protocol that is read, in bytes: a million steps of one line for each number.
const LONGEST: u64 = 64 << 20;

/// Reads and checks the protocol in the file at `path`, of at most 64 MiB: more than a million steps, which take some 2 GiB of memory.
///
/// # Errors
/// [`DescriptionError`] where the file cannot be read, is no TOML, or holds a key or value that makes no
/// protocol; it names the key.
pub fn read_protocol(path: &Path) -> Result<Protocol, DescriptionError> {
    parse_protocol(&source::read(path, LONGEST)?, path)
}

/// Reads the protocol in the file at `path` for a calibrated body: whatever the protocol says of a body is left aside.
///
/// # Errors
/// As for [`read_protocol`].
pub fn read_protocol_of(path: &Path, material: &MaterialFile) -> Result<Protocol, DescriptionError> {
    parse_protocol_of(&source::read(path, LONGEST)?, path, material)
}

/// As [`read_protocol_of`], of a text that was read already; `path` is used in messages alone.
///
/// # Errors
/// As for [`parse_protocol`].
pub fn parse_protocol_of(text: &str, path: &Path, material: &MaterialFile) -> Result<Protocol, DescriptionError> {
    let source = Source { path, text };
    check(&source, &tables_with(&source, &material.to_toml())?)
}

/// Reads title, body, law and contact of the protocol in the file at `path`, whatever its steps: for a contact that a record drives.
///
/// # Errors
/// As for [`read_protocol`], less those of steps and output.
pub fn read_scene(path: &Path) -> Result<(Option<String>, Model), DescriptionError> {
    parse_scene(&source::read(path, LONGEST)?, path)
}

/// As [`read_scene`], of a text that was read already; `path` is used in messages alone.
///
/// # Errors
/// As for [`parse_protocol`], less those of steps and output.
pub fn parse_scene(text: &str, path: &Path) -> Result<(Option<String>, Model), DescriptionError> {
    let source = Source { path, text };
    let tables: ProtocolTables = protocol_tables(&source)?;
    let model = model(&source, &tables.specimen, &tables.law, &tables.contact)?;
    Ok((tables.title, model))
}

/// The text of a protocol with the body of the material file that it names, if it does: what says all by itself wherever it is read.
///
/// # Errors
/// As for [`read_material`](super::read_material), and where the text is no TOML.
pub fn self_contained(text: &str, path: &Path) -> Result<String, DescriptionError> {
    let tables: toml::Table = protocol_tables(&Source { path, text })?;
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
    check(&source, &protocol_tables(&source)?)
}

/// Checks the tables of a protocol, all that is wrong with which is said of places in `source`.
pub(super) fn check(source: &Source<'_>, tables: &ProtocolTables) -> Result<Protocol, DescriptionError> {
    let model = model(source, &tables.specimen, &tables.law, &tables.contact)?;
    checked_steps(source, tables, model)
}

/// A protocol with this body and the steps of the tables.
fn checked_steps(source: &Source<'_>, tables: &ProtocolTables, model: Model) -> Result<Protocol, DescriptionError> {
    let Steps {
        program,
        motion,
        tables: written,
    } = steps(source, &tables.step, &model)?;
    let refused = |found: String| source.value("step", "steps that can be simulated", &found);
    let end = match &motion {
        Some(motion) => motion.end(),
        None => {
            let ends = step_ends(&program, model.contact())
                .map_err(|error| refused(error.in_step(|number| written[number - 1]).to_string()))?;
            ends.last().map_or(0.0, |end| end.time)
        }
    };
    let sampling = sampling(source, &tables.output, end)?;
    Ok(Protocol {
        title: tables.title.clone(),
        steps: program,
        written,
        motion,
        model,
        sampling,
        has_sweep: tables.sweep.is_some(),
    })
}

/// The body of these tables.
pub(super) fn model(
    source: &Source<'_>,
    specimen: &SpecimenTable,
    law: &LawTable,
    contact: &ContactTable,
) -> Result<Model, DescriptionError> {
    let specimen = specimen.body(source, contact.squeezed_from.map(Into::into))?;
    let separation = contact::separation(contact.separation.unwrap_or(true));
    match law.law(source)? {
        Law::Latency(law, rate) => {
            let model = ContactModel {
                layers: layers(source, contact, specimen.depth())?,
                specimen,
                law,
                separation,
            };
            Ok(match rate {
                RateDependence::Constant => Model::Latency(model),
                rate => Model::Varying(VaryingContact { model, rate }),
            })
        }
        Law::Linear(law, memory) => {
            let given = [("layers", contact.layers.is_some()), ("layer_thickness", contact.layer_thickness.is_some())];
            if let Some((name, _)) = given.iter().find(|(_, given)| *given) {
                let reason = "with a linear law, whose overshoot is a number of its own";
                return Err(source.unused(&format!("contact.{name}"), reason, &format!("remove {name}")));
            }
            Ok(Model::Linear(LinearContact {
                specimen,
                law,
                memory,
                separation,
            }))
        }
    }
}

fn layers(source: &Source<'_>, contact: &ContactTable, depth: f64) -> Result<Layers, DescriptionError> {
    let choice = contact::layers(source, contact.layers, contact.layer_thickness.as_ref(), depth)?;
    let layers = match choice {
        Some(choice) => choice.layers(depth).ok(),
        None => Layers::new(USUAL_LAYERS).ok(),
    };
    layers.ok_or_else(|| source.missing("contact.layers", "a number of 1 or more"))
}

/// Steps one by one, and as a motion if they are one.
struct Steps {
    program: Vec<ProgramStep>,
    motion: Option<Motion>,
    /// Number of the table, from 1, that each step of the program was written in.
    tables: Vec<usize>,
}

fn steps(source: &Source<'_>, tables: &[StepTable], model: &Model) -> Result<Steps, DescriptionError> {
    if tables.is_empty() {
        return Err(source.missing("step", "one or more [[step]] tables with to and rate"));
    }
    let (mut program, mut moves, mut written) = (Vec::new(), Vec::new(), Vec::new());
    let mut at = Some(0.0);
    for (index, table) in tables.iter().enumerate() {
        let key = |name: &str| format!("step[{}].{name}", index + 1);
        let ramp = ramp(source, &key, table, model)?;
        let hold = hold(source, &key, table)?;
        if ramp.is_none() && hold.is_none() {
            return Err(source.missing(format!("step[{}]", index + 1), "to or to_force, or a hold"));
        }
        if let (Some(ProgramStep::Move { to, .. }), None) = (ramp, hold)
            && at == Some(to)
            && let Some(written) = &table.to
        {
            return Err(source.value(key("to"), "another displacement than before, or a hold", written));
        }
        let to = match ramp {
            Some(ProgramStep::Move { to, .. }) => Some(to),
            None => at,
            Some(_) => None,
        };
        match (ramp, hold, to) {
            (Some(ProgramStep::Move { rate, .. }), None | Some(ProgramStep::HoldPosition { .. }), Some(to)) => {
                let hold = if let Some(ProgramStep::HoldPosition { duration }) = hold { duration } else { 0.0 };
                moves.push(ProtocolStep { to, rate, hold });
            }
            (None, Some(ProgramStep::HoldPosition { duration }), Some(to)) => {
                let rate = 1.0;
                moves.push(ProtocolStep {
                    to,
                    rate,
                    hold: duration,
                });
            }
            _ => {}
        }
        // Where the jaw stands after force control only the simulation knows.
        at = if matches!(hold, Some(ProgramStep::HoldForce { .. })) { None } else { to };
        program.extend(ramp.into_iter().chain(hold));
        written.resize(program.len(), index + 1);
    }
    let in_displacement =
        |step: &ProgramStep| matches!(step, ProgramStep::Move { .. } | ProgramStep::HoldPosition { .. });
    let motion = if program.iter().all(in_displacement) {
        let motion = simulate::protocol(&moves).map_err(|error| {
            let found = error.to_string();
            source.value("step", "steps that make a motion", &found)
        })?;
        Some(motion)
    } else {
        None
    };
    Ok(Steps {
        program,
        motion,
        tables: written,
    })
}

/// The first part of a step, if it has one.
fn ramp(
    source: &Source<'_>,
    key: &impl Fn(&str) -> String,
    table: &StepTable,
    model: &Model,
) -> Result<Option<ProgramStep>, DescriptionError> {
    let both = |a: &str, b: &str| source.both(&key(a), &key(b));
    match (&table.to, &table.to_force, &table.rate, &table.force_rate) {
        (Some(_), Some(_), ..) => Err(both("to", "to_force")),
        (_, _, Some(_), Some(_)) => Err(both("rate", "force_rate")),
        (Some(to), None, Some(rate), None) => {
            let written = to;
            let to = source.si(&key("to"), to, Dimension::Length)?;
            check_displacement(source, &key("to"), written, to, model)?;
            let rate = source.positive(&key("rate"), rate, Dimension::Speed)?;
            Ok(Some(ProgramStep::Move { to, rate }))
        }
        (None, Some(force), Some(rate), None) => Ok(Some(ProgramStep::MoveToForce {
            force: source.si(&key("to_force"), force, Dimension::Force)?,
            rate: source.positive(&key("rate"), rate, Dimension::Speed)?,
        })),
        (None, Some(force), None, Some(rate)) => Ok(Some(ProgramStep::Press {
            to: source.si(&key("to_force"), force, Dimension::Force)?,
            rate: source.positive(&key("force_rate"), rate, Dimension::ForceRate)?,
        })),
        (Some(_), None, None, _) => Err(source.missing(key("rate"), "the speed of the jaw, such as \"50 mm/min\"")),
        (None, Some(_), None, None) => {
            Err(source.missing(key("rate"), "the speed of the jaw, or force_rate, such as \"10 N/s\""))
        }
        (None, None, Some(_), _) => {
            Err(source.missing(key("to"), "a displacement to go to, such as \"5 mm\" (or to_force, such as \"10 N\")"))
        }
        (None, None, None, Some(_)) => Err(source.missing(key("to_force"), "a force to go to")),
        (None, None, None, None) => Ok(None),
    }
}

/// The second part of a step, if it has one.
fn hold(
    source: &Source<'_>,
    key: &impl Fn(&str) -> String,
    table: &StepTable,
) -> Result<Option<ProgramStep>, DescriptionError> {
    let duration = |name: &str, written: &QuantityText| {
        let duration = source.si(&key(name), written, Dimension::Time)?;
        if duration < 0.0 {
            return Err(source.value(key(name), "a time of 0 s or more", written));
        }
        Ok((duration > 0.0).then_some(duration))
    };
    match (&table.hold, &table.hold_force) {
        (Some(_), Some(_)) => Err(source.both(&key("hold"), &key("hold_force"))),
        (Some(hold), None) => Ok(duration("hold", hold)?.map(|duration| ProgramStep::HoldPosition { duration })),
        (None, Some(hold)) => Ok(duration("hold_force", hold)?.map(|duration| ProgramStep::HoldForce { duration })),
        (None, None) => Ok(None),
    }
}

/// The body must be able to take the displacement.
fn check_displacement(
    source: &Source<'_>,
    key: &str,
    written: &QuantityText,
    to: f64,
    model: &Model,
) -> Result<(), DescriptionError> {
    let specimen = model.specimen();
    let bonded = model.contact().separation() == simulate::Separation::Bonded;
    let contact_displacement = specimen.contact_displacement(to);
    let expected = match specimen.check_contact_displacement(contact_displacement, bonded) {
        Ok(()) => return Ok(()),
        Err(SpecimenError::TooDeep { limit, limit_name, .. }) => {
            let most = limit / specimen.contact_displacement(1.0) * 1e3;
            let why = match limit_name {
                table if table.contains("table") => format!("the {table}"),
                _ => "where nothing of the body would be left".to_owned(),
            };
            format!("a displacement below {most} mm, {why}")
        }
        Err(_) => "a displacement of 0 mm or more for a bonded body whose contact grows".to_owned(),
    };
    Err(source.value(key, expected, written))
}

fn sampling(source: &Source<'_>, output: &OutputTable, end: f64) -> Result<Sampling, DescriptionError> {
    match (&output.sample_rate, &output.times) {
        (Some(_), Some(_)) => Err(source.both("output.sample_rate", "output.times")),
        (None, None) => Ok(Sampling::Rate(USUAL_SAMPLE_RATE)),
        (Some(rate), None) => {
            let rate = source.positive("output.sample_rate", rate, Dimension::Frequency)?;
            Ok(Sampling::Rate(rate))
        }
        (None, Some(written)) => Ok(Sampling::Times(times(source, written, end)?)),
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
