//! MuJoCo: an MJCF model with the body, its contact in `solref` and `solimp`.
//!
//! Documentation: "XML Reference", default/geom attributes `solref`, `solimp`, `priority`, `condim`, `friction`, and option attributes
//! `cone`, `impratio`; "Modeling", section "Solver parameters"; "Computation", section "Constraint model" (mujoco.readthedocs.io).

use palpate::contact::Shape;
use palpate::export::SoftConstraint;

use super::super::card::Card;
use super::super::numbers::{plain, short};
use super::xml_comment;

/// Ratio of the impedances of friction and normal force: with it friction is nearly as stiff as that of a default contact, although the
/// impedance of the normal force is small.
const IMPRATIO: f64 = 2000.0;

/// Least damping, 1/s: friction has the damping of the normal force, and none would hold nothing.
const LEAST_DAMPING: f64 = 1.0;

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.80665;

pub(super) fn text(card: &Card, fit: &SoftConstraint) -> String {
    let damping = fit.damping.max(LEAST_DAMPING);
    let head = card.head(&notes(card, fit, damping));
    let friction = card
        .options
        .friction
        .map_or(String::new(), |mu| format!(" friction=\"{} 0.005 0.0001\"", plain(mu)));
    let numbers = |values: &[f64]| values.iter().map(|value| plain(*value)).collect::<Vec<_>>().join(" ");
    let solref = numbers(&[-fit.stiffness, -damping]);
    let solimp = numbers(&[fit.first, fit.last, fit.width, fit.midpoint, fit.power]);
    let mass = plain(fit.mass);
    let (geometry, height) = geometry(card.shape());
    format!(
        r#"{comment}<mujoco model="palpate contact">
  <option cone="elliptic" impratio="{IMPRATIO}"/>
  <default>
    <default class="palpate">
      <geom solref="{solref}" solimp="{solimp}" priority="1" condim="4"{friction}/>
    </default>
  </default>
  <worldbody>
    <body name="palpate_body" pos="0 0 {height}">
      <freejoint/>
      <geom name="palpate_body" class="palpate" {geometry} mass="{mass}"/>
    </body>
  </worldbody>
</mujoco>
"#,
        comment = xml_comment(&head)
    )
}

/// Attributes of the geom, and the height of its centre on the floor; a jaw closes along x.
fn geometry(shape: &Shape) -> (String, String) {
    match shape {
        Shape::Prism { area, length } => {
            let half = 0.5 * area.sqrt();
            let size = [0.5 * length, half, half].map(plain).join(" ");
            (format!("type=\"box\" size=\"{size}\""), plain(half))
        }
        shape => {
            let radius = super::super::model::radius(shape).map_or_else(|| plain(0.01), plain);
            (format!("type=\"sphere\" size=\"{radius}\""), radius)
        }
    }
}

fn notes(card: &Card, fit: &SoftConstraint, damping: f64) -> Vec<String> {
    let u = card.loading.indentation;
    let by = |du: f64, speed: f64| fit.force(u * (1.0 - du), speed);
    let stiffness = (by(0.0, 0.0) - by(1e-4, 0.0)) / (1e-4 * u);
    let resistance = fit.force(u, 1.0) - fit.force(u, 0.0);
    let stable = (2.0 * fit.mass / stiffness.max(f64::MIN_POSITIVE))
        .sqrt()
        .min(fit.mass / resistance.max(f64::MIN_POSITIVE));
    // Friction carries half the weight at each jaw: R_t f = b v with R_t = (1 − d)/(d m impratio), b = B/d_w.
    let impedance = fit.impedance(u);
    let creep = 0.5 * GRAVITY * (1.0 - impedance) * fit.last / (impedance * IMPRATIO * damping);
    vec![
        format!(
            "Use: include this model or copy class and body. priority=1 makes this geom's solref and solimp count, whatever those of the \
             jaws. The force is per mass: keep the mass of {} kg. The jaws must be much heavier; with jaws of mass M multiply both \
             numbers of solref by 1 + {}/M",
            short(fit.mass),
            short(fit.mass)
        ),
        format!(
            "The impedance is small, at most {}, so that the contact is a spring and a damper in a grip between two jaws; a contact \
             without an opposite one has up to {} % less force",
            SoftConstraint::LARGEST,
            100.0 * SoftConstraint::LARGEST
        ),
        format!("Time steps above {} s are unstable for this body between two jaws at this depth", short(stable)),
        format!(
            "Under its weight between two vertical jaws the body creeps by at most {} mm/s at this depth; raise impratio, or give a \
             contact pair a solreffriction of its own, for less",
            short(1e3 * creep)
        ),
    ]
}
