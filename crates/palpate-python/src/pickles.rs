//! Pickles of objects: bytes in pieces, so that Ctrl-C is heard between two of them.
//!
//! The pickler of CPython hears no signal. It calls `__reduce__` of every object and the function that makes it again, so
//! that bytes of hundreds of megabytes are many small objects here.

use std::fmt::Display;
use std::io::{self, BufReader, BufWriter, Read, Write};

use palpate::watch::Cancelled;
use palpate_jobs::output::sha256_of_parts;
use pyo3::PyTypeInfo;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyBytes, PyType};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::errors::{PalpateError, refused};
use crate::work::{Heard, at_length};

/// The format of pickles: another number where their content has another form.
pub(crate) const PICKLE: u32 = 4;

/// Bytes of a piece.
const PIECE: usize = 1 << 20;

/// What makes an object again: a function and its arguments.
pub(crate) type Made<'py, T> = (Bound<'py, PyAny>, T);

/// Refuses a pickle of another format.
pub(crate) fn check_pickle(format: u32) -> PyResult<()> {
    if format == PICKLE {
        return Ok(());
    }
    let message = format!("expected a pickle of format {PICKLE}, found format {format}");
    Err(refused::<PalpateError>(message, Some("make it again with this version of palpate")))
}

/// A part of the bytes of a pickle.
#[pyclass(frozen, name = "_Piece", module = "palpate._palpate")]
pub(crate) struct Piece(PyBackedBytes);

#[pymethods]
impl Piece {
    /// The bytes as they come out of a pickle.
    #[classmethod]
    fn _from_bytes<'py>(_class: &Bound<'_, PyType>, bytes: Bound<'py, PyBytes>) -> PyResult<Bound<'py, PyBytes>> {
        bytes.py().check_signals()?;
        Ok(bytes)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (PyBackedBytes,)>> {
        py.check_signals()?;
        let make = py.get_type::<Self>().getattr("_from_bytes")?;
        // The same object: a copy would be held until the pickle is whole.
        Ok((make, (self.0.clone_ref(py),)))
    }
}

/// What `write` writes as pieces, for a pickle; Ctrl-C is heard between them.
pub(crate) fn in_pieces(
    py: Python<'_>,
    write: impl FnOnce(&mut PieceWriter<'_>) -> io::Result<()>,
) -> PyResult<Vec<Piece>> {
    let (pieces, begun, raised) = (Vec::new(), Vec::with_capacity(PIECE), None);
    let mut writer = PieceWriter {
        py,
        pieces,
        begun,
        raised,
    };
    let written = write(&mut writer);
    // What writes may make an error of its own of the exception of a signal.
    writer.raised.take().map_or(Ok(()), Err)?;
    written?;
    writer.end_piece();
    Ok(writer.pieces)
}

/// The digest of all pieces together, in hexadecimal digits; Ctrl-C is heard between them.
pub(crate) fn digest(py: Python<'_>, pieces: &[Piece]) -> PyResult<String> {
    let mut heard = Ok(());
    let digest = sha256_of_parts(pieces.iter().map(|piece| &*piece.0).take_while(|_| {
        heard = py.check_signals();
        heard.is_ok()
    }));
    heard.map(|()| digest)
}

/// Cuts what is written into pieces.
pub(crate) struct PieceWriter<'py> {
    py: Python<'py>,
    pieces: Vec<Piece>,
    begun: Vec<u8>,
    raised: Option<PyErr>,
}

impl PieceWriter<'_> {
    fn end_piece(&mut self) {
        if !self.begun.is_empty() {
            self.pieces.push(Piece(PyBytes::new(self.py, &self.begun).into()));
            self.begun.clear();
        }
    }
}

