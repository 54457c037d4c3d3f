//! What the TOML reader says about a value, in words for people who do not program.

use super::error::KeyProblem;

/// What a message of the reader about the value of the key `at` means: which key is wrong, that one or one of its own, and why.
pub(crate) fn explain(message: &str, at: &str) -> (String, KeyProblem) {
    let child = |key: &str| if at.is_empty() { key.to_owned() } else { format!("{at}.{key}") };
    let value = |expected, found| (at.to_owned(), KeyProblem::Value { expected, found });
    let mut names = quoted(message).into_iter();
    if message.starts_with("unknown field ") {
        let unknown = names.next().unwrap_or_default();
        let key = if at.ends_with(&unknown) { at.to_owned() } else { child(&unknown) };
        return (key, KeyProblem::Unknown(names.collect()));
    }
    if message.starts_with("missing field ") {
        let missing = names.next().unwrap_or_default();
        let expected = needed(&missing).to_owned();
        // A table that is missing stands in no other.
        let key = if expected.contains(&format!("[{missing}]")) { missing } else { child(&missing) };
        return (key, KeyProblem::Missing(expected));
    }
    if message.starts_with("unknown variant ") {
        let found = names.next().unwrap_or_default();
        let names: Vec<String> = names.map(|name| format!("\"{name}\"")).collect();
        return value(any_of(&names), format!("\"{found}\""));
    }
    if message.ends_with("overflowed") {
        let expected = "a finite number, such as 1e300";
        return value(expected.to_owned(), "one beyond 1.8e308".to_owned());
    }
    if let Some((stated, expected)) = message.split_once(", expected ") {
        if let Some(length) = stated.strip_prefix("invalid length ") {
            return value(plain_expected(expected), format!("a list of {length}"));
        }
        let found = stated.strip_prefix("invalid type: ").or_else(|| stated.strip_prefix("invalid value: "));
        if let Some(found) = found {
            return value(plain_expected(expected), plain_found(found));
        }
    }
    (at.to_owned(), KeyProblem::Other(message.to_owned()))
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
        "law" => {
            "a table [law] with name and the parameters of that law (exponent and rate_coefficient of \"latency\")"
        }
        "step" => "one or more [[step]] tables with to and rate",
        "shape" => "\"ball\", \"pad\", \"strip\", \"cylinder\", \"block\" or \"spherical tip\"",
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
        "f64" => "a number",
        "usize" | "u64" | "i64" | "i32" => "a whole number",
        "a boolean" => "true or false",
        "a string" | "string or table" => "text in quotes",
        "a sequence" => "a list in square brackets",
        "a tuple of size 2" | "an array of length 2" => "two numbers in square brackets",
        _ if expected.starts_with("struct ") || expected == "a map" => "a table",
        _ => expected,
    }
    .to_owned()
}

fn plain_found(found: &str) -> String {
    match (found, quoted(found).as_slice()) {
        ("sequence", _) => "a list",
        ("map", _) => "a table",
        (_, [value]) => value,
        _ => found.strip_prefix("string ").unwrap_or(found),
    }
    .to_owned()
}
