//! The product's sources as a graph: every file, its module, and the files whose items it names.
//!
//! A small reader of Rust instead of a compiler: comments, literals and unit tests are left out, then `use` trees and paths that
//! begin with `crate`, `self` or `super` are followed, through re-exports, to the file that defines what they name.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The path of a module below its crate, without the crate.
type ModulePath = Vec<String>;

/// All product sources of one crate.
#[derive(Default)]
pub(crate) struct Sources {
    /// Source file of every module, from the folder `src`; inline modules have the file that holds them.
    files: BTreeMap<ModulePath, String>,
    modules: BTreeMap<ModulePath, Module>,
}

#[derive(Default)]
struct Module {
    /// Names of items that the module defines.
    defined: BTreeSet<String>,
    /// What `use` binds: the name, and the path behind it.
    bound: BTreeMap<String, Vec<String>>,
    /// Paths behind `use …::*`.
    globs: Vec<Vec<String>>,
    /// Every path that the module names.
    named: BTreeSet<Vec<String>>,
}

impl Sources {
    /// Reads the files below `folder`, the `src` of a crate.
    pub(crate) fn read(folder: &Path) -> Self {
        let mut sources = Self::default();
        let mut folders = vec![folder.to_owned()];
        while let Some(next) = folders.pop() {
            let entries = fs::read_dir(&next).unwrap_or_else(|error| panic!("{}: {error}", next.display()));
            for path in entries.flatten().map(|entry| entry.path()) {
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "rs") {
                    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
                    let inside = path.strip_prefix(folder).unwrap_or(&path);
                    sources.add(&inside.to_string_lossy().replace('\\', "/"), &text);
                }
            }
        }
        sources
    }

    /// Adds one file, named from `src`.
    pub(crate) fn add(&mut self, file: &str, text: &str) {
        let module = module_of(file);
        let tokens = tokens(text);
        self.scan(file, module, &without_tests(&tokens));
    }

    /// Every file, named from `src`.
    pub(crate) fn files(&self) -> impl Iterator<Item = &str> {
        self.files.values().map(String::as_str)
    }

    /// Pairs of files of which the first names something that the second defines. What a `mod.rs` takes from below its own
    /// folder is left out.
    pub(crate) fn edges(&self) -> BTreeSet<(String, String)> {
        let mut edges = BTreeSet::new();
        for (module, content) in &self.modules {
            let from = &self.files[module];
            // What tests use is not part of the library: those beside their code are dropped with their item, these have a file.
            if from.ends_with("/tests.rs") {
                continue;
            }
            for path in &content.named {
                let Some(to) = self.resolve(module, path, &mut BTreeSet::new()) else {
                    continue;
                };
                let own = from == "lib.rs" || from.strip_suffix("mod.rs").is_some_and(|folder| to.starts_with(folder));
                if &to != from && !own {
                    edges.insert((from.clone(), to));
                }
            }
        }
        edges
    }

    /// The file that defines what `path` means inside `module`; `None` for what is not of this crate.
    fn resolve(
        &self,
        module: &ModulePath,
        path: &[String],
        observed: &mut BTreeSet<(ModulePath, String)>,
    ) -> Option<String> {
        let mut at = module.clone();
        let mut rest = path;
        match rest.first()?.as_str() {
            "crate" => {
                at.clear();
                rest = &rest[1..];
            }
            "self" => rest = &rest[1..],
            "super" => {}
            name if self.modules.contains_key(&joined(&at, name)) => {}
            name if self.modules[&at].bound.contains_key(name) => {}
            _ => return None,
        }
        while rest.first().is_some_and(|segment| segment == "super") {
            at.pop();
            rest = &rest[1..];
        }
        self.find(at, rest, observed)
    }

    fn find(
        &self,
        mut at: ModulePath,
        mut rest: &[String],
        observed: &mut BTreeSet<(ModulePath, String)>,
    ) -> Option<String> {
        while let Some(name) = rest.first() {
            let below = joined(&at, name);
            if self.modules.contains_key(&below) {
                at = below;
                rest = &rest[1..];
                continue;
            }
            let module = self.modules.get(&at)?;
            if module.defined.contains(name) || !observed.insert((at.clone(), name.clone())) {
                break;
            }
            if let Some(bound) = module.bound.get(name) {
                let whole: Vec<String> = bound.iter().chain(&rest[1..]).cloned().collect();
                return self.resolve(&at, &whole, observed);
            }
            let behind = |glob: &Vec<String>| {
                let whole: Vec<String> = glob.iter().chain([name]).cloned().collect();
                self.resolve(&at, &whole, &mut observed.clone()).filter(|file| self.defines(file, name))
            };
            if let Some(file) = module.globs.iter().find_map(behind) {
                return Some(file);
            }
            break;
        }
        self.files.get(&at).cloned()
    }

    fn defines(&self, file: &str, name: &str) -> bool {
        self.modules
            .iter()
            .any(|(module, content)| self.files[module] == file && content.defined.contains(name))
    }

    fn scan(&mut self, file: &str, module: ModulePath, tokens: &[String]) {
        self.files.insert(module.clone(), file.to_owned());
        let mut content = Module::default();
        let mut i = 0;
        while i < tokens.len() {
            let next = |ahead: usize| tokens.get(i + ahead).map_or("", String::as_str);
            match tokens[i].as_str() {
                "mod" if next(2) == "{" => {
                    let end = closing(tokens, i + 2);
                    self.scan(file, joined(&module, next(1)), &tokens[i + 3..end]);
                    i = end;
                }
                "use" => {
                    let end = (i..tokens.len()).find(|at| tokens[*at] == ";").unwrap_or(tokens.len());
                    let mut at = i + 1;
                    tree(&tokens[..end], &mut at, &mut Vec::new(), &mut content);
                    i = end;
                }
                "fn" | "struct" | "enum" | "union" | "trait" | "type" | "const" | "static" => {
                    content.defined.insert(next(1).to_owned());
                }
                "macro_rules" => {
                    content.defined.insert(next(2).to_owned());
                }
                // The path of `pub(in …)` names no item.
                "crate" | "super" | "self" if next(1) == "::" && (i == 0 || tokens[i - 1] != "in") => {
                    let mut path = vec![tokens[i].clone()];
                    while tokens.get(i + 1).is_some_and(|token| token == "::")
                        && tokens.get(i + 2).is_some_and(|token| is_name(token))
                    {
                        path.push(tokens[i + 2].clone());
                        i += 2;
                    }
                    content.named.insert(path);
                }
                _ => {}
            }
            i += 1;
        }
        self.modules.insert(module, content);
    }
}

