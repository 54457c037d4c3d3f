//! What a law is, in words.

/// A law in words: what tables, figures and help show of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Description {
    /// Name in running text, such as "standard linear solid".
    pub title: &'static str,
    /// The law for relaxation, or for creep if it has no other form.
    pub equation: &'static str,
    /// Where it is used or comes from.
    pub source: &'static str,
}
