//! Any body, law and drive, in units of their own.

use palpate::contact::{Curve, Equilibrium, Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{
    Contact, ContactModel, LinearContact, LinearLaw, LinearTerm, Memory, Motion, ProgramStep, Separation,
};
use proptest::prelude::*;

/// Numbers spread evenly over the decades from 10^low to 10^high.
pub(crate) fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> + Clone {
    (low..high).prop_map(|power| 10f64.powf(power))
}

/// A body in units of its depth and modulus.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    pub(crate) form: Form,
    pub(crate) relaxed: Relaxed,
    pub(crate) sides: Sides,
    pub(crate) depth: f64,
    pub(crate) modulus: f64,
}

#[derive(Debug, Clone)]
pub(crate) enum Form {
    Ball,
    /// Radius over thickness.
    Pad(f64),
    /// Section over depth².
    Prism(f64),
    /// Places over depth, areas over depth².
    Profile(Vec<(f64, f64)>),
}

#[derive(Debug, Clone)]
pub(crate) enum Relaxed {
    Even,
    Hertz(f64),
    /// Places over depth, forces over modulus · depth².
    Measured(Vec<(f64, f64)>),
}

impl Body {
    pub(crate) fn specimen(&self) -> Specimen {
        let (depth, square) = (self.depth, self.depth * self.depth);
        let shape = match &self.form {
            Form::Ball => Shape::Ball { radius: depth },
            Form::Pad(wide) => Shape::Pad {
                radius: wide * depth,
                thickness: depth,
            },
            Form::Prism(area) => {
                let length = if self.sides == Sides::Two { 2.0 * depth } else { depth };
                Shape::Prism {
                    area: area * square,
                    length,
                }
            }
            Form::Profile(rows) => {
                let rows: Vec<(f64, f64)> = rows.iter().map(|(u, area)| (u * depth, area * square)).collect();
                Shape::Profile {
                    depth,
                    area: Curve::new(&rows).unwrap(),
                }
            }
        };
        let specimen = Specimen::new(shape, self.modulus, self.sides).unwrap();
        let relaxed = match &self.relaxed {
            Relaxed::Even => return specimen,
            Relaxed::Hertz(poisson_ratio) => Equilibrium::Hertz {
                poisson_ratio: *poisson_ratio,
            },
            Relaxed::Measured(rows) => {
                let unit = self.modulus * square;
                let rows: Vec<(f64, f64)> = rows.iter().map(|(u, force)| (u * depth, force * unit)).collect();
                Equilibrium::measured(&rows).unwrap()
            }
        };
        specimen.with_equilibrium(relaxed).unwrap()
    }

    /// The deepest displacement of the jaw that is used, m.
    pub(crate) fn deepest(&self) -> f64 {
        let mut share = 1.0f64;
        if let Form::Profile(rows) = &self.form {
            share = share.min(rows[rows.len() - 1].0);
        }
        if let Relaxed::Measured(rows) = &self.relaxed {
            share = share.min(rows[rows.len() - 1].0);
        }
        let contacts = if self.sides == Sides::Two { 2.0 } else { 1.0 };
        0.95 * share * self.depth * contacts
    }

    pub(crate) fn has_constant_section(&self) -> bool {
        matches!((&self.form, &self.relaxed), (Form::Prism(_), Relaxed::Even))
    }
}

/// Rows from first touch on, whose values rise; or whose values over places do.
pub(crate) fn rows(stiffens: bool) -> impl Strategy<Value = Vec<(f64, f64)>> + Clone {
    let step = (0.1..0.5f64, 0.05..1.0f64);
    (0.0..1.0f64, proptest::collection::vec(step, 1..5)).prop_map(move |(first, steps)| {
        let mut rows = vec![(0.0, if stiffens { 0.0 } else { (first - 0.5).max(0.0) })];
        let mut ratio = 0.2;
        for (width, rise) in steps {
            let (u, value) = rows[rows.len() - 1];
            let u = u + width;
            ratio += rise;
            rows.push((u, if stiffens { ratio * u } else { value + rise }));
        }
        rows
    })
}

