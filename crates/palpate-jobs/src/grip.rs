//! A material between two jaws: will it hold, and how to squeeze.

use std::path::Path;

use palpate::calibrate::Material;
use palpate::grip::{
    Band, Control, Grasp, Grip, GripError, Limits, Objective, Plan, Question, Regrip, STANDARD_GRAVITY,
};
use palpate::watch::{Progress, Watch};
use palpate_files::description::{MaterialFile, parse_material, read_text};
use palpate_report::document::GripDocument;
use palpate_report::result::{GrippedBody, TriedSqueeze};
use palpate_report::study::grip_text;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::depends::Dependencies;
use crate::options::checked_confidence;
use crate::output::sha256;
use crate::{ErrorKind, JobError, Outcome, Results};

/// Plan a grip of a calibrated body between two jaws: how long it holds, and how to squeeze. Mass and friction have to be given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args), command(next_help_heading = "Gripper"))]
#[serde(default, deny_unknown_fields)]
pub struct PlanGrip {
    /// Mass of the body.
    #[cfg_attr(feature = "clap", arg(
        long = "mass", value_name = "MASS", value_parser = crate::typed::mass, allow_hyphen_values = true,
        help_heading = "Load",
    ))]
    pub mass_kg: f64,
    /// Coefficient of friction between jaw and body.
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "NUMBER", allow_hyphen_values = true, help_heading = "Load")
    )]
    pub friction: f64,
    /// Safety factor on friction, 1 or more.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "NUMBER", default_value_t = PlanGrip::default().safety, allow_hyphen_values = true,
        help_heading = "Load",
    ))]
    pub safety: f64,
    /// Acceleration of the hand upwards.
    #[cfg_attr(feature = "clap", arg(
        long = "acceleration-up", value_name = "ACCELERATION", value_parser = crate::typed::acceleration,
        allow_hyphen_values = true, help_heading = "Load", default_value = "0 m/s^2", hide_default_value = true,
    ))]
    pub acceleration_up_m_per_s2: f64,
    /// Acceleration across gravity, in the plane of the jaws.
    #[cfg_attr(feature = "clap", arg(
        long = "acceleration-across", value_name = "ACCELERATION", value_parser = crate::typed::acceleration,
        allow_hyphen_values = true, help_heading = "Load", default_value = "0 m/s^2", hide_default_value = true,
    ))]
    pub acceleration_across_m_per_s2: f64,
    /// Acceleration along the closing axis, which unloads one jaw.
    #[cfg_attr(feature = "clap", arg(
        long = "acceleration-closing", value_name = "ACCELERATION", value_parser = crate::typed::acceleration,
        allow_hyphen_values = true, help_heading = "Load", default_value = "0 m/s^2", hide_default_value = true,
    ))]
    pub acceleration_closing_m_per_s2: f64,
    /// Torque about the closing axis.
    #[cfg_attr(feature = "clap", arg(
        long = "torque", value_name = "TORQUE", value_parser = crate::typed::torque, allow_hyphen_values = true,
        help_heading = "Load", default_value = "0 N m", hide_default_value = true,
    ))]
    pub torque_n_m: f64,
    /// Distance of the centre of mass from the closing axis.
    #[cfg_attr(feature = "clap", arg(
        long = "off-centre", value_name = "LENGTH", value_parser = crate::typed::off_centre, allow_hyphen_values = true,
        help_heading = "Load", default_value = "on the axis", hide_default_value = true,
    ))]
    pub off_centre_m: f64,
    /// Gravity; standard gravity if not given.
    #[cfg_attr(feature = "clap", arg(
        long = "gravity", value_name = "ACCELERATION", value_parser = crate::typed::acceleration,
        allow_hyphen_values = true, help_heading = "Load", help = "Gravity; 9.80665 m/s^2 if not given",
    ))]
    pub gravity_m_per_s2: Option<f64>,
    /// The fastest that the jaws go; the fastest ramp of the test if not given.
    #[cfg_attr(feature = "clap", arg(
        long = "speed", value_name = "SPEED", value_parser = crate::typed::speed, allow_hyphen_values = true,
    ))]
    pub speed_m_per_s: Option<f64>,
    /// How far the jaws may squeeze.
    #[cfg_attr(feature = "clap", arg(
        long = "stroke", value_name = "LENGTH", value_parser = crate::typed::length, allow_hyphen_values = true,
    ))]
    pub stroke_m: Option<f64>,
    /// The largest force that gripper and body bear.
    #[cfg_attr(feature = "clap", arg(
        long = "most-force", value_name = "FORCE", value_parser = crate::typed::force, allow_hyphen_values = true,
    ))]
    pub most_force_n: Option<f64>,
    /// How long closing may take; any time if not given.
    #[cfg_attr(feature = "clap", arg(
        long = "close-within", value_name = "TIME", value_parser = crate::typed::time, allow_hyphen_values = true,
    ))]
    pub close_within_s: Option<f64>,
    /// What the gripper holds once it has closed.
    #[schemars(with = "String", extend("enum" = ["position", "force"]))]
    #[cfg_attr(feature = "clap", arg(
        long, value_parser = crate::typed::one_of(crate::typed::CONTROLS), default_value = "position",
        help_heading = "Question",
    ))]
    pub control: Control,
    /// Squeeze that is in question.
    #[cfg_attr(feature = "clap", arg(
        long = "squeeze", value_name = "LENGTH", value_parser = crate::typed::length, allow_hyphen_values = true,
        help_heading = "Question",
    ))]
    pub squeeze_m: Option<f64>,
    /// Force that is in question, where the force is held.
    #[cfg_attr(feature = "clap", arg(
        long = "force", value_name = "FORCE", value_parser = crate::typed::force, allow_hyphen_values = true,
        help_heading = "Question", help = "Force that is in question, with --control force",
    ))]
    pub force_n: Option<f64>,
    /// How long it is to hold; 60 s if neither this nor a squeeze is given.
    #[cfg_attr(feature = "clap", arg(
        long = "hold", value_name = "TIME", value_parser = crate::typed::hold_time, allow_hyphen_values = true,
        help_heading = "Question",
        help = "How long it is to hold, or \"always\"; 60 s if neither this nor a squeeze is given",
    ))]
    pub hold_s: Option<f64>,
    /// It is to hold for ever.
    #[cfg_attr(feature = "clap", arg(skip))]
    pub hold_always: bool,
    /// What the squeeze should have least of.
    #[schemars(with = "String", extend("enum" = ["squeeze", "peak_force", "work"]))]
    #[cfg_attr(feature = "clap", arg(
        long, value_parser = crate::typed::one_of(crate::typed::OBJECTIVES), default_value = "squeeze",
        conflicts_with = "squeeze_m", help_heading = "Question",
    ))]
    pub objective: Objective,
    /// Lower and upper edge of the band in which squeezes again and again keep the force.
    #[cfg_attr(feature = "clap", arg(
        long = "band", value_name = "FORCES", value_parser = crate::typed::band, allow_hyphen_values = true,
        help_heading = "Question", help = "Band in which squeezes again and again keep the force, such as \"2.1..3 N\"",
    ))]
    pub band_n: Option<(f64, f64)>,
    /// What that schedule should have least of.
    #[cfg_attr(
        feature = "clap",
        arg(long, value_enum, default_value_t, requires = "band_n", help_heading = "Question")
    )]
    pub regrip: RegripFor,
    /// The shortest pause between two squeezes of that schedule; if not given, 1 s with least work, and any with fewest moves.
    #[cfg_attr(feature = "clap", arg(
        long = "shortest-pause", value_name = "TIME", value_parser = crate::typed::time, allow_hyphen_values = true,
        requires = "band_n", help_heading = "Question",
    ))]
    pub shortest_pause_s: Option<f64>,
    /// Probability with which the verdict has to hold, between 0 and 1; 0.5 for the best estimate. Intervals are of 95 %.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "SHARE", value_parser = crate::typed::coverage, allow_hyphen_values = true,
        default_value_t = PlanGrip::default().confidence, help_heading = "Question",
        help = "Probability with which the verdict has to hold; 0.5 for the best estimate",
    ))]
    pub confidence: f64,
}

