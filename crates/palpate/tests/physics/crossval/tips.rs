//! Tips of indenters against the integral equation of the layer (`tips.json`).

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use crate::common::reference;
use palpate::contact::{
    Base, Equilibrium, EquilibriumError, Layers, Shape, Sides, Specimen, SpecimenError, ThinLayer, Tip,
};
use palpate::latency::LatencyLaw;
use palpate::simulate::{ContactModel, ForceHistory, Motion, Sampling, Separation, simulate};
use serde::Deserialize;

#[derive(Deserialize)]
struct Tolerance {
    half_space: f64,
    layer: f64,
}

/// A tip on a sample of thickness 1 m and modulus 1 − ν² Pa.
#[derive(Deserialize)]
struct Case {
    tip: String,
    base: Option<Base>,
    poisson_ratio: f64,
    radius: f64,
    indentation: f64,
    force: f64,
}

/// An indented body of this modulus.
fn indented(
    tip: Tip,
    layer: Option<ThinLayer>,
    poisson_ratio: f64,
    modulus: f64,
) -> Result<Specimen, EquilibriumError> {
    let body = Specimen::new(Shape::Indenter { tip, layer }, modulus, Sides::One).unwrap();
    body.with_equilibrium(Equilibrium::Hertz { poisson_ratio })
}

fn relaxed(body: &Specimen, u: f64) -> f64 {
    body.force(body.equilibrium_strain(u), u)
}

#[test]
fn forces_of_tips_are_those_of_the_integral_equation() {
    let (tolerance, cases) = reference::<Tolerance, Case>("tips");
    let mut worst = 0.0f64;
    for case in &cases {
        let tip = match case.tip.as_str() {
            "sphere" => Tip::Sphere { radius: 1.0 },
            "cone" => Tip::Cone {
                half_angle: std::f64::consts::FRAC_PI_4,
            },
            _ => Tip::Punch { radius: case.radius },
        };
        // A half space is a layer of any thickness without its factor; that of a cone is as thick as to need none.
        let layer = |base| ThinLayer { thickness: 1.0, base };
        let layer = match (case.base, tip) {
            (Some(base), _) => Some(layer(base)),
            (None, Tip::Cone { .. }) => Some(ThinLayer {
                thickness: 1e12,
                base: Base::Bonded,
            }),
            (None, _) => None,
        };
        let modulus = 1.0 - case.poisson_ratio * case.poisson_ratio;
        let body = indented(tip, layer, case.poisson_ratio, modulus).unwrap();
        // The displacement of a punch is 1 m; its force is linear.
        let u = if case.tip == "punch" { 1e-3 } else { case.indentation };
        let found = relaxed(&body, u) / u * case.indentation;
        let off = (found / case.force - 1.0).abs();
        let allowed = if case.base.is_some() { tolerance.layer } else { tolerance.half_space };
        assert!(
            off < allowed,
            "{} {:?} {} at {}: {off:e}",
            case.tip,
            case.base,
            case.poisson_ratio,
            case.indentation
        );
        worst = if case.base.is_some() { worst.max(off) } else { worst };
    }
    println!("{} cases, largest error of a layer {worst:.2e}", cases.len());
}

/// The formulas as makers of atomic force microscopes print them, with numbers of a usual tip: R = 5 µm, E = 1 kPa, ν = 1/2, u = 0.5 µm.
#[test]
fn forces_and_areas_in_numbers() {
    let force = |tip, u| relaxed(&indented(tip, Some(thick()), 0.5, 1e3).unwrap(), u);
    let area = |tip, u| indented(tip, Some(thick()), 0.5, 1e3).unwrap().contact_area(u);
    let half_angle = 35f64.to_radians();
    let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-4, "{found:e}, {expected:e}");
    // 16/9 E √R u^(3/2)
    near(force(Tip::Sphere { radius: 5e-6 }, 5e-7), 1.405_46e-9);
    // 8/(3π) E tan α u²
    near(force(Tip::Cone { half_angle }, 5e-7), 1.485_86e-10);
    // 4/3 · 0.7453 E tan α u²
    near(force(Tip::Pyramid { half_angle }, 5e-7), 1.739_54e-10);
    // 8/3 E R u
    near(force(Tip::Punch { radius: 5e-6 }, 5e-7), 6.666_67e-9);
    // π R u, π (2/π u tan α)², π R²
    near(area(Tip::Sphere { radius: 5e-6 }, 5e-7), 7.853_98e-12);
    near(area(Tip::Cone { half_angle }, 5e-7), 1.560_63e-13);
    near(area(Tip::Punch { radius: 5e-6 }, 5e-7), 7.853_98e-11);
}

