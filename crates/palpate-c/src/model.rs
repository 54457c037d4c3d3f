//! A body with its law, from a file or a text.

use std::ffi::{CStr, c_char};
use std::path::Path;

use palpate::contact::{RateDependence, Sides};
use palpate::simulate::{Contact, ContactModel, Separation};
use palpate_files::description::{DescriptionError, law_named, parse_material, parse_scene, read_protocol_text};

use crate::call::{Message, Status, exclusive, guarded, shared};

/// A body with its law: what turns motion into force. It never changes, and any number of threads may use it at once.
#[derive(Debug)]
pub struct Model {
    pub(crate) contact: ContactModel,
    /// The deepest travel of the jaw in the test that it was calibrated by, m; infinite of a body that was described.
    calibrated: f64,
}

const _: () = {
    const fn shared_between_threads<T: Send + Sync>() {}
    shared_between_threads::<Model>();
};

/// Why there is no model.
enum Refused {
    Described(DescriptionError),
    /// A law that is not stepped, by its name.
    Law(Option<String>),
}

impl From<DescriptionError> for Refused {
    fn from(error: DescriptionError) -> Self {
        Self::Described(error)
    }
}

impl Refused {
    fn report(&self, message: &mut Message<'_>) -> Status {
        match self {
            Self::Described(error) => {
                match error.hint() {
                    Some(hint) => message.set(format_args!("{error}; hint: {hint}")),
                    None => message.set(format_args!("{error}")),
                }
                Status::Description
            }
            Self::Law(found) => {
                let found = found.as_ref().map_or("another law".to_owned(), |name| format!("\"{name}\""));
                message.set(format_args!(
                    "law.name: expected \"latency\" with one rate coefficient, which is stepped here, found {found}; hint: \
                     palpate.ContactStates in Python steps contacts of every law"
                ));
                Status::Law
            }
        }
    }
}

impl Model {
    fn read(text: &str, path: &Path) -> Result<Self, Refused> {
        let Contact::Latency {
            model: contact,
            rate: RateDependence::Constant,
        } = parse_scene(text, path)?.1
        else {
            return Err(Refused::Law(law_named(text)));
        };
        // A table of this name is that of a calibrated material, whose parameters nobody has edited since.
        let is_calibrated = text.lines().any(|line| line.trim_start().starts_with("[calibration"));
        let calibrated =
            if is_calibrated { parse_material(text, path)?.material.range().deepest } else { f64::INFINITY };
        Ok(Self { contact, calibrated })
    }

    /// The travel of the jaw that one contact's displacement is the share of, m.
    fn travel(&self, contact_displacement: f64) -> f64 {
        contact_displacement / self.contact.specimen.contact_displacement(1.0)
    }

    fn deepest(&self) -> f64 {
        let specimen = &self.contact.specimen;
        let is_strip = self.contact.separation == Separation::Bonded
            && specimen.check_contact_displacement(2.0 * specimen.deepest(), true).is_ok();
        if is_strip { f64::INFINITY } else { self.travel(specimen.deepest()) }
    }
}

/// A text of the caller.
///
/// # Safety
/// Null, or ends with a zero and is written by nothing while the result lives.
unsafe fn text<'a>(pointer: *const c_char, message: &mut Message<'_>) -> Result<&'a str, Status> {
    if pointer.is_null() {
        return Err(Status::NullPointer);
    }
    // SAFETY: not null, and by the contract of this function ends with a zero.
    let bytes = unsafe { CStr::from_ptr(pointer) };
    bytes.to_str().map_err(|error| {
        message.set(format_args!("expected text in UTF-8, found other bytes at byte {}", error.valid_up_to()));
        Status::Description
    })
}

fn give(made: Result<Model, Refused>, model: &mut *mut Model, message: &mut Message<'_>) -> Result<(), Status> {
    let made = made.map_err(|refused| refused.report(message))?;
    *model = Box::into_raw(Box::new(made));
    Ok(())
}

