//! The engines, and the options of the job.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::JobError;

/// A simulator that takes a card.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "snake_case")]
pub enum Engine {
    /// MuJoCo: MJCF with solref and solimp; needs the mass
    #[default]
    Mujoco,
    /// Drake: SDFormat with point and hydroelastic contact
    Drake,
    /// PhysX 5: compliant contact in C++
    Physx,
    /// Isaac Sim and Isaac Lab: compliant contact in USD
    Isaac,
    /// Newton: ShapeConfig in Python
    Newton,
    /// Abaqus: *ELASTIC and *VISCOELASTIC, TIME=PRONY
    Abaqus,
    /// OpenRadioss: /MAT/LAW42 with its Prony series
    Openradioss,
    /// FEBio: viscoelastic neo-Hookean solid in XML
    Febio,
    /// FElupe: small-strain viscoelastic material in Python
    Felupe,
}

impl Engine {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Mujoco,
        Self::Drake,
        Self::Physx,
        Self::Isaac,
        Self::Newton,
        Self::Abaqus,
        Self::Openradioss,
        Self::Febio,
        Self::Felupe,
    ];

    /// Its name as an option.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mujoco => "mujoco",
            Self::Drake => "drake",
            Self::Physx => "physx",
            Self::Isaac => "isaac",
            Self::Newton => "newton",
            Self::Abaqus => "abaqus",
            Self::Openradioss => "openradioss",
            Self::Febio => "febio",
            Self::Felupe => "felupe",
        }
    }

    /// Its name in a sentence.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Mujoco => "MuJoCo",
            Self::Drake => "Drake",
            Self::Physx => "PhysX",
            Self::Isaac => "Isaac",
            Self::Newton => "Newton",
            Self::Abaqus => "Abaqus",
            Self::Openradioss => "OpenRadioss",
            Self::Febio => "FEBio",
            Self::Felupe => "FElupe",
        }
    }

    /// Whether its card is a Prony series; else it is a contact without memory.
    #[must_use]
    pub fn is_continuum(self) -> bool {
        matches!(self, Self::Abaqus | Self::Openradioss | Self::Febio | Self::Felupe)
    }
}

/// Export a material as a card of another simulator, with its range and its error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Export {
    /// Simulator.
    #[cfg_attr(feature = "clap", arg(value_name = "ENGINE", value_enum))]
    pub engine: Engine,
    /// Displacement of the jaw at the end of loading; the deepest squeeze of the test if not given.
    #[cfg_attr(feature = "clap", arg(
        long = "depth", value_name = "LENGTH", value_parser = crate::typed::length, allow_hyphen_values = true,
        help = "Displacement of the jaw up to which the card is fitted; the deepest squeeze of the test if not given",
    ))]
    pub depth_m: Option<f64>,
    /// Fastest speed of the jaw, before the hold; the fastest ramp of the test if not given.
    #[cfg_attr(feature = "clap", arg(
        long = "speed", value_name = "SPEED", value_parser = crate::typed::speed, allow_hyphen_values = true,
    ))]
    pub speed_m_per_s: Option<f64>,
    /// Slowest speed of the jaw; the slowest ramp of the test if not given, or, where the test has one speed, half the fastest, or the least share
    /// of it that a card fits to 2 %.
    #[cfg_attr(feature = "clap", arg(
        long = "slowest", value_name = "SPEED", value_parser = crate::typed::speed, allow_hyphen_values = true,
    ))]
    pub slowest_m_per_s: Option<f64>,
    /// Length of the hold that a Prony series covers.
    #[cfg_attr(feature = "clap", arg(
        long = "hold", value_name = "TIME", value_parser = crate::typed::time,
        default_value = crate::typed::seconds(Export::default().hold_s), allow_hyphen_values = true,
    ))]
    pub hold_s: f64,
    /// Mass of the body; MuJoCo needs it, whose contact is per mass.
    #[cfg_attr(feature = "clap", arg(
        long = "mass", value_name = "MASS", value_parser = crate::typed::mass, allow_hyphen_values = true,
        help = "Mass of the body; MuJoCo needs it, because its contact is per mass",
    ))]
    pub mass_kg: Option<f64>,
    /// Coefficient of friction between jaw and body; that of the engine if not given.
    #[cfg_attr(feature = "clap", arg(long, value_name = "NUMBER", allow_hyphen_values = true))]
    pub friction: Option<f64>,
    /// Poisson's ratio of a Prony card; that of Hertz's law, or else 0.49, if not given.
    #[cfg_attr(feature = "clap", arg(long, value_name = "NUMBER", allow_hyphen_values = true))]
    pub poisson_ratio: Option<f64>,
    /// Terms of a Prony series in each decade of time; exponents below 2 need more.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "NUMBER", default_value_t = Export::default().terms_per_decade, allow_hyphen_values = true,
    ))]
    pub terms_per_decade: f64,
}

