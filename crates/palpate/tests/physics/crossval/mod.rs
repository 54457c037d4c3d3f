//! The law and the contact against numbers from other software.

mod contact;
mod latency;
mod tips;
