//! Every operation on files fails once: the old output is there whole, or the new one is, and nothing else.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use palpate_files::faults::{self, Hook, Operation};
use tempfile::tempdir;

/// Lets one operation fail, and counts all.
struct Nth {
    count: Arc<AtomicUsize>,
    fails: usize,
}

impl Hook for Nth {
    fn before(&self, _: Operation) -> io::Result<()> {
        match self.count.fetch_add(1, Ordering::SeqCst) == self.fails {
            true => Err(io::ErrorKind::StorageFull.into()),
            false => Ok(()),
        }
    }
}

/// Runs a command in which the operation of this number fails, and returns its exit code or what it says, and how many operations there
/// were.
fn with_fault(arguments: &[String], fails: usize) -> (Result<u8, String>, usize) {
    let count = Arc::new(AtomicUsize::new(0));
    faults::set(Some(Box::new(Nth {
        count: Arc::clone(&count),
        fails,
    })));
    let outcome = palpate_cli::attempt(arguments.iter().map(String::as_str));
    faults::set(None);
    (outcome.map_err(|error| error.to_string()), count.load(Ordering::SeqCst))
}

/// Everything below a folder; what a job keeps to resume from stays out of it.
fn tree(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(&folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
            let kept = path.extension().is_some_and(|ending| ending == "parts" || ending == "journal");
            match path.is_dir() {
                true if kept => {}
                true => {
                    found.insert(path.clone(), Vec::new());
                    folders.push(path);
                }
                false => {
                    found.insert(path.clone(), fs::read(&path).unwrap());
                }
            }
        }
    }
    found
}

fn put(folder: &Path, files: &BTreeMap<PathBuf, Vec<u8>>) {
    let _ = fs::remove_dir_all(folder);
    fs::create_dir_all(folder).unwrap();
    for (path, content) in files {
        // A folder has no content of its own, and neither has an empty file; here no output is empty.
        match content.is_empty() {
            true => fs::create_dir_all(path).unwrap(),
            false => {
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, content).unwrap();
            }
        }
    }
}

/// The first operations, the last ones, and some between.
fn chosen(count: usize) -> Vec<usize> {
    (0..count).filter(|index| *index < 7 || index + 7 >= count || index % 19 == 0).collect()
}

