//! What went wrong, as the user of the command reads it.

use anstyle::{AnsiColor, Style};
use palpate_jobs::JobError;
use palpate_report::spelling::with_flags;

use crate::terminal::clean;

/// Writes `error:` and `hint:` lines to standard error, in colour where it is a terminal.
pub(crate) fn tell(error: &JobError) {
    line("error", AnsiColor::Red, &error.reported(with_flags));
    if let Some(hint) = &error.hint {
        line("hint", AnsiColor::Cyan, &with_flags(hint));
    }
}

fn line(label: &str, color: AnsiColor, text: &str) {
    let style = Style::new().bold().fg_color(Some(color.into()));
    anstream::eprintln!("{style}{label}:{style:#} {}", clean(text));
}
