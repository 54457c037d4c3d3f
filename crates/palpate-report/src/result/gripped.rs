//! What a planned grip is shown with.

use palpate::calibrate::Extrapolation;
use palpate::grip::{Answer, Control, Grip, GripError};

/// A body in a gripper with the answer to a question.
#[derive(Debug)]
pub struct GrippedBody<'a> {
    /// Path of the material file, as given.
    pub path: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
    /// Body, load and gripper.
    pub grip: Grip<'a>,
    /// The answer.
    pub answer: Answer,
}

impl GrippedBody<'_> {
    /// How the grip that is asked about goes beyond what the test has shown.
    #[must_use]
    pub fn extrapolations(&self) -> &[Extrapolation] {
        self.answer.course().map_or(&[], |course| &course.extrapolations)
    }

    /// Grips that there are not, by name, and why.
    #[must_use]
    pub fn refused(&self) -> Vec<(&'static str, &GripError)> {
        let answer = &self.answer;
        [
            ("squeeze", answer.squeeze.as_ref().err()),
            ("squeeze and back off", answer.back_off.as_ref().err()),
            ("force held", answer.force_hold.as_ref().err()),
            ("squeeze again", answer.schedule.as_ref().and_then(|made| made.as_ref().err())),
        ]
        .into_iter()
        .filter_map(|(name, error)| Some((name, error?)))
        .collect()
    }

    /// The grip that is asked about, by name.
    #[must_use]
    pub fn asked(&self) -> &'static str {
        match self.answer.question.control {
            Control::Position => "squeeze",
            Control::Force => "force held",
        }
    }
}
