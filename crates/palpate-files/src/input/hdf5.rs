//! HDF5 within limits: what the groups of a file hold, and the numbers of a dataset.
//!
//! A size that a file states is compared with what its bytes warrant before anything is made of it, and where the reader panics the file
//! is damaged.

use hdf5_pure::{AttrValue, DType, Dataset, Error, File, Group};

use super::{contained::contained, source::Input};
use crate::error::FileError;

/// Most groups and datasets that are visited, and most named values.
const MOST_OBJECTS: usize = 1 << 16;

/// Deepest group in a group.
const DEEPEST: usize = 16;

/// An HDF5 file.
pub(crate) struct Hdf5 {
    input: Input,
    file: File,
}

/// A group of a file.
#[derive(Debug, Default)]
pub(crate) struct HeldInGroup {
    /// Its path: nothing for the root, `a/b` inside of it.
    pub(crate) path: String,
    /// Its attributes, by name.
    pub(crate) values: Vec<(String, String)>,
    pub(crate) datasets: Vec<HeldDataset>,
}

/// A dataset of a group.
#[derive(Debug)]
pub(crate) struct HeldDataset {
    pub(crate) name: String,
    /// What its attribute `unit` or `units` says.
    pub(crate) unit: Option<String>,
    pub(crate) content: Content,
}

/// What a dataset holds.
#[derive(Debug)]
pub(crate) enum Content {
    /// Real numbers: rows, columns, and the first row.
    Numbers(usize, usize, Vec<f64>),
    /// A text.
    Text(String),
    /// Something else.
    Other(String),
}

impl Hdf5 {
    pub(crate) fn open(input: &Input) -> Result<Self, FileError> {
        let bytes = input.bytes()?;
        contained(input, || {
            let file = File::from_bytes(bytes).map_err(|error| refused(input, "the file", &error))?;
            let input = input.clone();
            Ok(Self { input, file })
        })
    }

    /// The attributes of the root, by name.
    pub(crate) fn attributes(&self) -> Result<Vec<(String, String)>, FileError> {
        contained(&self.input, || self.values(&self.file.root(), "the root group", &mut { MOST_OBJECTS }))
    }

    /// The groups of the file, the root first, each before those inside of it.
    pub(crate) fn groups(&self) -> Result<Vec<HeldInGroup>, FileError> {
        contained(&self.input, || {
            let (mut found, mut left) = (Vec::new(), MOST_OBJECTS);
            self.visit(&self.file.root(), "", 0, &mut left, &mut found)?;
            Ok(found)
        })
    }

    /// All numbers of a dataset, row by row.
    pub(crate) fn numbers(&self, path: &str) -> Result<Vec<f64>, FileError> {
        contained(&self.input, || {
            let failed = |error| refused(&self.input, path, &error);
            let dataset = self.file.dataset(path).map_err(failed)?;
            self.count(path, &dataset.shape().map_err(failed)?)?;
            dataset.read_f64().map_err(failed)
        })
    }

    /// How many numbers an array of this shape has, if the bytes of the file warrant so many.
    fn count(&self, path: &str, shape: &[u64]) -> Result<usize, FileError> {
        let count = shape.iter().try_fold(1_u64, |product, size| product.checked_mul(*size));
        let bytes = count.and_then(|count| count.checked_mul(8)).unwrap_or(u64::MAX);
        self.input.bounded(bytes, "a dataset", super::MOST_IN_MEMORY)?;
        count
            .and_then(|count| usize::try_from(count).ok())
            .ok_or_else(|| self.input.damaged(path, "a dataset that fits into memory", format!("{shape:?}")))
    }

    /// Counts a group, a dataset or an attribute.
    fn spend(&self, left: &mut usize) -> Result<(), FileError> {
        *left = left.checked_sub(1).ok_or_else(|| {
            self.input
                .damaged("groups", format!("at most {MOST_OBJECTS} groups, datasets and attributes"), "more")
        })?;
        Ok(())
    }

