//! The header is that of the sources.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn header() -> String {
    fs::read_to_string(folder().join("include/palpate.h")).unwrap()
}

/// All sources, without their comments and tests.
fn sources() -> String {
    let (mut paths, mut folders) = (Vec::new(), vec![folder().join("src")]);
    while let Some(next) = folders.pop() {
        let entries = fs::read_dir(next).unwrap().map(|entry| entry.unwrap().path());
        let (inside, files): (Vec<PathBuf>, Vec<PathBuf>) = entries.partition(|path| path.is_dir());
        folders.extend(inside);
        paths.extend(files);
    }
    let code = |path: PathBuf| {
        let text = fs::read_to_string(path).unwrap();
        without_comments(text.split("#[cfg(test)]").next().unwrap(), "//")
    };
    paths.into_iter().map(code).collect()
}

fn without_comments(text: &str, begin: &str) -> String {
    text.lines().map(|line| line.split(begin).next().unwrap()).collect::<Vec<_>>().join("\n")
}

/// A header without its comments between `/*` and `*/`.
fn without_blocks(text: &str) -> String {
    let mut parts = text.split("/*");
    let first = parts.next().unwrap().to_owned();
    parts.fold(first, |text, part| text + part.split_once("*/").unwrap().1)
}

fn squeezed(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A type of Rust as C writes it.
fn in_c(rust: &str) -> String {
    let rust = rust.trim();
    if let Some(target) = rust.strip_prefix("*mut ") {
        return format!("{}*", in_c(target));
    }
    if let Some(target) = rust.strip_prefix("*const ") {
        return match target.strip_prefix("*const ") {
            Some(inner) => format!("const {}*const *", in_c(inner)),
            None => format!("const {}*", in_c(target)),
        };
    }
    let name = match rust {
        "f64" => "double",
        "usize" => "size_t",
        "i32" => "int32_t",
        "u32" => "uint32_t",
        "u8" => "uint8_t",
        "c_char" => "char",
        "Model" => "struct palpate_model",
        "State" => "struct palpate_state",
        "Many" => "struct palpate_many",
        "Status" => "palpate_status",
        other => panic!("a type that no test knows: {other}"),
    };
    format!("{name} ")
}

/// "name: type, …" of Rust as "type name" of C.
fn fields_in_c(list: &str) -> Vec<String> {
    let fields = list.split(',').map(squeezed).filter(|field| !field.is_empty());
    fields
        .map(|field| {
            let (name, kind) = field.trim_start_matches("pub ").split_once(':').unwrap();
            format!("{}{name}", in_c(kind))
        })
        .collect()
}

#[test]
fn functions_of_the_header_are_those_of_the_sources() {
    let sources = sources();
    let mut expected = BTreeMap::new();
    for rest in sources.split("#[unsafe(no_mangle)]").skip(1) {
        let (_, rest) = rest.split_once("fn ").unwrap();
        let (name, rest) = rest.split_once('(').unwrap();
        let (arguments, rest) = rest.split_once(')').unwrap();
        let result = in_c(rest.split_once("->").unwrap().1.split('{').next().unwrap());
        let arguments = fields_in_c(arguments);
        let arguments = if arguments.is_empty() { "void".to_owned() } else { arguments.join(", ") };
        expected.insert(name.to_owned(), format!("{result}{name}({arguments});"));
    }
    let mut found = BTreeMap::new();
    let header = without_blocks(&header());
    let plain: Vec<&str> = header.lines().filter(|line| !line.starts_with('#')).collect();
    for statement in plain.join("\n").replace("extern \"C\" {", "").split_inclusive(';').map(squeezed) {
        let Some((head, _)) = statement.split_once('(') else {
            continue;
        };
        let name = head.rsplit([' ', '*']).next().unwrap();
        found.insert(name.to_owned(), statement.clone());
    }
    assert!(expected.len() >= 22, "{}", expected.len());
    assert_eq!(found, expected);
}

#[test]
fn structs_and_codes_of_the_header_are_those_of_the_sources() {
    let (header, sources) = (without_blocks(&header()), sources());
    for (name, rust) in [("palpate_state", "pub struct State {"), ("palpate_many", "pub struct Many {")] {
        let fields = sources.split(rust).nth(1).unwrap().split('}').next().unwrap();
        let body = header.split(&format!("typedef struct {name} {{")).nth(1).unwrap().split('}').next().unwrap();
        let found: Vec<String> = body.split(';').map(squeezed).filter(|field| !field.is_empty()).collect();
        assert_eq!(found, fields_in_c(fields), "{name}");
    }
    let codes = sources.split("pub enum Status {").nth(1).unwrap().split('}').next().unwrap();
    let screaming = |name: &str| {
        let letter = |c: char| if c.is_uppercase() { format!("_{c}") } else { c.to_uppercase().to_string() };
        name.chars().map(letter).collect::<String>()
    };
    let expected: Vec<String> = codes
        .split(',')
        .map(squeezed)
        .filter_map(|code| {
            code.split_once(" = ").map(|(name, value)| format!("PALPATE_STATUS{} = {value}", screaming(name)))
        })
        .collect();
    let body = header.split("enum palpate_status").nth(1).unwrap().split('{').nth(1).unwrap();
    let found: Vec<String> =
        body.split('}').next().unwrap().split(',').map(squeezed).filter(|code| !code.is_empty()).collect();
    assert_eq!((found.len(), found), (11, expected));
    for constant in ["#define PALPATE_ABI_VERSION 1\n", "#define PALPATE_STATE_BYTES 24\n"] {
        assert!(header.contains(constant), "{constant}");
    }
}

/// Where cbindgen is installed, it writes the same bytes.
#[test]
fn cbindgen_writes_the_same_header() {
    let written = Command::new("cbindgen")
        .args(["--quiet", "--config", "cbindgen.toml", "."])
        .current_dir(folder())
        .output();
    match written {
        Ok(written) => assert_eq!(String::from_utf8(written.stdout).unwrap(), header()),
        Err(error) => eprintln!("skipped: cbindgen: {error}"),
    }
}
