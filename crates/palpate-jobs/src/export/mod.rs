//! A material as a card of another simulator: native text with its range and its error.
//!
//! | file | what |
//! |---|---|
//! | `options.rs` | the engines, and the options of the job |
//! | `model.rs` | the contact or the Prony series of an engine, fitted to a material |
//! | `card.rs` | a card: the fit with all that its text says |
//! | `header.rs` | the comment at the head of a card |
//! | `numbers.rs` | numbers as plain ASCII |
//! | `engines/` | the text of each engine |
//! | `document.rs` | a card for programs |

mod card;
mod document;
mod engines;
mod header;
mod model;
mod numbers;
mod options;

use palpate::calibrate::Material;
use palpate::export::{Conditions, ExportError, Loading};
use palpate::simulate::{Motion, Sampling};
use palpate::watch::{Progress, Watch};

pub use card::Card;
pub use document::{CardDocument, CardHoldError, CardParameter, CardPronyTerm};
pub use options::{Engine, Export};

use crate::{ErrorKind, JobError, MaterialSource, Outcome, Results};
use model::Model;

/// Share of the fastest speed that is the slowest of a card where the test has one speed.
const WIDEST: f64 = 0.5;

/// The same where a card for so wide a range has an error that needs a note. Narrower ranges hardly tell spring and damper apart.
const NARROWER: [f64; 4] = [0.6, 0.7, 0.8, 0.9];

impl Export {
    /// The conditions, where they are not given those of the test, and whether the slowest speed is neither given nor that of a test.
    fn conditions(&self, material: &Material) -> Result<(Conditions, bool), JobError> {
        let range = material.range();
        let fastest = self.speed_m_per_s.unwrap_or(range.fastest);
        let tested = Some(range.slowest).filter(|slowest| *slowest < 0.95 * fastest);
        let slowest = self.slowest_m_per_s.or(tested);
        let depth = self.depth_m.unwrap_or(range.deepest);
        let speeds = (slowest.unwrap_or(WIDEST * fastest), fastest);
        let conditions = Conditions::new(depth, speeds, self.hold_s).map_err(|error| refused(&error))?;
        Ok((conditions, slowest.is_none()))
    }

    /// The fit to these conditions or, where the slowest speed is free, to the widest range of speeds at which it needs no note.
    fn fitted(
        &self,
        material: &Material,
        (widest, is_free): (Conditions, bool),
    ) -> Result<(Conditions, Loading, Model), JobError> {
        let fit = |conditions: Conditions| {
            let loading = Loading::of(material.contact(), conditions).map_err(|error| refused(&error))?;
            let model = Model::fit(self, material, conditions, &loading)?;
            Ok::<_, JobError>((conditions, loading, model))
        };
        let needs_note = |(_, _, model): &(Conditions, Loading, Model)| model.noted_error().is_some();
        let found = fit(widest)?;
        if !is_free || !needs_note(&found) {
            return Ok(found);
        }
        for share in NARROWER {
            let mut conditions = widest;
            conditions.slowest = share * widest.fastest;
            // A range that determines no fit is none to choose.
            match fit(conditions) {
                Ok(narrower) if !needs_note(&narrower) => return Ok(narrower),
                _ => {}
            }
        }
        Ok(found)
    }

    /// The card of a material.
    ///
    /// # Errors
    /// [`JobError`] where an option is wrong, the body does not have the depth, or the engine's contact does not take the body.
    pub fn run(&self, source: &MaterialSource, watch: &mut dyn Watch) -> Result<Outcome<Card>, JobError> {
        self.check()?;
        let material = &source.file.material;
        let (conditions, is_free) = self.conditions(material)?;
        let duration = conditions.depth / conditions.fastest;
        let motion =
            Motion::new(vec![0.0, duration, duration + conditions.hold], vec![0.0, conditions.depth, conditions.depth])
                .map_err(|error| refused(&error.into()))?;
        // What is beyond the test: the largest force is that at the end of loading.
        let both_ends = Sampling::Times(vec![duration, duration + conditions.hold]);
        let predicted = material.predict_watched(&motion, &both_ends, 0.95, watch).map_err(|error| {
            let deepest = numbers::short(1e3 * material.range().deepest);
            let mut refused = JobError::simulation(error).of(&source.name);
            if refused.kind == ErrorKind::Model {
                refused.hint = Some(format!("the test went to {deepest} mm: ⟨depth={deepest}mm⟩"));
            }
            refused
        })?;
        watch.report(Progress::open("fitting", 0))?;
        let (conditions, loading, model) = self.fitted(material, (conditions, is_free))?;
        let extrapolations: Vec<String> = predicted.extrapolations.iter().map(ToString::to_string).collect();
        let card = Card::new(self, source, (conditions, loading), model, extrapolations);
        let mut notes: Vec<String> =
            card.extrapolations.iter().map(|text| format!("beyond the test: {text}")).collect();
        if let Some(error) = card.model.noted_error() {
            notes.push(format!(
                "the contact of {} has an error of up to {} % of the peak force in loading",
                self.engine.title(),
                numbers::short(100.0 * error)
            ));
        }
        Ok(Outcome::of(card).noted(notes))
    }
}

impl Results for Card {
    type Document = CardDocument;

    fn document(&self) -> CardDocument {
        CardDocument::new(self)
    }

    fn text(&self) -> String {
        engines::text(self)
    }
}

/// What the library refuses.
fn refused(error: &ExportError) -> JobError {
    let (kind, hint) = match error {
        ExportError::Condition { .. } | ExportError::Motion(_) => (ErrorKind::Option, None),
        ExportError::NoMixture { .. } => {
            (ErrorKind::Model, Some("calibrate with ⟨law=latency:2⟩ or another exponent above 1".to_owned()))
        }
        ExportError::NoRelaxation => (ErrorKind::Model, Some("an elastic card needs the modulus alone".to_owned())),
        _ => (ErrorKind::Model, None),
    };
    JobError::new(kind, error, hint)
}
