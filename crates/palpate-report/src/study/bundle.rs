//! The files of a study, in memory until all of them exist.

use std::io;

use palpate::watch::{Cancelled, Progress, Watch};

use crate::figure::{Figure, FigureError};
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
    Figure(#[from] FigureError),
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

    pub(crate) fn figures<'a>(
        &mut self,
        figures: impl IntoIterator<Item = &'a Figure>,
        pictures: Pictures,
        watch: &mut dyn Watch,
    ) -> Result<(), StudyError> {
        for (done, figure) in figures.into_iter().enumerate() {
            watch.report(Progress::open("drawing figures", done))?;
            self.text(format!("figures/{}.svg", figure.name), figure.to_svg()?);
            if pictures.png {
                self.files.push((format!("figures/{}.png", figure.name), figure.to_png(DPI)?));
            }
        }
        Ok(())
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

/// The figures whose name starts so, as a page shows them.
pub(super) fn drawn(figures: &[Figure], name: &str) -> Result<Vec<Block>, StudyError> {
    let chosen = figures.iter().filter(|figure| figure.name.starts_with(name));
    chosen.map(|figure| Ok(Block::figure(figure)?)).collect()
}
