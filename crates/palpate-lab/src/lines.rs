//! The command line and the lines of Python that do what the page did, to be run in its folder.

use std::path::Path;

use palpate::laws::Law;
use palpate_jobs::{Calibrate, PlanGrip};
use serde::Serialize;

use crate::folder::Subject;

/// What to type.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Lines {
    /// For a POSIX shell; `None` where one command cannot do it.
    pub(crate) shell: Option<String>,
    /// For Python.
    pub(crate) python: String,
}

/// A word of a POSIX shell; a file whose name begins with a hyphen is no option.
fn word(text: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "._-/=:,+@%".contains(letter);
    let text = if text.starts_with('-') { format!("./{text}") } else { text.to_owned() };
    if !text.is_empty() && text.chars().all(plain) {
        text
    } else {
        format!("'{}'", text.replace('\'', "'\\''"))
    }
}

/// A text of Python; JSON writes strings as Python reads them, but for letters beyond the first plane.
fn literal(text: &str) -> String {
    serde_json::to_string(text).unwrap_or_default()
}

fn stem(file: &str) -> String {
    Path::new(file).file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// How a test is named on a command line.
fn record_words(subject: &Subject, stated: Option<&str>) -> String {
    let test = stated.map_or_else(String::new, |name| format!(" --test {}", word(name)));
    let part = subject.part.as_deref().map_or_else(String::new, part_option);
    format!("{}{test}{part}", word(&subject.file))
}

/// The option that names a part, which may begin with a hyphen.
fn part_option(part: &str) -> String {
    if part.starts_with('-') {
        format!(" --part='{}'", part.replace('\'', "'\\''"))
    } else {
        format!(" --part {}", word(part))
    }
}

/// How a test is read in Python.
fn record_call(subject: &Subject, stated: Option<&str>) -> String {
    let test = stated.map_or_else(String::new, |name| format!(", test={}", literal(name)));
    let part = subject.part.as_deref().map_or_else(String::new, |part| format!(", part={}", literal(part)));
    format!("palpate.read({}{test}{part})", literal(&subject.file))
}

pub(crate) fn of_analysis(subject: &Subject, stated: Option<&str>) -> Lines {
    let out = format!("{}-report", stem(&subject.file));
    Lines {
        shell: Some(format!("palpate analyze {} --out {}", record_words(subject, stated), word(&out))),
        python: format!(
            "import palpate\n\nanalysis = {}.analyze()\nanalysis.report({})",
            record_call(subject, stated),
            literal(&out)
        ),
    }
}

pub(crate) fn of_creep(subject: &Subject, stated: Option<&str>) -> Lines {
    let out = format!("{}-creep", stem(&subject.file));
    Lines {
        shell: Some(format!("palpate compare {} --creep --out {}", record_words(subject, stated), word(&out))),
        python: format!(
            "import palpate\n\ncomparison = {}.compare(creep=True)\nprint(comparison)",
            record_call(subject, stated)
        ),
    }
}

pub(crate) fn of_batch(subject: &Subject, stated: Option<&str>, mapped: Option<&str>) -> Lines {
    let out = format!("{}-holds.csv", stem(&subject.file));
    let map = mapped.map_or_else(String::new, |name| format!(" --map {}", word(name)));
    let map_python = mapped.map_or_else(String::new, |name| format!(", map=[{}]", literal(name)));
    let test = stated.map_or_else(String::new, |name| format!(", test={}", literal(name)));
    Lines {
        shell: Some(format!("palpate batch {} --out {}{map}", record_words(subject, stated), word(&out))),
        python: format!(
            "import palpate\n\npalpate.batch([{}], {}{test}{map_python})",
            literal(&subject.file),
            literal(&out)
        ),
    }
}

/// The records as a list of Python, a line each.
fn list(subjects: &[Subject], stated: &[Option<String>]) -> String {
    let calls = subjects
        .iter()
        .zip(stated)
        .map(|(subject, stated)| format!("    {},\n", record_call(subject, stated.as_deref())));
    format!("records = [\n{}]\n", calls.collect::<String>())
}

pub(crate) fn of_comparison(subjects: &[Subject], stated: &[Option<String>]) -> Lines {
    // One command has one description, and takes whole files.
    let is_one = stated.windows(2).all(|pair| pair[0] == pair[1]) && subjects.iter().all(|one| one.part.is_none());
    let files: Vec<String> = subjects.iter().map(|subject| word(&subject.file)).collect();
    let test = stated
        .first()
        .and_then(Option::as_deref)
        .map_or_else(String::new, |name| format!(" --test {}", word(name)));
    Lines {
        shell: is_one.then(|| format!("palpate analyze {}{test} --out comparison", files.join(" "))),
        python: format!(
            "import palpate\n\n{}palpate.report_all([record.analyze() for record in records], \"comparison\")",
            list(subjects, stated)
        ),
    }
}

pub(crate) fn of_calibration(
    subjects: &[Subject],
    stated: &[Option<String>],
    law: Law,
    material: Option<&str>,
) -> Lines {
    let out = material.unwrap_or("material.toml");
    let (option, keyword) = if law == Calibrate::default().law {
        (String::new(), String::new())
    } else {
        let law = law.to_string();
        (format!(" --law {}", word(&law)), format!("law={}", literal(&law)))
    };
    let (calibrated, shell) = match (subjects, stated) {
        ([subject], [stated]) => (
            format!("calibration = {}.calibrate({keyword})\n", record_call(subject, stated.as_deref())),
            Some(format!(
                "palpate calibrate {}{option} --out {}",
                record_words(subject, stated.as_deref()),
                word(out)
            )),
        ),
        _ => {
            let files: Vec<String> = subjects.iter().map(|subject| word(&subject.file)).collect();
            let all_stated: Option<String> =
                stated.iter().map(|name| Some(format!(" --test {}", word(name.as_deref()?)))).collect();
            let whole = subjects.iter().all(|subject| subject.part.is_none());
            let keyword = if keyword.is_empty() { keyword } else { format!(", {keyword}") };
            (
                format!("{}calibration = palpate.calibrate(records{keyword})\n", list(subjects, stated)),
                all_stated
                    .filter(|_| whole)
                    .map(|tests| format!("palpate calibrate {}{tests}{option} --out {}", files.join(" "), word(out))),
            )
        }
    };
    Lines {
        shell,
        python: format!("import palpate\n\n{calibrated}calibration.material.write({})", literal(out)),
    }
}

pub(crate) fn of_grip(material: &str, options: &PlanGrip) -> Lines {
    let mut shell =
        format!("palpate grip {} --mass '{} kg' --friction {}", word(material), options.mass_kg, options.friction);
    let mut python = format!(
        "import palpate\n\nmaterial = palpate.Material.read({})\ngrip = material.grip(mass_kg={}, friction={}",
        literal(material),
        options.mass_kg,
        options.friction
    );
    let stated = [
        ("squeeze", "squeeze_m", "m", options.squeeze_m),
        ("hold", "hold_s", "s", options.hold_s),
        ("speed", "speed_m_per_s", "m/s", options.speed_m_per_s),
    ];
    for (flag, keyword, unit, value) in stated {
        if let Some(value) = value {
            shell.push_str(&format!(" --{flag} '{value} {unit}'"));
            python.push_str(&format!(", {keyword}={value}"));
        }
    }
    if options.confidence != PlanGrip::default().confidence {
        shell.push_str(&format!(" --confidence {}", options.confidence));
        python.push_str(&format!(", confidence={}", options.confidence));
    }
    Lines {
        shell: Some(shell),
        python: python + ")\nprint(grip)",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_words_of_a_shell_whatever_they_are() {
        for (name, expected) in [
            ("ball.csv", "ball.csv"),
            ("my ball.csv", "'my ball.csv'"),
            ("-rf", "./-rf"),
            ("it's; rm *", "'it'\\''s; rm *'"),
            ("$(x)", "'$(x)'"),
        ] {
            assert_eq!(word(name), expected);
        }
    }

    #[test]
    fn one_command_does_what_the_page_did_where_it_can() {
        let one = Subject {
            file: "a b.xlsx".to_owned(),
            part: Some("Sheet 1".to_owned()),
        };
        let lines = of_analysis(&one, Some("a b.xlsx.test.toml"));
        assert_eq!(
            lines.shell.unwrap(),
            "palpate analyze 'a b.xlsx' --test 'a b.xlsx.test.toml' --part 'Sheet 1' --out 'a b-report'"
        );
        assert!(
            lines
                .python
                .contains("palpate.read(\"a b.xlsx\", test=\"a b.xlsx.test.toml\", part=\"Sheet 1\").analyze()")
        );
        assert_eq!(part_option("-x y"), " --part='-x y'");
        let creep = of_creep(&one, None).shell.unwrap();
        assert_eq!(creep, "palpate compare 'a b.xlsx' --part 'Sheet 1' --creep --out 'a b-creep'");
        let two = [one.clone(), Subject { part: None, ..one }];
        assert_eq!(of_comparison(&two, &[None, None]).shell, None);
        let map = of_batch(&two[1], None, Some("relative_rate_per_s"));
        assert_eq!(map.shell.unwrap(), "palpate batch 'a b.xlsx' --out 'a b-holds.csv' --map relative_rate_per_s");
        assert!(map.python.contains("map=[\"relative_rate_per_s\"]"));
    }

    /// The lines made the material of the default law, whichever was chosen on the page.
    #[test]
    fn the_lines_of_a_calibration_have_its_law() {
        let one = Subject {
            file: "ball.csv".to_owned(),
            part: None,
        };
        let prony = Law::Prony { terms: 2 };
        let lines = of_calibration(std::slice::from_ref(&one), &[None], prony, Some("ball.material.toml"));
        assert_eq!(lines.shell.unwrap(), "palpate calibrate ball.csv --law prony:2 --out ball.material.toml");
        assert!(lines.python.contains("palpate.read(\"ball.csv\").calibrate(law=\"prony:2\")"), "{}", lines.python);
        let stated = [Some("a.toml".to_owned()), Some("b.toml".to_owned())];
        let several = of_calibration(&[one.clone(), one.clone()], &stated, prony, None);
        let shell = "palpate calibrate ball.csv ball.csv --test a.toml --test b.toml --law prony:2 --out material.toml";
        assert_eq!(several.shell.unwrap(), shell);
        assert!(several.python.contains("palpate.calibrate(records, law=\"prony:2\")"), "{}", several.python);
        let usual = of_calibration(&[one], &[None], Calibrate::default().law, None);
        assert_eq!(usual.shell.unwrap(), "palpate calibrate ball.csv --out material.toml");
        assert!(usual.python.contains(".calibrate()"), "{}", usual.python);
    }
}
