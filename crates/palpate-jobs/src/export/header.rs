//! The comment at the head of a card: what it is fitted to, its error, and what the engine cannot show.

use palpate::contact::Sides;
use palpate::export::HOLD_TIMES;
use palpate_report::document::Software;

use super::card::Card;
use super::model::Model;
use super::numbers::{short, signed};
use super::options::Engine;

/// Share of the peak force at first touch that is worth a line.
const LEAST_TOUCH: f64 = 1e-3;

/// Width of the lines of a comment.
const WIDTH: usize = 110;

impl Card {
    /// The sentences at the head of the card, then those of the engine.
    pub(super) fn head(&self, engine: &[String]) -> Vec<String> {
        let title = self.options.engine.title();
        let (name, sha256) = &self.material;
        let mut head = vec![
            format!("{title} card of the material {}, by palpate {}", plain(name), Software::this().version),
            format!("SHA-256 of the material: {sha256}"),
            format!("Law: {}", plain(&self.law)),
            self.fitted(),
        ];
        head.extend(self.errors());
        head.extend(self.limits());
        head.extend(self.extrapolations.iter().map(|text| format!("Beyond the test: {}", plain(text))));
        head.extend(engine.iter().map(|text| plain(text)));
        head.iter().flat_map(|sentence| wrapped(sentence)).collect()
    }

    /// Ranges of depth, speed and time.
    fn fitted(&self) -> String {
        let conditions = self.conditions;
        let share = self.body.contact_displacement(1.0);
        let at = |value: f64| short(1e3 * value);
        let held = match self.body.sides() {
            Sides::One => ", all of it at one contact of a body whose back is held",
            Sides::Two => "",
        };
        let contact = |low: f64, high: f64, unit: &str| {
            if share == 1.0 {
                String::new()
            } else {
                format!(" ({} to {} {unit} at each contact)", at(low), at(share * high))
            }
        };
        match &self.model {
            Model::Continuum(_) => format!(
                "Fitted to: a hold of 0 to {} s at {} mm of jaw travel{} after loading at {} mm/s",
                short(conditions.hold),
                at(conditions.depth),
                if share == 1.0 {
                    String::new()
                } else {
                    format!(" ({} mm at each contact)", at(share * conditions.depth))
                },
                at(conditions.fastest)
            ),
            _ => format!(
                "Fitted to: loading from {} to {} mm of jaw travel{} at {} to {} mm/s of the jaw{}{held}",
                at(self.loading.shallowest() / share),
                at(conditions.depth),
                contact(self.loading.shallowest(), conditions.depth, "mm"),
                at(conditions.slowest),
                at(conditions.fastest),
                contact(share * conditions.slowest, conditions.fastest, "mm/s")
            ),
        }
    }

    fn errors(&self) -> Vec<String> {
        let percent = |share: f64| short(100.0 * share);
        let peak = short(self.loading.peak);
        let mut errors = Vec::new();
        match &self.model {
            Model::Continuum(solid) => errors.push(format!(
                "Error of the Prony series: at most {} % of the force at the start of the hold, {peak} N",
                percent(solid.worst)
            )),
            _ => errors.extend(self.model.contact_error().map(|error| {
                format!(
                    "Error in loading: at most {} %, root mean square {} %, of the peak force of {peak} N",
                    percent(error.loading),
                    percent(error.loading_rms)
                )
            })),
        }
        errors.extend(self.model.contact_error().filter(|error| error.touch > LEAST_TOUCH).map(|error| {
            format!(
                "Error at first touch: the damper has {} % of the peak force there at once, the material none",
                percent(error.touch)
            )
        }));
        let at = HOLD_TIMES.iter().zip(self.model.hold_error());
        let at: Vec<String> = at.map(|(time, error)| format!("{} % at {time} s", signed(100.0 * error))).collect();
        errors.push(format!(
            "Error in a hold at {} mm after loading at {} mm/s, in % of the peak force: {}",
            short(1e3 * self.conditions.depth),
            short(1e3 * self.conditions.fastest),
            at.join(", ")
        ));
        errors
    }

    /// What the engine cannot show.
    fn limits(&self) -> Vec<String> {
        let title = self.options.engine.title();
        if let Model::Continuum(_) = self.model {
            let step = if self.options.engine == Engine::Abaqus { " (in a *STATIC step)" } else { "" };
            return vec![
                format!(
                    "What {title} cannot show with it: a Prony series is linear and of this depth and loading only. The relative rate \
                     of the latency law depends on the excess strain at the start of the hold; another depth, speed or history relaxes \
                     with other time constants"
                ),
                format!(
                    "Load within a time much shorter than the smallest time constant{step}, then hold: the series begins at the \
                     start of the hold"
                ),
                "The modulus is that of the contact law of the material; a mesh of the same body need not have its force"
                    .to_owned(),
            ];
        }
        let damping = match self.options.engine {
            Engine::Drake => "in proportion to the force",
            _ => "linearly",
        };
        let memory = format!(
            "What {title} cannot show: its contact has no memory. The force in a hold is constant, its damping part vanishes when the jaw \
             stops, a second squeeze is like the first, and speed changes the force {damping}"
        );
        let held = "Squeezed from one side: hold the back of the body, by a plate or the finger that it is on. Two jaws on a free body are \
                    two such contacts in series, with half of the force or less; a body between two jaws needs squeezed_from = 'two sides'";
        let pulls = format!(
            "separation = false in the material: its jaws can pull on the body. The contact of {title} only presses, and its force ends at 0; \
             a material of jaws that only press is calibrated with separation = true in [contact]"
        );
        let mut limits = vec![memory];
        limits.extend(self.is_bonded.then_some(pulls));
        limits.extend((self.body.sides() == Sides::One).then(|| held.to_owned()));
        limits
    }
}

/// Text that no comment ends early, on one line, in ASCII where the program of the card may want that.
fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '−' | '–' => plain.push('-'),
            letter if letter.is_ascii() && !letter.is_ascii_control() => plain.push(letter),
            letter if letter.is_whitespace() => plain.push(' '),
            _ => plain.push('?'),
        }
    }
    // Two hyphens end no comment of XML, but are not allowed in one.
    while plain.contains("--") {
        plain = plain.replace("--", "- -");
    }
    plain.replace("*/", "* /").replace("\"\"\"", "'''")
}

/// A sentence in lines; those after the first are indented.
fn wrapped(sentence: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    for word in sentence.split_whitespace() {
        if !line.is_empty() && line.len() + 1 + word.len() > WIDTH {
            lines.push(std::mem::replace(&mut line, "   ".to_owned()));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines.push(line);
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_of_a_file_ends_a_comment() {
        assert_eq!(plain("a--b---c\n*/ \"\"\" −1 é"), "a- -b- - -c * / ''' -1 ?");
        assert!(!plain("-----").contains("--"));
    }

    #[test]
    fn sentences_are_wrapped_at_words() {
        let lines = wrapped(&"word ".repeat(60));
        assert!(lines.len() == 3 && lines.iter().all(|line| line.len() <= WIDTH) && lines[1].starts_with("    word"));
    }
}
