//! What is refused is refused by code, with a message where there is a buffer, and changes nothing.

use std::ffi::{CStr, CString, c_char};
use std::ptr;

use palpate_c::{
    Model, PALPATE_STATE_BYTES, State, Status, palpate_force, palpate_model_calibrated_m, palpate_model_deepest_m,
    palpate_model_depth_m, palpate_model_free, palpate_model_from_file, palpate_model_from_text,
    palpate_model_is_bonded, palpate_model_sides, palpate_state_restore, palpate_state_save, palpate_step,
    palpate_step_force, palpate_step_force_message, palpate_step_message, palpate_stiffness,
};

use crate::common::{BALL, PAD, model};

fn from_text(toml: &str) -> (Status, String) {
    let toml = CString::new(toml).unwrap();
    let (mut model, mut message) = (ptr::null_mut(), [0; 400]);
    // SAFETY: texts with closing zeros, a place for the model, a buffer of that size.
    let status = unsafe {
        palpate_model_from_text(toml.as_ptr(), c"pad.toml".as_ptr(), &raw mut model, message.as_mut_ptr(), 400)
    };
    assert!(model.is_null());
    (status, text(&message))
}

fn text(message: &[c_char]) -> String {
    // SAFETY: the interface closes its messages.
    unsafe { CStr::from_ptr(message.as_ptr()) }.to_str().unwrap().to_owned()
}

#[test]
fn descriptions_that_make_no_model_are_refused_with_their_place() {
    let (status, message) = from_text(&BALL.replace("\"35 mm\"", "35"));
    assert_eq!(status, Status::Description);
    assert!(
        message.starts_with("pad.toml, line 4: specimen.radius = 35: ") && message.contains("; hint: "),
        "{message}"
    );
    let linear = "name = \"standard linear solid\"\nratio = 0.4\ntime = \"2 s\"";
    let (head, _) = BALL.split_once("name").unwrap();
    let (status, message) = from_text(&format!("{head}{linear}\n"));
    assert!(matches!(status, Status::Law | Status::Description), "{message}");
    let mut model = ptr::null_mut();
    let mut message = [0; 100];
    // SAFETY: a path with its closing zero, a place for the model, a buffer of that size.
    let status =
        unsafe { palpate_model_from_file(c"/no/such.toml".as_ptr(), &raw mut model, message.as_mut_ptr(), 100) };
    assert_eq!(status, Status::Description);
    assert!(text(&message).contains("/no/such.toml") && model.is_null());
    // SAFETY: null pointers where values are needed.
    let statuses = unsafe {
        [
            palpate_model_from_file(ptr::null(), &raw mut model, ptr::null_mut(), 0),
            palpate_model_from_file(c"a".as_ptr(), ptr::null_mut(), ptr::null_mut(), 0),
            palpate_model_from_text(ptr::null(), ptr::null(), &raw mut model, ptr::null_mut(), 0),
        ]
    };
    assert_eq!(statuses, [Status::NullPointer; 3]);
    // SAFETY: bytes with a closing zero, a place for the model, a buffer of that size.
    let status = unsafe {
        palpate_model_from_text(c"a = \"\xff\"".as_ptr(), ptr::null(), &raw mut model, message.as_mut_ptr(), 100)
    };
    assert_eq!(
        (status, text(&message).as_str()),
        (Status::Description, "expected text in UTF-8, found other bytes at byte 5")
    );
    // SAFETY: null is ignored.
    assert_eq!(unsafe { palpate_model_free(ptr::null_mut()) }, Status::Ok);
}

