//! The texts that all sheets share.

use super::{
    super::strings::Strings,
    package::{MOST_KEPT, Package, Step},
};
use crate::error::FileError;

/// Reads the part of shared texts, if there is one. How many it says it has is not believed.
pub(super) fn read(package: &Package, path: Option<&str>) -> Result<Strings, FileError> {
    let mut strings = Strings::default();
    let Some(path) = path else {
        return Ok(strings);
    };
    let (mut in_text, mut phonetic) = (false, false);
    package.read(path, MOST_KEPT, &mut |step, _, _| {
        match step {
            Step::Begin(element) => match element.local_name().as_ref() {
                "t" => in_text = true,
                // How a Japanese word is spoken, beside the word.
                "rPh" => phonetic = true,
                _ => {}
            },
            Step::Text(text) if in_text && !phonetic => strings.extend(text),
            Step::Text(_) => {}
            Step::End("t") => in_text = false,
            Step::End("rPh") => phonetic = false,
            Step::End("si") => strings.end(),
            Step::End("sst") => return Ok(false),
            Step::End(_) => {}
        }
        Ok(true)
    })?;
    Ok(strings)
}