/// One branch of a `use` tree, from `at`.
fn tree(tokens: &[String], at: &mut usize, prefix: &mut Vec<String>, content: &mut Module) {
    let depth = prefix.len();
    while *at < tokens.len() {
        match tokens[*at].as_str() {
            "::" => *at += 1,
            "{" => {
                *at += 1;
                while *at < tokens.len() && tokens[*at] != "}" {
                    tree(tokens, at, prefix, content);
                    if tokens.get(*at).is_some_and(|token| token == ",") {
                        *at += 1;
                    }
                }
                *at += 1;
                prefix.truncate(depth);
                return;
            }
            "*" => {
                *at += 1;
                content.globs.push(prefix.clone());
                content.named.insert(prefix.clone());
                prefix.truncate(depth);
                return;
            }
            "," | "}" => break,
            "as" => {
                let name = tokens.get(*at + 1).cloned().unwrap_or_default();
                *at += 2;
                content.bound.insert(name, prefix.clone());
                content.named.insert(prefix.clone());
                prefix.truncate(depth);
                return;
            }
            "self" if !prefix.is_empty() => *at += 1,
            name => {
                prefix.push(name.to_owned());
                *at += 1;
            }
        }
    }
    if let Some(name) = prefix.last().filter(|_| prefix.len() > 1) {
        content.bound.insert(name.clone(), prefix.clone());
    }
    content.named.insert(prefix.clone());
    prefix.truncate(depth);
}

fn joined(module: &ModulePath, name: &str) -> ModulePath {
    let mut below = module.clone();
    below.push(name.to_owned());
    below
}

