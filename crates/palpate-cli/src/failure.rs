//! What went wrong, as the user of the command reads it.

use anstyle::{AnsiColor, Style};
use palpate_jobs::JobError;
use palpate_report::spelling::with_flags;

/// Writes `error:` and `hint:` lines to standard error, in colour where it is a terminal.
pub(crate) fn tell(error: &JobError) {
    line("error", AnsiColor::Red, &message(error));
    if let Some(hint) = &error.hint {
        line("hint", AnsiColor::Cyan, &with_flags(hint));
    }
}

/// The message with the file in front.
pub(crate) fn message(error: &JobError) -> String {
    let place = error.place.as_ref().map_or(String::new(), |place| format!("{place}: "));
    format!("{place}{}", with_flags(&error.message))
}

fn line(label: &str, color: AnsiColor, text: &str) {
    let style = Style::new().bold().fg_color(Some(color.into()));
    anstream::eprintln!("{style}{label}:{style:#} {text}");
}
