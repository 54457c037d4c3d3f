//! Exponentials on a lattice: all combinations of a grid of rates, merged ones among them, and the valleys these show.
//!
//! A rate that is taken twice stands for two terms that came together, e^(−λt) and t e^(−λt): the edge of all combinations, where the
//! optimum often lies. Columns are made orthogonal one after the other, exact where rates are near each other.

use super::plane::Plane;
use crate::fit::{Condensed, Model};
use crate::optimise::Work;
use crate::vector::dot;

/// Distance in ln λ of terms that count as one taken twice.
const APART: f64 = 0.02;

/// A series with some rates kept, and a grid for the others.
pub(crate) struct Lattice<'a> {
    pub(crate) model: &'a Model,
    pub(crate) nodes: &'a Condensed,
    /// A shape of the series.
    pub(crate) shape: usize,
    /// What needs no search, rates that are kept among it.
    pub(crate) plane: Plane,
    /// Rates of the others, rising.
    pub(crate) grid: Vec<f64>,
    /// How many others.
    pub(crate) terms: usize,
}

/// One column of the lattice.
struct Column {
    /// Its place on the grid, and which of those at this place it is.
    place: usize,
    copy: usize,
    entries: Vec<f64>,
    /// Its square before anything was taken out of it.
    before: f64,
}

impl Lattice<'_> {
    /// Rates at the bottoms of the deepest valleys, deepest first.
    pub(crate) fn valleys(&self, most: usize, work: &mut Work) -> Vec<Vec<f64>> {
        let mut squares = Squares::new(self.grid.len(), self.terms);
        branch(&self.columns(), &[], &self.plane.values, self.terms, &mut squares);
        work.grid_points += squares.values.iter().filter(|square| square.is_finite()).count() as u64;
        squares.valleys(self.terms).iter().take(most).map(|combination| self.rates(combination)).collect()
    }

    /// The rate of a copy at a place.
    fn rate(&self, place: usize, copy: usize) -> f64 {
        let inwards = if 2 * place < self.grid.len() { APART } else { -APART };
        self.grid[place] + inwards * copy as f64
    }

    /// The rates of places that rise, the first of them at one place exactly there.
    fn rates(&self, combination: &[usize]) -> Vec<f64> {
        let copy = |i: usize| combination[..i].iter().filter(|place| **place == combination[i]).count();
        (0..combination.len()).map(|i| self.rate(combination[i], copy(i))).collect()
    }

    /// All columns, by place and then by copy.
    fn columns(&self) -> Vec<Column> {
        let column = |place: usize, copy: usize| {
            let mut entries = self.nodes.column(self.model, self.shape, &[self.rate(place, copy)]);
            let before = dot(&entries, &entries);
            self.plane.project(&mut entries);
            self.plane.project(&mut entries);
            Column {
                place,
                copy,
                entries,
                before,
            }
        };
        (0..self.grid.len())
            .flat_map(|place| (0..self.terms).map(move |copy| (place, copy)))
            .map(|(place, copy)| column(place, copy))
            .collect()
    }
}

/// Writes down what combinations of `terms` of `columns` leave of `rest`, beside those `taken` before.
fn branch(columns: &[Column], taken: &[(usize, usize)], rest: &[f64], terms: usize, squares: &mut Squares) {
    let square = dot(rest, rest);
    for (i, column) in columns.iter().enumerate() {
        let (place, copy) = (column.place, column.copy);
        // The second of a place is taken only after the first.
        if copy > 0 && taken.last() != Some(&(place, copy - 1)) {
            continue;
        }
        let size = dot(&column.entries, &column.entries);
        if size <= IMITATED * column.before {
            continue;
        }
        let part = dot(&column.entries, rest) / size;
        let here = [taken, &[(place, copy)]].concat();
        if terms == 1 {
            squares.set(&here, square - part * part * size);
            continue;
        }
        let less = |entries: &[f64], part: f64| -> Vec<f64> {
            entries.iter().zip(&column.entries).map(|(a, b)| a - part * b).collect()
        };
        let needed =
            |other: &&Column| if other.place > place { other.copy + 1 < terms } else { other.copy < copy + terms };
        let others = columns[i + 1..].iter().filter(needed).map(|other| Column {
            entries: less(&other.entries, dot(&column.entries, &other.entries) / size),
            ..*other
        });
        branch(&others.collect::<Vec<_>>(), &here, &less(rest, part), terms - 1, squares);
    }
}

/// Share of a column's square below which it lies in the plane of the others.
const IMITATED: f64 = 1e-22;

/// Residual squares of all combinations of places.
struct Squares {
    places: usize,
    values: Vec<f64>,
}

impl Squares {
    fn new(places: usize, terms: usize) -> Self {
        Self {
            places,
            values: vec![f64::INFINITY; (0..terms).map(|_| places).product()],
        }
    }

    fn index(&self, combination: impl Iterator<Item = usize>) -> usize {
        combination.fold(0, |index, place| index * self.places + place)
    }

    fn set(&mut self, taken: &[(usize, usize)], square: f64) {
        let index = self.index(taken.iter().map(|(place, _)| *place));
        self.values[index] = square;
    }

    /// Combinations that no neighbour is below, deepest first.
    fn valleys(&self, terms: usize) -> Vec<Vec<usize>> {
        let places_of = |index: usize| -> Vec<usize> {
            let digit = |power: u32| index / self.places.pow(power) % self.places;
            (0..terms as u32).rev().map(digit).collect()
        };
        let known = (0..self.values.len()).filter(|index| self.values[*index].is_finite());
        let mut found: Vec<(f64, Vec<usize>)> = known
            .map(|index| (index, places_of(index)))
            .filter(|(index, combination)| self.is_lowest(*index, combination))
            .map(|(index, combination)| (self.values[index], combination))
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.into_iter().map(|(_, combination)| combination).collect()
    }

    /// Whether all neighbours, each place moved by one at most, are higher, or as high and later.
    fn is_lowest(&self, index: usize, combination: &[usize]) -> bool {
        let here = self.values[index];
        let moves = 3usize.pow(combination.len() as u32);
        (0..moves).all(|code| {
            let mut beside = Vec::with_capacity(combination.len());
            for (i, place) in combination.iter().enumerate() {
                // 0, 1, 2 for a place before, the same and after.
                let moved = place + code / 3usize.pow(i as u32) % 3;
                if moved == 0 || moved > self.places {
                    return true;
                }
                beside.push(moved - 1);
            }
            beside.sort_unstable();
            let other = self.index(beside.into_iter());
            let value = self.values[other];
            here < value || here == value && index <= other
        })
    }
}