#[test]
fn every_operation_fails_once_and_the_output_is_complete() {
    let folder = tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let record = |scale: f64| -> String {
        let row = |i: u32| {
            let t = f64::from(i) / 10.0;
            let (d, f) = if t < 1.0 { (t, 2.0 * t) } else { (1.0, 1.0 + (1.0 + 4.0 * (t - 1.0)).powf(-0.25)) };
            format!("{t:.4},{d:.5},{:.6}\n", scale * f)
        };
        format!("time_s,displacement_mm,force_n\n{}", (0..=60).map(row).collect::<String>())
    };
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let material = fs::read_to_string(example.join("records/ball-material.toml")).unwrap();
    let protocol = "material = \"m.toml\"\nstep = [{ to = \"5 mm\", rate = \"500 mm/min\", hold = \"2 s\" }]\n\
        [output]\nsample_rate = \"20 Hz\"\n";
    fs::write(at("t.toml"), "specimen = { shape = \"ball\", radius = \"35 mm\", modulus = \"28 kPa\" }\n").unwrap();
    fs::write(at("m.toml"), &material).unwrap();
    let inputs = |is_new: bool| {
        let scale = if is_new { 1.1 } else { 1.0 };
        fs::write(at("r.csv"), record(scale)).unwrap();
        fs::write(at("p.toml"), protocol.replace("5 mm", if is_new { "6 mm" } else { "5 mm" })).unwrap();
        let swept = format!("{protocol}[sweep]\nstep.1.hold = \"1 s, {} s\"\n", 1.0 + scale);
        fs::write(at("s.toml"), swept).unwrap();
    };
    let out = folder.path().join("out");
    let to = |name: &str| out.join(name).display().to_string();
    let jobs: Vec<(&str, Vec<String>)> = vec![
        ("analyze", vec![at("r.csv"), "--no-compare".into(), "--out".into(), to("study")]),
        ("compare", vec![at("r.csv"), "--laws".into(), "stretched".into(), "--out".into(), to("laws")]),
        ("batch", vec![at("r.csv"), "--threads".into(), "1".into(), "--out".into(), to("holds.csv")]),
        ("batch", vec![at("r.csv"), "--threads".into(), "1".into(), "--out".into(), to("holds.parquet")]),
        (
            "sweep",
            vec![
                at("s.toml"),
                "--threads".into(),
                "1".into(),
                "--out".into(),
                to("sweep.parquet"),
                "--restart".into(),
            ],
        ),
        ("convert", vec![at("r.csv"), "--out".into(), to("r.parquet")]),
        ("convert", vec![at("r.csv"), "--out".into(), to("r.json")]),
        ("simulate", vec![at("p.toml"), "--out".into(), to("s.csv"), "--figure".into(), to("s.svg")]),
        (
            "predict",
            vec![
                at("m.toml"),
                "--protocol".into(),
                at("p.toml"),
                "--out".into(),
                to("p.csv"),
                "--figure".into(),
                to("p.svg"),
            ],
        ),
        ("simulate", vec![at("p.toml"), "--out".into(), to("s.mcap")]),
        ("predict", vec![at("m.toml"), "--protocol".into(), at("p.toml"), "--out".into(), to("p.mcap")]),
        ("watch", vec![at("r.csv"), "--slip-force".into(), "1.5 N".into(), "--out".into(), to("w.mcap")]),
        (
            "calibrate",
            vec![
                at("r.csv"),
                "--test".into(),
                at("t.toml"),
                "--no-alternatives".into(),
                "--out".into(),
                to("m.toml"),
                "--figure".into(),
                to("c.svg"),
            ],
        ),
        ("inspect", vec![at("r.csv"), "--test".into(), at("t.toml"), "--figure".into(), to("cut.svg")]),
    ];
    let mut messages: Vec<String> = Vec::new();
    for (command, options) in jobs {
        let arguments: Vec<String> = ["palpate", command].map(str::to_owned).into_iter().chain(options).collect();
        let whole = |is_new: bool| {
            inputs(is_new);
            put(&out, &BTreeMap::new());
            let (outcome, count) = with_fault(&arguments, usize::MAX);
            assert!(matches!(outcome, Ok(0 | 1)), "{arguments:?}: {outcome:?}");
            (tree(&out), count)
        };
        let ((old, _), (new, count)) = (whole(false), whole(true));
        assert!(old != new && count > 5, "{arguments:?}: {count} operations");
        let nothing = BTreeMap::new();
        let states: &[_] = if ["analyze", "batch"].contains(&command) { &[&old, &nothing] } else { &[&old] };
        for before in states {
            for fails in chosen(count) {
                put(&out, before);
                let (outcome, _) = with_fault(&arguments, fails);
                let after = tree(&out);
                let is_complete = after == **before || after == new || (command == "batch" && outcome == Ok(1));
                assert!(
                    is_complete,
                    "{arguments:?}, operation {fails}: {outcome:?}: {:?}",
                    after.keys().collect::<Vec<_>>()
                );
                match outcome {
                    // The one record was not read, and the new table says so.
                    Ok(1) if command == "batch" => put(&out, &BTreeMap::new()),
                    Ok(_) => {
                        assert!(after == new, "{arguments:?}, operation {fails}: done, and the old output is there");
                    }
                    Err(message) => messages.push(message),
                }
            }
        }
        // What failed does no harm to the next run.
        put(&out, &old);
        let _ = with_fault(&arguments, count / 2);
        assert!(matches!(with_fault(&arguments, usize::MAX).0, Ok(0 | 1)));
        assert!(tree(&out) == new, "{arguments:?}");
    }
    for message in &messages {
        let is_right = ["cannot write", "exceeds the limit", "expected a description of at most"]
            .iter()
            .any(|right| message.contains(right));
        assert!(is_right && !message.replace(".palpate-files", "").contains(".palpate-"), "{message}");
    }
    assert!(messages.iter().any(|message| message.contains("cannot write: no storage space")), "{messages:?}");
    assert!(messages.iter().any(|message| message.contains("exceeds the limit")), "{messages:?}");
}
