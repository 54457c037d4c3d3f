//! What the documents say about the sources, checked against the sources.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use palpate::test_problems::{PAPER_TEST_A, PAPER_TEST_B};
use palpate_files::description::{parse_protocol, parse_sweep, parse_test};

pub(crate) fn root() -> PathBuf {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent();
    crates.and_then(Path::parent).map(Path::to_owned).unwrap_or_default()
}

pub(crate) fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Files below `folder` with this extension, as paths from the root, sorted.
fn files(folder: &str, extension: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        let entries = fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        for path in entries.flatten().map(|entry| entry.path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|found| found == extension) {
                let inside = path.strip_prefix(root()).map(|path| path.to_string_lossy().replace('\\', "/"));
                found.extend(inside);
            }
        }
    }
    found.sort();
    found
}

/// Documents whose claims are checked.
fn documents() -> Vec<String> {
    let at_root = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md"];
    let mut documents: Vec<String> = at_root.map(str::to_owned).into();
    documents.retain(|document| root().join(document).exists());
    documents.push("crates/palpate-python/README.md".to_owned());
    documents.extend(files("docs", "md"));
    documents
}

/// A document without its fenced blocks, one entry a line, with line numbers from 1.
fn prose(text: &str) -> Vec<(usize, &str)> {
    let mut fenced = false;
    let mut lines = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            lines.push((index + 1, line));
        }
    }
    lines
}

/// What stands between single backticks in a line.
fn code_spans(line: &str) -> impl Iterator<Item = &str> {
    line.split('`').skip(1).step_by(2)
}

/// Whether a code span is meant as a path of this repository.
fn is_path(span: &str) -> bool {
    let folders = ["crates/", "docs/", "examples/", "validation/", ".ci/"];
    let in_folder = folders.iter().any(|folder| span.starts_with(folder));
    let at_root = !span.contains('/') && [".md", ".cff"].iter().any(|end| span.ends_with(end));
    (in_folder || at_root || span.starts_with("LICENSE-")) && !span.contains(['*', '<', '{', ' '])
}

#[test]
fn paths_in_backticks_exist() {
    let mut missing = Vec::new();
    for document in documents() {
        for (number, line) in prose(&read(&document)) {
            let paths = code_spans(line).filter(|span| is_path(span));
            let absent = paths.filter(|path| !root().join(path).exists());
            missing.extend(absent.map(|path| format!("{document}:{number}: {path}")));
        }
    }
    assert!(missing.is_empty(), "no such file:\n{}", missing.join("\n"));
}

/// Where a link in the READMEs leads, which PyPI and crates.io show, too: files of this tree by their addresses.
const PUBLISHED: [&str; 2] = [
    "https://github.com/palpate/palpate/blob/main/",
    "https://raw.githubusercontent.com/palpate/palpate/main/",
];

#[test]
fn links_into_this_tree_lead_somewhere() {
    let mut broken = Vec::new();
    for document in documents() {
        let is_published = document.ends_with("README.md") && !document.starts_with("docs/");
        let folder = root().join(&document).parent().map(Path::to_owned).unwrap_or_default();
        for (number, line) in prose(&read(&document)) {
            for rest in line.split("](").skip(1) {
                let target = rest.split([')', ' ']).next().unwrap_or_default();
                let inside = PUBLISHED.iter().find_map(|address| target.strip_prefix(address));
                if inside.is_none() && (target.contains("://") || target.starts_with("mailto:")) {
                    continue;
                }
                let (file, anchor) = inside.unwrap_or(target).split_once('#').unwrap_or((inside.unwrap_or(target), ""));
                let path = match file {
                    "" => root().join(&document),
                    file if inside.is_some() => root().join(file),
                    file => folder.join(file),
                };
                let unreachable = is_published && inside.is_none() && !file.is_empty();
                if unreachable || !path.exists() || !(anchor.is_empty() || has_heading(&path, anchor)) {
                    broken.push(format!("{document}:{number}: {target}"));
                }
            }
        }
    }
    assert!(broken.is_empty(), "broken links:\n{}", broken.join("\n"));
}

