//! What defines a law: its name, what it is in words, and the basis functions that it is composed of.

use super::BasisFunction;

/// A law in words: what tables, figures and help show of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Description {
    /// Name in running text, such as "standard linear solid".
    pub title: &'static str,
    /// The law for relaxation, or for creep if it has no other form.
    pub equation: &'static str,
    /// Where it is used or comes from.
    pub source: &'static str,
}

/// The signal of a law: a constant or none, and a sum of amplitudes times basis functions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Composition {
    /// Whether the constant is estimated; else it is 0 unless given.
    pub constant: bool,
    /// The basis functions, each with an amplitude.
    pub basis: &'static [BasisFunction],
}

impl Composition {
    /// Amplitudes times these basis functions.
    #[must_use]
    pub const fn of(basis: &'static [BasisFunction]) -> Self {
        Self { constant: false, basis }
    }

    /// A constant and amplitudes times these basis functions.
    #[must_use]
    pub const fn with_constant(basis: &'static [BasisFunction]) -> Self {
        Self { constant: true, basis }
    }
}

/// A law as it is defined, by this crate or by another one ([`Law::Custom`](super::Law::Custom)).
///
/// Williams' modified power law, E∞ + (E₀ − E∞)/(1 + t/τ)^α, needs a constant beside a basis function that exists:
///
/// ```
/// use palpate::fit::{LawOptions, Samples, fit_law};
/// use palpate::laws::{BasisFunction, Composition, Description, Law, LawDefinition};
/// static MODIFIED_POWER: LawDefinition = LawDefinition {
///     name: "modified-power",
///     description: Description {
///         title: "modified power",
///         equation: "y_e + Δ (1 + t/τ)^(−α)",
///         source: "Williams 1964",
///     },
///     relaxation: Some(Composition::with_constant(&[BasisFunction::PowerDecay])),
///     creep: None,
///     contains_exponential: false,
/// };
/// let times: Vec<f64> = (0..200).map(|i| 0.05 * f64::from(i)).collect();
/// let force: Vec<f64> = times.iter().map(|t| 2.0 + 3.0 * (1.0 + t / 0.5f64).powf(-0.7)).collect();
/// let fit = fit_law(&Samples::new(&times, &force), Law::Custom(&MODIFIED_POWER), &LawOptions::default())?;
/// assert!((fit.value("equilibrium").unwrap() - 2.0).abs() < 1e-6);
/// assert!((fit.value("exponent").unwrap() - 0.7).abs() < 1e-6);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct LawDefinition {
    /// Name as it is written; two laws of one name are one law.
    pub name: &'static str,
    /// What it is in words.
    pub description: Description,
    /// Its form for relaxation, if it has one.
    pub relaxation: Option<Composition>,
    /// Its form for creep, if it has one. A basis function that decays counts as 1 − function there.
    pub creep: Option<Composition>,
    /// Whether some values of its parameters make it the standard linear solid, so that it fits no worse.
    pub contains_exponential: bool,
}

impl PartialEq for LawDefinition {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}
