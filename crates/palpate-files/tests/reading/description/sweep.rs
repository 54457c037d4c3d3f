//! Sweeps.

use std::path::Path;

use palpate_files::description::{
    DescriptionError, Plan, Spacing, Sweep, parse_protocol, parse_sweep, schema_protocol,
};

use super::SQUEEZE;

fn sweep(table: &str) -> Result<Sweep, DescriptionError> {
    parse_sweep(&format!("{SQUEEZE}\n[sweep]\n{table}\n"), Path::new("squeeze.toml"))
}

/// Expects an error at this key with these words in its message and its hint.
fn refuses(table: &str, key: &str, message: &str, hint: &str) {
    let error = sweep(table).expect_err(table);
    assert_eq!(error.key(), Some(key), "{error}");
    let (found, helps) = (error.to_string(), error.hint().unwrap_or_default());
    assert!(found.contains(message) && found.contains("squeeze.toml"), "{found}");
    assert!(helps.contains(hint), "{helps}");
}

#[test]
fn a_grid_meets_every_value_with_every_other() {
    let sweep = sweep("law.exponent = \"1, 3, 5\"\nspecimen.radius = \"linear 30..40 mm, 2\"\n").unwrap();
    assert_eq!(sweep.runs, 6);
    assert_eq!(sweep.plan, Plan::Grid { counts: vec![3, 2] });
    let runs: Vec<Vec<f64>> = (0..6).map(|run| sweep.run(run).0).collect();
    let expected: Vec<Vec<f64>> = [1.0, 3.0, 5.0].iter().flat_map(|n| [vec![*n, 0.03], vec![*n, 0.04]]).collect();
    assert_eq!(runs, expected);
    let model = sweep.run(3).1.unwrap().contact;
    assert_eq!((model.latency().unwrap().law.exponent(), model.specimen().depth()), (3.0, 0.04));
    let names: Vec<_> = sweep.parameters.iter().map(|number| (number.column.as_str(), number.unit)).collect();
    assert_eq!(names, [("law_exponent", ""), ("specimen_radius_m", "m")]);
    assert_eq!(sweep.parameters[1].spacing, Spacing::Linear);
    assert_eq!(sweep.parameters[0].grid(), Some(vec![1.0, 3.0, 5.0]));
}

#[test]
fn the_order_of_the_file_is_kept() {
    let sweep =
        sweep("step.1.rate = \"1, 2 mm/s\"\nlaw.exponent = \"1, 2\"\ncontact = { layers = \"4, 8\" }").map(drop);
    // There is no [contact] with layers in the file.
    assert!(sweep.is_err());
    let sweep = self::sweep("step.1.rate = \"1, 2 mm/s\"\nlaw.exponent = \"1, 2\"").unwrap();
    let paths: Vec<_> = sweep.parameters.iter().map(|number| number.path.as_str()).collect();
    assert_eq!(paths, ["step[1].rate", "law.exponent"]);
}

#[test]
fn paths_and_lists_in_every_form() {
    for table in [
        "step.1.hold = \"1 s, 10 s\"",
        "\"step[1].hold\" = \"1, 10 s\"",
        "\"step.1.hold\" = [\"1\", \"10 s\"]",
        "step = { 1 = { hold = [\"1 s\", \"10000 ms\"] } }",
        "[sweep.step.1]\nhold = \"linear 1..10 s, 2\"",
    ] {
        let sweep = sweep(table).unwrap_or_else(|error| panic!("{table}: {error}"));
        assert_eq!(sweep.parameters[0].column, "step_1_hold_s", "{table}");
        assert_eq!((sweep.run(0).0, sweep.run(1).0), (vec![1.0], vec![10.0]), "{table}");
        assert!((sweep.run(1).1.unwrap().motion.unwrap().end() - 10.6).abs() < 1e-9);
    }
    assert_eq!(sweep("law.exponent = [1, 2.5]").unwrap().run(1).0, [2.5]);
}

#[test]
fn a_latin_hypercube_has_one_run_in_every_slice() {
    let table = "method = \"latin hypercube\"\nsamples = 50\nseed = 3\nlaw.exponent = \"linear 1..6\"\nlaw.rate_coefficient = \"log 1e2..1e7 /s\"\nspecimen.radius = \"30, 40 mm\"";
    let found = sweep(table).unwrap();
    assert_eq!(found.runs, 50);
    let values: Vec<Vec<f64>> = (0..50).map(|run| found.run(run).0).collect();
    let slices = |of: &dyn Fn(&[f64]) -> f64| {
        let mut slices: Vec<i64> = values.iter().map(|values| (50.0 * of(values)).floor() as i64).collect();
        slices.sort_unstable();
        slices
    };
    let all: Vec<i64> = (0..50).collect();
    assert_eq!(slices(&|values| (values[0] - 1.0) / 5.0), all);
    assert_eq!(slices(&|values| (values[1] / 1e2).log10() / 5.0), all);
    assert_eq!(values.iter().filter(|values| values[2] == 0.03).count(), 25);
    let other = sweep(&table.replace("seed = 3", "seed = 4")).unwrap();
    assert_ne!(other.run(0).0, values[0]);
    assert_eq!(sweep(table).unwrap().run(17).0, values[17]);
}

