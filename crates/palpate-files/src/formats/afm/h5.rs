//! HDF5 as afmformats writes it: a group a curve, with its metadata as attributes and a dataset a column.

use super::{
    afmformats::{draft, labels},
    assemble::assemble,
    metadata, numbers,
};
use crate::{
    error::FileError,
    input::{Content, Hdf5, HeldInGroup, Input, is_hdf5},
    table::{Found, Part, ReadOptions, SkippedPart},
};

/// Whether a file is one of afmformats: by what its root says.
pub(crate) fn recognise(input: &Input) -> bool {
    let of_afmformats = |(name, value): &(String, String)| name == "software" && value == "afmformats";
    is_hdf5(&input.beginning)
        && Hdf5::open(input).and_then(|file| file.attributes()).is_ok_and(|all| all.iter().any(of_afmformats))
}

/// Looks into the groups of a file.
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    let file = Hdf5::open(input)?;
    let mut groups: Vec<HeldInGroup> = file.groups()?.into_iter().filter(|group| !group.datasets.is_empty()).collect();
    // They are called 0, 1, …, 10.
    groups.sort_by_key(|group| group.path.parse::<u64>().unwrap_or(u64::MAX));
    let several = groups.len() > 1;
    let (mut curves, mut paths, mut skipped): (Vec<_>, Vec<_>, Vec<SkippedPart>) = Default::default();
    for group in groups {
        let stated = |name: &str| group.values.iter().find(|(own, _)| own == name).map(|(_, value)| value.as_str());
        let (mut columns, mut first, mut rows) = (Vec::new(), Vec::new(), None);
        for dataset in &group.datasets {
            match &dataset.content {
                Content::Numbers(own, 1, value) if own == rows.get_or_insert(*own) => {
                    columns.push(dataset.name.clone());
                    first.extend(value);
                }
                _ => {
                    let name = format!("{}/{}", group.path, dataset.name);
                    skipped.push(SkippedPart::new(name, "no column as long as the others"));
                }
            }
        }
        let rows = rows.unwrap_or(0);
        let part = Part {
            name: several.then(|| group.path.clone()),
            written: "HDF5 of afmformats".to_owned(),
            metadata: group.values.iter().map(|(name, value)| metadata(name, value)).collect(),
            ..Part::default()
        };
        let spring = stated("spring constant").and_then(|text| text.parse().ok());
        let (curve, without) = assemble(vec![draft(&columns, spring, rows, Some(first))], part);
        skipped.extend(without);
        let Some(mut curve) = curve else { continue };
        let all: Vec<String> = columns.iter().map(|name| format!("{}/{name}", group.path)).collect();
        if let Some(segment) = columns.iter().position(|name| name == "segment") {
            curve.part.labels = labels(stated("imaging mode"), &starts(&file.numbers(&all[segment])?), rows);
        }
        curves.push(curve);
        paths.push(all);
    }
    Ok(numbers::found(input, curves, skipped, Datasets { file, paths }))
}

/// Where the number of the segment changes, with the number.
fn starts(segments: &[f64]) -> Vec<(f64, usize)> {
    let mut starts: Vec<(f64, usize)> = Vec::new();
    for (row, number) in segments.iter().enumerate() {
        if starts.last().is_none_or(|(last, _)| last != number) {
            starts.push((*number, row));
        }
    }
    starts
}

/// The datasets of each curve.
struct Datasets {
    file: Hdf5,
    paths: Vec<Vec<String>>,
}

impl numbers::Channels for Datasets {
    fn numbers(&self, curve: usize, channel: usize) -> Result<Vec<f64>, FileError> {
        self.file.numbers(&self.paths[curve][channel])
    }
}