pub(crate) fn bodies() -> impl Strategy<Value = Body> + Clone {
    let form = prop_oneof![
        Just(Form::Ball),
        (1.0..5.0f64).prop_map(Form::Pad),
        (0.1..5.0f64).prop_map(Form::Prism),
        rows(false).prop_map(Form::Profile),
    ];
    let relaxed = prop_oneof![
        2 => Just(Relaxed::Even),
        1 => (0.0..0.5f64).prop_map(Relaxed::Hertz),
        1 => rows(true).prop_map(Relaxed::Measured),
    ];
    let sides = proptest::sample::select(vec![Sides::One, Sides::Two]);
    (form, relaxed, sides, decades(-6.0, 0.0), decades(2.0, 8.0)).prop_map(|(form, relaxed, sides, depth, modulus)| {
        let relaxed = match (&form, relaxed) {
            (Form::Prism(_) | Form::Profile(_), Relaxed::Hertz(_)) => Relaxed::Even,
            (_, relaxed) => relaxed,
        };
        Body {
            form,
            relaxed,
            sides,
            depth,
            modulus,
        }
    })
}

pub(crate) fn blocks() -> impl Strategy<Value = Body> + Clone {
    bodies().prop_map(|body| Body {
        form: Form::Prism(0.7),
        relaxed: Relaxed::Even,
        ..body
    })
}

/// A law in units of time.
#[derive(Debug, Clone)]
pub(crate) enum Law {
    /// n, layers, and v such that an excess strain of 0.1 fades at the rate 1.
    Latency(f64, f64),
    Linear(Vec<(f64, f64)>, Memory),
}

pub(crate) fn laws() -> impl Strategy<Value = Law> + Clone {
    let memory = proptest::sample::select(vec![Memory::Strain, Memory::Force]);
    // Six decades of rates.
    let term = (decades(-2.0, 0.7), decades(-3.0, 3.0));
    let exponent = prop_oneof![0.5..7.3f64, proptest::sample::select(vec![0.5, 1.0, 2.0, 5.0])];
    prop_oneof![
        (exponent, 1.5..40.0f64).prop_map(|(n, m)| Law::Latency(n, m)),
        (proptest::collection::vec(term, 1..6), memory).prop_map(|(terms, memory)| Law::Linear(terms, memory)),
    ]
}

/// A body, its law and the unit of time (s).
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    pub(crate) body: Body,
    pub(crate) law: Law,
    pub(crate) separation: Separation,
    pub(crate) unit: f64,
}

impl Scene {
    pub(crate) fn model(&self) -> Contact {
        let (specimen, separation) = (self.body.specimen(), self.separation);
        match &self.law {
            Law::Latency(n, m) => Contact::from(ContactModel {
                specimen,
                law: LatencyLaw::new(*n, 0.1f64.powf(1.0 - n) / self.unit).unwrap(),
                layers: Layers::new(*m).unwrap(),
                separation,
            }),
            Law::Linear(terms, memory) => {
                let term = |&(overshoot, rate): &(f64, f64)| LinearTerm {
                    overshoot,
                    rate: rate / self.unit,
                };
                let law = LinearLaw::new(&terms.iter().map(term).collect::<Vec<_>>()).unwrap();
                Contact::Linear(LinearContact {
                    specimen,
                    law,
                    memory: *memory,
                    separation,
                })
            }
        }
    }

    /// A equilibrium force that the body carries well, N.
    pub(crate) fn force(&self) -> f64 {
        let specimen = self.body.specimen();
        let u = specimen.contact_displacement(0.6 * self.body.deepest());
        specimen.force(specimen.equilibrium_strain(u), u)
    }

    pub(crate) fn remembers_force(&self) -> bool {
        matches!(&self.law, Law::Linear(_, Memory::Force)) && !self.body.has_constant_section()
    }

