//! Delimited text, as test machines and scripts write it.
//!
//! Channels in volts are scaled where a table above them says how (`channels.rs`).
//! A text holds one test, which is streamed, or several, one below the other (`sections.rs`, `runs.rs`) or side by
//! side (`beside.rs`).
//!
//! Reading goes in two steps. [`detect`] looks at the beginning of a file and says what it found:
//! encoding, delimiter, decimal mark, names, units, the line the data starts on. Someone (a person or a
//! description of the test) then picks columns, and [`read_columns`] streams these as `f64`.
//!
//! Nothing is guessed twice and nothing is dropped in silence: a cell that cannot be read is an error that
//! names its line and column, and the few lines that may be passed over (blank ones, comments, a footer) are
//! counted in [`Columns::ignored`](crate::table::Columns::ignored).
//!
//! ```
//! use palpate_files::input::Input;
//! use palpate_files::formats::text::{detect, read_columns};
//! use palpate_files::table::ReadOptions;
//!
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("press.csv");
//! std::fs::write(&path, "Time (s);Force (N)\n0,00;0,01\n0,10;0,52\n")?;
//! let input = Input::open(&path)?;
//! let layout = detect(&input, &ReadOptions::default())?;
//! assert_eq!(layout.columns[1].name.as_deref(), Some("Force"));
//! assert_eq!(layout.columns[1].unit.as_deref(), Some("N"));
//!
//! let read = read_columns(&input, &layout, &[1, 2], &mut |_done, _total| Ok(()))?;
//! assert_eq!(read.values, [vec![0.0, 0.1], vec![0.01, 0.52]]);
//! assert_eq!(read.line_of(1), Some(3));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod beside;
mod channels;
mod columns;
mod continued;
mod detect;
mod part;
mod row;
mod rows_ahead;
mod runs;
mod sample;
mod section;
mod sections;

pub use columns::read_columns;
pub use detect::detect;
pub(crate) use part::look_into;
