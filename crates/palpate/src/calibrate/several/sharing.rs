//! Which parameters have one value for all records.

use std::convert::Infallible;
use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::SeveralError;
use crate::calibrate::{Candidate, Material};
use crate::units::without_unit;

/// Which parameters have one value for all records; the others are each record's own.
///
/// ```
/// use palpate::calibrate::Sharing;
/// assert_eq!("all".parse(), Ok(Sharing::All));
/// assert_eq!("exponent, layer_thickness".parse(), Ok(Sharing::Named(vec!["exponent".into(), "layer_thickness".into()])));
/// assert_eq!(Sharing::default().to_string(), "none");
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(into = "String", from = "String")]
pub enum Sharing {
    /// None: every record has its own parameters.
    #[default]
    None,
    /// All: the records are tests of one body.
    All,
    /// Those with these names, with their unit or without: `rate_coefficient_per_s` or `rate_coefficient`.
    Named(Vec<String>),
}

impl From<String> for Sharing {
    fn from(text: String) -> Self {
        match text.trim() {
            "none" | "" => Self::None,
            "all" => Self::All,
            names => Self::Named(names.split(',').map(|name| name.trim().to_owned()).collect()),
        }
    }
}

impl FromStr for Sharing {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(text.to_owned().into())
    }
}

impl From<Sharing> for String {
    fn from(sharing: Sharing) -> Self {
        sharing.to_string()
    }
}

impl fmt::Display for Sharing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("none"),
            Self::All => f.write_str("all"),
            Self::Named(names) => f.write_str(&names.join(",")),
        }
    }
}

/// Places of the parameters among those of the material, and of all of them in one vector: the shared ones first, then the own ones of
/// record after record.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    /// Parameters of the material that are shared.
    pub(super) shared: Vec<usize>,
    /// Parameters of the material that are each record's own.
    pub(super) own: Vec<usize>,
    pub(super) records: usize,
}

impl Layout {
    /// # Errors
    /// [`SeveralError::UnknownParameter`] for a name that the candidate does not estimate.
    pub(super) fn new(sharing: &Sharing, candidate: Candidate, records: usize) -> Result<Self, SeveralError> {
        let names: Vec<String> = Material::names(candidate, 0).into_iter().map(|(name, _)| name).collect();
        let free: Vec<usize> = (0..names.len()).filter(|i| !Material::is_given(candidate, &names[*i])).collect();
        let is = |index: usize, name: &str| names[index] == name || without_unit(&names[index]) == name;
        if let Sharing::Named(wanted) = sharing
            && let Some(unknown) = wanted.iter().find(|name| !free.iter().any(|index| is(*index, name)))
        {
            return Err(SeveralError::UnknownParameter {
                name: unknown.clone(),
                names: free.iter().map(|index| names[*index].clone()).collect(),
            });
        }
        let is_shared = |index: &usize| match sharing {
            Sharing::None => false,
            Sharing::All => true,
            Sharing::Named(wanted) => wanted.iter().any(|name| is(*index, name)),
        };
        let (shared, own) = free.into_iter().partition(is_shared);
        Ok(Self { shared, own, records })
    }

    /// All parameters.
    pub(super) fn size(&self) -> usize {
        self.shared.len() + self.records * self.own.len()
    }

    /// Where those of a record stand in the vector: the shared, then its own.
    pub(super) fn places(&self, record: usize) -> Vec<usize> {
        (0..self.shared.len()).chain(self.own_places(record)).collect()
    }

    /// Where the own ones of a record stand.
    pub(super) fn own_places(&self, record: usize) -> std::ops::Range<usize> {
        let first = self.shared.len() + record * self.own.len();
        first..first + self.own.len()
    }

    /// Where the own parameter number `at` of each record stands.
    pub(super) fn places_of_own(&self, at: usize) -> Vec<usize> {
        (0..self.records).map(|record| self.own_places(record).start + at).collect()
    }

    /// Parameters of the material in the order of [`places`](Self::places).
    pub(super) fn parameters(&self) -> Vec<usize> {
        self.shared.iter().chain(&self.own).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::EquilibriumLaw;

    #[test]
    fn shared_parameters_come_first_and_unknown_names_are_refused_with_the_known() {
        let candidate = Candidate::new("latency".parse().unwrap(), EquilibriumLaw::UniformStrain);
        let named = |text: &str| Layout::new(&text.parse().unwrap(), candidate, 3);
        let layout = named("rate_coefficient,exponent").unwrap();
        assert_eq!((layout.shared.clone(), layout.own.clone(), layout.size()), (vec![1, 2], vec![0, 3], 8));
        assert_eq!(layout.places(2), [0, 1, 6, 7]);
        assert_eq!(named("none").unwrap().size(), 12);
        assert_eq!(named("all").unwrap().size(), 4);
        assert_eq!(named("rate_coefficient_per_s").unwrap().shared, [2]);
        let refused = named("exponent,stiffness").unwrap_err().to_string();
        assert!(refused.contains("\"stiffness\"") && refused.contains("modulus_pa, exponent"), "{refused}");
        let given = Candidate::new("latency:5".parse().unwrap(), EquilibriumLaw::UniformStrain);
        assert!(Layout::new(&"exponent".parse().unwrap(), given, 3).is_err());
    }
}
