//! The files of a study, in memory until all of them exist.

use std::io;

use palpate::watch::{Cancelled, Watch};

use crate::figure::{Drawn, Figure, FigureError, View};
use crate::page::Block;
use crate::table::Table;

/// Which pictures to make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Pictures {
    /// PNG beside SVG.
    pub png: bool,
}

/// Why a study could not be put together.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A figure.
    #[error(transparent)]
    Figure(FigureError),
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
}

/// Writes a series as CSV.
type WriteSeries<T> = fn(&mut dyn io::Write, &T) -> io::Result<()>;

/// Resolution of PNG pictures: print quality at the width of a journal's page.
const DPI: f64 = 300.0;

impl Bundle {
    pub(crate) fn text(&mut self, path: impl Into<String>, content: String) {
        self.files.push((path.into(), content.into_bytes()));
    }

    /// The files of figures, each drawn once: pages show the same drawings.
    pub(crate) fn figures(
        &mut self,
        figures: &[Figure],
        pictures: Pictures,
        watch: &mut dyn Watch,
    ) -> Result<Vec<Drawing>, StudyError> {
        let mut drawings = Vec::with_capacity(figures.len());
        for figure in figures {
            let Drawn { svg, view } = figure.drawing(watch)?;
            if pictures.png {
                self.files.push((format!("figures/{}.png", figure.name), figure.to_png_of(&svg, DPI)?));
            }
            self.text(format!("figures/{}.svg", figure.name), svg);
            drawings.push(Drawing {
                name: figure.name.clone(),
                view,
                caption: figure.caption.clone(),
                continues: figure.continues.clone(),
            });
        }
        Ok(drawings)
    }

    pub(crate) fn series<T>(&mut self, name: &str, write: WriteSeries<T>, series: &T) -> Result<(), StudyError> {
        let mut content = Vec::new();
        write(&mut content, series)?;
        self.files.push((format!("series/{name}.csv"), content));
        Ok(())
    }

    pub(crate) fn table(&mut self, table: &Table) {
        self.text(format!("tables/{}.csv", table.name), table.to_csv());
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
