//! What the TOML reader says about a value, in words for people who do not program.

use super::error::{DescriptionError, KeyPlace};

/// Turns a message of the reader about the value at `place` into an error. `into_child` moves a place to
/// one of its keys.
pub(crate) fn explain(
    message: &str,
    mut place: KeyPlace,
    into_child: impl Fn(&mut KeyPlace, &str),
) -> DescriptionError {
    if message.starts_with("unknown field ") {
        let mut names = quoted(message);
        let unknown = if names.is_empty() { String::new() } else { names.remove(0) };
        if !place.key.ends_with(&unknown) {
            into_child(&mut place, &unknown);
        }
        return DescriptionError::UnknownKey { place, accepted: names };
    }
    if message.starts_with("missing field ") {
        let missing = quoted(message).into_iter().next().unwrap_or_default();
        // A table that is missing stands in no other.
        if needed(&missing).contains(&format!("[{missing}]")) {
            place.key.clear();
            place.line = None;
        }
        into_child(&mut place, &missing);
        let expected = needed(&missing).to_owned();
        return DescriptionError::Missing { place, expected };
    }
    if message.starts_with("unknown variant ") {
        let mut names = quoted(message);
        let found = if names.is_empty() { String::new() } else { names.remove(0) };
        let names: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
        return DescriptionError::Value {
            place,
            expected: any_of(&names),
            found: format!("\"{found}\""),
        };
    }
    if message.ends_with("overflowed") {
        return DescriptionError::Value {
            place,
            expected: "a number that is not beyond all others, such as 1e300".to_owned(),
            found: "one beyond 1.8e308".to_owned(),
        };
    }
    if let Some((length, expected)) =
        message.strip_prefix("invalid length ").and_then(|body| body.split_once(", expected "))
    {
        return DescriptionError::Value {
            place,
            expected: plain_expected(expected),
            found: format!("a list of {length}"),
        };
    }
    let kinds = ["invalid type: ", "invalid value: "];
    let body = kinds.iter().find_map(|kind| message.strip_prefix(kind));
    match body.and_then(|body| body.split_once(", expected ")) {
        Some((found, expected)) => DescriptionError::Value {
            place,
            expected: plain_expected(expected),
            found: plain_found(found),
        },
        None => DescriptionError::Other {
            place,
            message: message.to_owned(),
        },
    }
}

/// `a`, `a or b`, `a, b or c`.
pub(crate) fn any_of(names: &[String]) -> String {
    match names {
        [] => "nothing".to_owned(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// The texts in backquotes.
fn quoted(message: &str) -> Vec<String> {
    message.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

fn needed(key: &str) -> &'static str {
    match key {
        "specimen" => "a table [specimen] with the shape and size of the body",
        "law" => "a table [law] with name and the numbers of that law (exponent and rate_coefficient of \"latency\")",
        "step" => "one or more [[step]] tables with to and rate",
        "shape" => "\"ball\", \"pad\", \"strip\", \"cylinder\" or \"block\"",
        "name" => "a law: \"latency\", \"standard-linear-solid\", \"prony\", \"fung\" or \"fractional-zener\"",
        "overshoot" => "a number above 0, such as 3",
        "share" => "a number above 0, such as 0.3",
        "time" => "a time, such as \"2 s\"",
        "exponent" => "a number above 0, such as 5",
        "rate_coefficient" => "a rate, such as \"2e4 /s\"",
        "modulus" => "a modulus, such as \"28 kPa\"",
        "to" => "a displacement of the jaw, such as \"5 mm\"",
        "rate" => "a speed, such as \"500 mm/min\", or in a law a rate, such as \"0.5 /s\"",
        "column" => "the number of a column, from 1, or its name in quotes",
        _ => "a value",
    }
}

fn plain_expected(expected: &str) -> String {
    match expected {
        "f64" => "a number".to_owned(),
        "usize" | "u64" | "i64" | "i32" => "a whole number".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a string" => "text in quotes".to_owned(),
        "a sequence" => "a list in square brackets".to_owned(),
        "a tuple of size 2" | "an array of length 2" => "two numbers in square brackets".to_owned(),
        "string or table" => "text in quotes".to_owned(),
        _ if expected.starts_with("struct ") || expected == "a map" => "a table".to_owned(),
        _ => expected.to_owned(),
    }
}

fn plain_found(found: &str) -> String {
    match found {
        "sequence" => return "a list".to_owned(),
        "map" => return "a table".to_owned(),
        _ => {}
    }
    if let [value] = quoted(found).as_slice() {
        return value.clone();
    }
    let text = found.strip_prefix("string ");
    text.map_or_else(|| found.to_owned(), ToOwned::to_owned)
}