/// Reads a model from a file: a material of `palpate calibrate`, or the tables specimen, law and contact of a protocol, whose steps are ignored.
///
/// `path` is UTF-8. `message` may be null; it takes at most `capacity` bytes with the closing zero: why there is no model, with file, line and
/// key, or nothing. The model must be freed by `palpate_model_free`.
///
/// # Safety
/// Each pointer is null or valid, `path` up to its closing zero and `message` for `capacity` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_model_from_file(
    path: *const c_char,
    model: *mut *mut Model,
    message: *mut c_char,
    capacity: usize,
) -> Status {
    guarded(|| {
        // SAFETY: by the contract of this function.
        let mut message = unsafe { Message::into(message, capacity) };
        // SAFETY: the same.
        let model = unsafe { exclusive(model) }?;
        // SAFETY: the same.
        let path = Path::new(unsafe { text(path, &mut message) }?);
        let made = read_protocol_text(path).map_err(Refused::from).and_then(|text| Model::read(&text, path));
        give(made, model, &mut message)
    })
}

/// Reads a model from TOML text, as `palpate_model_from_file` does from a file.
///
/// `name` stands in messages, and a `material = "FILE"` in the text is sought beside it; null is a text in the working directory.
///
/// # Safety
/// Each pointer is null or valid, `toml` and `name` up to their closing zeros and `message` for `capacity` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_model_from_text(
    toml: *const c_char,
    name: *const c_char,
    model: *mut *mut Model,
    message: *mut c_char,
    capacity: usize,
) -> Status {
    guarded(|| {
        // SAFETY: by the contract of this function.
        let mut message = unsafe { Message::into(message, capacity) };
        // SAFETY: the same.
        let model = unsafe { exclusive(model) }?;
        // SAFETY: the same.
        let toml = unsafe { text(toml, &mut message) }?;
        // SAFETY: the same.
        let name = if name.is_null() { "model" } else { unsafe { text(name, &mut message) }? };
        give(Model::read(toml, Path::new(name)), model, &mut message)
    })
}

/// Frees a model; null is ignored. Nothing may use it any more.
///
/// # Safety
/// Null, or a model of this library that was not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_model_free(model: *mut Model) -> Status {
    guarded(|| {
        if !model.is_null() {
            // SAFETY: by the contract of this function the box that `give` gave away.
            drop(unsafe { Box::from_raw(model) });
        }
        Ok(())
    })
}

/// Writes what a function of a model says.
///
/// # Safety
/// Each pointer is null or valid.
unsafe fn query<T>(model: *const Model, to: *mut T, of: impl FnOnce(&Model) -> T) -> Status {
    guarded(|| {
        // SAFETY: by the contract of this function.
        let model = unsafe { shared(model) }?;
        // SAFETY: the same.
        *unsafe { exclusive(to) }? = of(model);
        Ok(())
    })
}

/// Number of sides from which the body is squeezed: 2, and each contact takes half the displacement of the jaws, or 1.
///
/// # Safety
/// Each pointer is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_model_sides(model: *const Model, sides: *mut i32) -> Status {
    let of = |model: &Model| match model.contact.specimen.sides() {
        Sides::Two => 2,
        Sides::One => 1,
    };
    // SAFETY: by the contract of this function.
    unsafe { query(model, sides, of) }
}

/// Distance in m from an undeformed contact to the plane of the body that does not move, such as the radius of a ball.
///
/// # Safety
/// Each pointer is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_model_depth_m(model: *const Model, depth_m: *mut f64) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { query(model, depth_m, |model| model.contact.specimen.depth()) }
}

/// The largest displacement of the jaw in m that `palpate_step` accepts; infinite of a prism bonded to its grips.
///
/// # Safety
/// Each pointer is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_model_deepest_m(model: *const Model, deepest_m: *mut f64) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { query(model, deepest_m, Model::deepest) }
}

/// 1 where the body counts as bonded to its jaw (`separation = false`), which then pulls below 0 m from any distance; 0 where the jaw lets go.
///
/// # Safety
/// Each pointer is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_model_is_bonded(model: *const Model, is_bonded: *mut i32) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { query(model, is_bonded, |model| i32::from(model.contact.separation == Separation::Bonded)) }
}

/// The deepest displacement of the jaw in m in the test that a material was calibrated by; infinite of a body that was described.
///
/// # Safety
/// Each pointer is null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_model_calibrated_m(model: *const Model, calibrated_m: *mut f64) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { query(model, calibrated_m, |model| model.calibrated) }
}