/// What a schedule should have least of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "snake_case")]
pub enum RegripFor {
    /// Squeezes.
    #[default]
    Moves,
    /// Work of the jaws.
    Work,
}

impl Default for PlanGrip {
    fn default() -> Self {
        Self {
            mass_kg: f64::NAN,
            friction: f64::NAN,
            safety: 1.0,
            acceleration_up_m_per_s2: 0.0,
            acceleration_across_m_per_s2: 0.0,
            acceleration_closing_m_per_s2: 0.0,
            torque_n_m: 0.0,
            off_centre_m: 0.0,
            gravity_m_per_s2: None,
            speed_m_per_s: None,
            stroke_m: None,
            most_force_n: None,
            close_within_s: None,
            control: Control::Position,
            squeeze_m: None,
            force_n: None,
            hold_s: None,
            hold_always: false,
            objective: Objective::Squeeze,
            band_n: None,
            regrip: RegripFor::Moves,
            shortest_pause_s: None,
            confidence: Question::CONFIDENCE,
        }
    }
}

/// A material file, with what results say of it.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialSource {
    /// What the file says.
    pub file: MaterialFile,
    /// What to call it.
    pub name: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

impl MaterialSource {
    /// The material in a file.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be read, or is none.
    pub fn read(path: &Path) -> Result<Self, JobError> {
        let text = read_text(path)?;
        let file = parse_material(&text, path)?;
        let (name, sha256) = (path.display().to_string(), sha256(text.as_bytes()));
        Ok(Self { file, name, sha256 })
    }

