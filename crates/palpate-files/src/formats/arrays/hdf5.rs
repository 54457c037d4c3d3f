//! HDF5: the datasets of a group are arrays, its attributes named values. Files of MATLAB 7.3 are such files too.
//!
//! Without the feature `hdf5` such files are recognised and refused.

#[cfg(feature = "hdf5")]
use super::tables::{self, Array, Held, Place};
use crate::{
    error::FileError,
    input::{Input, is_hdf5},
    table::{Found, ReadOptions},
};
#[cfg(feature = "hdf5")]
use crate::{
    input::{Content, Hdf5},
    table::SkippedPart,
};

/// Whether a file begins as HDF5 does.
pub(crate) fn recognise(input: &Input) -> bool {
    is_hdf5(&input.beginning)
}

/// Says which build would read it.
#[cfg(not(feature = "hdf5"))]
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    Err(input.not_in_this_build(
        "a build that reads HDF5",
        "build palpate with the feature `hdf5`, which is enabled by default",
    ))
}

/// Looks into all groups of a file.
#[cfg(feature = "hdf5")]
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    let file = Hdf5::open(input)?;
    let (mut held, mut paths) = (Held::default(), Vec::new());
    for group in file.groups()? {
        let place = |name: String| Place {
            parent: group.path.clone(),
            name,
            mark: '/',
        };
        held.values.extend(group.values.iter().map(|(name, value)| (place(name.clone()), value.clone())));
        for dataset in group.datasets {
            let place = place(dataset.name);
            match dataset.content {
                Content::Numbers(rows, columns, first) => {
                    let (path, before) = (place.full(), held.arrays.len());
                    held.add(Array {
                        place,
                        unit: dataset.unit,
                        rows,
                        columns,
                        first,
                    });
                    if held.arrays.len() > before {
                        paths.push((path, columns));
                    }
                }
                Content::Text(text) => held.values.push((place, text)),
                Content::Other(what) => held.skipped.push(SkippedPart::new(place.full(), what)),
            }
        }
    }
    Ok(tables::found(input, "HDF5", held, Source { file, paths }))
}

/// The datasets of a file, each with its columns.
#[cfg(feature = "hdf5")]
struct Source {
    file: Hdf5,
    paths: Vec<(String, usize)>,
}

#[cfg(feature = "hdf5")]
impl tables::Source for Source {
    fn columns(&self, array: usize, columns: &[usize]) -> Result<Vec<Vec<f64>>, FileError> {
        let (path, width) = &self.paths[array];
        let numbers = self.file.numbers(path)?;
        let column = |column: &usize| numbers.iter().skip(*column).step_by(*width).copied().collect();
        Ok(columns.iter().map(column).collect())
    }
}
