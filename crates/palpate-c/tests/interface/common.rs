//! Models that several tests use.

use std::ffi::{CStr, CString};
use std::path::Path;
use std::ptr;

use palpate::simulate::{Contact, ContactModel};
use palpate_c::{Model, Status, palpate_model_free, palpate_model_from_text};
use palpate_files::description::parse_scene;

/// The ball of the paper.
pub(crate) const BALL: &str = r#"
[specimen]
shape = "ball"
radius = "35 mm"
modulus = "28 kPa"
[law]
name = "latency"
exponent = 5
rate_coefficient = "2e4 /s"
"#;

/// A pad by Hertz's law with an exponent that has no root of its own, pressed from one side.
pub(crate) const PAD: &str = r#"
[specimen]
shape = "pad"
radius = "12 mm"
thickness = "6 mm"
modulus = "90 kPa"
equilibrium = "hertz"
poisson_ratio = 0.48
[contact]
layers = 6.5
squeezed_from = "one side"
[law]
name = "latency"
exponent = 3.7
rate_coefficient = "150 /s"
"#;

/// A model of the interface that is freed with it.
pub(crate) struct Owned(pub(crate) *mut Model);

impl Drop for Owned {
    fn drop(&mut self) {
        // SAFETY: made by the interface and freed here alone.
        assert_eq!(unsafe { palpate_model_free(self.0) }, Status::Ok);
    }
}

pub(crate) fn model(toml: &str) -> Owned {
    let toml = CString::new(toml).unwrap();
    let (mut model, mut message) = (ptr::null_mut(), [0; 400]);
    // SAFETY: texts with closing zeros, a place for the model, a buffer of that size.
    let status = unsafe {
        palpate_model_from_text(toml.as_ptr(), ptr::null(), &raw mut model, message.as_mut_ptr(), message.len())
    };
    // SAFETY: the interface closes its messages.
    let message = unsafe { CStr::from_ptr(message.as_ptr()) };
    assert_eq!(status, Status::Ok, "{message:?}");
    Owned(model)
}

/// The same model of the library.
pub(crate) fn library_model(toml: &str) -> ContactModel {
    match parse_scene(toml, Path::new("model")).unwrap().1 {
        Contact::Latency { model, .. } => model,
        Contact::Linear(_) => panic!("a latency law"),
    }
}
