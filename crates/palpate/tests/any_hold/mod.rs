//! Bytes read as a law, options and columns: shared by the property test of inputs and the fuzz target `fit_law`.

use palpate::fit::{Fit, LawOptions, Loss, Samples, Termination, fit_law};
use palpate::laws::{Law, Response};

/// The laws that are tried.
pub(crate) const LAWS: [&str; 17] = [
    "latency",
    "latency:0.5",
    "latency:1",
    "latency:5",
    "maxwell",
    "kelvin-voigt",
    "sls",
    "burgers",
    "prony:2",
    "prony:3",
    "fung:2",
    "fung-continuous",
    "stretched",
    "power",
    "logarithmic",
    "fractional-zener",
    "diffusion",
];

/// Samples of a hold at most.
const MOST: usize = 60;

/// Whether nothing in a fit is NaN.
pub(crate) fn is_valid(fit: &Fit) -> bool {
    let errors = fit.white_covariance.iter().flatten().flatten().copied();
    let numbers = fit.parameters.iter().flat_map(|number| {
        let (low, high) = number.estimate.interval.unwrap_or((0.0, 0.0));
        [number.estimate.value, number.estimate.white_standard_error.unwrap_or(0.0), low, high]
    });
    let totals = [fit.residual_square, fit.rmse, fit.residual_correlation];
    errors.chain(numbers).chain(totals).chain(fit.values.iter().copied()).all(|number| !number.is_nan())
}

/// Fits what the bytes say; it must not panic, and nothing that ended well may hold NaN.
///
/// The first byte is the law, the second holds options, the third says how columns are written: any doubles, or 16-bit steps of time
/// and values, which are a hold more often.
pub(crate) fn fit_any(bytes: &[u8]) {
    let [law, options, form, columns @ ..] = bytes else {
        return;
    };
    let bit = |byte: u8, place: u8| byte >> place & 1 == 1;
    let law: Law = LAWS[usize::from(*law) % LAWS.len()].parse().expect("the name of a law");
    let options = LawOptions {
        response: if bit(*options, 0) { Response::Creep } else { Response::Relaxation },
        loss: match options >> 1 & 3 {
            0 => Loss::Huber,
            1 => Loss::Tukey,
            _ => Loss::Squares,
        },
        one_sign: bit(*options, 3),
        ..LawOptions::default()
    };
    let mut numbers = if bit(*form, 0) { doubles(columns) } else { steps(columns) };
    numbers.truncate(3 * MOST);
    let count = numbers.len() / 3;
    let (mut times, rest) = (numbers[..count].to_vec(), &numbers[count..]);
    if !bit(*form, 0) {
        let mut time = 0.0;
        times.iter_mut().for_each(|step| {
            time += 1e-3 + step.abs();
            *step = time;
        });
    }
    let (values, standard_deviations) = (&rest[..count], &rest[count..2 * count]);
    let samples = Samples::new(&times, values);
    let samples = if bit(*form, 1) { samples.with_standard_deviations(standard_deviations) } else { samples };
    if let Ok(fit) = fit_law(&samples, law, &options) {
        assert!(fit.termination != Termination::Converged || is_valid(&fit), "{fit:?}");
    }
}

/// Any doubles.
fn doubles(bytes: &[u8]) -> Vec<f64> {
    bytes.as_chunks().0.iter().map(|eight| f64::from_le_bytes(*eight)).collect()
}

/// Numbers between −33 and 33.
fn steps(bytes: &[u8]) -> Vec<f64> {
    bytes.as_chunks().0.iter().map(|two| 1e-3 * f64::from(i16::from_le_bytes(*two))).collect()
}
