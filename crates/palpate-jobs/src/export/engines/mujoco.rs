//! MuJoCo: an MJCF model of the body between two jaws, its contacts as pairs with `solref`, `solreffriction` and `solimp`.
//!
//! Documentation: "XML Reference", contact/pair attributes `solref`, `solreffriction`, `solimp`, `condim`, `friction`, and option attributes
//! `cone`, `impratio`; "Modeling", section "Solver parameters"; "Computation", section "Constraint model" (mujoco.readthedocs.io).
//!
//! Pairs, not geoms, because friction would otherwise have the damping of the normal force: with an impedance of 0.01 its rate is a hundred
//! times B, which no usual time step integrates.

use palpate::contact::Shape;
use palpate::export::SoftConstraint;

use super::super::card::Card;
use super::super::model::contact_points;
use super::super::numbers::{plain, short};
use super::xml_comment;

/// Ratio of the impedances of friction and normal force: friction is stiff, although the normal force has a small impedance.
const IMPRATIO: f64 = 1e6;

/// Rate of friction, 1/s: the damping of `solreffriction` is this times the impedance at the width. Time steps below 2/rate are stable.
const FRICTION_RATE: f64 = 400.0;

/// Mass of a jaw over that of the body.
const JAW: f64 = 1000.0;

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.80665;

pub(super) fn text(card: &Card, fit: &SoftConstraint) -> String {
    let head = card.head(&notes(card, fit));
    let friction = card.options.friction.map_or(String::new(), |mu| {
        let mu = plain(mu);
        format!(" friction=\"{mu} {mu} 0.005 0.0001 0.0001\"")
    });
    let numbers = |values: &[f64]| values.iter().map(|value| plain(*value)).collect::<Vec<_>>().join(" ");
    let points = contact_points(card.shape());
    let solref = numbers(&[-fit.stiffness / points, -fit.damping / points]);
    let solimp = numbers(&[fit.first, fit.last, fit.width, fit.midpoint, fit.power]);
    let sliding = numbers(&[-1.0, -FRICTION_RATE * fit.last]);
    let (geometry, half, height) = geometry(card.shape());
    let jaw = |side: &str, sign: f64| {
        let (thickness, height) = (0.2 * half, plain(height));
        let size = numbers(&[thickness, 2.0 * half, 2.0 * half]);
        let place = plain(sign * (half + thickness));
        format!(
            r#"    <body name="palpate_{side}_jaw" pos="0 0 {height}">
      <joint name="palpate_{side}_jaw" type="slide" axis="1 0 0"/>
      <geom name="palpate_{side}_jaw" type="box" size="{size}" pos="{place} 0 0" mass="{mass}"/>
    </body>
"#,
            mass = plain(JAW * fit.mass)
        )
    };
    format!(
        r#"{comment}<mujoco model="palpate contact">
  <option cone="elliptic" impratio="{IMPRATIO}"/>
  <default>
    <default class="palpate">
      <pair solref="{solref}" solreffriction="{sliding}" solimp="{solimp}" condim="4"{friction}/>
    </default>
  </default>
  <worldbody>
    <body name="palpate_body" pos="0 0 {height}">
      <freejoint/>
      <geom name="palpate_body" {geometry} mass="{mass}"/>
    </body>
{jaws}  </worldbody>
  <contact>
    <pair class="palpate" geom1="palpate_body" geom2="palpate_left_jaw"/>
    <pair class="palpate" geom1="palpate_body" geom2="palpate_right_jaw"/>
  </contact>
</mujoco>
"#,
        comment = xml_comment(&head),
        height = plain(height),
        mass = plain(fit.mass),
        jaws = jaw("left", -1.0) + &jaw("right", 1.0)
    )
}

/// Attributes of the geom, half its width between the jaws, which close along x, and the height of its centre on the floor (m).
fn geometry(shape: &Shape) -> (String, f64, f64) {
    match shape {
        Shape::Prism { area, length } => {
            let (half, side) = (0.5 * length, 0.5 * area.sqrt());
            let size = [half, side, side].map(plain).join(" ");
            (format!("type=\"box\" size=\"{size}\""), half, side)
        }
        shape => {
            let radius = super::super::model::radius(shape).unwrap_or(0.01);
            (format!("type=\"sphere\" size=\"{}\"", plain(radius)), radius, radius)
        }
    }
}

fn notes(card: &Card, fit: &SoftConstraint) -> Vec<String> {
    let u = card.loading.indentation;
    let by = |du: f64, speed: f64| fit.force(u * (1.0 - du), speed);
    let stiffness = ((by(0.0, 0.0) - by(1e-4, 0.0)) / (1e-4 * u)).max(f64::MIN_POSITIVE);
    let resistance = (fit.force(u, 1.0) - fit.force(u, 0.0)).max(f64::MIN_POSITIVE);
    // Two contacts, each with k and b: semi-implicit Euler is stable for dt² 2k/m + 2 dt 2b/m < 4.
    let normal = ((resistance * resistance + 2.0 * fit.mass * stiffness).sqrt() - resistance) / stiffness;
    let stable = normal.min(2.0 / FRICTION_RATE);
    // Friction carries half the weight at each jaw: R_t f = rate v with R_t = (1 − d)/(d m impratio).
    let impedance = fit.impedance(u);
    let points = contact_points(card.shape());
    let creep = 0.5 * GRAVITY * (1.0 - impedance) / (points * impedance * IMPRATIO * FRICTION_RATE);
    let mass = short(fit.mass);
    let corners = format!("The face of the block has {points} contacts with a jaw, which share its force");
    let mut notes = vec![
        format!(
            "Use: the pairs are the contact; give them the names of your geoms, and your model the option cone and impratio. The force is \
             per mass: keep the mass of {mass} kg. The jaws must be much heavier; with jaws of mass M multiply both numbers of solref by \
             1 + {mass}/M"
        ),
        format!(
            "The impedance is small, at most {}, so that the contact is a spring and a damper in a grip between two jaws; a contact \
             without an opposite one has up to {} % less force",
            SoftConstraint::LARGEST,
            100.0 * SoftConstraint::LARGEST
        ),
        format!("Time steps above {} s are unstable for this body between two jaws at this depth", short(stable)),
        format!(
            "Under its weight between two vertical jaws the body creeps by {} mm/min at this depth",
            short(60e3 * creep)
        ),
    ];
    notes.extend((points > 1.0).then_some(corners));
    notes
}
