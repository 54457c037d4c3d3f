//! The numbers in one message, whatever it is encoded in.

use std::collections::HashSet;

/// Most elements of an array that become columns; a longer one is no measurement but a picture or a cloud of points.
pub(super) const MOST_ELEMENTS: usize = 64;

/// Most numbers of one message that become columns.
pub(super) const MOST_NUMBERS: usize = 1024;

/// The numbers in a message.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Fields {
    /// Time stamp of its header in ns, if it has one that is not zero.
    pub(super) stamp: Option<i128>,
    /// The numbers, in the order of the message.
    pub(super) values: Vec<f64>,
    /// Two messages of one topic with the same signature have the same columns.
    pub(super) signature: Vec<u8>,
    /// Names of the numbers, where they were requested.
    pub(super) names: Option<Vec<String>>,
}

impl Fields {
    /// None yet, to be named or not.
    pub(super) fn none(named: bool) -> Self {
        Self {
            names: named.then(Vec::new),
            ..Self::default()
        }
    }

    /// Adds a number.
    pub(super) fn push(&mut self, path: &str, value: f64) -> Result<(), String> {
        if self.values.len() == MOST_NUMBERS {
            return Err(fault(None, &format!("at most {MOST_NUMBERS} numbers in a message"), "more"));
        }
        self.values.push(value);
        if let Some(names) = &mut self.names {
            names.push(path.to_owned());
        }
        Ok(())
    }

    /// Takes the time stamp of a header; zero stands for none.
    pub(super) fn stamped(&mut self, seconds: i64, nanoseconds: i64) {
        let stamp = i128::from(seconds) * 1_000_000_000 + i128::from(nanoseconds);
        if stamp != 0 && self.stamp.is_none() {
            self.stamp = Some(stamp);
        }
    }
}

/// Why a message cannot be read, as it is written behind its number: at which byte, where one is to blame, what was expected
/// and what found.
pub(super) fn fault(at: Option<usize>, expected: &str, found: &str) -> String {
    let at = at.map_or_else(String::new, |at| format!(", byte {at}"));
    format!("{at}: expected {expected}, found {found}")
}

/// Whether the texts of a field name the elements of the arrays beside it: the joints of a robot.
pub(super) fn names_elements(field: &str) -> bool {
    matches!(field, "name" | "names") || field.ends_with("_names")
}

/// Whether names tell elements apart.
pub(super) fn distinct(names: &[String]) -> bool {
    let mut observed = HashSet::new();
    names.iter().all(|name| observed.insert(name))
}
