//! What a report of a bug needs to know of a build: commit and target.

use std::path::Path;
use std::process::Command;

fn main() {
    let commit = commit().unwrap_or_else(|| "unknown".to_owned());
    let target = std::env::var("TARGET").unwrap_or_else(|_| "unknown".to_owned());
    println!("cargo::rustc-env=PALPATE_COMMIT={commit}");
    println!("cargo::rustc-env=PALPATE_TARGET={target}");
    println!("cargo::rerun-if-changed=build.rs");
    // What changes with a commit or a checkout; a path that is not there would run this in every build.
    let paths = ["HEAD", "logs/HEAD"].iter().filter_map(|name| git(&["rev-parse", "--git-path", name]));
    paths
        .filter(|path| Path::new(path).exists())
        .for_each(|path| println!("cargo::rerun-if-changed={path}"));
}

/// The commit of our own repository; none where the sources were unpacked, perhaps inside the repository of another project.
fn commit() -> Option<String> {
    let top = git(&["rev-parse", "--show-toplevel"])?;
    let is_ours = Path::new(&top).canonicalize().ok()? == Path::new("../..").canonicalize().ok()?;
    is_ours.then(|| git(&["rev-parse", "--short=12", "HEAD"]))?
}

/// What `git` answers in the folder of this crate.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    let answer = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (!answer.is_empty()).then_some(answer)
}
