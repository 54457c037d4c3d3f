//! Many contacts at once are contacts one by one.

use std::ptr;

use palpate_c::{Many, Model, State, Status, palpate_step, palpate_step_force_many, palpate_step_many};

use crate::common::{BALL, PAD, model};

/// Time step in s, and force in N, of all contacts.
static DT: f64 = 1e-3;
static FORCE: f64 = 1.5;

/// A contact among other numbers of an engine.
#[repr(C)]
#[derive(Clone, Copy, Default, Debug, PartialEq)]
struct Entry {
    before: f64,
    state: State,
    after: f64,
}

#[test]
fn contacts_at_strides_are_contacts_one_by_one() {
    let (ball, pad) = (model(BALL), model(PAD));
    let models: Vec<*const Model> =
        (0..9).map(|index| if index % 2 == 0 { ball.0 } else { pad.0 }.cast_const()).collect();
    let mut entries = [Entry {
        before: 3.0,
        state: State::default(),
        after: 4.0,
    }; 9];
    let (mut alone, mut results, mut statuses) = ([State::default(); 9], [0.0; 9], [Status::Internal; 9]);
    for tick in 1..=50 {
        let to: Vec<f64> = (0..9).map(|index| 1e-5 * f64::from(tick * (index + 1))).collect();
        let many = Many {
            count: 9,
            models: models.as_ptr(),
            model_stride: size_of::<*const Model>(),
            states: &raw mut entries[0].state,
            state_stride: size_of::<Entry>(),
            dt_s: &raw const DT,
            dt_stride: 0,
            to: to.as_ptr(),
            to_stride: size_of::<f64>(),
            results: results.as_mut_ptr(),
            statuses: statuses.as_mut_ptr(),
        };
        // SAFETY: arrays of this test at their strides.
        assert_eq!(unsafe { palpate_step_many(&raw const many) }, Status::Ok);
        for index in 0..9 {
            let mut force = 0.0;
            // SAFETY: pointers to values of this test.
            unsafe { palpate_step(models[index], &raw mut alone[index], 1e-3, to[index], &raw mut force) };
            assert_eq!(results[index].to_bits(), force.to_bits());
        }
        let states = entries.map(|entry| entry.state);
        assert_eq!((states, statuses), (alone, [Status::Ok; 9]));
        assert!(entries.iter().all(|entry| entry.before == 3.0 && entry.after == 4.0));
    }
}

#[test]
fn a_contact_that_cannot_be_stepped_stays_and_the_others_go_on() {
    let ball = model(BALL);
    let (mut states, mut results, mut statuses) = ([State::default(); 3], [5.0; 3], [Status::Internal; 3]);
    let to = [0.004, f64::NAN, 0.004];
    let one = ball.0.cast_const();
    let mut many = Many {
        count: 3,
        models: &raw const one,
        model_stride: 0,
        states: states.as_mut_ptr(),
        state_stride: size_of::<State>(),
        dt_s: &raw const DT,
        dt_stride: 0,
        to: to.as_ptr(),
        to_stride: size_of::<f64>(),
        results: results.as_mut_ptr(),
        statuses: statuses.as_mut_ptr(),
    };
    // SAFETY: arrays of this test at their strides, here and below.
    assert_eq!(unsafe { palpate_step_many(&raw const many) }, Status::SomeRefused);
    assert_eq!(statuses, [Status::Ok, Status::NotFinite, Status::Ok]);
    assert_eq!((states[1], results[1]), (State::default(), 5.0));
    assert!(states[0] == states[2] && results[0] == results[2] && results[0] > 0.0);
    many.to = &raw const FORCE;
    many.to_stride = 0;
    assert_eq!(unsafe { palpate_step_force_many(&raw const many) }, Status::Ok);
    many.count = 0;
    many.models = ptr::null();
    assert_eq!(unsafe { palpate_step_many(&raw const many) }, Status::Ok);
    many.count = 1;
    assert_eq!(unsafe { palpate_step_many(&raw const many) }, Status::NullPointer);
    assert_eq!(unsafe { palpate_step_many(ptr::null()) }, Status::NullPointer);
}