impl Default for Export {
    fn default() -> Self {
        Self {
            engine: Engine::default(),
            depth_m: None,
            speed_m_per_s: None,
            slowest_m_per_s: None,
            hold_s: 60.0,
            mass_kg: None,
            friction: None,
            poisson_ratio: None,
            terms_per_decade: 2.0,
        }
    }
}

impl Export {
    /// Checks what the library does not.
    pub(super) fn check(&self) -> Result<(), JobError> {
        let sound = |found: Option<f64>, is_sound: fn(f64) -> bool| found.is_none_or(is_sound);
        if !sound(self.friction, |found| found.is_finite() && found >= 0.0) {
            let found = self.friction.unwrap_or_default();
            return Err(JobError::option(format!("⟨friction⟩ must be a number of 0 or more, found {found}"), ""));
        }
        if !sound(self.poisson_ratio, |found| (0.0..0.5).contains(&found)) {
            let found = self.poisson_ratio.unwrap_or_default();
            let message = format!("⟨poisson_ratio⟩ must be 0 or more and below 0.5, found {found}");
            return Err(JobError::option(message, "use 0.49 for a body that hardly changes its volume"));
        }
        if !sound(self.mass_kg, |found| found.is_finite() && found > 0.0) {
            let found = self.mass_kg.unwrap_or_default();
            return Err(JobError::option(format!("⟨mass⟩ must be a finite number above 0 kg, found {found} kg"), ""));
        }
        if self.engine == Engine::Mujoco && self.mass_kg.is_none() {
            return Err(JobError::option(
                "a card for MuJoCo needs ⟨mass⟩: the force of its contact is in proportion to the mass of the body",
                "add ⟨mass=250g⟩ with the mass of the body",
            ));
        }
        self.check_effects()
    }

    /// Refuses options that have no effect on the card of the engine.
    fn check_effects(&self) -> Result<(), JobError> {
        let usual = Self::default();
        let is_dense = self.terms_per_decade.to_bits() != usual.terms_per_decade.to_bits();
        let is_held = self.hold_s.to_bits() != usual.hold_s.to_bits();
        let of_contacts = [("friction", self.friction.is_some()), ("slowest", self.slowest_m_per_s.is_some())];
        let of_elements =
            [("poisson_ratio", self.poisson_ratio.is_some()), ("terms_per_decade", is_dense), ("hold", is_held)];
        let (kind, others) = match self.engine.is_continuum() {
            true => ("engines of contacts", &of_contacts[..]),
            false => ("finite elements", &of_elements[..]),
        };
        match others.iter().find(|(_, is_given)| *is_given) {
            Some((name, _)) => {
                let message = format!("⟨{name}⟩ is for {kind}, and the engine is {}", self.engine.name());
                Err(JobError::option(message, &format!("leave ⟨{name}⟩ out")))
            }
            None => Ok(()),
        }
    }
}