    /// A material in memory, as the file would hold it.
    #[must_use]
    pub fn of(file: MaterialFile) -> Self {
        let (name, sha256) = ("material".to_owned(), sha256(file.to_toml().as_bytes()));
        Self { file, name, sha256 }
    }
}

/// Coverage of the intervals.
const INTERVALS: f64 = 0.95;

impl PlanGrip {
    /// The same with what is left out stated, where it does not follow from the material.
    fn stated(&self) -> Self {
        Self {
            gravity_m_per_s2: Some(self.gravity_m_per_s2.unwrap_or(STANDARD_GRAVITY)),
            hold_s: self.hold_s.filter(|time| time.is_finite()),
            hold_always: self.hold_always || self.hold_s == Some(f64::INFINITY),
            ..self.clone()
        }
    }

    fn question(&self) -> Result<Question, JobError> {
        if self.control == Control::Position && self.force_n.is_some() {
            return Err(JobError::option(
                "⟨force⟩ is for a force that is held, and the displacement is",
                "add ⟨control=force⟩, or ask with ⟨squeeze⟩ or ⟨most_force⟩",
            ));
        }
        if self.control == Control::Force && self.squeeze_m.is_some() {
            return Err(JobError::option(
                "⟨squeeze⟩ is for a displacement that is held, and the force is",
                "leave ⟨control=force⟩ out, or ask with ⟨force⟩",
            ));
        }
        if self.control == Control::Force && self.objective != Objective::default() {
            return Err(JobError::option(
                "⟨objective⟩ is for a squeeze that is sought, and the force is held",
                "leave ⟨control=force⟩ out, or leave ⟨objective⟩ out",
            ));
        }
        Ok(Question {
            control: self.control,
            squeeze: self.squeeze_m,
            force: self.force_n,
            duration: if self.hold_always { Some(f64::INFINITY) } else { self.hold_s },
            objective: self.objective,
            confidence: Some(self.confidence),
            band: self.band_n.map(|(low, high)| Band { low, high }),
            regrip: match self.regrip {
                RegripFor::Moves => Regrip::FewestMoves {
                    shortest_pause: self.shortest_pause_s.unwrap_or(0.0),
                },
                RegripFor::Work => Regrip::LeastWork {
                    shortest_pause: self.shortest_pause_s.unwrap_or(1.0),
                },
            },
        })
    }

