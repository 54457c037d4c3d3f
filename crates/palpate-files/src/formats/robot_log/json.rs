//! The numbers in a message written as JSON.

use serde_json::{Map, Value};

use super::fields::{Fields, MOST_ELEMENTS, distinct, fault, names_elements};

/// Reads the numbers of a message. `null` is how JSON writes a number that is none.
pub(super) fn read(message: &[u8]) -> Result<Fields, String> {
    let value: Value =
        serde_json::from_slice(message).map_err(|error| fault(None, "a message in JSON", &error.to_string()))?;
    let mut fields = Fields::none(true);
    let Value::Object(object) = &value else {
        return Err(fault(None, "a JSON object", "another value"));
    };
    let stamp = object.get("header").and_then(|header| header.get("stamp")).or_else(|| object.get("stamp"));
    if let Some((seconds, nanoseconds)) = stamp.and_then(time) {
        fields.stamped(seconds, nanoseconds);
    }
    for (name, value) in object.iter().filter(|(name, _)| *name != "header" && *name != "stamp") {
        element(name, value, Some(object), &mut fields)?;
    }
    let names = fields.names.as_deref().unwrap_or_default();
    fields.signature = names.join("\n").into_bytes();
    Ok(fields)
}

/// A time as ROS 2 and Foxglove (`sec`, `nsec`, `nanosec`) and ROS 1 (`secs`, `nsecs`) write it.
fn time(value: &Value) -> Option<(i64, i64)> {
    let whole = |names: [&str; 3]| names.iter().find_map(|name| value.get(name)).and_then(Value::as_i64);
    Some((whole(["sec", "secs", "seconds"])?, whole(["nanosec", "nsec", "nsecs"])?))
}

/// Adds the numbers in a value; where it is a field of an object, the names beside it may name its elements.
fn element(path: &str, value: &Value, beside: Option<&Map<String, Value>>, fields: &mut Fields) -> Result<(), String> {
    match value {
        Value::Number(number) => fields.push(path, number.as_f64().unwrap_or(f64::NAN)),
        Value::Bool(truth) => fields.push(path, f64::from(u8::from(*truth))),
        Value::Null => fields.push(path, f64::NAN),
        Value::Object(_) if time(value).is_some() => Ok(()),
        Value::Object(inner) => inner
            .iter()
            .try_for_each(|(name, value)| element(&format!("{path}.{name}"), value, Some(inner), fields)),
        Value::Array(values) if values.len() <= MOST_ELEMENTS => {
            let labels = beside.and_then(|object| labels(object, values.len()));
            values.iter().enumerate().try_for_each(|(index, value)| {
                let label = labels.as_ref().map_or_else(|| index.to_string(), |labels| labels[index].clone());
                element(&format!("{path}[{label}]"), value, None, fields)
            })
        }
        Value::Array(_) | Value::String(_) => Ok(()),
    }
}

/// The names that stand beside arrays of `count` elements.
fn labels(object: &Map<String, Value>, count: usize) -> Option<Vec<String>> {
    let arrays = object.iter().filter(|(name, _)| names_elements(name));
    arrays.into_iter().find_map(|(_, value)| {
        let names = value.as_array().filter(|names| names.len() == count)?;
        let names: Option<Vec<String>> = names.iter().map(|name| Some(name.as_str()?.to_owned())).collect();
        names.filter(|names| distinct(names))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_by_name() {
        let text = br#"{"header":{"stamp":{"sec":5,"nanosec":7},"frame_id":"a"},"name":["l","r"],"position":[1,2.5],
            "effort":[null,3],"ok":true,"deep":{"x":[{"y":4}]},"age":{"sec":1,"nanosec":2}}"#;
        let read = read(text).unwrap();
        assert_eq!(read.stamp, Some(5_000_000_007));
        let names = ["deep.x[0].y", "effort[l]", "effort[r]", "ok", "position[l]", "position[r]"];
        assert_eq!(read.names.unwrap(), names);
        assert!(read.values[1].is_nan());
        assert_eq!((read.values[0], &read.values[2..]), (4.0, &[3.0, 1.0, 1.0, 2.5][..]));
    }

    #[test]
    fn what_is_no_object_is_a_fault() {
        for text in [&b"[1]"[..], b"{", b"", b"{\"a\":1e", b"\xFF"] {
            assert!(super::read(text).is_err());
        }
        let deep = "[".repeat(10_000);
        assert!(super::read(deep.as_bytes()).is_err());
    }
}
