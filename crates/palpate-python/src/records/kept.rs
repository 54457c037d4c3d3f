//! A record as pickles keep it.

use palpate::record::{Correction, Record};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::errors::{RecordError, refused};

/// The columns of a record and what was done to them.
#[derive(Serialize, Deserialize)]
pub(crate) struct Kept {
    time: Vec<f64>,
    displacement: Option<Vec<f64>>,
    force: Vec<f64>,
    corrections: Vec<Correction>,
}

impl Kept {
    pub(crate) fn of(record: &Record) -> Self {
        Self {
            time: record.time().to_vec(),
            displacement: record.displacement().map(<[f64]>::to_vec),
            force: record.force().to_vec(),
            corrections: record.corrections().to_vec(),
        }
    }

    pub(crate) fn record(self) -> PyResult<Record> {
        let record = Record::new(self.time, self.displacement, self.force);
        let record = record.map_err(|error| refused::<RecordError>(&error, Some(error.hint())))?;
        Ok(record.corrected_before(self.corrections))
    }
}
