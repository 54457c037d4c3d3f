//! What a planned grip is shown with.

use palpate::calibrate::{Extrapolation, Misfit, Prediction};
use palpate::grip::{Answer, Control, Grip, GripError};

/// A body in a gripper with the answer to a question.
#[derive(Debug)]
pub struct GrippedBody<'a> {
    /// Path of the material file, as given.
    pub path: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
    /// SHA-256 over the material, the settings and the build: equal digests stand for equal plans.
    pub depends_on_sha256: String,
    /// What its record shows against the law of the material.
    pub misfit: Option<Misfit>,
    /// Body, load and gripper.
    pub grip: Grip<'a>,
    /// The answer.
    pub answer: Answer,
}

impl GrippedBody<'_> {
    /// How the grip that is in question goes beyond what the test has shown.
    #[must_use]
    pub fn extrapolations(&self) -> &[Extrapolation] {
        self.answer.course().map_or(&[], |course| &course.extrapolations)
    }

    /// Grips that there are not, by name, and why.
    #[must_use]
    pub fn refused(&self) -> Vec<(&'static str, &GripError)> {
        let names = ["squeeze", "overshoot and back off", "force held", "squeeze again"];
        names.into_iter().zip(self.grips()).filter_map(|(name, made)| Some((name, made?.err()?))).collect()
    }

    /// Squeeze, overshoot and back off, force held and schedule: the course of each, or why there is none; a schedule only if one was requested.
    #[must_use]
    pub fn grips(&self) -> [Option<Result<&Prediction, &GripError>>; 4] {
        let answer = &self.answer;
        [
            Some(answer.squeeze.as_ref().map(|made| &made.course)),
            Some(answer.back_off.as_ref().map(|made| &made.course)),
            Some(answer.force_hold.as_ref().map(|made| &made.course)),
            answer.schedule.as_ref().map(|made| made.as_ref().map(|made| &made.course)),
        ]
    }

    /// The grip that is in question, by name.
    #[must_use]
    pub fn requested(&self) -> &'static str {
        match self.answer.question.control {
            Control::Position => "squeeze",
            Control::Force => "force held",
        }
    }
}
