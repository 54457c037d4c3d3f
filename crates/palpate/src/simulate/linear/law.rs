//! The terms of a linear law.

use serde::{Deserialize, Serialize};

use super::fractional::{Sum, sum_of};

/// A term g exp(−λ t) of a relaxation function G(t) = 1 + Σ g_k exp(−λ_k t).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LinearTerm {
    /// g, by how much of the equilibrium strain a sudden squeeze overshoots; above 0.
    pub overshoot: f64,
    /// λ in 1/s, the inverse of the relaxation time; above 0.
    pub rate: f64,
}

/// A linear law of relaxation G(t), 1 at the end.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LinearLaw {
    /// By rising rate, all different.
    terms: Vec<LinearTerm>,
    error: f64,
}

/// Invalid parameters of a linear law.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LinearLawError {
    /// No term at all.
    #[error("a linear law needs a term that relaxes, found none")]
    Empty,
    /// A parameter that is not finite and above zero.
    #[error("term {term}: {name} must be above 0 {unit}, found {found} {unit}")]
    NotPositive {
        /// Number of the term, from 1.
        term: usize,
        /// Which number.
        name: &'static str,
        /// Its unit.
        unit: &'static str,
        /// What was given.
        found: f64,
    },
    /// A parameter that no body has, and with which a simulation would not end.
    #[error("term {term}: {name} must be from {least:e} to {most:e}{unit}, found {found:e}{unit}")]
    OutOfRange {
        /// Number of the term, from 1.
        term: usize,
        /// Which number.
        name: &'static str,
        /// Its unit behind a blank, if it has one.
        unit: &'static str,
        /// What was given.
        found: f64,
        /// Least that is accepted.
        least: f64,
        /// Most that is accepted.
        most: f64,
    },
    /// An order that no fractional element has, or that is a logarithm in all but name.
    #[error("the order of a fractional law must be from 0.05 to below 1, found {found}")]
    Order {
        /// What was given.
        found: f64,
    },
    /// Times that span no range.
    #[error("a fractional law needs a shortest time and a longer longest time, found {shortest} s and {longest} s")]
    Window {
        /// Shortest time, s.
        shortest: f64,
        /// Longest time, s.
        longest: f64,
    },
}

/// Overshoots that are accepted: beyond them a body rests at nothing against what it bears at first, or relaxes by nothing.
const OVERSHOOTS: (f64, f64) = (1e-15, 1e15);

/// Rates that are accepted, 1/s: from the age of the universe to molecules.
const RATES: (f64, f64) = (1e-18, 1e15);

/// Relative difference of rates below which two terms are one.
const ALIKE: f64 = 1e-9;

impl LinearLaw {
    /// The law of these terms, in any order: a generalised Maxwell body, a Prony series.
    ///
    /// ```
    /// use palpate::simulate::{LinearLaw, LinearTerm};
    /// let law = LinearLaw::new(&[LinearTerm { overshoot: 1.0, rate: 0.5 }, LinearTerm { overshoot: 0.5, rate: 0.01 }])?;
    /// assert_eq!(law.relaxation(0.0), 2.5);
    /// # Ok::<(), palpate::simulate::LinearLawError>(())
    /// ```
    ///
    /// # Errors
    /// [`LinearLawError`] for no terms, for overshoots that are not from 1e-15 to 1e15, and for rates that are not from 1e-18 to 1e15 1/s.
    pub fn new(terms: &[LinearTerm]) -> Result<Self, LinearLawError> {
        for (index, term) in terms.iter().enumerate() {
            let both = [("overshoot", "", term.overshoot, OVERSHOOTS), ("rate", "1/s", term.rate, RATES)];
            for (name, unit, found, (least, most)) in both {
                if !(found.is_finite() && found > 0.0) {
                    let term = index + 1;
                    return Err(LinearLawError::NotPositive {
                        term,
                        name,
                        unit,
                        found,
                    });
                }
                if !(least..=most).contains(&found) {
                    return Err(LinearLawError::OutOfRange {
                        term: index + 1,
                        name,
                        unit: if unit.is_empty() { "" } else { " 1/s" },
                        found,
                        least,
                        most,
                    });
                }
            }
        }
        match terms {
            [] => Err(LinearLawError::Empty),
            terms => Ok(Self::merged(terms.to_vec())),
        }
    }

    /// The law of terms that were checked.
    fn merged(mut sorted: Vec<LinearTerm>) -> Self {
        sorted.sort_by(|a, b| a.rate.total_cmp(&b.rate));
        let mut merged: Vec<LinearTerm> = Vec::with_capacity(sorted.len());
        for term in sorted {
            match merged.last_mut().filter(|last| term.rate - last.rate <= ALIKE * term.rate) {
                Some(last) => last.overshoot += term.overshoot,
                None => merged.push(term),
            }
        }
        Self {
            terms: merged,
            error: 0.0,
        }
    }

