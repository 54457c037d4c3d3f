//! How the readers of a language write numbers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Language of the people who read a CSV file; it decides the decimal sign and, with that, what separates cells.
///
/// A spreadsheet program takes both from the settings of its computer. Where these write a comma in numbers (Unicode CLDR, `decimal` of
/// the language), cells are separated by semicolons; other programs read such a file with `sep=";", decimal=","`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum CsvLocale {
    /// English: `1.5`, cells separated by commas, after RFC 4180.
    #[default]
    En,
    /// German: `1,5`, cells separated by semicolons.
    De,
    /// Spanish as in Spain, likewise.
    Es,
    /// French, likewise.
    Fr,
    /// Italian, likewise.
    It,
    /// Dutch, likewise.
    Nl,
    /// Polish, likewise.
    Pl,
    /// Portuguese, likewise.
    Pt,
}

impl CsvLocale {
    /// What separates cells.
    #[must_use]
    pub fn separator(self) -> char {
        if self == Self::En { ',' } else { ';' }
    }

    /// A number with the decimal sign of the language.
    ///
    /// ```
    /// use palpate_report::table::CsvLocale;
    ///
    /// assert_eq!(CsvLocale::De.number("-1.5e-09".to_owned()), "-1,5e-09");
    /// assert_eq!(CsvLocale::En.number("-1.5e-09".to_owned()), "-1.5e-09");
    /// ```
    #[must_use]
    pub fn number(self, text: String) -> String {
        if self == Self::En { text } else { text.replace('.', ",") }
    }
}
