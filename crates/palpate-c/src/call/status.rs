//! Codes of calls and their texts.

use std::ffi::{CStr, c_char};

use palpate::simulate::StepError;

/// The outcome of a call.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// A pointer that must not be null is null.
    NullPointer = 1,
    /// A time step, displacement, force or state that is NaN or infinite, or a time step below 0.
    NotFinite = 2,
    /// A displacement that the body cannot take.
    Displacement = 3,
    /// A force that no displacement carries, or that pulls where nothing can be pulled.
    Force = 4,
    /// Bytes of something else than a state of this format.
    StateBytes = 5,
    /// A file or a text that is no description of a body and its law.
    Description = 6,
    /// A law that is not stepped: any but the latency law with one rate coefficient.
    Law = 7,
    /// A result beyond the range of double precision.
    Range = 8,
    /// Some contacts of many were not stepped; the others were.
    SomeRefused = 9,
    /// A defect of this library; nothing was written.
    Internal = 10,
}

impl From<StepError> for Status {
    fn from(error: StepError) -> Self {
        match error {
            StepError::Displacement(_) => Self::Displacement,
            StepError::Force { .. } => Self::Force,
            StepError::Format => Self::StateBytes,
            _ => Self::NotFinite,
        }
    }
}

impl Status {
    fn text(self) -> &'static CStr {
        match self {
            Self::Ok => c"done",
            Self::NullPointer => c"expected a pointer, found null",
            Self::NotFinite => c"expected finite numbers and a time step of 0 s or more",
            Self::Displacement => c"the displacement is beyond the range of the body",
            Self::Force => c"no single displacement within the range of the body carries the force",
            Self::StateBytes => c"expected the bytes of a contact state",
            Self::Description => c"expected a description of a body and its law",
            Self::Law => c"a contact is stepped by the latency law with one rate coefficient",
            Self::Range => c"the result exceeds the range of double precision",
            Self::SomeRefused => c"some contacts could not be stepped",
            Self::Internal => c"a defect of palpate",
        }
    }

    const ALL: [Self; 11] = [
        Self::Ok,
        Self::NullPointer,
        Self::NotFinite,
        Self::Displacement,
        Self::Force,
        Self::StateBytes,
        Self::Description,
        Self::Law,
        Self::Range,
        Self::SomeRefused,
        Self::Internal,
    ];
}

/// The text of a code, in English and in static memory; one of its own for numbers that are no code.
#[unsafe(no_mangle)]
pub extern "C" fn palpate_status_text(status: i32) -> *const c_char {
    let known = Status::ALL.into_iter().find(|known| *known as i32 == status);
    known.map_or(c"an unknown status", Status::text).as_ptr()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_has_a_text_of_its_own() {
        let mut texts: Vec<&CStr> = Status::ALL.map(Status::text).to_vec();
        texts.sort_unstable();
        texts.dedup();
        assert_eq!(texts.len(), 11);
        for (number, status) in (0..).zip(Status::ALL) {
            assert_eq!(status as i32, number);
            assert_eq!(palpate_status_text(number), status.text().as_ptr());
        }
        // SAFETY: a text in static memory.
        let unknown = unsafe { CStr::from_ptr(palpate_status_text(-1)) };
        assert_eq!(unknown, c"an unknown status");
    }
}
