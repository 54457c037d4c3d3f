//! The steps of a protocol, and the motion that they make.

use palpate::{
    contact::SpecimenError,
    simulate::{self, Contact, Motion, ProgramStep, ProtocolStep},
    units::Dimension,
};

use super::tables::StepTable;
use crate::description::text::{error::DescriptionError, quantity::QuantityText, source::Source};

/// Steps one by one, and as a motion if they are one.
pub(crate) struct Steps {
    pub(crate) program: Vec<ProgramStep>,
    pub(crate) motion: Option<Motion>,
    /// Number of the table, from 1, that each step of the program was written in.
    pub(crate) tables: Vec<usize>,
}

pub(crate) fn steps(source: &Source<'_>, tables: &[StepTable], model: &Contact) -> Result<Steps, DescriptionError> {
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
            return Err(source.value(key("to"), "a displacement different from the previous one, or a hold", written));
        }
        let to = match ramp {
            Some(ProgramStep::Move { to, .. }) => Some(to),
            None => at,
            Some(_) => None,
        };
        if let (Some(to), None | Some(ProgramStep::HoldPosition { .. })) = (to, hold) {
            let rate = if let Some(ProgramStep::Move { rate, .. }) = ramp { rate } else { 1.0 };
            let hold = if let Some(ProgramStep::HoldPosition { duration }) = hold { duration } else { 0.0 };
            moves.push(ProtocolStep { to, rate, hold });
        }
        // Where the jaw stands after force control only the simulation knows.
        at = if matches!(hold, Some(ProgramStep::HoldForce { .. })) { None } else { to };
        program.extend(ramp.into_iter().chain(hold));
        written.resize(program.len(), index + 1);
    }
    // Where every table asks for displacements alone.
    let motion = (moves.len() == tables.len()).then(|| simulate::protocol(&moves));
    let motion = motion.transpose().map_err(|error| source.value("step", "steps that make a motion", &error))?;
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
    model: &Contact,
) -> Result<Option<ProgramStep>, DescriptionError> {
    let both = |a: &str, b: &str| source.both(key(a), key(b));
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
        (Some(_), Some(_)) => Err(source.both(key("hold"), key("hold_force"))),
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
    model: &Contact,
) -> Result<(), DescriptionError> {
    let specimen = model.specimen();
    let bonded = model.separation() == simulate::Separation::Bonded;
    let contact_displacement = specimen.contact_displacement(to);
    let expected = match specimen.check_contact_displacement(contact_displacement, bonded) {
        Ok(()) => return Ok(()),
        Err(SpecimenError::TooDeep { limit, limit_name, .. }) => {
            let most = limit / specimen.contact_displacement(1.0) * 1e3;
            let why = match limit_name {
                end if end.contains("table") || end.contains("contact") => format!("the {end}"),
                _ => "where the body would have no thickness".to_owned(),
            };
            format!("a displacement below {most} mm, {why}")
        }
        Err(_) => "a displacement of 0 mm or more for a bonded body whose contact grows".to_owned(),
    };
    Err(source.value(key, expected, written))
}
