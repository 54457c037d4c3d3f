//! Names of files that lead nowhere else.

use palpate_jobs::output::{file_name, sha256};

/// Whether a name is that of a file in a folder, on every system: no path, nothing hidden.
pub(super) fn is_plain(name: &str) -> bool {
    !name.starts_with('.') && !name.contains(['/', '\\', ':', '\0']) && !name.is_empty()
}

/// A name that any system can hold, made of one that a browser sent.
pub(super) fn plain(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    file_name(last.trim_start_matches('.'))
}

/// A name beside that of a file: of what belongs to it, or to one of its tests.
pub(super) fn beside(file: &str, part: Option<&str>, ending: &str) -> String {
    match part {
        None => format!("{file}{ending}"),
        Some("") => format!("{file}~"),
        // The digest keeps tests apart whose names no file can have.
        Some(part) => format!(
            "{file}~{}-{}{ending}",
            file_name(&part.chars().take(40).collect::<String>()),
            &sha256(part.as_bytes())[..8]
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_browsers_send_become_plain() {
        for (sent, expected) in [
            ("ball.csv", "ball.csv"),
            ("..", "test"),
            ("C:\\data\\ball.csv", "ball.csv"),
            ("../../etc/passwd", "passwd"),
            (".ssh", "ssh"),
            ("<img src=x>.csv", "-img src=x-.csv"),
        ] {
            assert_eq!(plain(sent), expected);
            assert!(is_plain(&plain(sent)), "{sent}");
        }
    }
}