#[test]
fn a_model_states_its_range() {
    let range = |model: *const Model| {
        let (mut sides, mut numbers) = (0, [0.0; 3]);
        let [depth, deepest, calibrated] = &mut numbers;
        // SAFETY: pointers to values of this test.
        let statuses = unsafe {
            [
                palpate_model_sides(model, &raw mut sides),
                palpate_model_depth_m(model, depth),
                palpate_model_deepest_m(model, deepest),
                palpate_model_calibrated_m(model, calibrated),
            ]
        };
        assert_eq!(statuses, [Status::Ok; 4]);
        (sides, numbers)
    };
    let (sides, [depth, deepest, calibrated]) = range(model(BALL).0);
    assert!(sides == 2 && depth == 0.035 && (0.07 - 1e-15..0.07).contains(&deepest) && calibrated == f64::INFINITY);
    let (sides, [depth, deepest, _]) = range(model(PAD).0);
    assert!(sides == 1 && depth == 0.006 && (0.006 - 1e-15..0.006).contains(&deepest));

    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/records/ball-material.toml");
    let path = CString::new(path).unwrap();
    let mut made = ptr::null_mut();
    // SAFETY: a path with its closing zero and a place for the model.
    let status = unsafe { palpate_model_from_file(path.as_ptr(), &raw mut made, ptr::null_mut(), 0) };
    assert_eq!(status, Status::Ok);
    let (sides, [_, _, calibrated]) = range(made);
    // `deepest` of the file.
    assert!(sides == 2 && (calibrated - 0.015_001_017).abs() < 1e-9);
    // SAFETY: made above.
    assert_eq!(unsafe { palpate_model_free(made) }, Status::Ok);
    let mut number = 0.0;
    // SAFETY: null pointers where values are needed.
    assert_eq!(unsafe { palpate_model_depth_m(ptr::null(), &raw mut number) }, Status::NullPointer);
}

/// A state that an engine had overwritten was answered with 1005 N and −5027 N/m for a ball of 35 mm.
#[test]
fn a_state_beyond_the_body_has_no_force_and_makes_no_step() {
    let owned = model(BALL);
    let (mut state, mut number) = (
        State {
            jaw_m: 0.05,
            behind_m: 0.0,
        },
        -1.0,
    );
    // SAFETY: pointers to values of this test.
    let statuses = unsafe {
        [
            palpate_force(owned.0, &raw const state, &raw mut number),
            palpate_stiffness(owned.0, &raw const state, &raw mut number),
            palpate_step(owned.0, &raw mut state, 0.1, 0.004, &raw mut number),
        ]
    };
    assert_eq!((statuses, number), ([Status::Displacement; 3], -1.0));
}

#[test]
fn a_model_states_whether_its_jaw_pulls() {
    for (sentence, expected, pulls) in
        [("", 0, false), ("separation = true", 0, false), ("separation = false", 1, true)]
    {
        let owned = model(&format!("{BALL}[contact]\n{sentence}\n"));
        let (mut is_bonded, mut state, mut force) = (-1, State::default(), f64::NAN);
        // SAFETY: pointers to values of this test, here and below.
        assert_eq!(unsafe { palpate_model_is_bonded(owned.0, &raw mut is_bonded) }, Status::Ok);
        unsafe { palpate_step(owned.0, &raw mut state, 1.0, 0.002, &raw mut force) };
        unsafe { palpate_step(owned.0, &raw mut state, 0.01, 0.0002, &raw mut force) };
        assert_eq!((is_bonded, force < 0.0), (expected, pulls), "{sentence}");
    }
}