impl Write for PieceWriter<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = bytes.len().min(PIECE - self.begun.len());
        self.begun.extend_from_slice(&bytes[..count]);
        if self.begun.len() == PIECE {
            if let Err(exception) = self.py.check_signals() {
                self.raised = Some(exception);
                return Err(io::ErrorKind::Other.into());
            }
            self.end_piece();
        }
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// One of the [`Pieces`]; a copy of an object takes those that a pickle would be made of.
#[derive(FromPyObject)]
enum Held {
    Piece(Py<Piece>),
    Bytes(PyBackedBytes),
}

/// The bytes that pieces make together.
#[derive(FromPyObject)]
#[pyo3(transparent)]
pub(crate) struct Pieces(Vec<Held>);

impl Pieces {
    fn slices(&self) -> impl Iterator<Item = &[u8]> {
        self.0.iter().map(|held| match held {
            Held::Piece(piece) => &*piece.get().0,
            Held::Bytes(bytes) => bytes,
        })
    }

    /// How many bytes there are.
    pub(crate) fn len(&self) -> usize {
        self.slices().map(<[u8]>::len).sum()
    }

    /// All of them, one behind the other.
    pub(crate) fn joined(self, py: Python<'_>) -> PyResult<Vec<u8>> {
        let mut all = Vec::with_capacity(self.len());
        for slice in self.slices() {
            py.check_signals()?;
            all.extend_from_slice(slice);
        }
        Ok(all)
    }

    /// The digest of all of them, in hexadecimal digits.
    pub(crate) fn sha256(&self, heard: &Heard) -> Result<String, Cancelled> {
        let digest = sha256_of_parts(self.slices().take_while(|_| heard.look().is_ok()));
        heard.look().map(|()| digest)
    }

    /// A reader of all of them, which ends where it hears so.
    pub(crate) fn reader(&self, heard: Heard) -> impl Read {
        let mut slices = self.slices();
        Slices {
            left: slices.next().unwrap_or_default(),
            slices,
            heard,
        }
    }
}

struct Slices<'a, I> {
    left: &'a [u8],
    slices: I,
    heard: Heard,
}

impl<'a, I: Iterator<Item = &'a [u8]>> Read for Slices<'a, I> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.heard.look().map_err(io::Error::other)?;
        while self.left.is_empty() {
            let Some(next) = self.slices.next() else { return Ok(0) };
            self.left = next;
        }
        // No more at once than takes some milliseconds.
        let count = buffer.len().min(PIECE);
        self.left.read(&mut buffer[..count])
    }
}

/// What an object was made of, from its pickle.
pub(crate) fn unpickled<T: DeserializeOwned + Send + 'static>(
    py: Python<'_>,
    json: Pieces,
    format: u32,
) -> PyResult<T> {
    /// Bytes that are read in some milliseconds.
    const BRIEF: usize = 1 << 18;
    /// Bytes that are read soon enough for an end of it to wait: from memory they are read in half the time.
    const SHORT: usize = 1 << 23;
    check_pickle(format)?;
    let size = json.len();
    if size > SHORT {
        let read = move |heard| serde_json::from_reader(BufReader::new(json.reader(heard)));
        return at_length(py, read)?.map_err(damaged);
    }
    let json = json.joined(py)?;
    let read = move || serde_json::from_slice(&json);
    if size > BRIEF { at_length(py, move |_| read())? } else { read() }.map_err(damaged)
}

/// A pickle that holds something else.
pub(crate) fn damaged(what: impl Display) -> PyErr {
    refused::<PalpateError>(format!("the pickle is damaged: {what}"), None::<&str>)
}

/// What makes an object again from its parts as JSON: `_from_json` of its class.
pub(crate) fn made_again<'py, T: PyTypeInfo>(
    py: Python<'py>,
    parts: &impl Serialize,
) -> PyResult<Made<'py, (Vec<Piece>, u32)>> {
    let json = in_pieces(py, |out| Ok(serde_json::to_writer(BufWriter::new(out), parts)?))?;
    Ok((py.get_type::<T>().getattr("_from_json")?, (json, PICKLE)))
}
