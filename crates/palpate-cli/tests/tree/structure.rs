//! Who uses whom: no cycles between files, modules as `ARCHITECTURE.md` draws them, crates one way.

use std::collections::{BTreeMap, BTreeSet};

use crate::documents::{read, root};
use crate::sources::Sources;

type Edges = BTreeSet<(String, String)>;

/// Our crates, with their sources.
fn crates() -> Vec<(String, Sources)> {
    let rows = crate_table();
    rows.into_keys()
        .map(|name| (name.clone(), Sources::read(&root().join("crates").join(name).join("src"))))
        .collect()
}

/// What stands in a folder, and who uses whom there; a `mod.rs` belongs to all of it and is left out.
fn rooms(edges: &Edges) -> BTreeMap<String, Edges> {
    let mut rooms: BTreeMap<String, Edges> = BTreeMap::new();
    for (from, to) in edges {
        let shared = from.split('/').zip(to.split('/')).take_while(|(from, to)| from == to).count();
        let folder = from.split('/').take(shared).collect::<Vec<_>>().join("/");
        let entry = |file: &str| file.split('/').take(shared + 1).collect::<Vec<_>>().join("/");
        let pair = (entry(from), entry(to));
        if !pair.0.ends_with("mod.rs") && !pair.1.ends_with("mod.rs") && pair.0 != pair.1 {
            rooms.entry(folder).or_default().insert(pair);
        }
    }
    rooms
}

/// The shortest way from an entry back to itself, if there is one.
fn cycle(edges: &Edges) -> Option<Vec<String>> {
    let starts: BTreeSet<&String> = edges.iter().map(|(from, _)| from).collect();
    starts.into_iter().filter_map(|start| way_back(edges, start)).min_by_key(Vec::len)
}

fn way_back(edges: &Edges, start: &str) -> Option<Vec<String>> {
    let mut ways = vec![vec![start.to_owned()]];
    let mut reached = BTreeSet::new();
    while !ways.is_empty() {
        let mut longer = Vec::new();
        for way in ways {
            let last = &way[way.len() - 1];
            for (_, to) in edges.iter().filter(|(from, _)| from == last) {
                let mut next = way.clone();
                next.push(to.clone());
                if to == start {
                    return Some(next);
                }
                if reached.insert(to.clone()) {
                    longer.push(next);
                }
            }
        }
        ways = longer;
    }
    None
}

/// Files of a folder do not use each other in a circle, its sub-folders taken as a whole; a `mod.rs` may use what is below it.
#[test]
fn no_import_cycles() {
    let mut found = Vec::new();
    for (name, sources) in crates() {
        for mut edges in rooms(&sources.edges()).into_values() {
            while let Some(way) = cycle(&edges) {
                found.push(format!("crates/{name}/src: {}", way.join(" -> ")));
                edges.remove(&(way[0].clone(), way[1].clone()));
            }
        }
    }
    assert!(found.is_empty(), "files that use each other:\n{}", found.join("\n"));
}

type Modules = BTreeMap<String, BTreeSet<String>>;

/// The fenced blocks "```modules CRATE" of `ARCHITECTURE.md`: a row names modules, what they use after two blanks, and all that
/// they use stands above them.
fn drawn_modules() -> BTreeMap<String, Modules> {
    let page = read("ARCHITECTURE.md");
    let mut drawn = BTreeMap::new();
    for block in page.split("```modules ").skip(1) {
        let (name, rows) = block.split_once('\n').unwrap_or_default();
        let rows = rows.split("```").next().unwrap_or_default();
        let mut modules = Modules::new();
        for row in rows.lines() {
            let (names, used) = row.split_once("  ").unwrap_or((row, ""));
            let words = |text: &str| -> BTreeSet<String> {
                text.split([',', ' ']).filter(|word| !word.is_empty()).map(str::to_owned).collect()
            };
            let used = if used.trim() == "nothing of these" { BTreeSet::new() } else { words(used) };
            let above = used.iter().all(|module| modules.contains_key(module));
            assert!(above, "ARCHITECTURE.md, {name}: {names} uses what does not stand above it");
            modules.extend(words(names).into_iter().map(|module| (module, used.clone())));
        }
        drawn.insert(name.trim().to_owned(), modules);
    }
    drawn
}

