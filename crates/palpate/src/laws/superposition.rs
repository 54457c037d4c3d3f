//! Shapes averaged over a loading: the answer of a linear law to it.
//!
//! ⟨φ⟩(t) = ∫ φ(t + u) dγ,  u how long before the hold, t ≥ 0 since its start.
//!
//! An exponential only loses a factor, ⟨exp(−λ·)⟩(t) = A(λ) exp(−λt), which is known in closed form for every straight piece.
//!
//! For every other shape the integral over u is cut into panels that halve towards the start of the hold, down to where u is
//! shorter than t. There φ(t + u) is as good as a polynomial in u, for a shape of time is smooth everywhere but at 0:
//! it is replaced by the one through 16 Gauss nodes, and that is integrated exactly over the loading, however many
//! pieces it has. The error is below 10⁻¹² of the shape's start (measured in the tests, for β up to 2 too).

use std::ops::Range;

use super::loading::Piece;
use super::{BasisFunction, Kernel, Loading};
use crate::special::{gauss_legendre, legendre};

/// Nodes of a panel.
const NODES: usize = 16;

/// Halvings, down to 10⁻¹² of the loading.
const HALVINGS: usize = 40;

/// Samples that go through a shape together, once for every node.
const BATCH: usize = 512;

/// A loading made ready to average shapes over.
#[derive(Debug, Clone)]
pub(crate) struct Superposition {
    pieces: Vec<Piece>,
    duration: f64,
    /// Nodes for t from 2⁻ⁱ of the loading on, i the place in the list; the last for everything below.
    levels: Vec<Vec<Node>>,
}

/// A place before the hold and what of the loading it stands for.
#[derive(Debug, Clone, Copy)]
struct Node {
    age: f64,
    weight: f64,
}

impl Superposition {
    pub(crate) fn new(loading: &Loading) -> Self {
        let pieces: Vec<Piece> = loading.pieces().collect();
        let duration = loading.duration();
        let (rule, inner) = (gauss_legendre::<NODES>(), gauss_legendre::<{ NODES / 2 }>());
        let panel = |from: f64, to: f64| panel(&pieces, from, to, &rule, &inner);
        let mut halves = Vec::new();
        let mut levels = Vec::with_capacity(HALVINGS + 1);
        let mut age = duration;
        for _ in 0..=HALVINGS {
            let near = panel(0.0, age);
            levels.push(near.into_iter().chain(halves.iter().copied()).collect());
            halves.extend(panel(0.5 * age, age));
            age *= 0.5;
        }
        Self {
            pieces,
            duration,
            levels,
        }
    }

    /// ⟨φ⟩ at every time ≥ 0; a latency shape, which knows no superposition, as it is.
    pub(crate) fn value(&self, shape: &BasisFunction, times: &[f64], theta: &[f64], value: &mut [f64]) {
        match shape {
            shape if !shape.superposes() => shape.value(times, theta, value),
            BasisFunction::Exponential => {
                let (factor, _) = self.exponential_factor(theta[0].exp());
                shape.value(times, theta, value);
                value.iter_mut().for_each(|phi| *phi *= factor);
            }
            _ => self.average(times, &mut [value], |times, rows| shape.value(times, theta, &mut rows[0])),
        }
    }

    /// ⟨φ⟩ and its derivatives by every parameter.
    pub(crate) fn gradient(
        &self,
        shape: &BasisFunction,
        times: &[f64],
        theta: &[f64],
        value: &mut [f64],
        derivatives: &mut [Vec<f64>],
    ) {
        match shape {
            shape if !shape.superposes() => shape.gradient(times, theta, value, derivatives),
            BasisFunction::Exponential => {
                let (factor, slope) = self.exponential_factor(theta[0].exp());
                shape.gradient(times, theta, value, derivatives);
                for (phi, by_log_rate) in value.iter_mut().zip(&mut derivatives[0]) {
                    *by_log_rate = factor * *by_log_rate + slope * *phi;
                    *phi *= factor;
                }
            }
            _ => {
                let mut outputs: Vec<&mut [f64]> =
                    std::iter::once(value).chain(derivatives.iter_mut().map(Vec::as_mut_slice)).collect();
                self.average(times, &mut outputs, |times, rows| {
                    let (value, derivatives) = rows.split_at_mut(1);
                    shape.gradient(times, theta, &mut value[0], derivatives);
                });
            }
        }
    }

