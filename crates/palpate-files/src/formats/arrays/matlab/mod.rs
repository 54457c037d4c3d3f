//! MATLAB files of level 5, which MATLAB writes with `-v6` and `-v7`, and SciPy and Octave too: after MathWorks' "MAT-File Format".
//!
//! A file is a header of 128 bytes and elements, each a tag with kind and size, and mostly packed by zlib. An array has flags with its class,
//! dimensions, a name, and its numbers column by column, in any kind of numbers that holds them. Structures and cells hold arrays again.
//!
//! | file | what |
//! |---|---|
//! | `elements.rs` | the elements of a file, unpacked as they are read, within limits |
//! | `arrays.rs` | the arrays in an element |

mod arrays;
mod elements;

use super::tables::{self, Array, Held, MOST_ARRAYS, Place};
use crate::{
    error::FileError,
    input::Input,
    table::{Found, ReadOptions, SkippedPart},
};
use arrays::{Numbers, Visit, walk};
use elements::{Element, Elements};

/// Whether a file begins like one of level 5: with its version and order of bytes behind a text.
pub(crate) fn recognise(input: &Input) -> bool {
    elements::order(&input.beginning).is_some()
}

/// Looks into all arrays of a file.
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    let mut elements = Elements::open(input)?;
    let mut looked = Look {
        input,
        held: Held::default(),
        places: Vec::new(),
        element: None,
        number: 0,
    };
    while let Some(element) = elements.next()? {
        (looked.element, looked.number) = (Some(element), 0);
        let lowest_first = elements.lowest_first;
        walk(input, elements.bytes(element)?, lowest_first, &mut looked)?;
    }
    let source = Source {
        input: input.clone(),
        places: looked.places,
    };
    Ok(tables::found(input, "MATLAB file (.mat)", looked.held, source))
}

/// What is there, and where.
struct Look<'a> {
    input: &'a Input,
    held: Held,
    /// Of each array its element, and its number among the arrays of that.
    places: Vec<(Element, usize)>,
    element: Option<Element>,
    number: usize,
}

impl Visit for Look<'_> {
    fn array(&mut self, place: Place, shape: (usize, usize), numbers: &mut Numbers<'_, '_>) -> Result<(), FileError> {
        self.bounded()?;
        let (before, number) = (self.held.arrays.len(), self.number);
        self.number += 1;
        self.held.add(Array {
            place,
            unit: None,
            rows: shape.0,
            columns: shape.1,
            first: numbers.first_row(shape.0)?,
        });
        if self.held.arrays.len() > before {
            self.places.extend(self.element.map(|element| (element, number)));
        }
        Ok(())
    }

    fn text(&mut self, place: Place, text: String) -> Result<(), FileError> {
        self.bounded()?;
        self.held.values.push((place, text));
        Ok(())
    }

    fn other(&mut self, place: Place, what: &'static str) -> Result<(), FileError> {
        self.bounded()?;
        self.held.skipped.push(SkippedPart::new(place.full(), what));
        Ok(())
    }
}

impl Look<'_> {
    fn bounded(&self) -> Result<(), FileError> {
        let Held {
            arrays,
            values,
            skipped,
        } = &self.held;
        match arrays.len() + values.len() + skipped.len() {
            count if count < MOST_ARRAYS => Ok(()),
            _ => Err(self.input.damaged("the arrays", format!("at most {MOST_ARRAYS} of them"), "more")),
        }
    }
}

/// The arrays of a file, to be read again.
struct Source {
    input: Input,
    places: Vec<(Element, usize)>,
}

impl tables::Source for Source {
    fn columns(&self, array: usize, columns: &[usize]) -> Result<Vec<Vec<f64>>, FileError> {
        let (element, number) = self.places[array];
        let mut elements = Elements::open(&self.input)?;
        let mut taken = Take {
            columns,
            left: number,
            found: None,
        };
        let lowest_first = elements.lowest_first;
        walk(&self.input, elements.bytes(element)?, lowest_first, &mut taken)?;
        taken
            .found
            .ok_or_else(|| self.input.damaged("the arrays", "the array that was there before", "none"))
    }
}

/// Takes columns of one array.
struct Take<'a> {
    columns: &'a [usize],
    /// Arrays before it.
    left: usize,
    found: Option<Vec<Vec<f64>>>,
}

impl Visit for Take<'_> {
    fn array(&mut self, _: Place, (rows, _): (usize, usize), numbers: &mut Numbers<'_, '_>) -> Result<(), FileError> {
        if self.found.is_none() && self.left == 0 {
            self.found = Some(numbers.columns(rows, self.columns)?);
        }
        self.left = self.left.saturating_sub(1);
        Ok(())
    }
}
