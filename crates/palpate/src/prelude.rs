//! The types and functions that carry the main jobs: `use palpate::prelude::*;`.
//!
//! Fit a law to a hold, compare laws, analyse a record, calibrate a material on it, and predict and plan with it:
//!
//! ```
//! use palpate::prelude::*;
//!
//! // A force in N that relaxes from 3 to 1 N by the latency law with n = 3 and λ = 0.5 per second, sampled for 40 s.
//! let time: Vec<f64> = (0..400).map(|i| 0.1 * f64::from(i)).collect();
//! let force: Vec<f64> = time.iter().map(|t| 1.0 + 2.0 / (1.0 + t).sqrt()).collect();
//!
//! // 1. Fit a law to the hold: no starting values.
//! let fit = fit_law(&Samples::new(&time, &force), "latency".parse()?, &LawOptions::default())?;
//! assert!((fit.value("exponent").unwrap() - 3.0).abs() < 1e-6);
//!
//! // 2. Compare laws by what they predict beyond the fitted part.
//! let laws = vec!["latency:3".parse()?, "standard-linear-solid".parse()?];
//! let comparison = compare_laws(&Samples::new(&time, &force), &CompareOptions { laws, ..CompareOptions::default() })?;
//! assert_eq!(comparison.verdict.unwrap().law.to_string(), "latency:3");
//!
//! // 3. Simulate a squeeze of the paper's ball: 5 mm at 8 mm/s, a hold of 20 s.
//! let ball = ContactModel {
//!     specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?,
//!     law: LatencyLaw::new(5.0, 2e4)?,
//!     layers: Layers::new(8.0)?,
//!     separation: Separation::Unilateral,
//! };
//! let squeeze = protocol(&[ProtocolStep { to: 0.005, rate: 0.008, hold: 20.0 }])?;
//! let series = simulate(&squeeze, &ball, &Sampling::Rate(20.0))?;
//!
//! // 4. Analyse a record: phases, laws of every hold, findings.
//! let body = Geometry { shape: Shape::Ball { radius: 0.035 }, sides: Sides::Two, modulus: Some(28e3), equilibrium: Default::default() };
//! let record = Record::new(series.time.clone(), Some(series.displacement), series.force.clone())?;
//! let options = AnalysisOptions { geometry: Some(body.clone()), ..AnalysisOptions::default() };
//! let analysis = analyze(&record, &options)?;
//! assert_eq!((analysis.holds.len(), analysis.across.common_exponent), (1, Some(5.0)));
//!
//! // 5. Calibrate a material on the whole record, predict another motion with it, and ask how long a grip holds.
//! let data = CalibrationData::new(body, Separation::Unilateral, squeeze.clone(), series.time, series.force, &[0.005])?;
//! let latency = Candidate::new("latency:5".parse()?, EquilibriumLaw::UniformStrain);
//! let material = calibrate(&data, latency, 0.95, &mut Unwatched)?.material;
//! assert!((material.estimate("modulus_pa").unwrap().value / 28e3 - 1.0).abs() < 1e-3);
//! let prediction = material.predict(&squeeze, &Sampling::Times(vec![10.0]), 0.95)?;
//! assert!((prediction.trajectory.force[0] - 1.59).abs() < 0.05);
//! let grip = Grip::new(&material, Grasp::new(0.1, 0.6)?, Limits::new(0.008)?, 0.95)?;
//! assert!(matches!(grip.position_hold(&Plan::squeeze(0.005, 0.008))?.time_to_slip, TimeToSlip::Never));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use crate::analysis::{Analysis, AnalysisOptions, Geometry, analyze};
pub use crate::calibrate::{Calibration, CalibrationData, Candidate, EquilibriumLaw, Material, calibrate};
pub use crate::contact::{Layers, Shape, Sides, Specimen};
pub use crate::fit::{Fit, FitOptions, LawOptions, Samples, fit_hold, fit_law};
pub use crate::forecast::{CompareOptions, Comparison, compare_laws};
pub use crate::grip::{Grasp, Grip, Limits, Plan, TimeToSlip};
pub use crate::latency::LatencyLaw;
pub use crate::laws::{ExponentChoice, Law};
pub use crate::record::Record;
pub use crate::simulate::{ContactModel, ProtocolStep, Sampling, Separation, Trajectory, protocol, simulate};
pub use crate::watch::Unwatched;
