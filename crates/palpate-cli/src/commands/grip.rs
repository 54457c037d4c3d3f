//! `palpate grip`: will it hold, and how to squeeze.

use palpate::calibrate::Material;
use palpate::grip::{Band, Control, Grasp, Grip, GripError, Limits, Objective, Question, Regrip};
use palpate_files::description::read_material;
use palpate_report::document::GripDocument;
use palpate_report::result::GrippedBody;
use palpate_report::study::{Pictures, grip_bundle, grip_figure, grip_text};

use super::picture::{check_picture, picture};
use super::predict::described;
use crate::arguments::{ControlName, Format, GripArguments, ObjectiveName, RegripName};
use crate::failure::{Failure, Outcome};
use crate::files::{sha256, write_bundle, write_file};
use crate::progress::Working;
use crate::terminal::{note, print};

pub(crate) fn run(arguments: &GripArguments) -> Result<Outcome, Failure> {
    if let Some(path) = &arguments.figure {
        check_picture(path)?;
    }
    let question = question(arguments)?;
    let material = read_material(&arguments.material).map_err(described)?.material;
    let working = Working::new("planning the grip");
    let grip = gripper(arguments, &material).map_err(|error| failed(&error))?;
    let answer = grip.answer(&question).map_err(|error| failed(&error))?;
    let holds = match answer.holds() {
        Ok(holds) => holds,
        Err(error) if error.is_answer() => false,
        Err(error) => return Err(failed(&error)),
    };
    let hint = answer.holds().err().map(|error| error.hint());
    let body = GrippedBody {
        path: arguments.material.display().to_string(),
        sha256: sha256(&arguments.material)?,
        grip,
        answer,
    };
    let figure = arguments.figure.as_ref().map(|path| picture(path, &grip_figure(&body, "grip"))).transpose()?;
    let bundle = match &arguments.out {
        Some(_) => Some(grip_bundle(&body, Pictures::default()).map_err(|error| Failure::new(error, None))?),
        None => None,
    };
    drop(working);
    if let (Some(folder), Some(bundle)) = (&arguments.out, &bundle) {
        write_bundle(folder, bundle)?;
    }
    if let (Some(path), Some(bytes)) = (&arguments.figure, &figure) {
        write_file(path, bytes)?;
    }
    let text = match arguments.format {
        Format::Text => grip_text(&body),
        Format::Json => {
            let text =
                serde_json::to_string_pretty(&GripDocument::new(&body)).map_err(|error| Failure::new(error, None))?;
            format!("{text}\n")
        }
    };
    print(&text)?;
    if let Some(folder) = &arguments.out {
        note(&format!("report written: {}", folder.join("report.html").display()));
    }
    if let Some(hint) = hint {
        note(hint);
    }
    Ok(if holds { Outcome::Done } else { Outcome::Negative })
}

fn failed(error: &GripError) -> Failure {
    let hint = error.hint();
    Failure::new(error, (!hint.is_empty()).then(|| hint.to_owned()))
}

fn question(arguments: &GripArguments) -> Result<Question, Failure> {
    let control = match arguments.control {
        ControlName::Position => Control::Position,
        ControlName::Force => Control::Force,
    };
    if control == Control::Position && arguments.force.is_some() {
        return Err(Failure::new(
            "--force is for a force that is held, and the displacement is",
            Some("add --control force, or ask with --squeeze or --most-force".to_owned()),
        ));
    }
    if control == Control::Force && arguments.squeeze.is_some() {
        return Err(Failure::new(
            "--squeeze is for a displacement that is held, and the force is",
            Some("leave --control force out, or ask with --force".to_owned()),
        ));
    }
    Ok(Question {
        control,
        squeeze: arguments.squeeze,
        force: arguments.force,
        duration: arguments.hold,
        objective: match arguments.objective {
            ObjectiveName::Squeeze => Objective::Squeeze,
            ObjectiveName::PeakForce => Objective::PeakForce,
            ObjectiveName::Work => Objective::Work,
        },
        assured: arguments.assured,
        band: arguments.band.map(|(low, high)| Band { low, high }),
        regrip: match arguments.regrip {
            RegripName::Moves => Regrip::FewestMoves,
            RegripName::Work => Regrip::LeastWork {
                shortest_pause: arguments.shortest_pause,
            },
        },
    })
}

/// The body in the gripper that was described.
fn gripper<'a>(arguments: &GripArguments, material: &'a Material) -> Result<Grip<'a>, GripError> {
    let (load, can) = (&arguments.load, &arguments.gripper);
    let mut grasp = Grasp::new(load.mass, load.friction)?;
    grasp.safety = load.safety;
    grasp.gravity = load.gravity.unwrap_or(grasp.gravity);
    grasp.acceleration_up = load.acceleration_up.unwrap_or(0.0);
    grasp.acceleration_across = load.acceleration_across.unwrap_or(0.0);
    grasp.acceleration_closing = load.acceleration_closing.unwrap_or(0.0);
    grasp.torque = load.torque.unwrap_or(0.0);
    grasp.off_centre = load.off_centre.unwrap_or(0.0);
    let mut limits = Limits::new(can.speed.unwrap_or(material.shown.fastest))?;
    limits.stroke = can.stroke;
    limits.force = can.most_force;
    limits.closing = can.close_within;
    Grip::new(material, grasp, limits, arguments.confidence)
}