/// A displacement that is held leaves the equilibrium force, and that force, held, the displacement.
#[test]
fn force_and_displacement_of_a_relaxed_tip_belong_together() {
    let layer = Some(ThinLayer {
        thickness: 6e-6,
        base: Base::Bonded,
    });
    let half_angle = 0.6;
    for (tip, layer) in [
        (Tip::Sphere { radius: 5e-6 }, None),
        (Tip::Sphere { radius: 5e-6 }, layer),
        (Tip::Cone { half_angle }, layer),
        (Tip::Pyramid { half_angle }, layer),
        (Tip::Punch { radius: 2e-6 }, layer),
    ] {
        let specimen = indented(tip, layer, 0.45, 2e3).unwrap();
        let (u, expected) = (1e-6, relaxed(&specimen, 1e-6));
        let model = ContactModel {
            specimen,
            law: LatencyLaw::new(1.0, 1.0).unwrap(),
            layers: Layers::new(4.0).unwrap(),
            separation: Separation::Unilateral,
        };
        let (times, end) = (vec![0.0, 1.0, 200.0], Sampling::Times(vec![200.0]));
        let held = simulate(&Motion::new(times.clone(), vec![0.0, u, u]).unwrap(), &model, &end).unwrap();
        assert!((held.force[0] / expected - 1.0).abs() < 1e-9, "{tip:?}: {}", held.force[0] / expected);
        let crept = ForceHistory::new(times, vec![0.0, expected, expected]).unwrap();
        let crept = simulate(&crept, &model, &end).unwrap();
        assert!((crept.displacement[0] / u - 1.0).abs() < 1e-9, "{tip:?}: {}", crept.displacement[0] / u);
    }
}

fn thick() -> ThinLayer {
    ThinLayer {
        thickness: 10.0,
        base: Base::Bonded,
    }
}

#[test]
fn tips_without_a_range_are_refused() {
    let shape = |tip, thickness: Option<f64>| {
        let layer = thickness.map(|thickness| ThinLayer { thickness, ..thick() });
        Specimen::new(Shape::Indenter { tip, layer }, 1e3, Sides::One)
    };
    let cone = Tip::Cone { half_angle: 0.6 };
    assert_eq!(shape(cone, None), Err(SpecimenError::NoDepth));
    assert!(matches!(shape(cone, Some(-1.0)), Err(SpecimenError::NotPositive { name: "thickness", .. })));
    for half_angle in [0.0, 1.6, f64::NAN] {
        let pyramid = shape(Tip::Pyramid { half_angle }, Some(1e-5));
        assert!(matches!(pyramid, Err(SpecimenError::HalfAngle { .. })), "{half_angle}");
    }
    let punch = Tip::Punch { radius: 4e-6 };
    let wide = ThinLayer {
        thickness: 6e-6,
        ..thick()
    };
    assert!(matches!(indented(punch, Some(wide), 0.5, 1e3), Err(EquilibriumError::WidePunch { .. })));
    // √(R u) = h/2 at u = h²/(4 R)
    let bead = indented(Tip::Sphere { radius: 5e-6 }, Some(wide), 0.5, 1e3).unwrap();
    assert!(bead.check_contact_displacement(1.79e-6, false).is_ok());
    let deep = bead.check_contact_displacement(1.81e-6, false).unwrap_err();
    assert!(deep.to_string().contains("the contact is as wide as the layer is thick of 0.00000"), "{deep}");
}