/// Whether a Markdown file has a heading with this anchor (lower case, blanks to hyphens, punctuation dropped).
fn has_heading(path: &Path, anchor: &str) -> bool {
    let text = fs::read_to_string(path).unwrap_or_default();
    prose(&text).into_iter().any(|(_, line)| {
        let title = line.trim_start_matches('#');
        let kept = title.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        let slug: String = kept.flat_map(char::to_lowercase).map(|c| if c == ' ' { '-' } else { c }).collect();
        line.starts_with('#') && slug == anchor
    })
}

#[test]
fn architecture_is_short_enough_to_be_read() {
    let lines = read("ARCHITECTURE.md").lines().count();
    assert!(lines <= 250, "ARCHITECTURE.md has {lines} lines, at most 250 are read");
}

/// Every equation of the paper stands in the theory once, followed by the files that implement it, which name it.
#[test]
fn every_equation_names_the_source_that_implements_it() {
    let mut sources: BTreeMap<u32, Vec<String>> = BTreeMap::new();
    for document in files("docs/theory", "md") {
        let mut current = None;
        for line in read(&document).lines() {
            if let Some(rest) = line.strip_prefix("**Equation (") {
                let number = rest.split(')').next().and_then(|number| number.parse().ok());
                let number: u32 = number.unwrap_or_else(|| panic!("{document}: no number in \"{line}\""));
                assert!(current.is_none(), "{document}: the equation before ({number}) names no source");
                assert!(!sources.contains_key(&number), "equation ({number}) stands twice");
                current = Some(number);
            } else if let Some(rest) = line.strip_prefix("Implemented in: ") {
                let number = current.take().unwrap_or_else(|| panic!("{document}: \"{line}\" follows no equation"));
                sources.insert(number, code_spans(rest).filter(|span| is_path(span)).map(str::to_owned).collect());
            }
        }
        assert!(current.is_none(), "{document}: the last equation names no source");
    }
    assert_eq!(sources.keys().copied().collect::<Vec<_>>(), (1..=11).collect::<Vec<_>>());
    for (number, paths) in sources {
        assert!(!paths.is_empty(), "equation ({number}) names no file");
        for path in paths {
            assert!(read(&path).contains(&format!("({number})")), "{path} does not mention equation ({number})");
        }
    }
}

#[test]
fn golden_numbers_in_the_theory_are_those_of_the_tests() {
    let page = read("docs/theory/contact-simulation.md").replace('−', "-");
    for (test, goldens) in [("(a)", PAPER_TEST_A), ("(b)", PAPER_TEST_B)] {
        for golden in goldens {
            let begin = format!("| {test} | {:.1} |", golden.time);
            let end = format!("| {:.12} | {:.10} |", golden.excess_strain, golden.force);
            let found = page.lines().any(|line| line.starts_with(&begin) && line.ends_with(&end));
            assert!(found, "no row {begin} … {end}");
        }
    }
}

/// Descriptions in the guides and among the examples are accepted by their reader.
#[test]
fn descriptions_in_guides_and_examples_are_valid() {
    let mut texts: Vec<(String, String)> =
        files("examples", "toml").into_iter().map(|path| (path.clone(), read(&path))).collect();
    for guide in files("docs/guides", "md") {
        let page = read(&guide);
        let blocks = page.split("```toml\n").skip(1).map(|block| block.split("```").next().unwrap_or_default());
        texts.extend(blocks.map(|block| (guide.clone(), block.to_owned())));
    }
    assert!(texts.iter().any(|(path, _)| path.starts_with("docs")), "no description in the guides");
    for (path, text) in texts {
        let is_protocol = text.lines().any(|line| line.starts_with("[[step]]"));
        let checked = match is_protocol {
            true if text.contains("\n[sweep]") => parse_sweep(&text, &root().join(&path)).map(drop),
            true => parse_protocol(&text, &root().join(&path)).map(drop),
            false => parse_test(&text, &root().join(&path)).map(drop),
        };
        assert!(checked.is_ok(), "{path}: {checked:?}\n{text}");
    }
}

