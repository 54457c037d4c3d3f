//! A record as pickles keep it.

use std::borrow::Cow;

use palpate::record::{Correction, LabelledSegment, Record};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::errors::{RecordError, refused};

/// The columns of a record and what was done to them.
#[derive(Serialize, Deserialize)]
pub(crate) struct Kept<'a> {
    time: Cow<'a, [f64]>,
    displacement: Option<Cow<'a, [f64]>>,
    force: Cow<'a, [f64]>,
    corrections: Cow<'a, [Correction]>,
    labels: Cow<'a, [LabelledSegment]>,
}

impl<'a> Kept<'a> {
    pub(crate) fn of(record: &'a Record) -> Self {
        Self {
            time: record.time().into(),
            displacement: record.displacement().map(Cow::from),
            force: record.force().into(),
            corrections: record.corrections().into(),
            labels: record.labels().into(),
        }
    }

    pub(crate) fn record(self) -> PyResult<Record> {
        let displacement = self.displacement.map(Cow::into_owned);
        let record = Record::new(self.time.into_owned(), displacement, self.force.into_owned());
        let record = record.map_err(|error| refused::<RecordError>(&error, Some(error.hint())))?;
        Ok(record.corrected_before(self.corrections.into_owned()).labelled(self.labels.into_owned()))
    }
}