    /// The attributes of a group, by name.
    fn values(&self, group: &Group, title: &str, left: &mut usize) -> Result<Vec<(String, String)>, FileError> {
        let mut values: Vec<(String, String)> = Vec::new();
        for (name, value) in group.attrs().map_err(|error| refused(&self.input, title, &error))? {
            self.spend(left)?;
            values.extend(shown(&value).map(|value| (name, value)));
        }
        values.sort_unstable();
        Ok(values)
    }

    fn visit(
        &self,
        group: &Group,
        path: &str,
        depth: usize,
        left: &mut usize,
        found: &mut Vec<HeldInGroup>,
    ) -> Result<(), FileError> {
        let title = if path.is_empty() { "the root group".to_owned() } else { path.to_owned() };
        let failed = |error| refused(&self.input, &title, &error);
        self.spend(left)?;
        let values = self.values(group, &title, left)?;
        let mut datasets = Vec::new();
        for (name, dataset) in group.iter_datasets().map_err(failed)? {
            self.spend(left)?;
            datasets.push(self.dataset(&join(path, &name), name, &dataset)?);
        }
        found.push(HeldInGroup {
            path: path.to_owned(),
            values,
            datasets,
        });
        if depth < DEEPEST {
            for (name, inside) in group.iter_groups().map_err(failed)? {
                self.visit(&inside, &join(path, &name), depth + 1, left, found)?;
            }
        }
        Ok(())
    }

    fn dataset(&self, path: &str, name: String, dataset: &Dataset) -> Result<HeldDataset, FileError> {
        let failed = |error| refused(&self.input, path, &error);
        let attributes = dataset.attrs().map_err(failed)?;
        let unit = ["unit", "units", "Unit", "Units"].iter().find_map(|name| attributes.get(*name)).and_then(shown);
        let unit = unit.filter(|unit| !unit.trim().is_empty());
        let shape = dataset.shape().map_err(failed)?;
        let kind = dataset.dtype().map_err(failed)?;
        let content = match (&kind, &shape[..]) {
            (DType::String | DType::VariableLengthString, [] | [1]) => {
                let texts = if dataset.element_size().map_err(failed)? <= 4096 {
                    dataset.read_string()
                } else {
                    Ok(Vec::new())
                };
                match texts.map_err(failed)?.into_iter().next() {
                    Some(text) => Content::Text(text),
                    None => Content::Other("a long text".to_owned()),
                }
            }
            (kind, [] | [_] | [_, _]) if is_number(kind) => {
                let count = self.count(path, &shape)?;
                let rows = shape.first().map_or(1, |rows| *rows as usize);
                let columns = count.checked_div(rows).unwrap_or(0);
                let first = match (columns, shape.is_empty()) {
                    (0 | MOST_OBJECTS.., _) => Vec::new(),
                    (_, true) => dataset.read_f64().map_err(failed)?,
                    (_, false) => dataset.read_f64_rows(0, 1).map_err(failed)?,
                };
                Content::Numbers(rows, columns, first)
            }
            (kind, _) if is_number(kind) => Content::Other(format!("an array of {} dimensions", shape.len())),
            (kind, _) => Content::Other(format!("not of real numbers ({kind})")),
        };
        Ok(HeldDataset { name, unit, content })
    }
}

fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}/{name}") }
}

fn is_number(kind: &DType) -> bool {
    matches!(
        kind,
        DType::F32
            | DType::F64
            | DType::I8
            | DType::I16
            | DType::I32
            | DType::I64
            | DType::U8
            | DType::U16
            | DType::U32
            | DType::U64
            | DType::Enum(_)
    )
}

/// An attribute as a named value: a text, or one number; `None` of lists and of other types.
fn shown(value: &AttrValue) -> Option<String> {
    let text = value.as_str().map(str::to_owned);
    let whole = || Some(value.as_i64()?.to_string()).or_else(|| Some(value.as_u64()?.to_string()));
    text.or_else(whole).or_else(|| Some(format!("{:?}", value.as_f64()?)))
}

/// What the reader says of a part of the file.
fn refused(input: &Input, place: &str, error: &Error) -> FileError {
    input.damaged(place, "what HDF5 has there", error.to_string())
}
