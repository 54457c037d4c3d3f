//! How the messages of a topic are laid out, from the text of their ROS 2 definition (`ros2msg`).
//!
//! The text is the definition of the message, then those of the types it is made of, each behind a line of `=` and a
//! line `MSG: package/Type`. Constants and default values take no room in a message.

use std::collections::HashMap;

use crate::input::Number;

/// Most types that a message is made of.
const MOST_TYPES: usize = 512;

/// Most types inside one another.
const DEEPEST: usize = 32;

/// The types of a message; the first is the message itself. No type contains itself, and all are there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Schema {
    pub(super) types: Vec<Vec<Field>>,
}

/// One field of a type.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) count: Count,
}

/// What a field, or each of its elements, is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Number(Number),
    Text,
    /// A time or a duration: whole seconds, then nanoseconds.
    Time,
    /// A type, by its index.
    Structure(usize),
    /// The byte by which a type without fields is written.
    Filler,
}

/// How many elements a field has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Count {
    One,
    Array(usize),
    /// As many as the message says.
    Sequence,
}

fn number(name: &str) -> Option<Number> {
    Some(match name {
        "bool" => Number::Bool,
        "int8" => Number::I8,
        "uint8" | "byte" | "char" => Number::U8,
        "int16" => Number::I16,
        "uint16" => Number::U16,
        "int32" => Number::I32,
        "uint32" => Number::U32,
        "int64" => Number::I64,
        "uint64" => Number::U64,
        "float32" => Number::F32,
        "float64" => Number::F64,
        _ => return None,
    })
}

impl Schema {
    /// Reads the definition of the message called `name`. What is wrong with one comes back in words.
    pub(super) fn parse(name: &str, text: &str) -> Result<Self, String> {
        let mut blocks = vec![(short(name), Vec::new())];
        for line in text.lines().map(str::trim) {
            if line.len() >= 3 && line.bytes().all(|byte| byte == b'=') {
                blocks.push((String::new(), Vec::new()));
            } else if let (Some((title, lines)), Some(other)) = (blocks.last_mut(), line.strip_prefix("MSG:"))
                && title.is_empty()
                && lines.is_empty()
            {
                *title = short(other.trim());
            } else if let Some((_, lines)) = blocks.last_mut()
                && !line.is_empty()
                && !line.starts_with('#')
            {
                lines.push(line);
            }
        }
        if blocks.len() > MOST_TYPES {
            return Err(format!("its definition has more than {MOST_TYPES} types"));
        }
        let mut places = HashMap::new();
        for (index, (title, _)) in blocks.iter().enumerate() {
            places.entry(title.as_str()).or_insert(index);
        }
        let fields = |(title, lines): &(String, Vec<&str>)| {
            let package = title.split('/').next().unwrap_or("");
            let fields = lines.iter().filter_map(|line| field(line, package, &places).transpose());
            let mut fields = fields.collect::<Result<Vec<Field>, String>>()?;
            if fields.is_empty() {
                fields.push(Field {
                    name: String::new(),
                    kind: Kind::Filler,
                    count: Count::One,
                });
            }
            Ok(fields)
        };
        let types = blocks.iter().map(fields).collect::<Result<Vec<_>, String>>()?;
        let mut depths = vec![None; types.len()];
        depth(&types, 0, &mut depths, 0)?;
        Ok(Self { types })
    }
}

/// `package/Type` of `package/msg/Type`.
pub(super) fn short(name: &str) -> String {
    match (name.split('/').next(), name.rsplit('/').next()) {
        (Some(package), Some(own)) if name.contains('/') => format!("{package}/{own}"),
        _ => name.to_owned(),
    }
}

/// The field that a line defines; `None` for a constant.
fn field(line: &str, package: &str, places: &HashMap<&str, usize>) -> Result<Option<Field>, String> {
    let unclear = || format!("its definition has a line that is no field: {}", crate::error::shorten(line));
    let (kind, rest) = line.split_once(char::is_whitespace).ok_or_else(unclear)?;
    let rest = rest.trim_start();
    let end = rest.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').unwrap_or(rest.len());
    let (name, behind) = rest.split_at(end);
    if name.is_empty() {
        return Err(unclear());
    }
    if behind.trim_start().starts_with('=') {
        return Ok(None);
    }
    let (kind, count) = match kind.split_once('[') {
        None => (kind, Count::One),
        Some((kind, size)) => {
            let size = size.strip_suffix(']').ok_or_else(unclear)?;
            let count = match size.parse() {
                _ if size.is_empty() || size.starts_with("<=") => Count::Sequence,
                Ok(0) | Err(_) => return Err(unclear()),
                Ok(count) => Count::Array(count),
            };
            (kind, count)
        }
    };
    Ok(Some(Field {
        name: name.to_owned(),
        kind: resolved(kind, package, places)?,
        count,
    }))
}

