//! Names of files and folders that every system can hold, and that no system takes for one another.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::sha256;

/// Longest name in bytes: file systems hold 255, and endings come behind it.
const LONGEST: usize = 200;

/// Names that Windows keeps for devices, whatever their ending.
const DEVICES: [&str; 6] = ["con", "prn", "aux", "nul", "com", "lpt"];

/// A name of a test as the name of a file: what no system allows there becomes a hyphen.
#[must_use]
pub fn file_name(name: &str) -> String {
    let allowed = |letter: char| !palpate_files::is_unprintable(letter) && !"/\\:*?\"<>|".contains(letter);
    let clean: String = name.chars().map(|letter| if allowed(letter) { letter } else { '-' }).collect();
    // Windows drops blanks and dots at the end.
    let clean = clean.trim().trim_matches('.').trim();
    match clean {
        "" => "test".to_owned(),
        clean if is_device(clean) => format!("{clean}-"),
        clean if clean.len() > LONGEST => {
            // Names that differ at their ends alone stay apart.
            let digest = &sha256(name.as_bytes())[..8];
            let end = (0..=LONGEST - 9).rev().find(|end| clean.is_char_boundary(*end)).unwrap_or(0);
            format!("{}-{digest}", &clean[..end])
        }
        clean => clean.to_owned(),
    }
}

fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_lowercase();
    let numbered = |device: &str| {
        let number = stem.strip_prefix(device).map(str::as_bytes);
        matches!((device, number), ("com" | "lpt", Some([b'0'..=b'9'])))
    };
    DEVICES
        .iter()
        .any(|device| numbered(device) || (stem == *device && !matches!(*device, "com" | "lpt")))
}

/// Names in one folder, each given once; upper and lower case are one name.
#[derive(Debug, Default)]
pub(crate) struct Names {
    taken: HashSet<String>,
    next: HashMap<String, usize>,
}

impl Names {
    /// A folder in `out` by this name, with a number where that is taken.
    pub(crate) fn folder_in(&mut self, out: &Path, name: &str) -> PathBuf {
        let mut own = file_name(name);
        let next = self.next.entry(own.to_lowercase()).or_insert(1);
        while !self.taken.insert(own.to_lowercase()) {
            *next += 1;
            own = format!("{}-{next}", file_name(name));
        }
        out.join(own)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_system_can_hold_a_name() {
        let cases = [
            ("a/b:c", "a-b-c"),
            (" . ", "test"),
            ("CON", "CON-"),
            ("nul.txt", "nul.txt-"),
            ("com1", "com1-"),
            ("comb", "comb"),
            ("com", "com"),
            ("x\u{202e}gpj", "x-gpj"),
            ("ends.", "ends"),
        ];
        for (name, expected) in cases {
            assert_eq!(file_name(name), expected, "{name}");
        }
        let (one, other) = ("ä".repeat(300), "ä".repeat(299) + "a");
        assert!(file_name(&one).len() <= LONGEST && file_name(&one) != file_name(&other));
    }

    #[test]
    fn names_that_a_disk_takes_for_one_another_are_numbered() {
        let mut names = Names::default();
        let folders = ["Test", "test", "TEST-2", "test"].map(|name| names.folder_in(Path::new(""), name));
        assert_eq!(folders, ["Test", "test-2", "TEST-2-2", "test-3"].map(PathBuf::from));
    }
}
