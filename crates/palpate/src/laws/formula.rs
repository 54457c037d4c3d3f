//! A law with its parameters put in, as people write it.

use super::{BasisFunction, Column, LawCurve, Term};
use crate::number::significant;
use crate::units::quantity;

/// Significant digits of a parameter in a formula.
const DIGITS: usize = 4;

impl LawCurve {
    /// The law as a formula: `F(t) = 2.000 N + 3.000 N · exp(−t/4.000 s)`.
    ///
    /// `symbol` stands for the signal and `unit` is its SI unit, empty for strain; amplitudes and times stand in the units that suit
    /// their size, to four digits. E_α is the Mittag-Leffler function, E₁ the exponential integral.
    ///
    /// ```
    /// use palpate::laws::{BasisFunction, LawCurve, Response, Term};
    /// let term = Term { amplitude: 0.1, shape: BasisFunction::LatencyWith(5.0), parameters: vec![0.5f64.ln()] };
    /// let curve = LawCurve { response: Response::Relaxation, constant: 0.2, terms: vec![term] };
    /// assert_eq!(curve.formula("ε", ""), "ε(t) = 0.2000 + 0.1000 · (1 + 4 · 0.5000 s⁻¹ · t)^(−1/4)");
    /// ```
    #[must_use]
    pub fn formula(&self, symbol: &str, unit: &str) -> String {
        let mut parts: Vec<(bool, String)> = Vec::new();
        if self.constant != 0.0 || self.terms.is_empty() {
            parts.push((self.constant < 0.0, quantity(self.constant.abs(), unit, DIGITS)));
        }
        for term in &self.terms {
            let column = Column::of(&term.shape, self.response);
            let shape = shape(term);
            let shape = if column.offset == 0.0 { shape } else { format!("[1 − {shape}]") };
            let negative = (term.amplitude < 0.0) != (column.offset == 0.0 && column.sign < 0.0);
            parts.push((negative, format!("{} · {shape}", quantity(term.amplitude.abs(), unit, DIGITS))));
        }
        let mut text = format!("{symbol}(t) =");
        for (index, (negative, part)) in parts.iter().enumerate() {
            text.push_str(match (index, negative) {
                (0, false) => " ",
                (0, true) => " −",
                (_, false) => " + ",
                (_, true) => " − ",
            });
            text.push_str(part);
        }
        text
    }
}

/// A shape as a function of t.
fn shape(term: &Term) -> String {
    let log_rate = term.parameters.first().copied().unwrap_or(0.0);
    let (rate, time) = (log_rate.exp(), quantity((-log_rate).exp(), "s", DIGITS));
    let second = term.parameters.get(1).copied().unwrap_or(1.0);
    let latency = |n: f64| match n {
        1.0 => format!("exp(−{} s⁻¹ · t)", significant(rate, DIGITS)),
        n => {
            let order = short(n - 1.0);
            format!("(1 + {order} · {} s⁻¹ · t)^(−1/{order})", significant(rate, DIGITS))
        }
    };
    match term.shape {
        BasisFunction::Latency => latency(second),
        BasisFunction::LatencyWith(n) => latency(n),
        BasisFunction::Exponential => format!("exp(−t/{time})"),
        BasisFunction::Stretched => format!("exp(−(t/{time})^{})", short(second)),
        BasisFunction::PowerDecay => format!("(1 + t/{time})^(−{})", short(second)),
        BasisFunction::PowerGrowth => format!("(t/{time})^{}", short(second)),
        BasisFunction::Logarithm => format!("ln(1 + t/{time})"),
        BasisFunction::MittagLeffler => format!("E_α(−(t/{time})^α) with α = {}", short(second)),
        BasisFunction::FungContinuous => {
            let fastest = quantity((-log_rate - second).exp(), "s", DIGITS);
            format!("[E₁(t/{time}) − E₁(t/{fastest})]/{}", short(second))
        }
        BasisFunction::Diffusion => format!("(8/π²) Σ_k exp(−k² t/{time})/k² over odd k"),
        BasisFunction::Straight => format!("t/{time}"),
        BasisFunction::Custom(custom) => {
            custom.kernel.formula(&term.parameters).unwrap_or_else(|| format!("{}(t)", custom.name))
        }
    }
}

/// A dimensionless parameter: 4 where it is whole, 3.853 where it is not.
fn short(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e4 {
        format!("{value}").replace('-', "−")
    } else {
        significant(value, DIGITS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::{LawOptions, Samples, fit_law};
    use crate::laws::{Law, Response};
    use crate::test_problems::noisy_hold;

    #[test]
    fn every_law_has_a_formula_with_its_values() {
        let (times, values) = noisy_hold(300, 3.0, 1e-4);
        for (law, words) in [
            ("latency", " s⁻¹ · t)^(−1/"),
            ("latency:1", "exp(−"),
            ("prony:2", "exp(−t/"),
            ("stretched", "exp(−(t/"),
            ("power", "(1 + t/"),
            ("logarithmic", " − "),
            ("fractional-zener", "E_α(−(t/"),
            ("fung-continuous", "E₁(t/"),
            ("diffusion", "Σ_k"),
        ] {
            let law: Law = law.parse().unwrap();
            let fit = fit_law(&Samples::new(&times, &values), law, &LawOptions::default()).unwrap();
            let formula = fit.curve.formula("F", "N");
            assert!(formula.starts_with("F(t) = ") && formula.contains(words) && formula.contains(" N"), "{formula}");
        }
    }

    #[test]
    fn creep_rises_from_its_start() {
        let term = Term {
            amplitude: 2e-3,
            shape: BasisFunction::Exponential,
            parameters: vec![-(5f64.ln())],
        };
        let curve = LawCurve {
            response: Response::Creep,
            constant: 1e-2,
            terms: vec![term],
        };
        assert_eq!(curve.formula("u", "m"), "u(t) = 10.00 mm + 2.000 mm · [1 − exp(−t/5.000 s)]");
    }
}