fn resolved(kind: &str, package: &str, places: &HashMap<&str, usize>) -> Result<Kind, String> {
    if let Some(number) = number(kind) {
        return Ok(Kind::Number(number));
    }
    if kind == "string" || kind.starts_with("string<=") {
        return Ok(Kind::Text);
    }
    if kind.starts_with("wstring") {
        return Err("it holds text of wide characters, which is not read".to_owned());
    }
    let full = match kind {
        "Header" => "std_msgs/Header".to_owned(),
        _ if kind.contains('/') => short(kind),
        _ => format!("{package}/{kind}"),
    };
    match full.as_str() {
        "builtin_interfaces/Time" | "builtin_interfaces/Duration" => Ok(Kind::Time),
        _ => places
            .get(full.as_str())
            .map(|place| Kind::Structure(*place))
            .ok_or_else(|| format!("its definition lacks the type {full}")),
    }
}

/// How many types lie inside one another from this one on; refused where one contains itself.
fn depth(types: &[Vec<Field>], index: usize, known: &mut [Option<usize>], above: usize) -> Result<usize, String> {
    if let Some(depth) = known[index] {
        return Ok(depth);
    }
    if above > DEEPEST {
        return Err(format!(
            "its definition has types that contain themselves, or more than {DEEPEST} inside one another"
        ));
    }
    let mut deepest = 0;
    for field in &types[index] {
        if let Kind::Structure(inner) = field.kind {
            deepest = deepest.max(1 + depth(types, inner, known, above + 1)?);
        }
    }
    if above + deepest > DEEPEST {
        return Err(format!("its definition has more than {DEEPEST} types inside one another"));
    }
    known[index] = Some(deepest);
    Ok(deepest)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WRENCH: &str = "# a comment\nstd_msgs/Header header\nWrench wrench\n\
        ================================================================================\n\
        MSG: geometry_msgs/Wrench\nVector3  force\nVector3  torque # N m\n\
        ================================================================================\n\
        MSG: geometry_msgs/Vector3\nfloat64 x 0.0\nfloat64 y\nfloat64 z\n\
        ================================================================================\n\
        MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";

    #[test]
    fn nested_types_are_found_in_their_packages() {
        let schema = Schema::parse("geometry_msgs/msg/WrenchStamped", WRENCH).unwrap();
        assert_eq!(schema.types.len(), 4);
        let names: Vec<&str> = schema.types[2].iter().map(|field| field.name.as_str()).collect();
        assert_eq!(names, ["x", "y", "z"]);
        assert_eq!(schema.types[0][1].kind, Kind::Structure(1));
        assert_eq!(schema.types[3][0].kind, Kind::Time);
    }

    #[test]
    fn arrays_bounds_constants_and_defaults() {
        let text = "int32 IDLE=0\nstring NAME = \"a b\"\nfloat64[] a\nfloat32[3] b [1, 2, 3]\nstring<=10[<=5] c\nbool d true\n";
        let schema = Schema::parse("some/Thing", text).unwrap();
        let counts: Vec<Count> = schema.types[0].iter().map(|field| field.count).collect();
        assert_eq!(counts, [Count::Sequence, Count::Array(3), Count::Sequence, Count::One]);
        assert_eq!(schema.types[0][2].kind, Kind::Text);
        let empty = Schema::parse("std_msgs/Empty", "# nothing\n").unwrap();
        assert_eq!(empty.types[0][0].kind, Kind::Filler);
    }

    #[test]
    fn what_cannot_be_laid_out_is_stated() {
        let lacking = Schema::parse("a/B", "other/Missing x\n").unwrap_err();
        assert!(lacking.contains("lacks the type other/Missing"), "{lacking}");
        let circle = "C c\n===\nMSG: a/C\nB b\n";
        let circle = Schema::parse("a/B", circle).unwrap_err();
        assert!(circle.contains("contain themselves"), "{circle}");
        for text in ["float64\n", "float64[0] x\n", "float64[x y\n", "float64 =\n", "float64[-1] x\n", "wstring x\n"] {
            assert!(Schema::parse("a/B", text).is_err(), "{text}");
        }
    }

    #[test]
    fn many_types_inside_one_another_take_no_time() {
        // Each type holds the next twice: 2^30 ways through, looked at once each.
        let mut text = "T0 a\nT0 b\n".to_owned();
        for index in 0..30 {
            text.push_str(&format!("===\nMSG: p/T{index}\nT{0} a\nT{0} b\n", index + 1));
        }
        text.push_str("===\nMSG: p/T30\nfloat64 x\n");
        assert!(Schema::parse("p/Top", &text).is_ok());
        let deeper = text.replace("float64 x", "T31 x\n===\nMSG: p/T31\nT32 x\n===\nMSG: p/T32\nfloat64 x");
        assert!(Schema::parse("p/Top", &deeper).is_err());
    }
}
