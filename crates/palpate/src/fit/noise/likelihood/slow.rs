//! Noise with slow parts beside white noise, by Kalman's filter.

use super::filter::{LANES, Noises};
use super::kind::{Kind, Likelihood, SHARES, slowest};
use super::rows::Rows;
use crate::fit::noise::model::{MOST_PARTS, NoiseModel, Parts};
use crate::optimise::{Few, minimise};

/// Most means of neighbours of a series that a first look takes.
const GLANCE: usize = 200;

/// The longest correlation time of a power law over the length of the hold: what is slower still looks like a constant.
const OUTLASTS: f64 = 16.0;

/// Fall of the deviance that a first look has to show: from there to the bottom it falls by some units more. Of white residuals that
/// look slow, two of three are done with here.
const PROMISE: f64 = 2.0;

/// Noise with slow parts: Kalman's filter whitens all columns alike, sample by sample.
pub(crate) struct Slow<'a> {
    rows: Rows,
    residuals: &'a [f64],
    /// Samples of each of the series, which are independent of each other.
    length: usize,
    /// The longest correlation time of a power law, in samples.
    longest: f64,
}

/// κ of correlations that are slow.
fn kappas(length: usize) -> (f64, f64) {
    (0.05, slowest(length))
}

fn is_within(x: &[f64], bounds: &[(f64, f64)]) -> bool {
    x.iter().zip(bounds).all(|(x, (low, high))| (low..=high).contains(&x))
}

/// ρ and s from κ and ln(s/(1 − s)).
pub(crate) fn mixture(x: &[f64], length: usize) -> Option<NoiseModel> {
    is_within(x, &[kappas(length), SHARES]).then(|| NoiseModel::WhiteAndAutoregressive {
        correlation: (0.5 * x[0]).tanh(),
        share: share(x[1]),
    })
}

/// ln(s/(1 − s)) of a share of all but rounding.
const ALONE: f64 = 30.0;

/// Doubles of exponents.
const TWICE: (f64, f64) = (0.6, 4.4);

/// a from its double, and the share as above.
pub(crate) fn power_law(x: &[f64], longest: f64) -> Option<NoiseModel> {
    (is_within(x, &[TWICE, SHARES]) || is_within(x, &[TWICE, (ALONE, ALONE)])).then(|| NoiseModel::PowerLaw {
        exponent: 0.5 * x[0],
        share: share(x[1]),
        longest,
    })
}