#[test]
fn a_run_that_makes_no_protocol_says_so() {
    let sweep = sweep("specimen.radius = \"2, 35 mm\"").unwrap();
    let error = sweep.run(0).1.unwrap_err();
    assert_eq!(error.key(), Some("step[1].to"));
    assert!(sweep.run(1).1.is_ok());
    // A swept value that is refused by itself is shown as it was written.
    let sweep = self::sweep("specimen.radius = \"-2, 35 mm\"").unwrap();
    let error = sweep.run(0).1.unwrap_err().to_string();
    assert!(error.contains("specimen.radius") && error.contains("-2 mm"), "{error}");
}

#[test]
fn sweeps_over_what_is_no_number() {
    refuses("law.exponnt = \"1, 2\"", "sweep.law.exponnt", "law.exponent, law.rate_coefficient", "law.exponent?");
    refuses(
        "contact.layers = \"4, 8\"",
        "sweep.contact.layers",
        "unknown parameter",
        "add this one to its table",
    );
    refuses("step.2.hold = \"1, 2 s\"", "sweep.step.2.hold", "unknown parameter", "step[1].hold?");
    refuses("specimen.shape = \"1, 2\"", "sweep.specimen.shape", "specimen.shape, which is none", "");
    refuses("law.name = \"1, 2\"", "sweep.law.name", "expected a parameter of the protocol", "");
    refuses("law.exponent = 5", "sweep.law.exponent", "values in quotes", "");
    refuses("law.exponent = true", "sweep.law.exponent", "found true", "");
    refuses("law.exponent = [true]", "sweep.law.exponent", "a list of numbers", "");
    refuses("law.exponent = []", "sweep.law.exponent", "one value or more", "");
    refuses("", "sweep", "missing", "law.exponent = ");
    refuses("method = \"grid\"", "sweep", "missing", "");
    let error = parse_sweep(SQUEEZE, Path::new("squeeze.toml")).unwrap_err();
    assert!(error.to_string().contains("sweep: missing"), "{error}");
    let error = parse_sweep(&format!("sweep = 3\n{SQUEEZE}"), Path::new("squeeze.toml")).unwrap_err();
    assert!(error.to_string().contains("expected a table"), "{error}");
}

#[test]
fn values_that_make_no_sweep() {
    let exponent = |values: &str| format!("law.exponent = \"{values}\"");
    for (values, words) in [
        ("", "values such as"),
        ("linear 1..5", "the number of values after a comma"),
        ("linear 5..1, 3", "rises"),
        ("log 0..1, 3", "above 0"),
        ("log 1..5, 1", "2 or more"),
        ("nan, 1", "values such as"),
        ("1, 1", "once"),
    ] {
        refuses(&exponent(values), "sweep.law.exponent", words, "");
    }
    refuses("specimen.radius = \"20, 40\"", "sweep.specimen.radius", "expected a unit", "");
    refuses("specimen.radius = \"20, 40 kPa\"", "sweep.specimen.radius", "not a unit of length", "use one of");
    let twice = "law.exponent = \"1, 2\"\n\"law.exponent\" = \"1, 2\"";
    refuses(twice, "sweep.law.exponent", "found both", "");
    let million = "law.exponent = \"linear 1..5, 100000\"\nlaw.rate_coefficient = \"log 1..5 /s, 100000\"";
    refuses(million, "sweep", "at most 10000000 runs, found 10000000000", "");
    let hypercube = |rest: &str| format!("method = \"latin hypercube\"\nlaw.exponent = \"linear 1..5\"\n{rest}");
    refuses(&hypercube(""), "sweep.samples", "missing", "samples = 1000");
    refuses(&hypercube("samples = 0"), "sweep.samples", "1 or more", "");
    refuses(&hypercube("samples = -3"), "sweep.samples", "found -3", "");
    refuses(&hypercube("samples = 2.5"), "sweep.samples", "a whole number", "");
    refuses(&hypercube("samples = 99999999999"), "sweep", "at most 10000000 runs", "");
    let counted = "method = \"latin hypercube\"\nsamples = 9\nlaw.exponent = \"linear 1..5, 3\"";
    refuses(counted, "sweep.law.exponent", "without a number of values", "");
    refuses("law.exponent = \"1, 2\"\nsamples = 9", "sweep.samples", "not used by a grid", "latin hypercube");
    refuses("law.exponent = \"1, 2\"\nmethod = \"random\"", "sweep.method", "found \"random\"", "");
    let error = sweep("law.exponent = \"1, 2\"\nlaw.exponent = \"1, 2\"").unwrap_err();
    assert!(error.hint().unwrap_or_default().contains("appears twice"), "{error}");
}

#[test]
fn a_simulation_leaves_the_sweep_aside() {
    let text = format!("{SQUEEZE}\n[sweep]\nlaw.exponent = \"1, 2\"\n");
    let (with, without) = (parse_protocol(&text, Path::new("a")), parse_protocol(SQUEEZE, Path::new("a")));
    let (with, without) = (with.unwrap(), without.unwrap());
    assert!(with.has_sweep && !without.has_sweep);
    assert_eq!((with.contact, with.steps), (without.contact, without.steps));
    let schema = schema_protocol().to_string();
    assert!(schema.contains("latin hypercube") && schema.contains("log 1e3..1e6 /s, 50"), "{schema}");
}
