//! Steps of the interface are those of the library to the last bit.

use std::ptr;

use palpate::simulate::ContactState;
use palpate::test_problems::Rng;
use palpate_c::{
    PALPATE_STATE_BYTES, State, Status, palpate_excess_strain, palpate_force, palpate_is_touching,
    palpate_state_restore, palpate_state_save, palpate_step, palpate_step_force, palpate_stiffness, palpate_surface,
};

use crate::common::{BALL, PAD, library_model, model};

fn of(state: ContactState) -> State {
    let (jaw_m, behind_m) = state.displacements();
    State { jaw_m, behind_m }
}

#[test]
fn steps_are_those_of_the_library_to_the_last_bit() {
    for toml in [BALL, PAD] {
        let (owned, library) = (model(toml), library_model(toml));
        let (mut state, mut expected) = (State::default(), ContactState::default());
        let (mut random, mut place, mut left) = (Rng::new(11), 0.0, 0);
        for tick in 0..2000 {
            let dt = if random.uniform() < 0.1 { 0.0 } else { 0.02 * random.uniform() };
            let mut found = f64::NAN;
            if tick % 7 == 3 && expected.is_touching(&library) {
                let force = 3.0 * random.uniform();
                let reached = expected.step_force(&library, dt, force).unwrap();
                // SAFETY: pointers to values of this test.
                let status = unsafe { palpate_step_force(owned.0, &raw mut state, dt, force, &raw mut found) };
                assert_eq!((status, found.to_bits()), (Status::Ok, reached.to_bits()), "{tick}");
                place = reached;
            } else {
                place = (place + 1e-3 * (random.uniform() - 0.5)).clamp(-0.001, 0.005);
                let force = expected.step(&library, dt, place).unwrap();
                // SAFETY: pointers to values of this test.
                let status = unsafe { palpate_step(owned.0, &raw mut state, dt, place, &raw mut found) };
                assert_eq!((status, found.to_bits()), (Status::Ok, force.to_bits()), "{tick}");
            }
            left += usize::from(!expected.is_touching(&library));
            assert_eq!(state, of(expected), "{tick}");
            let mut looks = [f64::NAN; 4];
            let [force, stiffness, excess, surface] = &mut looks;
            // SAFETY: pointers to values of this test.
            let statuses = unsafe {
                [
                    palpate_force(owned.0, &raw const state, force),
                    palpate_stiffness(owned.0, &raw const state, stiffness),
                    palpate_excess_strain(owned.0, &raw const state, excess),
                    palpate_surface(owned.0, &raw const state, surface),
                ]
            };
            assert_eq!(statuses, [Status::Ok; 4]);
            let values = [
                expected.force(&library),
                expected.stiffness(&library),
                expected.excess_strain(&library),
                expected.surface(&library),
            ];
            assert_eq!(looks.map(f64::to_bits), values.map(f64::to_bits), "{tick}");
            let mut touching = -1;
            // SAFETY: pointers to values of this test.
            let status = unsafe { palpate_is_touching(owned.0, &raw const state, &raw mut touching) };
            assert_eq!((status, touching), (Status::Ok, i32::from(expected.is_touching(&library))));
        }
        assert!(left > 20, "{left} steps without contact");
    }
}

#[test]
fn a_state_comes_back_from_its_bytes_and_a_result_may_be_ignored() {
    let owned = model(BALL);
    let mut state = State::default();
    // SAFETY: pointers to values of this test, and null where it is allowed.
    assert_eq!(unsafe { palpate_step(owned.0, &raw mut state, 0.1, 0.004, ptr::null_mut()) }, Status::Ok);
    let (mut bytes, mut back) = ([0; PALPATE_STATE_BYTES], State::default());
    // SAFETY: as many bytes as a state has.
    assert_eq!(unsafe { palpate_state_save(&raw const state, bytes.as_mut_ptr()) }, Status::Ok);
    // SAFETY: the same.
    assert_eq!(unsafe { palpate_state_restore(bytes.as_ptr(), &raw mut back) }, Status::Ok);
    assert_eq!(back, state);
    let library = ContactState::from_displacements(state.jaw_m, state.behind_m).unwrap();
    assert_eq!(bytes, library.to_bytes());
}