fn share(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

impl<'a> Slow<'a> {
    /// Residuals beside the columns of a fit of `samples`, in series of `length` samples.
    pub(crate) fn new(jacobian: &[&'a [f64]], residuals: &'a [f64], length: usize, samples: usize) -> Self {
        let columns: Vec<&[f64]> = jacobian.iter().copied().chain([residuals]).collect();
        Self {
            rows: Rows::new(&columns),
            residuals,
            length,
            longest: OUTLASTS * samples as f64,
        }
    }

    /// The restricted likelihood of each of some models.
    pub(crate) fn likelihoods(&self, models: &[Option<NoiseModel>]) -> Vec<Option<Likelihood>> {
        let of =
            |(product, log_determinant): (Vec<f64>, f64)| Likelihood::of(&product, log_determinant, self.rows.samples);
        let parts = models.iter().copied().flatten().map(NoiseModel::parts);
        let mut found = whitened(&self.rows, self.length, parts).into_iter().map(of);
        models.iter().map(|model| model.and_then(|_| found.next()?)).collect()
    }

    /// The best white noise with AR(1), if a first look finds a deviance that promises to fall below this one.
    pub(crate) fn mixture(&self, deviance: f64) -> Option<Kind> {
        let bounds = [kappas(self.length), SHARES];
        let places = (1..).map(|i| 1.2 * f64::from(i)).take_while(|kappa| *kappa < bounds[0].1);
        let places: Vec<[f64; 2]> = places.flat_map(|kappa| [-2.5, 0.0, 2.5].map(|share| [kappa, share])).collect();
        let model = |x: &[f64]| mixture(x, self.length);
        self.best(&self.start(&places, model)?, &bounds, deviance, model)
    }

    /// The best power law without white noise, then the best with it, likewise below the deviance that `worth` gives after those that are known.
    pub(crate) fn power_laws(&self, mut worth: impl FnMut(Option<Kind>) -> f64) {
        let alone = |x: &[f64]| power_law(&[x[0], ALONE], self.longest);
        let beside = |x: &[f64]| power_law(x, self.longest);
        let shares = [-3.0, -1.0, 1.0, 4.0];
        let places: Vec<[f64; 2]> =
            [1.4, 2.4, 3.6].into_iter().flat_map(|twice| shares.map(|share| [twice, share])).collect();
        let starts = (self.start(&[[1.0], [2.0], [3.0], [4.0]], alone), self.start(&places, beside));
        // Neither is worth a search where both are far off.
        let at = [starts.0.and_then(|x| alone(&x)), starts.1.and_then(|x| beside(&x))];
        let found = self.likelihoods(&at);
        let mut deviance = worth(None);
        let promises = |found: &Option<Likelihood>| found.is_some_and(|found| found.deviance <= deviance - PROMISE);
        let (first, second) = (promises(&found[0]), promises(&found[1]));
        if let (Some(start), true) = (starts.0, first) {
            deviance = worth(self.best(&start, &[TWICE], deviance, alone));
        }
        if let (Some(start), true) = (starts.1, second) {
            worth(self.best(&start, &[TWICE, SHARES], deviance, beside));
        }
    }

    /// Where to begin: means of neighbouring residuals can tell, as if nothing had been fitted.
    fn start<const K: usize>(
        &self,
        places: &[[f64; K]],
        model: impl Fn(&[f64]) -> Option<NoiseModel>,
    ) -> Option<[f64; K]> {
        let together = self.length.div_ceil(GLANCE);
        let length = self.length / together;
        let mean = |some: &[f64]| some.iter().sum::<f64>() / together as f64;
        let series = self.residuals.chunks_exact(self.length);
        let means: Vec<f64> = series.flat_map(|series| series.chunks_exact(together).map(mean)).collect();
        let count = means.len() as f64;
        let models: Vec<(NoiseModel, [f64; K])> =
            places.iter().filter_map(|place| Some((model(place)?, *place))).collect();
        let parts = models.iter().map(|(model, _)| model.of_means(together));
        let deviances = whitened(&Rows::new(&[&means]), length, parts)
            .into_iter()
            .map(|(square, log_determinant)| count * (square[0] / count).ln() + log_determinant);
        let alone = models.iter().zip(deviances).filter(|(_, deviance)| deviance.is_finite());
        alone.min_by(|a, b| a.1.total_cmp(&b.1)).map(|((_, start), _)| *start)
    }

    fn best(
        &self,
        start: &[f64],
        bounds: &[(f64, f64)],
        deviance: f64,
        model: impl Fn(&[f64]) -> Option<NoiseModel>,
    ) -> Option<Kind> {
        let evaluate = |points: &[Few]| {
            let models: Vec<Option<NoiseModel>> = points.iter().map(|x| model(x)).collect();
            self.likelihoods(&models)
        };
        let found = minimise(&evaluate, start, bounds, deviance - PROMISE)?;
        Kind::about(&found, &evaluate, &model)
    }
}

/// WᵀW and ln |R| of each of some noises with these parts, by which rows are whitened in series of `length` samples.
fn whitened(rows: &Rows, length: usize, noises: impl Iterator<Item = Parts>) -> Vec<(Vec<f64>, f64)> {
    let noises: Vec<Parts> = noises.collect();
    let of_some = |some: &[Parts]| {
        let all = match some.iter().all(|parts| parts.len() <= 1) {
            true => rows.whitened(&Noises::<1>::new(some), length),
            false => rows.whitened(&Noises::<MOST_PARTS>::new(some), length),
        };
        all.into_iter().take(some.len()).collect::<Vec<_>>()
    };
    noises.chunks(LANES).flat_map(of_some).collect()
}
