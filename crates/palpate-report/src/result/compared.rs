//! Laws compared on the holds of a record, of relaxation and of creep alike.

use palpate::analysis::{Analysis, CreepHold, Finding, Signal};
use palpate::forecast::Comparison;
use palpate::segment::After;
use palpate::units::{quantity, suited};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::input::Input;
use super::words::condition;
use crate::word::word;

/// What the laws were fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Quantity {
    /// Strain of the contact layer.
    Strain,
    /// Force, N.
    Force,
    /// Displacement, m.
    Displacement,
}

/// One hold with the laws compared on it.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedHold {
    /// Number of the hold in the record, from 1.
    pub number: usize,
    /// What came before.
    pub after: Option<After>,
    /// Time of its first sample, s.
    pub start: f64,
    /// Time of its last sample, s.
    pub end: f64,
    /// Time from which the laws are fitted, s.
    pub fit_start: f64,
    /// What was held: the displacement, m, or in creep the force, N.
    pub level: Option<f64>,
    /// What the laws were fitted to.
    pub quantity: Quantity,
    /// Times since the start of the fit, s.
    pub times: Vec<f64>,
    /// The quantity at those times.
    pub values: Vec<f64>,
    /// The comparison; `None` where nothing could be fitted.
    pub comparison: Option<Comparison>,
    /// What to know about this hold.
    pub findings: Vec<Finding>,
}

/// One record with its holds.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedRecord {
    /// Where it came from.
    pub input: Input,
    /// Its holds.
    pub holds: Vec<ComparedHold>,
    /// What to know about the record as a whole.
    pub findings: Vec<Finding>,
}

/// A file on which nothing could be compared.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "LeftOutDocument")]
pub struct LeftOut {
    /// Path as given.
    pub path: String,
    /// Why.
    pub reason: String,
    /// What would help.
    pub hint: Option<String>,
}

impl Quantity {
    /// Its SI unit.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Strain => "1",
            Self::Force => "N",
            Self::Displacement => "m",
        }
    }

    /// Its SI unit at an axis: none of a strain.
    pub(crate) fn axis_unit(self) -> &'static str {
        if self == Self::Strain { "" } else { self.unit() }
    }

    /// The unit for people of values up to this size, and the factor to it.
    pub(crate) fn for_people(self, largest: f64) -> (&'static str, f64) {
        match self {
            Self::Strain => ("", 1.0),
            Self::Force => suited("N", largest),
            Self::Displacement => suited("m", largest),
        }
    }
}

impl From<Signal> for Quantity {
    fn from(signal: Signal) -> Self {
        match signal {
            Signal::Strain => Self::Strain,
            Signal::Force => Self::Force,
        }
    }
}

impl ComparedHold {
    /// "Hold 2, after loading, 10.00 mm", or "…, 6.00 N" in creep.
    pub(crate) fn title(&self) -> String {
        let condition = Some(self.condition()).filter(|condition| !condition.is_empty());
        format!("Hold {}{}", self.number, condition.map_or_else(String::new, |condition| format!(", {condition}")))
    }

    /// The same for the narrow head of a panel: "Hold 2, 10.00 mm".
    pub(crate) fn short_title(&self) -> String {
        let held = self.held().map_or_else(String::new, |held| format!(", {held}"));
        format!("Hold {}{held}", self.number)
    }

    /// What holds of one kind have in common: "after loading, 10.00 mm".
    pub(crate) fn condition(&self) -> String {
        condition(self.after.map(word).as_deref(), self.held())
    }

    /// What was held.
    fn held(&self) -> Option<String> {
        self.level.map(|level| match self.quantity {
            Quantity::Displacement => quantity(level, "N", 3),
            _ => held_at(level),
        })
    }
}

/// How far the jaw goes in a record, m.
pub(crate) fn travel(analysis: &Analysis) -> f64 {
    let places = analysis.record.displacement().unwrap_or_default();
    places.iter().fold(0.0, |most, place| most.max(place.abs()))
}

/// The displacement that a hold is held at, m, for people: what is less than a ten-thousandth of the travel is none, as after a return to first
/// touch.
pub(crate) fn displacement_held(displacement: Option<f64>, travel: f64) -> Option<f64> {
    /// Titles have four digits.
    const LEAST: f64 = 1e-4;
    displacement.map(|place| if place.abs() < LEAST * travel { 0.0 } else { place })
}

/// The displacement that a hold is held at, as titles have it.
pub(crate) fn held_at(displacement: f64) -> String {
    quantity(displacement, "m", 4)
}

impl ComparedRecord {
    /// The comparison in an analysis.
    #[must_use]
    pub fn of_analysis(analysis: &Analysis, input: Input) -> Self {
        let travel = travel(analysis);
        let holds = analysis.holds.iter().map(|hold| ComparedHold {
            number: hold.number,
            after: hold.after,
            start: hold.start,
            end: hold.end,
            fit_start: hold.fit_start,
            level: displacement_held(hold.displacement, travel),
            quantity: hold.signal.into(),
            times: hold.times[..hold.fitted].to_vec(),
            values: hold.values[..hold.fitted].to_vec(),
            comparison: hold.comparison.clone(),
            findings: hold.findings.clone(),
        });
        Self {
            input,
            holds: holds.collect(),
            findings: analysis.findings.clone(),
        }
    }

    /// Holds of creep.
    #[must_use]
    pub fn of_creep(holds: Vec<CreepHold>, findings: Vec<Finding>, input: Input) -> Self {
        let holds = holds.into_iter().map(|hold| ComparedHold {
            number: hold.number,
            after: hold.after,
            start: hold.start,
            end: hold.end,
            fit_start: hold.fit_start,
            level: Some(hold.force),
            quantity: Quantity::Displacement,
            times: hold.times,
            values: hold.displacement,
            comparison: hold.comparison,
            findings: hold.findings,
        });
        Self {
            input,
            holds: holds.collect(),
            findings,
        }
    }

    /// Whether any law could be judged on any hold.
    #[must_use]
    pub fn has_verdict(&self) -> bool {
        self.verdicts().next().is_some()
    }

    /// The holds on which laws could be judged.
    pub(crate) fn verdicts(&self) -> impl Iterator<Item = (&ComparedHold, &Comparison)> {
        let compared = self.holds.iter().filter_map(|hold| Some((hold, hold.comparison.as_ref()?)));
        compared.filter(|(_, comparison)| comparison.verdict.is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::{displacement_held, held_at};

    /// A hold at 10 µm had the title "Hold 1, 0.0 mm", and holds at 0.25 mm those of 0.2 mm and 0.3 mm.
    #[test]
    fn titles_tell_small_displacements_apart() {
        let titles = [1e-5, 0.249_999e-3, 0.250_001e-3, 0.0101].map(held_at);
        assert_eq!(titles, ["10.00 µm", "0.2500 mm", "0.2500 mm", "10.10 mm"]);
    }

    /// A hold after a return to first touch had the title "Hold 6, 3.000 nm".
    #[test]
    fn a_displacement_of_nothing_is_none() {
        let title = |place, travel| held_at(displacement_held(Some(place), travel).unwrap());
        assert_eq!(title(3e-9, 0.015), held_at(0.0));
        assert_eq!(title(-3e-9, 0.015), held_at(0.0));
        assert_eq!(title(3e-9, 1e-6), "3.000 nm");
    }
}
