//! A series of exponentials where rates come near each other or near none: divided differences in place of columns that imitate each other.
//!
//! Exponentials of rates z₀ ≤ … ≤ z_k that are near each other span the same functions as the divided differences
//!
//! f\[z₀ … z_j\] = (−t)ʲ e^(−zt) Σ_q h_q(d₀ … d_j) (−t)^q / (j + q)!, with d_i = z_i − z,
//!
//! where z is the mean of the rates and h_q the sum of all products of q of the d. These stay apart, and are there still, when rates are
//! equal. The constant is the exponential of rate 0. With b_j the linear parameters of a group,
//!
//! ∂/∂z_i Σ_j b_j f\[z₀ … z_j\] = B_i f\[z₀ … z_k, z_i\] + what the group itself spans, B_i = Σ_j b_j Π_{l>j} (z_i − z_l).

use crate::optimise::{Orthogonal, Target};
use crate::vector::{accelerated, exponential_columns};

/// A rate of a group, and which nonlinear parameter it belongs to; none for the constant.
#[derive(Clone, Copy)]
struct Node {
    rate: f64,
    parameter: Option<usize>,
}

/// Exponentials of these ln λ at one place, and what the derivatives of their columns count by.
pub(crate) fn confluent(times: &[f64], constant: bool, theta: &[f64], target: Target<'_>) -> (Orthogonal, Vec<f64>) {
    let groups = groups(theta, constant);
    let mut columns = Vec::new();
    let mut derivatives = vec![Vec::new(); theta.len()];
    for group in &groups {
        let middle = group.iter().map(|node| node.rate).sum::<f64>() / group.len() as f64;
        let mut decay = vec![1.0; times.len()];
        if middle > 0.0 {
            exponential_columns(times, middle, [&mut decay]);
        }
        let apart: Vec<f64> = group.iter().map(|node| node.rate - middle).collect();
        for j in 0..apart.len() {
            columns.push(divided_difference(times, &decay, &apart[..=j]));
        }
        for (node, own) in group.iter().zip(&apart) {
            if let Some(parameter) = node.parameter {
                derivatives[parameter] = divided_difference(times, &decay, &[apart.as_slice(), &[*own]].concat());
            }
        }
    }
    let here = Orthogonal::of(theta, columns, derivatives, target);
    let linear = here.linear();
    let mut factors = vec![0.0; theta.len()];
    let mut from = 0;
    for group in &groups {
        let own = &linear[from..from + group.len()];
        for node in group {
            if let Some(parameter) = node.parameter {
                // Horner's scheme of Newton's polynomial from its end.
                let sum = own.iter().zip(group).fold(0.0, |sum, (b, other)| sum * (node.rate - other.rate) + b);
                factors[parameter] = node.rate * sum;
            }
        }
        from += group.len();
    }
    (here, factors)
}

/// The rates, and 0 for the constant, in groups of those near each other.
fn groups(theta: &[f64], constant: bool) -> Vec<Vec<Node>> {
    let rates = theta.iter().enumerate().map(|(i, log)| Node {
        rate: log.exp(),
        parameter: Some(i),
    });
    let still = constant.then_some(Node {
        rate: 0.0,
        parameter: None,
    });
    let mut nodes: Vec<Node> = still.into_iter().chain(rates).collect();
    nodes.sort_by(|a, b| a.rate.total_cmp(&b.rate));
    let mut groups: Vec<Vec<Node>> = Vec::new();
    for node in nodes {
        let width = f64::max(SLOW, NEAR * node.rate);
        match groups.last_mut() {
            Some(group)
                if node.rate - group[0].rate <= width
                    || group.last().is_some_and(|last| node.rate - last.rate <= 0.2 * width) =>
            {
                group.push(node);
            }
            _ => groups.push(vec![node]),
        }
    }
    groups
}

/// Difference of rates of a group, per duration, and of the rate itself.
const SLOW: f64 = 0.6;

const NEAR: f64 = 0.15;

/// Terms of the series over q: beyond them is rounding for rates of a group wherever the exponential has not died away.
const TERMS: usize = 18;

/// f\[z₀ … z_j\] at the times, where `decay` is e^(−zt) and `apart` the differences of the rates from z.
fn divided_difference(times: &[f64], decay: &[f64], apart: &[f64]) -> Vec<f64> {
    let mut products = [0.0; TERMS];
    products[0] = 1.0;
    for d in apart {
        for q in 1..TERMS {
            products[q] += d * products[q - 1];
        }
    }
    let order = apart.len() - 1;
    let mut factorial = (1..=order).map(|i| i as f64).product::<f64>();
    let terms = if apart.iter().all(|d| *d == 0.0) { 1 } else { TERMS };
    for (q, product) in products.iter_mut().enumerate() {
        if q > 0 {
            factorial *= (order + q) as f64;
        }
        *product /= factorial;
    }
    let mut entries = vec![0.0; times.len()];
    // Horner's scheme over all times at once.
    accelerated(
        #[inline(always)]
        || {
            for product in products[..terms].iter().rev() {
                entries.iter_mut().zip(times).for_each(|(sum, time)| *sum = product - time * *sum);
            }
            for _ in 0..order {
                entries.iter_mut().zip(times).for_each(|(entry, time)| *entry *= -time);
            }
            entries.iter_mut().zip(decay).for_each(|(entry, decay)| *entry *= decay);
        },
    );
    entries
}