    /// As far back as a jaw goes, as a share of the deepest: a bonded round body loses its contact area on the way to first touch, but not
    /// its force if that is what it remembers.
    pub(crate) fn least(&self) -> f64 {
        match (self.separation, self.remembers_force()) {
            (Separation::Bonded, true) => 0.05,
            (Separation::Bonded, false) => 0.0,
            (Separation::Unilateral, _) => -0.05,
        }
    }

    pub(crate) fn motion(&self, knots: &[(f64, f64)]) -> Motion {
        let (mut times, mut displacements) = (vec![0.0], vec![0.0]);
        for (wait, share) in knots {
            times.push(times[times.len() - 1] + wait * self.unit);
            let share = self.least() + (1.0 - self.least()) * share;
            displacements.push(share * self.body.deepest());
        }
        Motion::new(times, displacements).unwrap()
    }
}

pub(crate) fn scenes_of(bodies: impl Strategy<Value = Body>) -> impl Strategy<Value = Scene> {
    let separation = proptest::sample::select(vec![Separation::Bonded, Separation::Unilateral]);
    (bodies, laws(), separation, decades(-3.0, 3.0)).prop_map(|(body, law, separation, unit)| Scene {
        body,
        law,
        separation,
        unit,
    })
}

pub(crate) fn scenes() -> impl Strategy<Value = Scene> {
    scenes_of(bodies())
}

/// Waits in units of time and levels from the least to the deepest; some of them holds.
pub(crate) fn knots() -> impl Strategy<Value = Vec<(f64, f64)>> + Clone {
    let knot = (decades(-2.0, 1.5), 0.0..0.9f64, any::<bool>());
    proptest::collection::vec(knot, 1..7).prop_map(|knots| {
        let mut at = 0.0;
        let each = |(wait, share, holds): (f64, f64, bool)| {
            if !holds {
                at = share;
            }
            (wait, at)
        };
        knots.into_iter().map(each).collect()
    })
}

/// A step of a program in units of the scene.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Step {
    Move(f64, f64),
    MoveToForce(f64, f64),
    HoldPosition(f64),
    Press(f64, f64),
    HoldForce(f64),
}

pub(crate) fn steps() -> impl Strategy<Value = Vec<Step>> + Clone {
    let (wait, level) = (decades(-2.0, 1.5), 0.0..0.9f64);
    // No force at all now and then.
    let force = prop_oneof![4 => 0.01..1.0f64, 1 => Just(0.0)];
    let rate = decades(-1.5, 1.0);
    let step = prop_oneof![
        (level, rate.clone()).prop_map(|(level, rate)| Step::Move(level, rate)),
        (force.clone(), rate.clone()).prop_map(|(force, rate)| Step::MoveToForce(force, rate)),
        wait.clone().prop_map(Step::HoldPosition),
        (force, rate).prop_map(|(force, rate)| Step::Press(force, rate)),
        wait.prop_map(Step::HoldForce),
    ];
    proptest::collection::vec(step, 1..7)
}

impl Scene {
    pub(crate) fn program(&self, steps: &[Step]) -> Vec<ProgramStep> {
        let (deepest, force, unit) = (self.body.deepest(), self.force(), self.unit);
        let step = |step: &Step| match *step {
            Step::Move(level, rate) => ProgramStep::Move {
                to: (self.least() + (1.0 - self.least()) * level) * deepest,
                rate: rate * deepest / unit,
            },
            Step::MoveToForce(share, rate) => ProgramStep::MoveToForce {
                force: share * force,
                rate: rate * deepest / unit,
            },
            Step::HoldPosition(wait) => ProgramStep::HoldPosition { duration: wait * unit },
            Step::Press(share, rate) => ProgramStep::Press {
                to: share * force,
                rate: rate * force / unit,
            },
            Step::HoldForce(wait) => ProgramStep::HoldForce { duration: wait * unit },
        };
        steps.iter().map(step).collect()
    }
}
