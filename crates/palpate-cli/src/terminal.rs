//! Standard output that survives a closed pipe.

use std::io::{ErrorKind, Write};

use crate::failure::Failure;

/// Writes `text` to standard output; a reader that has seen enough (`| head`) is no error.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::new(format!("cannot write to standard output: {error}"), None))
        }
        _ => Ok(()),
    }
}

/// Tells something beside the data, on standard error.
pub(crate) fn note(text: &str) {
    anstream::eprintln!("{text}");
}