    /// The body in the gripper that is described.
    fn gripper<'a>(&self, material: &'a Material) -> Result<Grip<'a>, GripError> {
        let mut grasp = Grasp::new(self.mass_kg, self.friction)?;
        grasp.safety = self.safety;
        grasp.gravity = self.gravity_m_per_s2.unwrap_or(grasp.gravity);
        grasp.acceleration_up = self.acceleration_up_m_per_s2;
        grasp.acceleration_across = self.acceleration_across_m_per_s2;
        grasp.acceleration_closing = self.acceleration_closing_m_per_s2;
        grasp.torque = self.torque_n_m;
        grasp.off_centre = self.off_centre_m;
        let mut limits = Limits::new(self.speed_m_per_s.unwrap_or(material.range().fastest))?;
        limits.stroke = self.stroke_m;
        limits.force = self.most_force_n;
        limits.closing = self.close_within_s;
        Grip::new(material, grasp, limits, INTERVALS)
    }

    /// Plans the grip of a material.
    ///
    /// # Errors
    /// [`JobError`] where there is no such question, or the watch ends it. That nothing holds is an answer.
    pub fn run<'a>(
        &self,
        source: &'a MaterialSource,
        watch: &mut dyn Watch,
    ) -> Result<Outcome<GrippedBody<'a>>, JobError> {
        let question = self.question()?;
        checked_confidence(self.confidence)?;
        let grip = self.gripper(&source.file.material).map_err(|error| ungripped(&error))?;
        let answer = grip.answer_watched(&question, watch).map_err(|error| ungripped(&error))?;
        let (holds, notes) = match answer.holds() {
            Ok(holds) => (holds, Vec::new()),
            Err(error) if error.is_answer() => (false, vec![error.hint().to_owned()]),
            Err(error) => return Err(ungripped(&error)),
        };
        let result = GrippedBody {
            path: source.name.clone(),
            sha256: source.sha256.clone(),
            depends_on_sha256: Dependencies::new("grip", &self.stated())
                .file("material", Some(&source.sha256))
                .sha256()?,
            misfit: source.file.origin.misfit,
            grip,
            answer,
        };
        Ok(Outcome::of(result).answered(holds).noted(notes))
    }
}

impl PlanGrip {
    /// Only whether the squeeze that is stated holds as long as is stated, with the course of the force: quick enough to follow a person who
    /// moves a slider.
    ///
    /// # Errors
    /// [`JobError`] where squeeze or time are not stated, or the gripper may not take the squeeze.
    pub fn try_squeeze(&self, source: &MaterialSource, watch: &mut dyn Watch) -> Result<TriedSqueeze, JobError> {
        /// Samples of the course, a step.
        const SAMPLES: usize = 80;
        let (Some(squeeze), Some(duration), Control::Position) = (self.squeeze_m, self.hold_s, self.control) else {
            return Err(JobError::option(
                "⟨squeeze⟩ and ⟨hold⟩ are needed to try a squeeze whose displacement is held",
                "",
            ));
        };
        checked_confidence(self.confidence)?;
        let grip = self.gripper(&source.file.material).map_err(|error| ungripped(&error))?;
        let plan = Plan::squeeze(squeeze, grip.limits().speed);
        watch.report(Progress::open("trying a squeeze", 0))?;
        let course = grip.course(&plan, duration, SAMPLES).map_err(|error| ungripped(&error))?;
        let probability = grip.probability(&plan, duration).map_err(|error| ungripped(&error))?;
        let found = (course, probability, self.confidence);
        Ok(TriedSqueeze::new(&grip, squeeze, duration, found, source.file.origin.misfit.as_ref()))
    }
}

impl Results for GrippedBody<'_> {
    type Document = GripDocument;

    fn document(&self) -> GripDocument {
        GripDocument::new(self)
    }

    fn text(&self) -> String {
        grip_text(self)
    }
}

fn ungripped(error: &GripError) -> JobError {
    let kind = match error {
        GripError::Cancelled(_) => ErrorKind::Cancelled,
        GripError::Number { .. } => ErrorKind::Option,
        _ => ErrorKind::Model,
    };
    JobError::new(kind, error, error.hint().to_owned())
}