    /// A(λ) = ∫ exp(−λu) dγ and dA/d ln λ.
    fn exponential_factor(&self, rate: f64) -> (f64, f64) {
        let nodes = &self.levels[HALVINGS];
        // Long records are quicker, and as exact as anything else, by nodes.
        if self.pieces.len() > nodes.len() {
            return nodes.iter().fold((0.0, 0.0), |(factor, slope), node| {
                let part = node.weight * (-rate * node.age).exp();
                (factor + part, slope - rate * node.age * part)
            });
        }
        self.pieces.iter().fold((0.0, 0.0), |(factor, slope), piece| {
            let (late, x) = (rate * piece.to, rate * (piece.from - piece.to));
            let last = piece.change * (-late).exp();
            // (1 − e⁻ˣ)/x, and x times its derivative.
            let mean = if x > 0.0 { -(-x).exp_m1() / x } else { 1.0 };
            let change = (-x).exp() - mean;
            (factor + last * mean, slope + last * (change - late * mean))
        })
    }

    /// Sums weight × row(t + age) over the nodes, for every row that `evaluate` fills.
    fn average(&self, times: &[f64], outputs: &mut [&mut [f64]], evaluate: impl Fn(&[f64], &mut [Vec<f64>])) {
        let mut rows = vec![Vec::new(); outputs.len()];
        let mut shifted = Vec::new();
        for (batch, level) in self.batches(times) {
            let nodes = &self.levels[level];
            shifted.clear();
            shifted.extend(nodes.iter().flat_map(|node| times[batch.clone()].iter().map(|t| t + node.age)));
            rows.iter_mut().for_each(|row| row.resize(shifted.len(), 0.0));
            evaluate(&shifted, &mut rows);
            for (output, row) in outputs.iter_mut().zip(&rows) {
                let output = &mut output[batch.clone()];
                output.fill(0.0);
                for (node, part) in nodes.iter().zip(row.chunks_exact(batch.len())) {
                    output.iter_mut().zip(part).for_each(|(sum, value)| *sum += node.weight * value);
                }
            }
        }
    }

    /// Neighbouring samples that need the same nodes.
    fn batches(&self, times: &[f64]) -> Vec<(Range<usize>, usize)> {
        let mut batches: Vec<(Range<usize>, usize)> = Vec::new();
        for (i, time) in times.iter().enumerate() {
            let halvings = (self.duration / time).log2().ceil();
            // Not a number at 0 or below: the finest.
            let level = if halvings < HALVINGS as f64 { halvings.max(0.0) as usize } else { HALVINGS };
            match batches.last_mut() {
                Some((range, last)) if *last == level && range.len() < BATCH => range.end = i + 1,
                _ => batches.push((i..i + 1, level)),
            }
        }
        batches
    }
}