/// Findings are explained to the reader, all of them and no other.
#[test]
fn the_guide_explains_every_finding() {
    let source = code_of(&read("crates/palpate/src/analysis/finding.rs"));
    let listed = source
        .split("pub enum Finding {")
        .nth(1)
        .and_then(|rest| rest.split("\n}").next())
        .unwrap_or_default();
    let variants = listed
        .lines()
        .filter_map(|line| line.strip_prefix("    "))
        .filter(|line| !line.starts_with([' ', '}']));
    let words = variants.map(|line| line.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default());
    let mut codes: Vec<String> = words.map(in_snake_case).collect();
    let told = read("crates/palpate/src/analysis/finding/text.rs");
    assert!(codes.iter().all(|code| told.contains(&format!("\"{code}\""))), "{codes:?}");
    let guide = read("docs/guides/reading-the-report.md");
    let rows = guide.split("## Findings").nth(1).and_then(|rest| rest.split("\n## ").next()).unwrap_or_default();
    let mut explained: Vec<&str> = rows.lines().filter(|line| line.starts_with("| `")).flat_map(code_spans).collect();
    codes.sort_unstable();
    explained.sort_unstable();
    assert_eq!(explained, codes);
}

/// `TooFewSamples` as `too_few_samples`.
fn in_snake_case(name: &str) -> String {
    let letter = |c: char| if c.is_uppercase() { format!("_{}", c.to_lowercase()) } else { c.to_string() };
    name.chars().map(letter).collect::<String>().trim_start_matches('_').to_owned()
}

/// A source without its comments and unit tests.
fn code_of(source: &str) -> String {
    let code = source.split("#[cfg(test)]").next().unwrap_or_default();
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    lines.collect::<Vec<_>>().join("\n")
}

/// What helps is said without the flags of the command: each front end writes options its own way.
#[test]
fn the_library_knows_no_flags() {
    for path in files("crates/palpate/src", "rs") {
        let source = code_of(&read(&path));
        let texts = source.split('"').skip(1).step_by(2);
        let is_flag = |word: &str| {
            word.trim_matches(['(', '`'])
                .strip_prefix("--")
                .is_some_and(|name| name.starts_with(char::is_alphabetic))
        };
        assert!(!texts.into_iter().any(|text| text.split_whitespace().any(is_flag)), "{path} names a flag");
    }
}

#[test]
fn the_library_touches_nothing_outside_itself() {
    let forbidden = ["std::fs", "std::net", "std::env", "std::process", "std::time", "print!", "println!", "stderr"];
    for path in files("crates/palpate/src", "rs") {
        let code = code_of(&read(&path));
        for word in forbidden {
            assert!(!code.contains(word), "{path} has {word}");
        }
    }
}

#[test]
fn nothing_opens_a_connection_or_starts_a_program() {
    let rust = ["std::net", "unix::net", "TcpStream", "UdpSocket", "process::{", "process::Command"];
    let python = ["subprocess", "socket", "urllib", "os.system"];
    let sources = files("crates", "rs")
        .into_iter()
        // The lab is a server, and says in SECURITY.md what it answers.
        .filter(|path| path.contains("/src/") && !path.contains("crates/palpate-lab/"))
        .map(|path| (path, &rust[..]));
    let scripts = files("crates/palpate-python/python", "py").into_iter().map(|path| (path, &python[..]));
    for (path, forbidden) in sources.chain(scripts) {
        let code = code_of(&read(&path));
        for word in forbidden {
            assert!(!code.contains(word), "{path} has {word}");
        }
    }
}

#[test]
fn citation_and_changelog_know_the_version() {
    let version = env!("CARGO_PKG_VERSION");
    assert!(read("CITATION.cff").lines().any(|line| line == format!("version: {version}")), "CITATION.cff");
    assert!(read("CHANGELOG.md").contains(version), "CHANGELOG.md");
}

