//! The numbers that figures and tables have in the paper, and the links to them. What the paper does not have is numbered S1, S2, …

use palpate::paper::Evidence;

use crate::page::Block;
use crate::study::bundle::{Drawing, named};
use crate::table::Table;

/// Names of figures and tables with their numbers.
const NUMBERS: [(&str, &str); 23] = [
    ("figure_1", "Figure 1"),
    ("figure_2", "Figure 2"),
    ("figure_4", "Figure 4"),
    ("figure_4a", "Figure 4(a)"),
    ("figure_4b", "Figure 4(b)"),
    ("figure_6", "Figure 6"),
    ("figure_6a", "Figure 6(a)"),
    ("figure_6b", "Figure 6(b)"),
    ("figure_7", "Figure 7"),
    ("figure_8", "Figure 8"),
    ("closed_form", "Figure S1"),
    ("forces_by_step", "Figure S2"),
    ("equilibria", "Figure S3"),
    ("sensitivities", "Figure S4"),
    ("rate_coefficients", "Figure S5"),
    ("table_1", "Table I"),
    ("table_2", "Table II"),
    ("table_forces_by_step", "Table S1"),
    ("table_explanations", "Table S2"),
    ("table_last_unloading", "Table S3"),
    ("table_laboratories", "Table S4"),
    ("table_orders", "Table S5"),
    ("table_sensitivities", "Table S6"),
];

/// The number of a figure or table by its name, such as `Figure 4(a)`.
pub(super) fn number(name: &str) -> &'static str {
    NUMBERS.iter().find(|(known, _)| *known == name).map_or("", |(_, number)| number)
}

/// A caption behind the number of its figure or table.
pub(super) fn caption(name: &str, text: impl AsRef<str>) -> String {
    format!("{}. {}", number(name), text.as_ref())
}

/// Figures and tables in the order in which a page has them, so that links lead to them.
pub(super) struct Placed<'a> {
    drawings: &'a [Drawing],
    tables: &'a [Table],
    figures: Vec<String>,
    tabled: Vec<String>,
}

impl<'a> Placed<'a> {
    pub(super) fn new(drawings: &'a [Drawing], tables: &'a [Table]) -> Self {
        Self {
            drawings,
            tables,
            figures: Vec::new(),
            tabled: Vec::new(),
        }
    }

    /// The figures whose name starts so.
    pub(super) fn figures(&mut self, name: &str) -> Vec<Block> {
        let blocks: Vec<Block> = named(self.drawings, name).collect();
        // A figure that has none of its kind takes no number of the page.
        self.figures.extend(blocks.iter().map(|_| name.to_owned()));
        blocks
    }

    /// The table of this name, if there is one.
    pub(super) fn table(&mut self, name: &str) -> Option<Block> {
        let table = self.tables.iter().find(|table| table.name == name)?;
        self.tabled.push(name.to_owned());
        Some(Block::Table(table.clone()))
    }

    /// What to call the evidence, and the link to it; `None` where the page does not have it.
    pub(super) fn link(&self, evidence: Evidence) -> Option<(String, String)> {
        let place =
            |placed: &[String], name: &str| placed.iter().position(|known| known == name).map(|index| index + 1);
        match evidence {
            Evidence::Figure(name) => {
                let index = place(&self.figures, name)?;
                Some((number(name).to_owned(), format!("#figure-{index}")))
            }
            Evidence::Table(name) => {
                let index = place(&self.tabled, name)?;
                Some((number(&table_key(name)).to_owned(), format!("#table-{index}")))
            }
            Evidence::Series(name) => Some((format!("series {name}"), format!("series/{name}.csv"))),
        }
    }
}

/// A table and a figure may have one name; in [`NUMBERS`] such tables have another.
pub(super) fn table_key(name: &str) -> String {
    if name.starts_with("table_") { name.to_owned() } else { format!("table_{name}") }
}
