//! Corrections that a test asks for.

use palpate::{
    record::{Baseline, Compliance, CorrectionOptions, SkewChoice},
    segment::{ContactChoice, TouchMethod},
};

use super::{says, test};

#[test]
fn nothing_is_corrected_without_a_request() {
    assert_eq!(test("").unwrap().analysis.corrections, CorrectionOptions::default());
    let nothing = "clock.skew = \"report\"\nforce.baseline = \"none\"";
    assert_eq!(test(nothing).unwrap().analysis.corrections, CorrectionOptions::default());
}

#[test]
fn all_that_can_be_requested_for() {
    let text = r#"
        clock = { skew = "-35 ms", resample = "1 kHz" }
        force = { filter = "0.2 s", baseline = "sloped", baseline_window = ["0 s", "1 min"] }
        machine = { compliance = "0.5 um/N" }
    "#;
    let requested = test(text).unwrap().analysis.corrections;
    assert_eq!((requested.skew, requested.resample), (SkewChoice::Given(-0.035), Some(1000.0)));
    assert_eq!((requested.baseline, requested.baseline_window), (Some(Baseline::Sloped), Some((0.0, 60.0))));
    assert_eq!(requested.force_filter, Some(0.2));
    let corner = test("force.filter = \"0.8 Hz\"").unwrap().analysis.corrections.force_filter.unwrap();
    assert!((corner - 0.198_943_7).abs() < 1e-7, "{corner}");
    assert_eq!(requested.compliance, Some(Compliance::Constant(5e-7)));
    assert_eq!(test(text).unwrap().analysis.corrections, requested);
    assert_eq!(test("clock.skew = \"auto\"").unwrap().analysis.corrections.skew, SkewChoice::Auto);
    let table = "machine.compliance_table = [[\"0 N\", \"0 um\"], [\"10 N\", \"4 um\"]]";
    let Some(Compliance::Table(table)) = test(table).unwrap().analysis.corrections.compliance else {
        panic!("no table")
    };
    assert_eq!((table.range(), table.deflection(5.0)), ((0.0, 10.0), Some(2e-6)));
}

#[test]
fn wrong_corrections_are_named() {
    says(test("clock.skew = \"much\""), "clock.skew", "expected \"report\", \"auto\" or a time", "");
    says(test("clock.skew = \"35\""), "clock.skew", "expected a unit after the number", "");
    says(test("clock.resample = \"0 Hz\""), "clock.resample", "a frequency above 0 Hz", "");
    says(test("force.filter = \"0 s\""), "force.filter", "a time above 0 s", "");
    says(test("force.filter = \"0 Hz\""), "force.filter", "a frequency above 0 Hz", "");
    says(test("clock.rate = \"1 Hz\""), "clock.rate", "skew", "");
    says(test("force.baseline = \"curved\""), "force.baseline", "\"none\", \"constant\" or \"sloped\"", "");
    let backwards = "force = { baseline = \"constant\", baseline_window = [\"2 s\", \"1 s\"] }";
    says(test(backwards), "force.baseline_window", "the earlier first", "");
    let alone = "force.baseline_window = [\"0 s\", \"1 s\"]";
    says(test(alone), "force.baseline_window", "without a baseline", "baseline = \"constant\"");
    says(test("machine.compliance = \"-1 um/N\""), "machine.compliance", "0 m/N or more", "");
    says(test("machine.compliance = \"1 um\""), "machine.compliance", "is not a unit of compliance", "");
    let falls = "machine.compliance_table = [[\"0 N\", \"1 um\"], [\"10 N\", \"0 um\"]]";
    says(test(falls), "machine.compliance_table", "in row 2", "");
    let both = "machine = { compliance = \"1 um/N\", compliance_table = [[\"0 N\", \"0 um\"], [\"1 N\", \"1 um\"]] }";
    says(test(both), "machine.compliance", "compliance_table", "");
}

#[test]
fn first_touch_by_a_rule() {
    for (name, rule) in [
        ("loading curve", TouchMethod::LoadingCurve),
        ("threshold", TouchMethod::Threshold),
        ("two lines", TouchMethod::TwoLines),
        ("hertz", TouchMethod::Hertz),
        ("ratio-of-variances", TouchMethod::VarianceRatio),
    ] {
        let text = format!("contact.touch = \"{name}\"");
        assert_eq!(test(&text).unwrap().analysis.touch, ContactChoice::By(rule));
    }
    says(test("contact.touch = \"magic\""), "contact.touch", "a rule (\"loading curve\", \"threshold\"", "");
}

#[test]
fn volts_need_a_scale() {
    let volts = "columns.force = { column = 2, unit = \"V\", scale = \"12.5 N/V\", offset = \"-200 mN\" }";
    let force = test(volts).unwrap().columns.force.unwrap();
    assert_eq!((force.scale, force.offset), (Some(12.5), -0.2));
    says(test("columns.force = { unit = \"V\" }"), "columns.force.unit", "\"V\" is not a unit of force", "");
    says(test("columns.force = { scale = \"12.5 mm/V\" }"), "columns.force.scale", "a force per volt", "");
    let newtons = "columns.force = { unit = \"N\", scale = \"12.5 N/V\" }";
    says(test(newtons), "columns.force.unit", "\"N\" is not a unit of voltage", "");
    says(test("columns.force.offset = \"2 mm\""), "columns.force.offset", "is not a unit of force", "");
}
