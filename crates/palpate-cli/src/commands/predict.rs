//! `palpate predict`: what a calibrated body does under a protocol.

use palpate::simulate::{Sampling, SimulateError};
use palpate_files::description::{DescriptionError, read_material, read_protocol_of};
use palpate_report::study::{prediction_figure, prediction_table, write_prediction};

use super::picture::{check_picture, picture};
use crate::arguments::PredictArguments;
use crate::failure::{Failure, Outcome};
use crate::files::{write_file, write_file_with};
use crate::progress::Working;
use crate::terminal::{note, print, print_with};

pub(crate) fn run(arguments: &PredictArguments) -> Result<Outcome, Failure> {
    if let Some(path) = &arguments.figure {
        check_picture(path)?;
    }
    let file = read_material(&arguments.material).map_err(described)?;
    let protocol = read_protocol_of(&arguments.protocol, &file).map_err(described)?;
    let material = file.material;
    let mut at = arguments.at.clone();
    at.sort_by(f64::total_cmp);
    at.dedup();
    let sampling = if at.is_empty() { protocol.sampling.clone() } else { Sampling::Times(at.clone()) };
    let working = Working::new("predicting");
    let predict = |sampling: &Sampling| {
        material.predict(protocol.drive(), sampling, arguments.confidence).map_err(|error| {
            let hint = matches!(error, SimulateError::SampleTime { .. })
                .then(|| "ask for times inside the protocol, or lengthen its last hold".to_owned());
            Failure::of_file(&arguments.protocol, error, hint)
        })
    };
    let predicted = predict(&sampling)?;
    // Single times make no curve.
    let course = if arguments.figure.is_some() && !at.is_empty() { Some(predict(&protocol.sampling)?) } else { None };
    let figure = match &arguments.figure {
        Some(path) => {
            let caption = format!("What {} does, by its calibrated law.", arguments.material.display());
            let title = protocol.title.as_deref().map_or(caption.clone(), |title| format!("{title}. {caption}"));
            Some(picture(path, &prediction_figure(course.as_ref().unwrap_or(&predicted), "prediction", &title))?)
        }
        None => None,
    };
    drop(working);
    if let (Some(path), Some(bytes)) = (&arguments.figure, &figure) {
        write_file(path, bytes)?;
    }
    match &arguments.out {
        Some(path) => write_file_with(path, |out| write_prediction(out, &predicted))?,
        None if at.is_empty() => print_with(|out| write_prediction(out, &predicted))?,
        None => {}
    }
    if !at.is_empty() {
        print(&prediction_table(&predicted).to_plain_text())?;
    }
    if material.uncertainty.is_none() {
        note("the calibration left a number open: the intervals hold noise alone");
    }
    for beyond in &predicted.extrapolations {
        note(&format!("beyond the test: {beyond}"));
    }
    Ok(Outcome::Done)
}

pub(super) fn described(error: DescriptionError) -> Failure {
    let hint = error.hint();
    Failure::new(error, hint)
}