/// Which modules of a crate use which.
fn used_modules(sources: &Sources) -> Modules {
    let mut used = Modules::new();
    for file in sources.files().filter(|file| !["lib.rs", "main.rs"].contains(file)) {
        used.entry(module(file)).or_default();
    }
    for (from, to) in sources.edges() {
        if ![&from, &to].iter().any(|file| ["lib.rs", "main.rs"].contains(&file.as_str()))
            && module(&from) != module(&to)
        {
            used.entry(module(&from)).or_default().insert(module(&to));
        }
    }
    used
}

/// The modules as `ARCHITECTURE.md` would draw them, the ones that use least first.
fn rows(used: &Modules) -> String {
    let mut text = String::new();
    let mut drawn: BTreeSet<&String> = BTreeSet::new();
    while drawn.len() < used.len() {
        let mut ready: BTreeMap<&BTreeSet<String>, Vec<&str>> = BTreeMap::new();
        let mut names = Vec::new();
        for (module, uses) in used.iter().filter(|(module, _)| !drawn.contains(module)) {
            if uses.iter().all(|module| drawn.contains(module)) {
                ready.entry(uses).or_default().push(module);
                names.push(module);
            }
        }
        if names.is_empty() {
            return text + "(the others use each other)\n";
        }
        drawn.extend(names);
        for (uses, modules) in ready {
            let uses: Vec<&str> = uses.iter().map(String::as_str).collect();
            let uses = if uses.is_empty() { "nothing of these".to_owned() } else { uses.join(", ") };
            text.push_str(&format!("{:<24}  {uses}\n", modules.join(", ")));
        }
    }
    text
}

#[test]
fn modules_use_what_the_architecture_draws() {
    let drawn = drawn_modules();
    let mut wrong = String::new();
    for (name, sources) in crates() {
        let used = used_modules(&sources);
        if drawn.get(&name) != Some(&used) {
            wrong.push_str(&format!("```modules {name}\n{}```\n", rows(&used)));
        }
    }
    assert!(wrong.is_empty(), "ARCHITECTURE.md draws other modules than these:\n{wrong}");
}

/// The first part of a path below `src`.
fn module(file: &str) -> String {
    file.split(['/', '.']).next().unwrap_or_default().to_owned()
}

/// Rows of the table "Crates": the name, and which of ours it may use.
fn crate_table() -> BTreeMap<String, BTreeSet<String>> {
    let page = read("ARCHITECTURE.md");
    let names = |cell: &str| -> BTreeSet<String> {
        let spans = cell.split('`').skip(1).step_by(2);
        spans.map(|span| span.trim_start_matches("crates/").to_owned()).collect()
    };
    let rows = page.lines().filter(|line| line.starts_with("| `crates/"));
    let mut table = BTreeMap::new();
    for row in rows {
        let cells: Vec<&str> = row.trim_matches('|').split('|').collect();
        if let [name, _, uses] = cells[..]
            && name.matches('/').count() == 1
        {
            table.extend(names(name).into_iter().map(|name| (name, names(uses))));
        }
    }
    assert!(table.contains_key("palpate"), "ARCHITECTURE.md has no table of crates");
    table
}

/// Names of our crates among the dependencies of a manifest, those of tests aside.
fn dependencies(manifest: &str) -> BTreeSet<String> {
    let table = manifest.split("[dependencies]").nth(1).unwrap_or_default();
    let table = table.split("\n[").next().unwrap_or_default();
    let names = table.lines().filter_map(|line| line.split(['.', ' ', '=']).next());
    names.filter(|name| name.starts_with("palpate")).map(str::to_owned).collect()
}

#[test]
fn crates_depend_as_the_architecture_says_and_one_way() {
    let table = crate_table();
    let folders = std::fs::read_dir(root().join("crates")).into_iter().flatten().flatten();
    let folders: BTreeSet<String> = folders.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    assert_eq!(table.keys().cloned().collect::<BTreeSet<_>>(), folders, "crates in ARCHITECTURE.md");
    let mut arrows = Edges::new();
    for (name, allowed) in table {
        let used = dependencies(&read(&format!("crates/{name}/Cargo.toml")));
        assert_eq!(used, allowed, "what {name} uses, and what ARCHITECTURE.md says");
        arrows.extend(used.into_iter().map(|used| (name.clone(), used)));
    }
    assert_eq!(cycle(&arrows), None);
}
