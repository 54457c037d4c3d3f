//! Text as HTML.

use crate::escape::escape;
use crate::script::{Level, runs};

/// What is written of each of several things, one after the other.
pub(super) fn each<T>(things: impl IntoIterator<Item = T>, written: impl FnMut(T) -> String) -> String {
    things.into_iter().map(written).collect()
}

/// Escaped text with superscripts and subscripts as elements.
pub(super) fn rich(text: &str) -> String {
    let element = |(level, run): &(Level, String)| match level {
        Level::Base => escape(run),
        Level::Raised => format!("<sup>{}</sup>", escape(run)),
        Level::Lowered => format!("<sub>{}</sub>", escape(run)),
        Level::Dot => "\u{307}".to_owned(),
    };
    each(&runs(text), element)
}
