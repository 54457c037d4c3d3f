//! An error as the user reads it, and what the exit code says.

use anstyle::{AnsiColor, Style};

/// How a command that could run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Exit code 0.
    Done,
    /// Done, but the verdict is negative: exit code 1.
    Negative,
}

/// Why a command could not run: exit code 2.
#[derive(Debug)]
pub(crate) struct Failure {
    message: String,
    hint: Option<String>,
}

impl Failure {
    pub(crate) fn new(message: impl std::fmt::Display, hint: Option<String>) -> Self {
        Self {
            message: message.to_string(),
            hint,
        }
    }

    /// An error about a file, with the file's name in front.
    pub(crate) fn of_file(path: &std::path::Path, message: impl std::fmt::Display, hint: Option<String>) -> Self {
        Self::new(format!("{}: {message}", path.display()), hint)
    }

    /// What is wrong, and what would help, for a list of what was left out.
    pub(crate) fn into_parts(self) -> (String, Option<String>) {
        (self.message, self.hint)
    }

    /// Writes `error:` and `hint:` lines to standard error, in colour where it is a terminal.
    pub(crate) fn tell(&self) {
        tell("error", AnsiColor::Red, &self.message);
        if let Some(hint) = &self.hint {
            tell("hint", AnsiColor::Cyan, hint);
        }
    }
}

fn tell(label: &str, color: AnsiColor, text: &str) {
    let style = Style::new().bold().fg_color(Some(color.into()));
    anstream::eprintln!("{style}{label}:{style:#} {text}");
}
