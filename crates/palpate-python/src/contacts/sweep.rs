//! A protocol and its sweep, to a file.

use std::path::PathBuf;

use palpate_files::description::parse_sweep;
use palpate_jobs::Sweep;
use pyo3::prelude::*;

use super::protocol::StatedProtocol;
use crate::files::{shard, stated};
use crate::listed::Threads;
use crate::work::writing_job;

/// Refuses a protocol that has no sweep.
#[pyfunction]
pub(crate) fn _checked_sweep(protocol: &Bound<'_, PyAny>) -> PyResult<()> {
    let (path, text) = stated("described", protocol)?;
    StatedProtocol::new(path, text)?.parsed(parse_sweep).map(drop)
}

/// Simulate the runs of a protocol with a table ``[sweep]`` into one table: ``palpate sweep``.
///
/// Finished parts are kept beside the table: a sweep that was ended goes on where it stood.
///
/// Parameters
/// ----------
/// protocol
///     Path of the protocol (TOML), or a mapping with its tables, as for `simulate`. ``"sweep"`` has values by the path of the parameter
///     they replace: ``{"law.exponent": [3, 5], "specimen.radius_m": [0.03, 0.035], "law.rate_coefficient": "log 1e3..1e5 /s, 9"}``.
/// out
///     A table ending in .parquet.
/// figure
///     A figure ending in .svg, .png or .pdf.
/// show
///     Which result the figure shows, by the name of its column; the peak force if left out.
/// restart
///     Whether all runs are computed again, whatever was computed before.
/// shard
///     "3/40": compute only the third of 40 slices of the runs, into the folder `out` that all slices share; `merge` makes one table of them.
/// threads
///     How many runs are simulated side by side; as many as there are processors if left out. The table does not depend on it.
///
/// Returns
/// -------
/// runs, refused : int
///     How many runs the table has, and how many of them were refused.
///
/// Raises
/// ------
/// OptionError, OSError
///     A protocol without a sweep, a table that cannot be written.
///
/// Examples
/// --------
/// >>> import palpate, tempfile
/// >>> from pathlib import Path
/// >>> protocol = {
/// ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
/// ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
/// ...     "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
/// ...     "sweep": {"law.exponent": [3, 5], "specimen.radius_m": [0.03, 0.035, 0.04]},
/// ... }
/// >>> with tempfile.TemporaryDirectory() as folder:
/// ...     palpate.sweep(protocol, Path(folder) / "runs.parquet")
/// (6, 0)
#[pyfunction]
#[pyo3(signature = (protocol, out, *, figure=None, show=None, restart=false, shard=None, threads=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn sweep(
    py: Python<'_>,
    protocol: &Bound<'_, PyAny>,
    out: PathBuf,
    figure: Option<PathBuf>,
    show: Option<String>,
    restart: bool,
    shard: Option<&str>,
    threads: Option<Threads>,
) -> PyResult<(u64, u64)> {
    let usual = Sweep::default();
    let question = Sweep {
        show: show.unwrap_or(usual.show),
        restart,
        shard: shard.map(self::shard).transpose()?,
        threads: threads.map(|threads| threads.0),
    };
    let (path, text) = stated("described", protocol)?;
    let done = match path {
        Some(path) => writing_job(py, move |watch| question.run(&path, Some(&out), figure.as_deref(), watch)),
        None => {
            let protocol = StatedProtocol::new(None, text)?;
            let swept = protocol.parsed(parse_sweep)?;
            writing_job(py, move |watch| {
                question.run_protocol(&swept, &protocol.path, Some(&out), figure.as_deref(), watch)
            })
        }
    };
    done.map(|done| (done.result.runs, done.result.refused))
}
