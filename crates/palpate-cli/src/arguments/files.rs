//! How the files of a report are written.

use clap::Args;
use palpate_jobs::JobError;
use palpate_jobs::typed::{CSV_LOCALES, Choice, one_of};
use palpate_report::figure::{Column, PictureFormat};
use palpate_report::study::FileOptions;
use palpate_report::table::CsvLocale;

/// How the files of a report are written.
#[derive(Debug, Args)]
pub(crate) struct FilesArguments {
    /// Formats of the figure files; svg if not given
    #[arg(long, value_name = "FORMAT,…", value_delimiter = ',', value_parser = one_of(FORMATS))]
    figures: Option<Vec<PictureFormat>>,
    /// Width of the figure files: a column of a journal; if not given, each figure has its own
    #[arg(long, value_parser = one_of(COLUMNS))]
    column: Option<Column>,
    /// Language of the readers of CSV files: it decides decimal sign and separator; en if not given
    #[arg(long, value_name = "LANGUAGE", value_parser = one_of(CSV_LOCALES))]
    csv_locale: Option<CsvLocale>,
}

impl FilesArguments {
    /// The options for the files in a folder, if one is named.
    ///
    /// # Errors
    /// [`JobError`] where there is none, but options for its files.
    pub(crate) fn options(&self, has_folder: bool) -> Result<FileOptions, JobError> {
        let given = [
            ("figures", self.figures.is_some()),
            ("column", self.column.is_some()),
            ("csv_locale", self.csv_locale.is_some()),
        ];
        if let Some((name, _)) = given.into_iter().find(|(_, is_given)| *is_given && !has_folder) {
            let message = format!("⟨{name}⟩ is for the files of a report, found no folder for them");
            return Err(JobError::option(message, "name the folder with ⟨out⟩"));
        }
        let usual = FileOptions::default();
        Ok(FileOptions {
            figures: self.figures.clone().unwrap_or(usual.figures),
            column: self.column,
            holds: None,
            csv_locale: self.csv_locale.unwrap_or_default(),
        })
    }
}

/// Formats of figures.
const FORMATS: &[Choice<PictureFormat>] = &[
    ("svg", "Vectors, with the typeface of the reader", PictureFormat::Svg),
    ("png", "Pixels, 300 per inch", PictureFormat::Png),
    ("pdf", "Vectors, with the typeface embedded", PictureFormat::Pdf),
];

/// Widths of figures.
const COLUMNS: &[Choice<Column>] =
    &[("single", "One column, 85 mm", Column::Single), ("double", "Both columns, 174 mm", Column::Double)];
