//! Standard output that survives a closed pipe.

use std::io::{self, Write};
use std::path::Path;

use palpate_jobs::{ErrorKind, JobError};
use palpate_report::spelling::with_flags;

/// Lays texts out for the terminal that standard output is, if it is one.
pub(crate) fn measure() {
    if let Some((width, _)) = terminal_size::terminal_size_of(io::stdout()) {
        palpate_report::set_width(usize::from(width.0));
    }
}

/// Writes `text` to standard output; a reader that has observed enough (`| head`) is no error.
pub(crate) fn print(text: &str) -> Result<(), JobError> {
    print_with(|out| out.write_all(text.as_bytes()))
}

/// Likewise, for output that is made as it goes.
pub(crate) fn print_with(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), JobError> {
    let mut out = io::BufWriter::new(io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            let kind = ErrorKind::File(error.kind());
            Err(JobError::new(kind, format!("cannot write to standard output: {error}"), None))
        }
        _ => Ok(()),
    }
}

/// Tells something beside the data, on standard error.
pub(crate) fn note(text: &str) {
    anstream::eprintln!("{text}");
}

/// Likewise, of several things.
pub(crate) fn notes(texts: &[String]) {
    texts.iter().for_each(|text| note(&with_flags(text)));
}

/// Tells of a report.
pub(crate) fn note_report(folder: &Path) {
    note(&format!("report written: {}", folder.join("report.html").display()));
}
