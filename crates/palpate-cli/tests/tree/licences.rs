//! Every archive that is made of this tree holds the licences of its content.

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use crate::documents::{read, root};

/// The files that Cargo packs of a crate. The source archive of the Python package has the same of every crate.
fn packed(name: &str) -> BTreeSet<String> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(["package", "--list", "--allow-dirty", "--offline", "--package", name])
        .current_dir(root())
        .output()
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect()
}

#[test]
fn every_packed_crate_holds_its_licences() {
    let folders = fs::read_dir(root().join("crates")).unwrap();
    for name in folders.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()) {
        let files = packed(&name);
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            assert!(files.contains(licence), "{name} is packed without {licence}");
            assert_eq!(read(&format!("crates/{name}/{licence}")), read(licence), "{licence} of {name}");
        }
        for font in files.iter().filter(|file| file.ends_with(".ttf")) {
            let licence = font
                .rsplit_once('/')
                .map_or_else(|| "OFL.txt".to_owned(), |(folder, _)| format!("{folder}/OFL.txt"));
            assert!(files.contains(&licence), "{name} is packed with {font} and without {licence}");
        }
    }
}

/// `tests/test_package.py` looks into the installed wheel; this needs no build.
#[test]
fn the_python_package_lists_the_licences_of_its_content() {
    let project = read("crates/palpate-python/pyproject.toml");
    let listed = project.lines().find_map(|line| line.strip_prefix("license-files = ")).unwrap_or_default();
    let files = packed("palpate-python");
    for file in ["LICENSE-MIT", "LICENSE-APACHE", "OFL.txt", "THIRD-PARTY-LICENSES"] {
        assert!(listed.contains(&format!("\"{file}\"")), "license-files lacks {file}: {listed}");
        assert!(files.contains(file), "the source archive lacks {file}");
    }
    assert_eq!(read("crates/palpate-python/OFL.txt"), read("crates/palpate-report/fonts/OFL.txt"));
}
