//! `palpate reproduce`: the paper's study.

use palpate_report::study::{Pictures, reproduce, reproduction_bundle};

use crate::arguments::ReproduceArguments;
use crate::failure::{Failure, Outcome};
use crate::files::write_bundle;
use crate::progress::Working;
use crate::terminal::print;

pub(crate) fn run(arguments: &ReproduceArguments) -> Result<Outcome, Failure> {
    let working = Working::new("simulating and re-identifying the paper's tests");
    let study = reproduce().map_err(|error| Failure::new(error, None))?;
    let pictures = Pictures { png: arguments.png };
    let bundle = reproduction_bundle(&study, pictures).map_err(|error| Failure::new(error, None))?;
    write_bundle(&arguments.out, &bundle)?;
    drop(working);
    let mut text = String::from("What the paper reports, checked on its simulated and re-identified tests:\n\n");
    for check in &study.checks {
        let word = if check.passed { "pass" } else { "FAIL" };
        text.push_str(&format!("  {word}  {}\n        {}\n", check.name, check.found));
    }
    let report = arguments.out.join("report.html");
    text.push_str(&format!("\n{} files written; open {}\n", bundle.files.len(), report.display()));
    print(&text)?;
    Ok(if study.all_passed() { Outcome::Done } else { Outcome::Negative })
}
