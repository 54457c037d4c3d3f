//! Where in a map a curve was measured.

use palpate::units::{Dimension, factor};

use crate::table::Metadata;

/// Where a curve was measured, as its file states it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPosition {
    /// First coordinate, m.
    pub x: f64,
    /// Second coordinate, m.
    pub y: f64,
    /// Number of the curve in its map, where the file numbers it.
    pub index: Option<u64>,
}

/// Names of the coordinates: of JPK maps and afmformats ("position x"), JPK text exports ("xPosition") and Optics11 ("X-position (um)").
const COORDINATES: [[&str; 2]; 2] = [["positionx", "xposition"], ["positiony", "yposition"]];
/// Names of the number of a curve: of its place in the grid before its folder in the file.
const NUMBERS: [&str; 3] = ["position index", "enum", "index"];

impl MapPosition {
    /// The position among the named values of a file; `None` where a coordinate is missing, is no number, or has no unit of length.
    ///
    /// ```
    /// use palpate_files::record::MapPosition;
    /// use palpate_files::table::Metadata;
    ///
    /// let entry = |name: &str, value: &str| Metadata { name: name.into(), value: value.into(), unit: Some("um".into()) };
    /// let found = MapPosition::of(&[entry("X-position", "2"), entry("Y-position", "-4")]).expect("a position");
    /// assert_eq!((found.x, found.y, found.index), (2e-6, -4e-6, None));
    /// assert_eq!(MapPosition::of(&[entry("X-position", "2")]), None);
    /// ```
    #[must_use]
    pub fn of(metadata: &[Metadata]) -> Option<Self> {
        let coordinate = |names: [&str; 2]| {
            metadata.iter().find_map(|entry| {
                let name: String = entry.name.chars().filter(char::is_ascii_alphabetic).collect();
                let factor = factor(entry.unit.as_deref()?, Dimension::Length)?;
                let value: f64 = entry.value.trim().parse().ok()?;
                let position = value * factor;
                (names.contains(&name.to_ascii_lowercase().as_str()) && position.is_finite()).then_some(position)
            })
        };
        let [x, y] = COORDINATES.map(coordinate);
        let number = |name: &&str| metadata.iter().find(|entry| entry.name == *name)?.value.trim().parse().ok();
        let index = NUMBERS.iter().find_map(number);
        Some(Self { x: x?, y: y?, index })
    }
}