/// Nodes for ages `from` to `to`, with the weights that integrate their polynomial over the loading.
///
/// The polynomial through f at the Gauss nodes xⱼ is Σ_k (k + ½) P_k Σ_j ωⱼ P_k(xⱼ) f(xⱼ), so that the weight of node j is
/// ωⱼ Σ_k (k + ½) P_k(xⱼ) ∫ P_k dγ.
fn panel(pieces: &[Piece], from: f64, to: f64, rule: &[(f64, f64)], inner: &[(f64, f64)]) -> Vec<Node> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut moments = [0.0; NODES];
    for piece in pieces {
        let (late, early) = (piece.to.max(from), piece.from.min(to));
        if early <= late {
            continue;
        }
        let share = piece.change * (early - late) / (piece.from - piece.to);
        let (center, width) = (0.5 * (late + early), 0.5 * (early - late));
        // Half as many nodes integrate the polynomials exactly, without the cancellation of their antiderivatives.
        let mut means = [0.0; NODES];
        for (x, weight) in inner {
            let values: [f64; NODES] = legendre((center + width * x - middle) / half);
            means.iter_mut().zip(values).for_each(|(sum, value)| *sum += 0.5 * weight * value);
        }
        moments.iter_mut().zip(means).for_each(|(sum, mean)| *sum += share * mean);
    }
    let node = |(x, weight): &(f64, f64)| {
        let terms = legendre::<NODES>(*x).into_iter().zip(&moments).enumerate();
        Node {
            age: middle + half * x,
            weight: weight * terms.map(|(k, (value, moment))| (k as f64 + 0.5) * value * moment).sum::<f64>(),
        }
    };
    rule.iter().map(node).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use serde::Deserialize;

    use super::*;

    #[derive(Deserialize)]
    struct Reference {
        tolerance: Tolerance,
        loadings: HashMap<String, Vec<(f64, f64)>>,
        cases: Vec<Case>,
    }

    #[derive(Deserialize)]
    struct Tolerance {
        value: f64,
        derivative: f64,
    }

    #[derive(Deserialize)]
    struct Case {
        shape: BasisFunction,
        parameters: Vec<f64>,
        loading: String,
        time: f64,
        value: f64,
        derivatives: Vec<f64>,
    }

    impl Case {
        /// ⟨φ⟩ and its derivatives, as they are found and as they should be.
        fn run(&self, superposition: &Superposition) -> Vec<(f64, f64)> {
            let theta: Vec<f64> = self
                .parameters
                .iter()
                .enumerate()
                .map(|(i, parameter)| if i == 0 { parameter.ln() } else { *parameter })
                .collect();
            let (mut value, mut alone) = ([f64::NAN], [f64::NAN]);
            let mut derivatives = vec![vec![f64::NAN]; theta.len()];
            superposition.value(&self.shape, &[self.time], &theta, &mut alone);
            superposition.gradient(&self.shape, &[self.time], &theta, &mut value, &mut derivatives);
            assert!((value[0] - alone[0]).abs() <= 1e-15 * alone[0].abs().max(1.0), "{} {}", value[0], alone[0]);
            let expected = std::iter::once(&self.value).chain(&self.derivatives);
            value.into_iter().chain(derivatives.into_iter().flatten()).zip(expected.copied()).collect()
        }
    }

    /// Parameters of `validation/finite_ramps.py`.
    #[test]
    fn every_shape_follows_every_loading() {
        let text = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../validation/reference/finite_ramps.json"));
        let reference: Reference = serde_json::from_str(text).expect("a reference file");
        let ready = |pairs: &Vec<(f64, f64)>| {
            let (times, values): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
            Superposition::new(&Loading::new(&times, &values).unwrap())
        };
        let loadings: HashMap<&String, Superposition> =
            reference.loadings.iter().map(|(name, pairs)| (name, ready(pairs))).collect();
        assert!(reference.cases.len() > 300);
        for case in &reference.cases {
            for (i, (found, expected)) in case.run(&loadings[&case.loading]).into_iter().enumerate() {
                let Tolerance { value, derivative } = reference.tolerance;
                let allowed = if i == 0 { value } else { derivative };
                let error = (found - expected).abs() / expected.abs().max(1.0);
                let Case { shape, parameters, .. } = case;
                assert!(error < allowed, "{shape:?} {parameters:?} {} t = {} {i}: {error:e}", case.loading, case.time);
            }
        }
    }

    /// Many pieces go through nodes, few through closed forms.
    #[test]
    fn a_long_record_gives_what_its_few_pieces_give() {
        let few = Loading::new(&[0.0, 0.5, 0.75, 2.0], &[0.0, 0.75, 0.5, 1.0]).unwrap();
        let times: Vec<f64> = (0..=20_000).map(|i| 1e-4 * f64::from(i)).collect();
        let values: Vec<f64> = times.iter().map(|t| few.at(t - 2.0)).collect();
        let many = Superposition::new(&Loading::new(&times, &values).unwrap());
        let few = Superposition::new(&few);
        for rate in [1e-2, 1.0, 30.0, 1e4] {
            let (a, b) = (few.exponential_factor(rate), many.exponential_factor(rate));
            assert!((a.0 - b.0).abs() < 2e-13 && (a.1 - b.1).abs() < 2e-13, "{rate}: {a:?} {b:?}");
        }
        let (mut a, mut b) = (vec![0.0; 5], vec![0.0; 5]);
        for (superposition, out) in [(&few, &mut a), (&many, &mut b)] {
            superposition.value(&BasisFunction::Stretched, &[0.0, 1e-3, 0.1, 1.0, 9.0], &[1.0, 0.3], out);
        }
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-13), "{a:?} {b:?}");
    }
}
