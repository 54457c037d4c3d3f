//! States of contacts and observers, and results as JSON, that something has damaged: shared by a test and the fuzz target `read_state`.

use std::sync::LazyLock;

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::fit::{Fit, LawOptions, Samples, fit_law};
use palpate::latency::LatencyLaw;
use palpate::laws::Law;
use palpate::observe::{Observer, ObserverOptions};
use palpate::simulate::{
    ContactModel, ContactState, ProtocolStep, Sampling, Separation, Trajectory, protocol, simulate,
};

/// What is damaged, in the state in which it was written.
static WHOLE: LazyLock<[Vec<u8>; 4]> = LazyLock::new(|| {
    let mut observer = Observer::new(ObserverOptions::default()).expect("the usual options");
    for tick in 0..400 {
        let time = 0.01 * f64::from(tick);
        let (jaw, force) = if time < 1.0 { (time, 2.0 * time) } else { (1.0, 1.0 + (4.0 * time - 3.0).powf(-0.25)) };
        observer.feed(time, Some(1e-3 * jaw), force).expect("a reading");
    }
    let times: Vec<f64> = (0..60).map(f64::from).collect();
    let values: Vec<f64> = times.iter().map(|t| 1.0 + (1.0 + 4.0 * t).powf(-0.25) + 1e-3 * (9.0 * t).sin()).collect();
    let law: Law = "latency".parse().expect("the name of a law");
    let fit = fit_law(&Samples::new(&times, &values), law, &LawOptions::default()).expect("a fit");
    let motion = protocol(&[ProtocolStep {
        to: 5e-3,
        rate: 8e-3,
        hold: 1.0,
    }]);
    let trajectory =
        simulate(&motion.expect("a motion"), &model(), &Sampling::Rate(5.0)).expect("a motion within the body");
    let json = |json: serde_json::Result<Vec<u8>>| json.expect("numbers that have a form in JSON");
    [
        ContactState::default().to_bytes().to_vec(),
        observer.to_bytes(),
        json(serde_json::to_vec(&fit)),
        json(serde_json::to_vec(&trajectory)),
    ]
});

fn model() -> ContactModel {
    ContactModel {
        specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).expect("a ball"),
        law: LatencyLaw::new(5.0, 2e4).expect("a law"),
        layers: Layers::new(8.0).expect("layers"),
        separation: Separation::Unilateral,
    }
}

/// Damages a state as the bytes say, reads it, and asks it everything; it must not panic.
///
/// The first byte is which state. Every three that follow are a place and the byte that stands there; a last one or two are where it is cut.
pub(crate) fn answer_any(bytes: &[u8]) {
    let [which, patches @ ..] = bytes else { return };
    let which = usize::from(*which) % WHOLE.len();
    let mut state = WHOLE[which].clone();
    let count = state.len();
    let place = |at: &[u8]| at.iter().fold(0, |place, byte| place << 8 | usize::from(*byte)) % count;
    let chunks = patches.chunks_exact(3);
    let cut = chunks.remainder();
    for patch in chunks {
        state[place(&patch[..2])] = patch[2];
    }
    if !cut.is_empty() {
        state.truncate(place(cut));
    }
    match which {
        0 => {
            let Ok(mut contact) = <[u8; ContactState::BYTES]>::try_from(state)
                .map_err(drop)
                .and_then(|state| ContactState::from_bytes(state).map_err(drop))
            else {
                return;
            };
            for displacement in [1e-3, 5e-3, 0.0] {
                let _ = contact.step(&model(), 1e-2, displacement);
                let _ = contact.step_force(&model(), 1e-2, 1e3 * displacement);
                let _ = (contact.force(&model()), contact.surface(&model()), contact.is_touching(&model()));
            }
        }
        1 => {
            let Ok(mut observer) = Observer::from_bytes(ObserverOptions::default(), &state) else {
                return;
            };
            for tick in 0..20 {
                let _ = observer.feed(4.0 + 0.01 * f64::from(tick), Some(1e-3), 1.5);
            }
            let _ = observer.to_bytes();
        }
        2 => {
            let Ok(fit) = serde_json::from_slice::<Fit>(&state) else {
                return;
            };
            for elapsed in [0.0, 1.0, 1e6, f64::NAN] {
                let _ = (fit.predict_interval(elapsed), fit.predict_sample(elapsed));
            }
            let _ = (fit.value("exponent"), fit.estimate("equilibrium"));
        }
        _ => {
            let Ok(found) = serde_json::from_slice::<Trajectory>(&state) else {
                return;
            };
            let sum: f64 = (0..found.len()).map(|index| found.force[index] + found.strain[index]).sum();
            let _ = (sum, found.in_contact.iter().filter(|touches| **touches).count());
        }
    }
}
