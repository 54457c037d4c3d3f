//! Descriptions in TOML: what they give, and what their errors say.

mod corrections;
mod examples;
mod material;
mod protocol;
mod schema;
mod sweep;
mod syntax;
mod test;

use std::path::Path;

use palpate_files::description::{DescriptionError, Protocol, TestDescription, parse_protocol, parse_test};

/// A protocol with all that is needed, and nothing else.
const SQUEEZE: &str = r#"
[specimen]
shape = "ball"
radius = "35 mm"
modulus = "28 kPa"
[law]
name = "latency"
exponent = 5
rate_coefficient = "2e4 /s"
[contact]
[output]
[[step]]
to = "5 mm"
rate = "500 mm/min"
hold = "10 s"
"#;

fn protocol(text: &str) -> Result<Protocol, DescriptionError> {
    parse_protocol(text, Path::new("squeeze.toml"))
}

fn test(text: &str) -> Result<TestDescription, DescriptionError> {
    parse_test(text, Path::new("test.toml"))
}

/// The squeeze with one text in place of another.
fn with(old: &str, new: &str) -> String {
    assert!(SQUEEZE.contains(old), "{old}");
    SQUEEZE.replace(old, new)
}

/// Checks key, message and hint of an error.
#[track_caller]
fn says<T: std::fmt::Debug>(result: Result<T, DescriptionError>, key: &str, message: &str, hint: &str) {
    let error = result.expect_err("an error");
    let (text, help) = (error.to_string(), error.hint().unwrap_or_default());
    eprintln!("{text}\n   hint: {help}");
    assert_eq!(error.key().unwrap_or_default(), key, "{text}");
    assert!(text.contains(key), "{text}");
    assert!(text.contains(message), "{text}\n  lacks {message}");
    assert!(help.contains(hint), "{help}\n  lacks {hint}");
}
