//! What a calibration of several records is shown with.

use palpate::analysis::{Finding, Severity};
use palpate::calibrate::{
    BatchParameter, Between, CalibratedSpecimen, CalibrationData, Misfit, ResidualCourse, SeveralCalibration,
};
use palpate::number::{counted, significant};

use super::calibrated::{bonded_remark, formula_of_material, range_remark};
use super::input::Input;
use super::parameters::parameter_title;
use super::words::percent;

/// Several records calibrated together.
#[derive(Debug)]
pub struct CalibratedBatch {
    /// Where each record comes from.
    pub inputs: Vec<Input>,
    /// What was fitted, record by record.
    pub data: Vec<CalibrationData>,
    /// What was found.
    pub found: SeveralCalibration,
}

/// Below this probability of one value the records contradict a shared parameter.
const CONTRADICTED: f64 = 0.01;

impl CalibratedBatch {
    fn titles(&self, is: impl Fn(&Between) -> bool) -> Vec<String> {
        let parameters = self.found.parameters.iter().filter(|parameter| is(&parameter.between));
        parameters.map(|parameter| parameter_title(&parameter.name)).collect()
    }

    /// The answer in lines: the law of another specimen with its values put in, what is shared, what differs and by how much, and how
    /// closely the law describes the records.
    #[must_use]
    pub fn answer(&self) -> Vec<String> {
        let found = &self.found;
        let shared = self.titles(|between| matches!(between, Between::Shared { .. }));
        let sharing = if shared.is_empty() { "none".to_owned() } else { shared.join(", ") };
        let mut lines = vec![format!(
            "Law calibrated on {} together: {}; shared parameters: {sharing}.",
            counted(found.specimens.len(), "record"),
            found.candidate
        )];
        lines.extend(found.specimen.as_ref().and_then(formula_of_material));
        let share = percent(found.confidence);
        for BatchParameter { name, between, .. } in &found.parameters {
            if let Between::Own { spread, .. } = between {
                let title = parameter_title(name);
                let percent = |share: f64| significant(100.0 * share, 2);
                let (low, high) = spread.interval;
                lines.push(if spread.is_distinguishable() {
                    format!(
                        "Between specimens the {title} differs by {} % ({share} interval: {} to {} %).",
                        percent(spread.deviation),
                        percent(low),
                        percent(high)
                    )
                } else if high > 0.0 {
                    format!(
                        "The {title} does not differ distinguishably between specimens: by less than {} %.",
                        percent(high)
                    )
                } else {
                    format!("The {title} differs less between specimens than the errors of the records explain.")
                });
            }
        }
        let relative = found.specimens.iter().map(|specimen| 100.0 * specimen.relative);
        let (least, most) = relative.fold((f64::INFINITY, 0.0f64), |(low, high), r| (low.min(r), high.max(r)));
        let residual = format!("Root mean square residual: {} to {}", significant(least, 2), significant(most, 2));
        lines.push(format!("{residual} % of the peak force of a record."));
        lines
    }

    /// What the records show against the law.
    #[must_use]
    pub fn misfit(&self) -> Option<Misfit> {
        self.found.specimens.iter().find_map(Self::misfit_of)
    }

    /// What one of the records shows against it.
    #[must_use]
    pub fn misfit_of(specimen: &CalibratedSpecimen) -> Option<Misfit> {
        ResidualCourse::is_systematic(specimen.noise, specimen.relative).then_some(Misfit::Residuals)
    }

    /// The findings of records because of which numbers must not be used, in sentences that name the record.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let of = |specimen: &CalibratedSpecimen| {
            let severe = specimen.findings.iter().filter(|finding| finding.severity() == Severity::Warning);
            let sentence = |finding: &Finding| {
                format!("{}: {}: {}; {}.", specimen.name, finding.code(), finding.observation(), finding.meaning())
            };
            severe.map(sentence).collect::<Vec<String>>()
        };
        self.found.specimens.iter().flat_map(of).collect()
    }

    /// All remarks: the warnings, and what the parameters alone do not tell.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        [self.warnings(), self.notes()].concat()
    }

    /// What the parameters alone do not tell.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let found = &self.found;
        let mut remarks: Vec<String> = found.parameters.iter().filter_map(contradicted).collect();
        let count = found.specimens.len();
        let has_own = !self.titles(|between| matches!(between, Between::Own { .. })).is_empty();
        remarks.push(match (&found.specimen, has_own) {
            (None, _) => {
                "Two records do not determine how own parameters differ together: there is no material of another specimen, which needs 3 records or more, or all parameters shared.".to_owned()
            }
            (Some(_), false) => "All parameters are shared: the material is the one that all records tested, without a spread.".to_owned(),
            (Some(_), true) => format!(
                "The material is that of a specimen of the batch that was not tested: its intervals contain the spread between the {count} specimens, with {} degrees of freedom.",
                count - 1
            ),
        });
        let body = |data: &CalibrationData| (data.geometry().shape.clone(), data.geometry().sides);
        if found.specimen.is_some() && self.data.iter().any(|data| body(data) != body(&self.data[0])) {
            remarks
                .push(format!("The bodies differ in geometry: the material has that of {}.", found.specimens[0].name));
        }
        let systematic = |specimen: &&CalibratedSpecimen| Self::misfit_of(specimen).is_some();
        let systematic: Vec<&str> =
            found.specimens.iter().filter(systematic).map(|specimen| specimen.name.as_str()).collect();
        if !systematic.is_empty() {
            remarks.push(format!(
                "The residuals of {} are systematic: the law does not describe all of the record. Standard errors and intervals account for their correlation, not for a law of another form.",
                systematic.join(", ")
            ));
        }
        remarks.extend(found.specimen.as_ref().map(|material| range_remark(material.range())));
        remarks.extend(found.specimen.as_ref().and_then(bonded_remark));
        remarks
    }
}

/// That records calibrated alone contradict that a parameter is the same in all.
fn contradicted(parameter: &BatchParameter) -> Option<String> {
    let Between::Shared {
        one_value_p: Some(p), ..
    } = parameter.between
    else {
        return None;
    };
    (p < CONTRADICTED).then(|| {
        let title = parameter_title(&parameter.name);
        let p = if p < 1e-4 { "p < 0.0001".to_owned() } else { format!("p = {}", significant(p, 2)) };
        format!(
            "The records contradict one {title} for all ({p}): calibrated alone they differ more than their errors explain. Its interval does not contain that difference; as an own parameter it has a spread."
        )
    })
}