#[test]
fn refused_steps_change_nothing_and_say_why() {
    let owned = model(BALL);
    let mut state = State::default();
    let mut force = 0.0;
    // SAFETY: pointers to values of this test, here and below.
    unsafe { palpate_step(owned.0, &raw mut state, 0.1, 0.004, &raw mut force) };
    let before = (state, force);
    let nan = f64::NAN;
    let refused = [
        (nan, 0.004, Status::NotFinite, "time step must be a finite number of 0 s or more, found NaN"),
        (-1.0, 0.004, Status::NotFinite, "time step must be a finite number of 0 s or more, found -1"),
        (
            f64::INFINITY,
            0.004,
            Status::NotFinite,
            "time step must be a finite number of 0 s or more, found inf",
        ),
        (0.1, nan, Status::NotFinite, "displacement must be a finite number, found NaN"),
        (
            0.1,
            0.08,
            Status::Displacement,
            "contact displacement must stay below the radius of 0.035 m, found 0.04 m",
        ),
    ];
    for (dt, to, expected, reason) in refused {
        let status = unsafe { palpate_step(owned.0, &raw mut state, dt, to, &raw mut force) };
        assert_eq!((status, state, force), (expected, before.0, before.1));
        let mut message = [1; 200];
        let status = unsafe { palpate_step_message(owned.0, &raw const state, dt, to, message.as_mut_ptr(), 200) };
        assert_eq!((status, text(&message).as_str()), (expected, reason));
    }
    let status = unsafe { palpate_step_force(owned.0, &raw mut state, 0.1, 1e6, &raw mut force) };
    assert_eq!((status, state, force), (Status::Force, before.0, before.1));
    let mut message = [1; 200];
    let status = unsafe { palpate_step_force_message(owned.0, &raw const state, 0.1, -1.0, message.as_mut_ptr(), 200) };
    assert_eq!(status, Status::Force);
    assert_eq!(text(&message), "no single displacement within the range of the body carries -1 N");
    let status = unsafe { palpate_step_message(owned.0, &raw const state, 0.1, 0.004, message.as_mut_ptr(), 200) };
    assert_eq!((status, text(&message).as_str(), state), (Status::Ok, "", before.0));
}

#[test]
fn null_and_states_that_are_none_are_refused() {
    let owned = model(BALL);
    let (mut state, mut force) = (State::default(), 7.0);
    // SAFETY: null pointers where values are needed, and pointers to values of this test, here and below.
    let statuses = unsafe {
        [
            palpate_step(ptr::null(), &raw mut state, 0.1, 0.004, &raw mut force),
            palpate_step(owned.0, ptr::null_mut(), 0.1, 0.004, &raw mut force),
            palpate_force(owned.0, &raw const state, ptr::null_mut()),
            palpate_state_save(ptr::null(), ptr::null_mut()),
            palpate_state_restore(ptr::null(), &raw mut state),
        ]
    };
    assert_eq!((statuses, state, force), ([Status::NullPointer; 5], State::default(), 7.0));
    for bad in [f64::NAN, f64::INFINITY] {
        for (jaw_m, behind_m) in [(bad, 0.0), (0.0, bad)] {
            let mut broken = State { jaw_m, behind_m };
            let bits = [jaw_m.to_bits(), behind_m.to_bits()];
            let status = unsafe { palpate_step(owned.0, &raw mut broken, 0.1, 0.004, &raw mut force) };
            assert_eq!((status, force), (Status::NotFinite, 7.0));
            assert_eq!([broken.jaw_m.to_bits(), broken.behind_m.to_bits()], bits);
            assert_eq!(unsafe { palpate_force(owned.0, &raw const broken, &raw mut force) }, Status::NotFinite);
            let mut bytes = [0; PALPATE_STATE_BYTES];
            assert_eq!(unsafe { palpate_state_save(&raw const broken, bytes.as_mut_ptr()) }, Status::NotFinite);
        }
    }
    let bytes = [0; PALPATE_STATE_BYTES];
    assert_eq!(unsafe { palpate_state_restore(bytes.as_ptr(), &raw mut state) }, Status::StateBytes);
    // Finite numbers far outside of any body: a code or a finite force, never another number.
    for (jaw_m, behind_m) in [(1e300, -1e300), (-1e300, 1e300), (1e-300, 1e300), (f64::MAX, -f64::MAX)] {
        for to in [-0.001, 0.0, 0.004] {
            let mut far = State { jaw_m, behind_m };
            let status = unsafe { palpate_step(owned.0, &raw mut far, 1e-3, to, &raw mut force) };
            assert!(status != Status::Internal && force.is_finite(), "{jaw_m} {behind_m}: {status:?} {force}");
        }
    }
}
