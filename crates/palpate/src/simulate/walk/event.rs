//! Contacts lost and regained.

use serde::{Deserialize, Serialize};

/// A contact that was lost or regained.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactEvent {
    /// Lost or regained.
    pub kind: ContactEventKind,
    /// When, s.
    pub time: f64,
    /// Displacement of the surface (and of one contact's share of the jaw) at that moment, m.
    pub contact_displacement: f64,
}

/// What happened to the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactEventKind {
    /// The jaw left the body.
    Lost,
    /// The jaw met the body again.
    Regained,
}
