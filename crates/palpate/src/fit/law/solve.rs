//! From samples to the solution of a law, in the units of the fit.

use super::fitted::Fitted;
use crate::fit::global::search::search;
use crate::fit::problem::build::build;
use crate::fit::{FitError, LawOptions, Loss, SampleChoice, Samples};
use crate::laws::Law;
use crate::optimise::Work;

impl Fitted {
    /// Finds the numbers of a law.
    pub(crate) fn new(
        samples: &Samples<'_>,
        law: Law,
        options: &LawOptions,
        work: &mut Work,
    ) -> Result<Self, FitError> {
        let form = options.form(law)?;
        let chosen = chosen(samples, options.samples)?;
        let samples = &chosen.samples(samples);
        let (model, scaled) = build(form, samples, options)?;
        let solution = search(&model, &scaled, options.most_iterations, work).ok_or(FitError::NoDecay)?;
        let mut fitted = Self {
            model,
            scaled,
            solution,
        };
        if options.loss != Loss::Squares {
            fitted.resist(options, work)?;
        }
        fitted.arrange();
        Ok(fitted)
    }
}

/// Samples that were picked, if not all.
struct Chosen(Option<[Vec<f64>; 3]>);

impl Chosen {
    fn samples<'a>(&'a self, all: &Samples<'a>) -> Samples<'a> {
        match &self.0 {
            None => *all,
            Some([times, values, deviations]) => Samples {
                times,
                values,
                deviations: all.deviations.map(|_| deviations.as_slice()),
            },
        }
    }
}

fn chosen(samples: &Samples<'_>, choice: SampleChoice) -> Result<Chosen, FitError> {
    let SampleChoice::LogSpaced(count) = choice else {
        return Ok(Chosen(None));
    };
    samples.check(1)?;
    let times = samples.times;
    let mut kept = vec![0];
    let (first, last) = (times[1] - times[0], times[times.len() - 1] - times[0]);
    for i in 0..count.max(2) {
        let at = first * (last / first).powf(i as f64 / (count.max(2) - 1) as f64);
        let after = times.partition_point(|t| t - times[0] < at).min(times.len() - 1);
        let before =
            after - usize::from(after > 1 && at - (times[after - 1] - times[0]) < times[after] - times[0] - at);
        if kept.last().is_some_and(|last| *last < before) {
            kept.push(before);
        }
    }
    let pick = |column: &[f64]| kept.iter().map(|i| column[*i]).collect::<Vec<f64>>();
    let deviations = samples.deviations.map_or_else(Vec::new, pick);
    Ok(Chosen(Some([pick(times), pick(samples.values), deviations])))
}
