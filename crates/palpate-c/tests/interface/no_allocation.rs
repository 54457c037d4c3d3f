//! A step allocates nothing.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ffi::c_char;

use palpate_c::{
    Many, State, Status, palpate_excess_strain, palpate_force, palpate_step, palpate_step_force, palpate_step_many,
    palpate_step_message, palpate_stiffness,
};

use crate::common::{BALL, PAD, model};

/// The allocator of the system, which counts what this thread requests.
struct Counting;

thread_local! {
    static REQUESTS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // A thread that is ending has no such cell any more.
    let _ = REQUESTS.try_with(|requests| requests.set(requests.get() + 1));
}

// SAFETY: every call is handed on to the allocator of the system as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: by the contract of this function.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: by the contract of this function.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: by the contract of this function.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn requests() -> usize {
    REQUESTS.with(Cell::get)
}

#[test]
fn steps_allocate_nothing() {
    let before = requests();
    drop(std::hint::black_box(Box::new(1)));
    assert_eq!(requests(), before + 1, "the counter counts");
    for toml in [BALL, PAD] {
        let owned = model(toml);
        let (mut state, mut found, mut message) = (State::default(), 0.0, [0 as c_char; 200]);
        let (one, dt) = (owned.0.cast_const(), 1e-3);
        let before = requests();
        for tick in 1..=1000 {
            // Far enough back that the jaw leaves and returns.
            let place = 0.002 * (1.5 * (0.02 * f64::from(tick)).sin() + 0.4);
            let many = Many {
                count: 1,
                models: &raw const one,
                model_stride: 0,
                states: &raw mut state,
                state_stride: size_of::<State>(),
                dt_s: &raw const dt,
                dt_stride: 0,
                to: &raw const place,
                to_stride: 0,
                results: &raw mut found,
                statuses: std::ptr::null_mut(),
            };
            // SAFETY: pointers to values of this test.
            let statuses = unsafe {
                [
                    palpate_step(owned.0, &raw mut state, 1e-3, place, &raw mut found),
                    palpate_step_many(&raw const many),
                    palpate_step_force(owned.0, &raw mut state, 1e-3, 0.5, &raw mut found),
                    palpate_force(owned.0, &raw const state, &raw mut found),
                    palpate_stiffness(owned.0, &raw const state, &raw mut found),
                    palpate_excess_strain(owned.0, &raw const state, &raw mut found),
                ]
            };
            // SAFETY: the same, and a buffer of that size.
            let refused = unsafe {
                palpate_step_message(owned.0, &raw const state, 1e-3, f64::NAN, message.as_mut_ptr(), message.len())
            };
            assert!(statuses == [Status::Ok; 6] && refused == Status::NotFinite);
        }
        assert_eq!(requests(), before);
    }
}
