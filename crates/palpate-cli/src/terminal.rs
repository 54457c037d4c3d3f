//! The one way to the terminal: standard output that survives a closed pipe, and texts in which nothing moves the cursor.

use std::borrow::Cow;
use std::io::{self, Write};
use std::path::Path;

use palpate_files::faults::{Operation, before};
use palpate_files::is_unprintable;
use palpate_jobs::{ErrorKind, JobError};
use palpate_report::spelling::with_flags;

/// Lays texts out for the terminal that standard output is, if it is one.
pub(crate) fn measure() {
    if let Some((width, _)) = terminal_size::terminal_size_of(io::stdout()) {
        palpate_report::set_width(usize::from(width.0));
    }
}

/// A text for people without what would move the cursor or change the direction of writing; titles, units and names of files hold anything.
pub(crate) fn clean(text: &str) -> Cow<'_, str> {
    let harmful = |letter: char| is_unprintable(letter) && letter != '\n';
    match text.contains(harmful) {
        true => text
            .chars()
            .map(|letter| if harmful(letter) { char::REPLACEMENT_CHARACTER } else { letter })
            .collect(),
        false => Cow::Borrowed(text),
    }
}

/// Writes `text` to standard output; a reader that has observed enough (`| head`) is no error.
pub(crate) fn print(text: &str) -> Result<(), JobError> {
    print_with(|out| out.write_all(clean(text).as_bytes()))
}

/// Likewise, for output that is made as it goes.
pub(crate) fn print_with(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), JobError> {
    let mut out = io::BufWriter::new(io::stdout().lock());
    let begun = before(Operation::Write);
    match begun.and_then(|()| write(&mut out)).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            let kind = ErrorKind::File(error.kind());
            Err(JobError::new(kind, format!("cannot write to standard output: {error}"), None))
        }
        _ => Ok(()),
    }
}

/// Tells something beside the data, on standard error.
pub(crate) fn note(text: &str) {
    anstream::eprintln!("{}", clean(text));
}

/// Likewise, of several things.
pub(crate) fn notes(texts: &[String]) {
    texts.iter().for_each(|text| note(&with_flags(text)));
}

/// Tells of a report.
pub(crate) fn note_report(folder: &Path) {
    note(&format!("report written: {}", folder.join("report.html").display()));
}
