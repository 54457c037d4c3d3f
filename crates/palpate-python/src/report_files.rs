//! How the files of a report are written, as Python states it.

use palpate_report::study::FileOptions;
use palpate_report::table::CsvLocale;
use pyo3::PyResult;

use crate::errors::choice;
use crate::listed::Listed;

/// The language of the readers of CSV files; English if left out.
pub(crate) fn csv_locale(name: Option<&str>) -> PyResult<CsvLocale> {
    let known = ["en", "de", "es", "fr", "it", "nl", "pl", "pt"];
    name.map_or(Ok(CsvLocale::default()), |name| choice("csv_locale", &known, name))
}

/// The options for the files of a report; the usual where they are left out.
pub(crate) fn file_options(
    figures: Option<Listed<String>>,
    column: Option<&str>,
    locale: Option<&str>,
) -> PyResult<FileOptions> {
    let format = |name: &String| choice("figures", &["svg", "png", "pdf"], name);
    let formats = figures.map(|names| names.0.iter().map(format).collect::<PyResult<_>>()).transpose()?;
    let usual = FileOptions::default();
    Ok(FileOptions {
        figures: formats.unwrap_or(usual.figures),
        column: column.map(|name| choice("column", &["single", "double"], name)).transpose()?,
        csv_locale: csv_locale(locale)?,
        ..usual
    })
}