/// `a/b.rs` and `a/b/mod.rs` are `a::b`, `lib.rs` is the crate; `main.rs` stands beside it.
fn module_of(file: &str) -> ModulePath {
    let path = file.trim_end_matches(".rs").trim_end_matches("/mod");
    path.split('/').filter(|part| *part != "lib").map(str::to_owned).collect()
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Names, `::` and single signs; comments and literals are left out.
pub(crate) fn tokens(text: &str) -> Vec<String> {
    let chars: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let mut i = 0;
    while i < chars.len() {
        let next = |ahead: usize| chars.get(i + ahead).copied().unwrap_or(' ');
        match chars[i] {
            '/' if next(1) == '/' => i += chars[i..].iter().take_while(|c| **c != '\n').count(),
            '/' if next(1) == '*' => i = after_comment(&chars, i),
            '"' => i = after_text(&chars, i),
            'r' | 'b' | 'c' if raw_hashes(&chars, i).is_some() => i = after_raw(&chars, i),
            '\'' if next(1) == '\\' => i += 3 + chars[i + 3..].iter().take_while(|c| **c != '\'').count(),
            '\'' if next(2) == '\'' => i += 3,
            ':' if next(1) == ':' => {
                tokens.push("::".to_owned());
                i += 2;
            }
            c if c.is_alphanumeric() || c == '_' => {
                let word: String = chars[i..].iter().take_while(|c| c.is_alphanumeric() || **c == '_').collect();
                i += word.chars().count();
                tokens.push(word);
            }
            c if c.is_whitespace() => i += 1,
            c => {
                tokens.push(c.to_string());
                i += 1;
            }
        }
    }
    tokens
}

fn after_comment(chars: &[char], start: usize) -> usize {
    let (mut depth, mut i) = (0, start);
    while i + 1 < chars.len() {
        match (chars[i], chars[i + 1]) {
            ('/', '*') => (depth, i) = (depth + 1, i + 2),
            ('*', '/') => (depth, i) = (depth - 1, i + 2),
            _ => i += 1,
        }
        if depth == 0 {
            return i;
        }
    }
    chars.len()
}

fn after_text(chars: &[char], start: usize) -> usize {
    let mut i = start + 1;
    while i < chars.len() && chars[i] != '"' {
        i += if chars[i] == '\\' { 2 } else { 1 };
    }
    i + 1
}

/// Number of hashes of the raw text that begins here.
fn raw_hashes(chars: &[char], start: usize) -> Option<usize> {
    if start > 0 && (chars[start - 1].is_alphanumeric() || chars[start - 1] == '_') {
        return None;
    }
    let letters = chars[start..].iter().take_while(|c| "rbc".contains(**c)).count();
    let hashes = chars[start + letters..].iter().take_while(|c| **c == '#').count();
    let raw = letters <= 2 && chars[start..start + letters].contains(&'r');
    (raw && chars.get(start + letters + hashes) == Some(&'"')).then_some(hashes)
}

fn after_raw(chars: &[char], start: usize) -> usize {
    let hashes = raw_hashes(chars, start).unwrap_or(0);
    let mut i = start + chars[start..].iter().take_while(|c| **c != '"').count() + 1;
    while i < chars.len() {
        let closes = chars[i] == '"' && chars[i + 1..].iter().take(hashes).filter(|c| **c == '#').count() == hashes;
        i += 1;
        if closes {
            return i + hashes;
        }
    }
    i
}

/// The place of the bracket that closes the one at `open`.
fn closing(tokens: &[String], open: usize) -> usize {
    let mut depth = 0_usize;
    for (i, token) in tokens.iter().enumerate().skip(open) {
        match token.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return i;
        }
    }
    tokens.len()
}

/// The tokens without items under `#[cfg(test)]`.
pub(crate) fn without_tests(tokens: &[String]) -> Vec<String> {
    let mut kept = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        if tokens[i] == "#" && tokens.get(i + 1).is_some_and(|token| token == "[") {
            let end = closing(tokens, i + 1);
            let attribute = &tokens[i + 2..end];
            if attribute.first().is_some_and(|name| name == "cfg")
                && attribute.iter().any(|word| word == "test")
                && !attribute.iter().any(|word| word == "not")
            {
                i = after_item(tokens, end + 1);
            } else {
                kept.extend_from_slice(&tokens[i..=end.min(tokens.len() - 1)]);
                i = end + 1;
            }
        } else {
            kept.push(tokens[i].clone());
            i += 1;
        }
    }
    kept
}

/// The place after the item that begins at `start`.
fn after_item(tokens: &[String], start: usize) -> usize {
    let mut i = start;
    while i < tokens.len() {
        match tokens[i].as_str() {
            ";" => return i + 1,
            "{" => return closing(tokens, i) + 1,
            "(" | "[" => i = closing(tokens, i) + 1,
            _ => i += 1,
        }
    }
    i
}

#[test]
fn paths_lead_through_re_exports_to_the_file_that_defines() {
    let mut sources = Sources::default();
    sources.add("lib.rs", "pub mod a;\nmod b;\nmod c;\n");
    sources.add(
        "a/mod.rs",
        "mod deep;\npub use deep::{Deep, other as renamed};\npub struct Own;\nfn f() { deep::g() }\n",
    );
    sources.add("a/deep.rs", "use super::Own;\npub struct Deep; // use crate::c::C;\npub fn other() {}\n");
    sources.add("b.rs", "use crate::a::{self, Deep};\n#[cfg(test)]\nmod tests { use crate::c::C; }\n");
    sources.add(
        "c.rs",
        "pub struct C;\nfn f() -> &'static str { crate::a::renamed(); let _ = '\"'; r#\"crate::b::x\"# }\n",
    );
    sources.add("a/tests.rs", "use crate::c::C;\n");
    let edges: Vec<(String, String)> = sources.edges().into_iter().collect();
    let expected = [("a/deep.rs", "a/mod.rs"), ("b.rs", "a/deep.rs"), ("b.rs", "a/mod.rs"), ("c.rs", "a/deep.rs")];
    assert_eq!(edges, expected.map(|(from, to)| (from.to_owned(), to.to_owned())));
}
