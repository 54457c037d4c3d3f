//! The contact in a controller: no operating system, no standard library, no allocator.
//!
//! `cargo build --release` makes a static library of it, with `--target thumbv7em-none-eabihf` for a Cortex-M4. Of anything in it that
//! needed std the compiler would refuse the panic handler, of anything that allocated it would ask for an allocator.

#![no_std]

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{ContactModel, ContactState, Separation};

/// A contact between two ticks.
pub type State = [u8; ContactState::BYTES];

/// Writes a body at rest at first touch to `state`.
#[unsafe(no_mangle)]
pub extern "C" fn contact_start(state: &mut State) {
    *state = ContactState::default().to_bytes();
}

/// Moves the jaw to `displacement` (m, since first touch) within `dt` (s) and returns the contact force (N).
///
/// `state` was written by `contact_start` or by the tick before. Bytes that are no contact, and a step that cannot be taken, give NaN and
/// leave the state as it was.
#[unsafe(no_mangle)]
pub extern "C" fn contact_step(state: &mut State, dt: f64, displacement: f64) -> f64 {
    step(state, dt, displacement).unwrap_or(f64::NAN)
}

fn step(state: &mut State, dt: f64, displacement: f64) -> Option<f64> {
    let model = fingertip()?;
    let mut contact = ContactState::from_bytes(*state).ok()?;
    let force = contact.step(&model, dt, displacement).ok()?;
    *state = contact.to_bytes();
    Some(force)
}

/// A gripper's fingertip of 10 mm radius with 4 mm of silicone, as `palpate analyze` found its law.
fn fingertip() -> Option<ContactModel> {
    let pad = Shape::Pad {
        radius: 0.01,
        thickness: 0.004,
    };
    Some(ContactModel {
        specimen: Specimen::new(pad, 1.2e5, Sides::One).ok()?,
        law: LatencyLaw::new(4.3, 8e3).ok()?,
        layers: Layers::new(6.0).ok()?,
        separation: Separation::Unilateral,
    })
}

/// What a machine does about a mistake of ours is its own: a reset, a brake.
#[panic_handler]
fn stop(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
