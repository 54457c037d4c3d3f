//! The files of a study, in memory until all of them exist.

use std::io;

use palpate::watch::{Cancelled, Watch};

use palpate::number::counted;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::figure::{Column, Drawn, Figure, FigureError, PictureFormat, View};
use crate::page::{Block, Page};
use crate::table::{CsvLocale, Table};
#[cfg(feature = "xlsx")]
use crate::table::{Workbook, WorkbookError};

/// How the files of a study are written.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FileOptions {
    /// Formats of the figures.
    pub figures: Vec<PictureFormat>,
    /// Width of the figures in a journal; each has its own if not given. The page shows its own in any case.
    pub column: Option<Column>,
    /// Numbers of the holds that the figures of an analysed record show, from 1; all if not given. The page shows all in any case.
    pub holds: Option<Vec<usize>>,
    /// Language of the readers of CSV files.
    pub csv_locale: CsvLocale,
}

impl Default for FileOptions {
    fn default() -> Self {
        Self {
            figures: vec![PictureFormat::Svg],
            column: None,
            holds: None,
            csv_locale: CsvLocale::default(),
        }
    }
}

impl FileOptions {
    /// Nothing but what the page needs.
    pub(crate) fn without_figures(&self) -> Self {
        Self {
            figures: Vec::new(),
            ..self.clone()
        }
    }
}

/// Why a study could not be put together.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A figure.
    #[error(transparent)]
    Figure(FigureError),
    /// The figures are to show a hold that the record does not have.
    #[error("the figures are to show hold {hold}, found {} in the record", counted(*.holds, "hold"))]
    NoHold {
        /// Its number.
        hold: usize,
        /// How many the record has.
        holds: usize,
    },
    /// The workbook of tables.
    #[cfg(feature = "xlsx")]
    #[error(transparent)]
    Workbook(#[from] WorkbookError),
    /// Writing to memory.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// JSON.
    #[error("a result could not be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The watch ended it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<FigureError> for StudyError {
    fn from(error: FigureError) -> Self {
        match error {
            FigureError::Cancelled(cancelled) => cancelled.into(),
            error => Self::Figure(error),
        }
    }
}

/// A figure once drawn.
pub(crate) struct Drawing {
    name: String,
    view: View,
    caption: String,
    continues: Option<String>,
}

impl Drawing {
    /// As a page shows it.
    pub(crate) fn block(&self) -> Block {
        Block::Figure {
            view: self.view.clone(),
            caption: self.caption.clone(),
        }
    }
}

/// Files by relative path.
#[derive(Debug, Clone, Default)]
pub struct Bundle {
    /// Path with forward slashes, and content.
    pub files: Vec<(String, Vec<u8>)>,
    /// What `report.html` is made of; `None` where there is none.
    pub page: Option<Page>,
    /// The tables in it, for the workbook.
    #[cfg(feature = "xlsx")]
    tables: Vec<Table>,
    csv_locale: CsvLocale,
}

/// Writes a series as CSV.
type WriteSeries<T> = fn(&mut dyn io::Write, &T, CsvLocale) -> io::Result<()>;

impl From<Vec<(String, Vec<u8>)>> for Bundle {
    fn from(files: Vec<(String, Vec<u8>)>) -> Self {
        Self {
            files,
            ..Self::default()
        }
    }
}

impl Bundle {
    /// No files yet; those of tables and series are for these readers.
    pub(crate) fn new(csv_locale: CsvLocale) -> Self {
        Self {
            csv_locale,
            ..Self::default()
        }
    }

    pub(crate) fn text(&mut self, path: impl Into<String>, content: String) {
        self.files.push((path.into(), content.into_bytes()));
    }

    /// The page.
    pub(crate) fn report(&mut self, page: Page) {
        self.text("report.html", page.to_html());
        self.page = Some(page);
    }

    /// The files of figures. Pages show the same drawings, unless the files are to have the width of a column.
    pub(crate) fn figures(
        &mut self,
        figures: &[Figure],
        options: &FileOptions,
        watch: &mut dyn Watch,
    ) -> Result<Vec<Drawing>, StudyError> {
        let mut drawings = Vec::with_capacity(figures.len());
        for figure in figures {
            let Drawn { svg, view } = figure.drawing(watch)?;
            match options.column {
                None => self.pictures(figure, &svg, options)?,
                Some(_) if options.figures.is_empty() => {}
                Some(column) => {
                    for printed in figure.for_column(column) {
                        let svg = printed.to_svg_watched(watch)?;
                        self.pictures(&printed, &svg, options)?;
                    }
                }
            }
            drawings.push(Drawing {
                name: figure.name.clone(),
                view,
                caption: figure.caption.clone(),
                continues: figure.continues.clone(),
            });
        }
        Ok(drawings)
    }

    /// The files of a figure once drawn, one in each format.
    fn pictures(&mut self, figure: &Figure, svg: &str, options: &FileOptions) -> Result<(), StudyError> {
        for format in &options.figures {
            let path = format!("figures/{}.{}", figure.name, format.ending());
            self.files.push((path, figure.to_file_of(svg.to_owned(), *format)?));
        }
        Ok(())
    }

    pub(crate) fn series<T>(&mut self, name: &str, write: WriteSeries<T>, series: &T) -> Result<(), StudyError> {
        let mut content = Vec::new();
        write(&mut content, series, self.csv_locale)?;
        self.files.push((format!("series/{name}.csv"), content));
        Ok(())
    }

    pub(crate) fn table(&mut self, table: &Table) {
        self.text(format!("tables/{}.csv", table.name), table.to_csv(self.csv_locale));
        #[cfg(feature = "xlsx")]
        self.tables.push(table.clone());
    }

    /// The same with all its tables once more as the sheets of one workbook, `tables.xlsx`; without the feature `xlsx` as it is.
    #[cfg(not(feature = "xlsx"))]
    pub(crate) fn with_workbook(self) -> Result<Self, StudyError> {
        Ok(self)
    }

    /// The same with all its tables once more as the sheets of one workbook, `tables.xlsx`.
    #[cfg(feature = "xlsx")]
    pub(crate) fn with_workbook(mut self) -> Result<Self, StudyError> {
        let mut workbook = Workbook::default();
        for table in std::mem::take(&mut self.tables) {
            workbook.table(&table)?;
        }
        self.files.push(("tables.xlsx".to_owned(), workbook.finish()?));
        Ok(self)
    }

    pub(crate) fn json(&mut self, path: &str, document: &impl serde::Serialize) -> Result<(), StudyError> {
        let mut text = serde_json::to_string_pretty(document)?;
        text.push('\n');
        self.text(path, text);
        Ok(())
    }
}

/// The drawings whose name starts so, as a page shows them: those that go on where one ends are folded below it.
pub(super) fn named(drawings: &[Drawing], name: &str) -> impl Iterator<Item = Block> {
    drawings
        .iter()
        .filter(move |drawing| drawing.name.starts_with(name))
        .map(|drawing| match &drawing.continues {
            Some(title) => Block::Folded {
                title: title.clone(),
                blocks: vec![drawing.block()],
            },
            None => drawing.block(),
        })
}
