//! The contact or the Prony series of an engine, fitted to a material.

use palpate::calibrate::Material;
use palpate::contact::{Equilibrium, Shape, Specimen};
use palpate::export::{
    CardError, Conditions, HOLD_TIMES, HoldCurve, HuntCrossley, Loading, PronySeries, SoftConstraint, SpringDamper,
};

use super::options::{Engine, Export};
use super::refused;
use crate::{ErrorKind, JobError};

/// What a card holds.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Model {
    Soft(SoftConstraint),
    HuntCrossley(HuntCrossley),
    Spring(SpringDamper),
    Continuum(Continuum),
}

/// A viscoelastic solid.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Continuum {
    pub(super) series: PronySeries,
    pub(super) curve: HoldCurve,
    /// Young's modulus of the relaxed body, Pa.
    pub(super) equilibrium_modulus: f64,
    pub(super) poisson_ratio: f64,
    /// kg/m³, with whether it follows from the mass.
    pub(super) density: (f64, bool),
    /// Largest error over the hold, as a share of the force at its start.
    pub(super) worst: f64,
    /// Error at [`HOLD_TIMES`], as shares of the force at the start of the hold.
    pub(super) hold: [f64; 3],
}

impl Continuum {
    /// Young's modulus at the start of the hold, Pa.
    pub(super) fn instantaneous_modulus(&self) -> f64 {
        self.equilibrium_modulus / self.series.equilibrium()
    }
}

/// Poisson's ratio where nothing is known of it.
const POISSON_RATIO: f64 = 0.49;

/// Largest Poisson's ratio that finite elements without pressure take.
const MOST_POISSON_RATIO: f64 = 0.495;

/// Density where no mass is given, kg/m³: that of water.
const DENSITY: f64 = 1000.0;

impl Model {
    pub(super) fn fit(
        options: &Export,
        material: &Material,
        conditions: Conditions,
        loading: &Loading,
    ) -> Result<Self, JobError> {
        let body = material.contact().specimen();
        let fitted = match options.engine {
            Engine::Mujoco => {
                geometry(options.engine, body.shape())?;
                SoftConstraint::fit(loading, options.mass_kg.unwrap_or(f64::NAN)).map(Self::Soft)
            }
            Engine::Drake => {
                geometry(options.engine, body.shape())?;
                HuntCrossley::fit(loading, radius(body.shape())).map(Self::HuntCrossley)
            }
            Engine::Physx | Engine::Isaac | Engine::Newton => SpringDamper::fit(loading).map(Self::Spring),
            Engine::Abaqus | Engine::Openradioss | Engine::Febio | Engine::Felupe => {
                return continuum(options, material, conditions, loading).map(Self::Continuum);
            }
        };
        fitted.map_err(|error| refused(&error))
    }

    /// The error of a contact.
    pub(super) fn contact_error(&self) -> Option<CardError> {
        match self {
            Self::Soft(fit) => Some(fit.error),
            Self::HuntCrossley(fit) => Some(fit.error),
            Self::Spring(fit) => Some(fit.error),
            Self::Continuum(_) => None,
        }
    }

    /// The largest error of a contact in loading, as a share of the peak force, if it is large enough for a note.
    pub(super) fn noted_error(&self) -> Option<f64> {
        /// Largest error that needs none.
        const UNNOTED: f64 = 0.02;
        self.contact_error().map(|error| error.loading).filter(|error| *error > UNNOTED)
    }

    /// The error in a hold at [`HOLD_TIMES`], as shares of the peak force.
    pub(super) fn hold_error(&self) -> [f64; 3] {
        match self {
            Self::Continuum(solid) => solid.hold,
            other => other.contact_error().map_or([f64::NAN; 3], |error| error.hold),
        }
    }
}

/// Radius (m) of a body that is round where it is touched.
pub(super) fn radius(shape: &Shape) -> Option<f64> {
    match shape {
        Shape::Ball { radius } | Shape::Pad { radius, .. } => Some(*radius),
        _ => None,
    }
}

/// Contact points of a body on a jaw in MuJoCo: the corners of the face of a block, each with a contact of its own.
pub(super) fn contact_points(shape: &Shape) -> f64 {
    if matches!(shape, Shape::Prism { .. }) { 4.0 } else { 1.0 }
}

/// Refuses bodies whose geometry a rigid-body engine has no primitive for.
fn geometry(engine: Engine, shape: &Shape) -> Result<(), JobError> {
    let found = match shape {
        Shape::Ball { .. } | Shape::Pad { .. } | Shape::Prism { .. } => return Ok(()),
        Shape::Profile { .. } => "a profile",
        Shape::Indenter { .. } => "the tip of an indenter",
    };
    let message =
        format!("a card for {} needs a ball, a pad or a body of constant section, found {found}", engine.title());
    let hint = "cards for physx, isaac and newton have no geometry".to_owned();
    Err(JobError::new(ErrorKind::Model, message, hint))
}

fn continuum(
    options: &Export,
    material: &Material,
    conditions: Conditions,
    loading: &Loading,
) -> Result<Continuum, JobError> {
    let contact = material.contact();
    let curve = HoldCurve::of(contact, conditions).map_err(|error| refused(&error))?;
    let series = curve.series(conditions.hold, options.terms_per_decade).map_err(|error| refused(&error))?;
    let body = contact.specimen();
    let poisson_ratio = match (options.poisson_ratio, body.equilibrium()) {
        (Some(given), _) => given,
        (None, Equilibrium::Hertz { poisson_ratio }) => poisson_ratio.min(MOST_POISSON_RATIO),
        (None, _) => POISSON_RATIO,
    };
    let density = match (options.mass_kg, volume(body.shape())) {
        (Some(mass), Some(volume)) => (mass / volume, true),
        _ => (DENSITY, false),
    };
    let mut hold = [0.0; 3];
    for ((error, time), held) in hold.iter_mut().zip(HOLD_TIMES).zip(loading.held) {
        *error = series.value(time) - held / curve.peak;
    }
    let worst = match curve.latency() {
        Some((exponent, rate)) => series.worst_error(conditions.hold, |time| {
            let share = curve.equilibrium / curve.peak;
            share + (1.0 - share) * palpate::latency::decay(rate * time, exponent)
        }),
        None => 0.0,
    };
    Ok(Continuum {
        equilibrium_modulus: modulus(body, curve.indentation),
        poisson_ratio,
        density,
        worst,
        hold,
        series,
        curve,
    })
}

/// Young's modulus (Pa) of the relaxed body: that of its law, or of a table of forces F_e/(A ε_e) at an indentation (m).
fn modulus(body: &Specimen, u: f64) -> f64 {
    match body.equilibrium() {
        Equilibrium::UniformStrain | Equilibrium::Hertz { .. } => body.modulus(),
        Equilibrium::Measured { .. } => body.equilibrium_force(u) / (body.contact_area(u) * body.equilibrium_strain(u)),
    }
}

/// Volume (m³) of a body whose shape is all of it.
fn volume(shape: &Shape) -> Option<f64> {
    match shape {
        Shape::Ball { radius } => Some(4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)),
        Shape::Prism { area, length } => Some(area * length),
        _ => None,
    }
}