    /// The standard linear solid: one term with this relaxation time in s.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn standard(overshoot: f64, time: f64) -> Result<Self, LinearLawError> {
        let rate = 1.0 / time;
        Self::new(&[LinearTerm { overshoot, rate }])
    }

    /// Fung's reduced relaxation function g(t) = c₀ + Σ cᵢ exp(−νᵢ t), Σc = 1, with `terms` of cᵢ and νᵢ (1/s): G = g/c₀.
    ///
    /// # Errors
    /// As for [`new`](Self::new); a c₀ that is not above 0 leaves no equilibrium to relax to.
    pub fn fung(terms: &[(f64, f64)]) -> Result<Self, LinearLawError> {
        let rest = 1.0 - terms.iter().map(|(share, _)| share).sum::<f64>();
        if !(rest.is_finite() && rest > 0.0) {
            return Err(LinearLawError::NotPositive {
                term: 0,
                name: "c0 = 1 - the other shares",
                unit: "",
                found: rest,
            });
        }
        let term = |&(share, rate): &(f64, f64)| LinearTerm {
            overshoot: share / rest,
            rate,
        };
        Self::new(&terms.iter().map(term).collect::<Vec<_>>())
    }

    /// The fractional Zener law G(t) = 1 + g E_α(−(t/τ)^α), as a sum of exponentials good from the time `shortest` to `longest` (s); how
    /// good is [`error`](Self::error).
    ///
    /// E_α(−s^α) is a sum of exponentials of all rates r with the density sin(πα)/π · r^α/(r^{2α} + 2 r^α cos πα + 1) over ln r (Gross 1947);
    /// the sum is that of the trapezoidal rule.
    ///
    /// ```
    /// use palpate::simulate::LinearLaw;
    /// let law = LinearLaw::fractional(2.0, 5.0, 0.5, (1e-2, 1e3))?;
    /// // E_½(−√s) = exp(s) erfc(√s), 0.427583576… at s = 1
    /// assert!((law.relaxation(5.0) - (1.0 + 2.0 * 0.427_583_576_155_807)).abs() < 1e-7);
    /// assert!(law.error() < 1e-7);
    /// # Ok::<(), palpate::simulate::LinearLawError>(())
    /// ```
    ///
    /// # Errors
    /// [`LinearLawError`] for an order that is not from 0.05 to below 1, an overshoot or a time that is not above 0, and a window of no width.
    pub fn fractional(
        overshoot: f64,
        time: f64,
        order: f64,
        (shortest, longest): (f64, f64),
    ) -> Result<Self, LinearLawError> {
        if !(0.05..1.0).contains(&order) {
            return Err(LinearLawError::Order { found: order });
        }
        if !(shortest > 0.0 && longest > shortest && longest.is_finite()) {
            return Err(LinearLawError::Window { shortest, longest });
        }
        let unit = LinearTerm {
            overshoot,
            rate: 1.0 / time,
        };
        Self::new(&[unit])?;
        let Sum { terms, error } = sum_of(order, (shortest / time, longest / time));
        let scaled = terms.into_iter().map(|(weight, rate)| LinearTerm {
            overshoot: overshoot * weight,
            rate: rate / time,
        });
        Ok(Self {
            error: overshoot * error,
            ..Self::merged(scaled.collect())
        })
    }

    /// The terms, by rising rate.
    #[must_use]
    pub fn terms(&self) -> &[LinearTerm] {
        &self.terms
    }

    /// By how much G is off at most, over the times it was made for; 0 of a law that is a sum of exponentials itself.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.error
    }

    /// G(t) at a time ≥ 0 (s).
    #[must_use]
    pub fn relaxation(&self, time: f64) -> f64 {
        1.0 + self.terms.iter().map(|term| term.overshoot * (-term.rate * time).exp()).sum::<f64>()
    }

    /// Σ g_k.
    pub(super) fn overshoot(&self) -> f64 {
        self.terms.iter().map(|term| term.overshoot).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_alike_are_one_and_wrong_ones_are_refused() {
        let term = |overshoot, rate| LinearTerm { overshoot, rate };
        let law = LinearLaw::new(&[term(1.0, 2.0), term(0.5, 0.1), term(3.0, 2.0)]).unwrap();
        assert_eq!(law.terms(), [term(0.5, 0.1), term(4.0, 2.0)]);
        assert_eq!(LinearLaw::new(&[]), Err(LinearLawError::Empty));
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(LinearLaw::new(&[term(bad, 1.0)]).is_err() && LinearLaw::new(&[term(1.0, bad)]).is_err());
            assert!(LinearLaw::standard(1.0, bad).is_err(), "{bad}");
        }
        for bad in [1e300, 1e-300] {
            let refused = LinearLaw::new(&[term(bad, 1.0)]).unwrap_err().to_string();
            assert!(refused.starts_with("term 1: overshoot must be from 1e-15 to 1e15, found "), "{refused}");
            assert!(LinearLaw::new(&[term(1.0, bad)]).is_err());
        }
        assert!(LinearLaw::fung(&[(0.6, 1.0), (0.4, 0.1)]).is_err());
        let fung = LinearLaw::fung(&[(0.3, 1.0), (0.2, 0.1)]).unwrap();
        assert!((fung.relaxation(0.0) - 2.0).abs() < 1e-15);
        assert!(LinearLaw::fractional(1.0, 1.0, 1.0, (0.1, 1.0)).is_err());
        assert!(LinearLaw::fractional(1.0, 1.0, 0.5, (1.0, 1.0)).is_err());
    }
}
