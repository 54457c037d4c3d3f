//! MuJoCo: an MJCF model of the body between two jaws, or of the held body and one jaw, its contacts as pairs with `solref`, `solreffriction`
//! and `solimp`.
//!
//! Documentation: "XML Reference", contact/pair attributes `solref`, `solreffriction`, `solimp`, `condim`, `friction`, and option attributes
//! `cone`, `impratio`; "Modeling", section "Solver parameters"; "Computation", section "Constraint model" (mujoco.readthedocs.io).
//!
//! Pairs, not geoms, because friction would otherwise have the damping of the normal force: with an impedance of 0.01 its rate is a hundred
//! times B, which no usual time step integrates.

use palpate::contact::{Shape, Sides};
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

/// The weld that holds a body squeezed from one side, as stiff as the largest stable time step allows, and its stiffness over the mass of the body, 1/s²:
/// d/(1 − d) over the square of its time.
const WELD: &str = "solref=\"0.01 1\" solimp=\"0.9999 0.9999 0.001 0.5 2\"";
const WELD_STIFFNESS: f64 = 9999.0 / (0.01 * 0.01);

/// Share of the depth by which the weld gives way, and by which the body moves at most: friction at the jaw also turns it.
const GIVES: f64 = 1e-5;
const MOVES: f64 = 1e-4;

pub(super) fn text(card: &Card, fit: &SoftConstraint) -> String {
    let head = card.head(&notes(card, fit));
    let friction = card.options.friction.map_or(String::new(), |mu| {
        let mu = plain(mu);
        format!(" friction=\"{mu} {mu} 0.005 0.0001 0.0001\"")
    });
    let points = contact_points(card.shape());
    let (names, weld): (&[(&str, f64)], String) = match card.body.sides() {
        Sides::Two => (&[("palpate_left_jaw", -1.0), ("palpate_right_jaw", 1.0)], String::new()),
        Sides::One => {
            let weld = format!(
                "  <equality>\n    <weld name=\"palpate_back\" body1=\"palpate_body\" {WELD}/>\n  </equality>\n"
            );
            (&[("palpate_jaw", -1.0)], weld)
        }
    };
    let mass = mass(card, fit);
    let share = fit.mass / mass;
    let solref = numbers(&[-share * fit.stiffness / points, -share * fit.damping / points]);
    let solimp = numbers(&[fit.first, fit.last, fit.width, fit.midpoint, fit.power]);
    let sliding = numbers(&[-1.0, -FRICTION_RATE * fit.last]);
    let (geometry, half, height) = geometry(card.shape());
    let jaws: String = names.iter().map(|(name, side)| jaw(name, *side, (half, height), JAW * mass)).collect();
    let pairs: String = names
        .iter()
        .map(|(name, _)| format!("    <pair class=\"palpate\" geom1=\"palpate_body\" geom2=\"{name}\"/>\n"))
        .collect();
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
{pairs}  </contact>
{weld}</mujoco>
"#,
        comment = xml_comment(&head),
        height = plain(height),
        mass = plain(mass),
    )
}

fn numbers(values: &[f64]) -> String {
    values.iter().map(|value| plain(*value)).collect::<Vec<_>>().join(" ")
}

/// Mass of the body in the model, kg: of one that a weld holds, the weld's stiffness is in proportion to it.
fn mass(card: &Card, fit: &SoftConstraint) -> f64 {
    match card.body.sides() {
        Sides::Two => fit.mass,
        Sides::One => {
            let least = card.loading.peak / (GIVES * card.loading.indentation * WELD_STIFFNESS);
            // Two digits, not below it.
            let digit = 10f64.powf(least.log10().floor() - 1.0);
            fit.mass.max((least / digit).ceil() * digit)
        }
    }
}

/// A jaw on a slide along x, on one side of a body of half the width and the height of its centre (m).
fn jaw(name: &str, side: f64, (half, height): (f64, f64), mass: f64) -> String {
    let thickness = 0.2 * half;
    let size = numbers(&[thickness, 2.0 * half, 2.0 * half]);
    let (place, height, mass) = (plain(side * (half + thickness)), plain(height), plain(mass));
    format!(
        r#"    <body name="{name}" pos="0 0 {height}">
      <joint name="{name}" type="slide" axis="1 0 0"/>
      <geom name="{name}" type="box" size="{size}" pos="{place} 0 0" mass="{mass}"/>
    </body>
"#
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
    let points = contact_points(card.shape());
    let mass = short(mass(card, fit));
    let largest = 100.0 * SoftConstraint::LARGEST;
    let mut notes = vec![
        "Use: the pairs are the contact; give them the names of your geoms, and your model the option cone and impratio".to_owned(),
        format!(
            "The force is in proportion to 1/(w1 + w2), w the first number of body_invweight0 of the two bodies in the compiled model, and \
             the card is for {mass} kg (w1 = 1/{mass}) and jaws so heavy that w2 is 0. For other bodies multiply both numbers of solref by \
             {mass} (w1 + w2), with w from model.body_invweight0[id][0] of your compiled model. It does not follow from the mass: of a jaw \
             of mass M on one slide joint it is 1/M where model.body_simple[id] is 2, such as with its centre of mass at the origin of its \
             body and the joint along an axis of that, and 1/(3 M) where not, as here"
        ),
    ];
    match card.body.sides() {
        Sides::Two => notes.extend(between_jaws(card, fit, u, largest)),
        Sides::One => notes.extend([
            format!(
                "The weld holds the back of the body, which weighs {mass} kg so that it moves by less than {} of the depth; give the weld body2, \
                 the plate or the finger that the body is on, or let the geom of the body be one of that plate or finger, whose w then counts",
                plain(MOVES)
            ),
            format!("Time steps above {} s are unstable: friction is stiff", short(2.0 / FRICTION_RATE)),
            format!(
                "The impedance is small, at most {}, so that the contact is a spring and a damper where what it presses is held; a body or \
                 a jaw that it alone moves has up to {largest} % less force",
                SoftConstraint::LARGEST
            ),
        ]),
    }
    notes.extend(
        (points > 1.0).then(|| format!("The face of the body has {points} contacts with a jaw, which share its force")),
    );
    notes
}

/// What holds for a free body between two jaws.
fn between_jaws(card: &Card, fit: &SoftConstraint, u: f64, largest: f64) -> [String; 3] {
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
    [
        format!(
            "The impedance is small, at most {}, so that the contact is a spring and a damper in a grip between two jaws; a contact \
             without an opposite one has up to {largest} % less force",
            SoftConstraint::LARGEST,
        ),
        format!("Time steps above {} s are unstable for this body between two jaws at this depth", short(stable)),
        format!(
            "Under its weight between two vertical jaws the body creeps by {} mm/min at this depth",
            short(60e3 * creep)
        ),
    ]
}