/// No dependency, on any platform, asks for a newer Rust than we promise.
#[test]
fn every_dependency_builds_with_our_rust() {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(["metadata", "--format-version", "1"])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    let release = |text: &str| -> Vec<u32> { text.split('.').take(2).filter_map(|part| part.parse().ok()).collect() };
    let ours = packages.iter().find(|package| package["name"] == "palpate").unwrap();
    let ours = ours["rust_version"].as_str().unwrap();
    let newer: Vec<String> = packages
        .iter()
        .filter(|package| package["rust_version"].as_str().is_some_and(|found| release(found) > release(ours)))
        .map(|package| format!("{} {} asks for {}", package["name"], package["version"], package["rust_version"]))
        .collect();
    assert!(newer.is_empty(), "newer than Rust {ours}:\n{}", newer.join("\n"));
}

/// Words of this project's own for which the field has one, and that one.
const REFUSED_WORDS: [(&str, &str); 48] = [
    ("foretell", "predict"),
    ("foretold", "predicted, held-out"),
    ("rival", "alternative"),
    ("relaxed force", "equilibrium force"),
    ("relaxed_force", "equilibrium_force"),
    ("even strain", "uniform strain"),
    ("even_strain", "uniform_strain"),
    ("even-strain", "uniform-strain"),
    ("evenstrain", "UniformStrain"),
    ("materialnumber", "MaterialParameter"),
    ("pure number", "dimensionless"),
    ("numbers of the law", "parameters of the law"),
    ("numbers of a law", "parameters of a law"),
    ("numbers of the material", "parameters of the material"),
    ("numbers of a material", "parameters of a material"),
    ("do as well", "are not distinguishable from the best"),
    ("does as well", "is not distinguishable from the best"),
    ("best or as good", "not distinguishable from the best"),
    ("leaves over", "residual"),
    ("--assured", "--confidence"),
    ("ghost", "redundant term"),
    ("exponent_fixed", "law"),
    ("prediction_error", "holdout_error"),
    ("force_deviation_n", "force_standard_error_n"),
    ("told", "reported, or an active verb"),
    ("said", "stated, or an active verb"),
    ("asked", "requested"),
    ("seen", "observed"),
    ("as_good", "indistinguishable"),
    ("left over", "residual"),
    ("what it leaves", "residual"),
    ("force at rest", "equilibrium force"),
    ("keep the place", "position hold"),
    ("squeeze kept", "position hold"),
    ("believed", "ModelFilter"),
    ("surprised", "INNOVATION_LIMIT"),
    ("mended", "repaired"),
    ("lastsdocument", "TimeToSlipDocument"),
    // Plain English by themselves; as names of types and functions they are not.
    ("holdingdocument", "PositionHoldDocument"),
    ("presseddocument", "ForceHoldDocument"),
    ("fn holding(", "position_hold"),
    ("cellplace", "CellPosition"),
    ("keyplace", "KeyPosition"),
    ("with_deviations", "with_standard_deviations"),
    ("is_whole", "is_valid, validate"),
    ("struct shown", "CalibrationRange"),
    ("that_swells", "that_expands"),
    ("unasked", "not requested"),
];

/// Messages, options, identifiers, snapshots and documents speak the language of the field.
#[test]
fn no_word_of_our_own_stands_where_the_field_has_one() {
    let own = "crates/palpate-cli/tests/tree/documents.rs";
    let kinds = [
        ("crates", "rs"),
        ("crates", "py"),
        ("crates", "pyi"),
        ("crates", "snap"),
        ("crates", "md"),
        ("crates/palpate-files/src", "toml"),
        ("docs", "md"),
        ("examples", "toml"),
    ];
    let mut paths: Vec<String> = kinds.iter().flat_map(|(folder, extension)| files(folder, extension)).collect();
    // What changed is described with the names that were.
    paths.extend(documents().into_iter().filter(|path| path != "CHANGELOG.md"));
    paths.push("crates/palpate-files/tests/corpus/messages.toml".to_owned());
    let mut wrong = Vec::new();
    for path in paths.iter().filter(|path| *path != own) {
        for (index, line) in read(path).to_lowercase().lines().enumerate() {
            for (refused, instead) in REFUSED_WORDS {
                // "arrival" holds a word that it is not.
                let at = line.match_indices(refused).any(|(at, _)| !line[..at].ends_with(char::is_alphabetic));
                if at {
                    wrong.push(format!("{path}:{}: \"{refused}\"; say \"{instead}\"", index + 1));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
