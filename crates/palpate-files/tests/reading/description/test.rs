//! Descriptions of tests.

use palpate::{
    analysis::LayersChoice,
    budget::{Cause, Evaluation},
    contact::{Equilibrium, Shape, Sides},
    instrument::InstrumentQuantity,
    segment::{ContactChoice, GivenHold, HoldMode, HoldStart},
    simulate::Separation,
};
use palpate_files::{
    cell::{DecimalMark, Delimiter},
    description::TestDescription,
    input::Encoding,
    table::ColumnRef,
};

use super::{says, test};

#[test]
fn nothing_stated_is_the_default() {
    let nothing = test("").unwrap();
    assert_eq!(nothing, TestDescription::default());
    assert_eq!(nothing.analysis.exponents, [1.0, 2.0, 3.0, 5.0, 7.0]);
    assert_eq!((nothing.analysis.touch, nothing.analysis.free_exponent), (ContactChoice::AsRecorded, true));
}

#[test]
fn everything_stated() {
    let text = r#"
        about = { title = "a", source = "b", note = "c" }
        file = { delimiter = "semicolon", decimal = "comma", encoding = "gbk", skip_lines = 2, header = false }
        [columns]
        time = { column = 5, unit = "ms" }
        displacement = { column = "Weg", unit = "mm", sign = -1, clock = { column = 4, unit = "s" } }
        force = { unit = "kN" }
        [specimen]
        shape = "ball"
        radius = "35 mm"
        modulus = "28 kPa"
        [contact]
        squeezed_from = "one side"
        separation = false
        layer_thickness = "5 mm"
        touch = "2.5 mm"
        [phases]
        tolerance = "0.05 mm"
        minimum_hold = "2 s"
        still_below = 0.03
        hold_start = "peak + 0.5 s"
        [fit]
        exponents = [1, 2.5]
        free_exponent = false
        exponent_range = [0.5, 9]
        confidence = 0.9
        until = "10 min"
    "#;
    let all = test(text).unwrap();
    assert_eq!(all.about.note.as_deref(), Some("c"));
    assert_eq!((all.reading.delimiter, all.reading.decimal), (Some(Delimiter::Semicolon), Some(DecimalMark::Comma)));
    assert_eq!((all.reading.encoding, all.reading.header), (Some(Encoding::Gbk), Some(false)));
    assert_eq!(all.reading.skip_lines, Some(2));
    let displacement = all.columns.displacement.unwrap();
    assert_eq!(displacement.column, Some(ColumnRef::Name("Weg".to_owned())));
    assert_eq!((displacement.sign, displacement.unit.as_deref()), (-1.0, Some("mm")));
    assert_eq!(displacement.clock.unwrap().column, ColumnRef::Number(4));
    assert_eq!(all.columns.force.unwrap().column, None);
    let body = all.analysis.geometry.unwrap();
    assert_eq!((&body.shape, body.sides), (&Shape::Ball { radius: 0.035 }, Sides::One));
    assert_eq!(body.modulus, Some(28e3));
    assert_eq!(
        (all.analysis.separation, all.analysis.layers),
        (Separation::Bonded, Some(LayersChoice::Thickness(0.005)))
    );
    assert_eq!(LayersChoice::Thickness(0.005).layers(body.shape.depth(body.sides)).unwrap().count(), 0.035 / 0.005);
    assert_eq!(all.analysis.touch, ContactChoice::Displacement(0.0025));
    assert_eq!((all.analysis.segment.tolerance, all.analysis.segment.minimum_hold), (Some(5e-5), Some(2.0)));
    assert_eq!(
        (all.analysis.segment.still_below, all.analysis.segment.hold_start),
        (Some(0.03), HoldStart::AfterPeak(0.5))
    );
    assert_eq!((all.analysis.exponents, all.analysis.free_exponent), (vec![1.0, 2.5], false));
    assert_eq!((all.analysis.fit.exponent_range, all.analysis.fit.confidence), ((0.5, 9.0), 0.9));
    assert_eq!(all.analysis.fit_until, Some(600.0));
}

#[test]
fn the_shape_sets_what_is_usual() {
    let ball = test("[specimen]\nshape = \"ball\"\nradius = \"35 mm\"").unwrap();
    assert_eq!((ball.analysis.touch, ball.analysis.separation), (ContactChoice::Auto, Separation::Unilateral));
    assert_eq!(ball.analysis.geometry.unwrap().sides, Sides::Two);
    let block = test("[specimen]\nshape = \"block\"\narea = \"1 cm^2\"\nlength = \"2 cm\"").unwrap();
    assert_eq!((block.analysis.touch, block.analysis.separation), (ContactChoice::AsRecorded, Separation::Bonded));
    let body = block.analysis.geometry.unwrap();
    assert_eq!((body.sides, body.shape.depth(body.sides), body.modulus), (Sides::One, 0.02, None));
    assert_eq!(test("[specimen]\nshape = \"none\"").unwrap().analysis.geometry, None);
}

#[test]
fn a_test_may_state_the_law_of_its_body() {
    let tip =
        "[specimen]\nshape = \"pyramidal tip\"\nhalf_angle = \"20 deg\"\nthickness = \"5 um\"\npoisson_ratio = 0.5";
    let test_of_tip = test(tip).unwrap();
    assert_eq!(
        (test_of_tip.analysis.touch, test_of_tip.analysis.separation),
        (ContactChoice::Auto, Separation::Unilateral)
    );
    let body = test_of_tip.analysis.geometry.unwrap();
    assert_eq!(body.equilibrium, Equilibrium::Hertz { poisson_ratio: 0.5 });
    assert!(body.specimen(1e3).is_ok());
    let ball = "[specimen]\nshape = \"ball\"\nradius = \"35 mm\"\n";
    let hertz = test(&format!("{ball}equilibrium = \"hertz\"\npoisson_ratio = 0.45")).unwrap();
    assert_eq!(hertz.analysis.geometry.unwrap().equilibrium, Equilibrium::Hertz { poisson_ratio: 0.45 });
    let block = "[specimen]\nshape = \"block\"\narea = \"1 cm^2\"\nlength = \"2 cm\"\n";
    let block = format!("{block}equilibrium = \"hertz\"\npoisson_ratio = 0.45");
    says(test(&block), "specimen.equilibrium", "Hertz's law needs", "");
    let forces = format!("{ball}equilibrium_forces = [[\"0 mm\", \"0 N\"], [\"1 mm\", \"0.2 N\"]]");
    says(test(&forces), "specimen.equilibrium_forces", "in a test", "keep equilibrium_forces for a protocol");
}

#[test]
fn wrong_values_name_their_keys() {
    for (text, key, message) in [
        (
            "columns.force.column = 0",
            "columns.force.column",
            "the number of a column, from 1, or its name in quotes, or a list of these, found 0",
        ),
        (
            "columns.force.column = 1.5",
            "columns.force.column",
            "the number of a column, from 1, or its name in quotes, or a list of these, found 1.5",
        ),
        (
            "columns.force.unit = \"mm\"",
            "columns.force.unit",
            "\"mm\" is not a unit of force (accepted: N, kN",
        ),
        ("columns.time.unit = \"mm\"", "columns.time.unit", "\"mm\" is not a unit of time (accepted: s,"),
        ("columns.force.sign = -2", "columns.force.sign", "1 or -1, found -2"),
        (
            "columns.force.clock = { column = 1, unit = \"N\" }",
            "columns.force.clock.unit",
            "\"N\" is not a unit of time",
        ),
        (
            "columns.force.clock = { unit = \"s\" }",
            "columns.force.clock.column",
            "missing, expected the number of a column, from 1",
        ),
        ("[columns]\nforce = {}\nstress = {}", "columns.force", "either this or columns.stress, found both"),
        (
            "specimen = { shape = \"ball\", radius = \"1 m\" }\ncolumns.stress = {}",
            "columns.stress",
            "not used for a body whose contact area changes",
        ),
        (
            "specimen = { shape = \"none\", length = \"1 m\" }",
            "specimen.length",
            "not used with shape = \"none\", which has no sizes",
        ),
        (
            "specimen = { shape = \"none\", modulus = \"1 Pa\" }",
            "specimen.modulus",
            "not used without a [specimen] that has a shape",
        ),
        (
            "specimen = { shape = \"strip\", width = \"1 m\", length = \"1 m\" }",
            "specimen.thickness",
            "the thickness of a strip",
        ),
        ("specimen = { shape = \"block\", length = \"1 m\" }", "specimen.area", "such as \"40 mm^2\""),
        (
            "contact.squeezed_from = \"one side\"",
            "contact.squeezed_from",
            "not used without a [specimen] that has a shape",
        ),
        ("contact.layers = 8", "contact.layers", "not used without a [specimen] that has a shape"),
        (
            "contact.layer_thickness = \"1 mm\"",
            "contact.layer_thickness",
            "not used without a [specimen] that has a shape",
        ),
        (
            "contact.touch = \"first\"",
            "contact.touch",
            "\"ratio of variances\") or a displacement such as \"2.5 mm\", found \"first\"",
        ),
        ("contact.touch = \"2.5\"", "contact.touch", "expected a unit after the number"),
        ("contact.touch = 2.5", "contact.touch", "text in quotes, found 2.5"),
        (
            "phases.hold_start = \"top\"",
            "phases.hold_start",
            "\"settled\" or a time after the peak such as \"peak + 0.5 s\", found \"top\"",
        ),
        (
            "phases.hold_start = \"peak + 2\"",
            "phases.hold_start",
            "such as \"peak + 0.5 s\", found \"peak + 2\"",
        ),
        ("phases.tolerance = \"0 mm\"", "phases.tolerance", "a length above 0 m"),
        ("phases.tolerance = 0.05", "phases.tolerance", "expected a unit"),
        ("phases.minimum_hold = \"-2 s\"", "phases.minimum_hold", "a time above 0 s"),
        ("phases.still_below = 1", "phases.still_below", "between 0 and 1, found 1"),
        (
            "[[phases.hold]]\nfrom = \"9 s\"\nto = \"4 s\"",
            "phases.hold[1].to",
            "a time after its start (from = \"9 s\"), found \"4 s\"",
        ),
        (
            "[[phases.hold]]\nfrom = \"1 s\"\nto = \"4 s\"\n[[phases.hold]]\nfrom = \"3 s\"\nto = \"6 s\"",
            "phases.hold[2].from",
            "does not overlap hold 1",
        ),
        ("[[phases.hold]]\nfrom = \"1 mm\"\nto = \"4 s\"", "phases.hold[1].from", "mm"),
        (
            "[[phases.hold]]\nfrom = \"1 s\"\nto = \"4 s\"\nmode = \"jaw\"",
            "phases.hold[1].mode",
            "displacement",
        ),
        ("fit.exponents = [1, 0]", "fit.exponents[2]", "a number above 0, found 0"),
        ("fit.exponents = []\nfit.free_exponent = false", "fit.exponents", "one exponent or more"),
        ("fit.exponents = 5", "fit.exponents", "a list in square brackets, found 5"),
        ("fit.exponent_range = [3, 1]", "fit.exponent_range", "the smaller first, found [3, 1]"),
        (
            "fit.exponent_range = [3]",
            "fit.exponent_range",
            "two numbers in square brackets, found a list of 1",
        ),
        ("fit.confidence = 95", "fit.confidence", "between 0 and 1, such as 0.95, found 95"),
        ("fit.until = \"0 s\"", "fit.until", "a time above 0 s"),
        ("fit.free_exponent = 1", "fit.free_exponent", "true or false, found 1"),
        (
            "file.delimiter = \"pipe\"",
            "file.delimiter",
            "\"tab\", \"semicolon\", \"comma\" or \"blanks\", found \"pipe\"",
        ),
        ("file.skip_lines = -1", "file.skip_lines", "a whole number, found -1"),
        ("about.title = 3", "about.title", "text in quotes, found 3"),
    ] {
        says(test(text), key, message, "");
    }
}

#[test]
fn likely_slips_have_a_hint() {
    let hint = |text: &str| test(text).unwrap_err().hint().unwrap_or_default();
    let ball = |radius: &str, modulus: &str| {
        format!("specimen = {{ shape = \"ball\", radius = \"{radius}\", modulus = \"{modulus}\" }}")
    };
    for (radius, modulus, help) in [
        ("0 mm", "28 kPa", "radius must be above zero"),
        ("35 mm", "-28 kPa", "modulus must be above zero"),
        ("35,0 mm", "28 kPa", "write a decimal point: radius = \"35.0 mm\""),
        ("35 mm", "28 kpa", "did you mean kPa?"),
        ("1e300 m", "28 kPa", "check the value and the unit of radius"),
        ("35 mm", "28e30 GPa", "check the value and the unit of modulus"),
    ] {
        let found = hint(&ball(radius, modulus));
        assert!(found.contains(help), "{radius}, {modulus}: {found}");
    }
    assert!(hint("specimen = { shape = \"potato\" }").contains("\"block\""));
}

#[test]
fn holds_can_be_given() {
    let text = "[[phases.hold]]\nfrom = \"500 ms\"\nto = \"2 s\"\n\n[[phases.hold]]\nfrom = \"1 min\"\nto = \"62 s\"\nmode = \"force\"";
    let test = test(text).unwrap();
    let hold = |from, to, mode| GivenHold { from, to, mode };
    assert_eq!(test.analysis.given_holds, [hold(0.5, 2.0, None), hold(60.0, 62.0, Some(HoldMode::ForceHeld))]);
}

#[test]
fn an_instrument_is_read_with_its_distributions() {
    let text = r#"
        specimen = { shape = "ball", radius = "35 mm", modulus = "28 kPa" }
        [instrument]
        force = "0.2 N"
        force_gain = { limits = "0.5 %", distribution = "triangular" }
        displacement = "1e-3 mm"
        touch = { standard = "0.05 mm", type = "A", freedom = 9, cause = "record" }
        clock = { standard = "0.1 %", cause = "clock 2" }
        radius = { limits = "0.1 mm", distribution = "arcsine" }
        modulus = { expanded = "1 kPa", coverage_factor = 2 }
        temperature = { standard = "0.5 K", modulus_per_k = "-0.4 %/K" }
    "#;
    let inputs = test(text).unwrap().analysis.instrument.inputs;
    let expected = [
        ("force", 0.2 / 3f64.sqrt()),
        ("force_gain", 0.005 / 6f64.sqrt()),
        ("displacement", 1e-6 / 3f64.sqrt()),
        ("touch", 5e-5),
        ("clock", 1e-3),
        ("radius", 1e-4 / 2f64.sqrt()),
        ("modulus", 500.0),
        ("temperature", 0.5),
    ];
    assert_eq!(inputs.len(), expected.len());
    for (input, (name, u)) in inputs.iter().zip(expected) {
        assert_eq!(input.quantity.name(), name);
        assert!((input.uncertainty.standard_uncertainty / u - 1.0).abs() < 1e-12, "{name}");
    }
    assert_eq!((inputs[3].uncertainty.evaluation, inputs[3].uncertainty.freedom), (Evaluation::A, 9.0));
    let effects = InstrumentQuantity::Temperature {
        modulus_per_k: -0.004,
        rate_per_k: 0.0,
    };
    assert_eq!(inputs[7].quantity, effects);
    let causes = [2, 3, 4].map(|index: usize| inputs[index].uncertainty.cause.clone());
    assert_eq!(causes, [Cause::AsStated, Cause::EachRecord, Cause::Named("clock 2".to_owned())]);
    // The section of a cylinder follows from its diameter: u(A) = 2 A/d u(d).
    let cylinder = r#"
        specimen = { shape = "cylinder", diameter = "20 mm", length = "30 mm" }
        instrument = { diameter = { standard = "0.1 mm" }, length = "0.2 mm" }
    "#;
    let inputs = test(cylinder).unwrap().analysis.instrument.inputs;
    let area = std::f64::consts::PI * 0.01 * 0.01;
    assert!((inputs[0].uncertainty.standard_uncertainty / (2.0 * area / 0.02 * 1e-4) - 1.0).abs() < 1e-12);
}

/// The thickness of a dumbbell was refused for a body "whose sizes are width, thickness and length".
#[test]
fn an_instrument_knows_the_sizes_of_dumbbells_and_tips() {
    let dumbbell = r#"
        specimen = { shape = "dumbbell", thickness = "2 mm", widths = [["0 mm", "12 mm"], ["10 mm", "4 mm"], ["30 mm", "4 mm"], ["40 mm", "12 mm"]] }
        instrument = { thickness = { standard = "0.05 mm" } }
    "#;
    let inputs = test(dumbbell).unwrap().analysis.instrument.inputs;
    // u(A) = w u(t).
    assert!((inputs[0].uncertainty.standard_uncertainty / (4e-3 * 5e-5) - 1.0).abs() < 1e-12);
    let tip = r#"
        specimen = { shape = "conical tip", half_angle = "35 deg", thickness = "5 um", poisson_ratio = 0.5 }
        instrument = { half_angle = { standard = "1 deg" }, thickness = "0.2 um" }
    "#;
    let inputs = test(tip).unwrap().analysis.instrument.inputs;
    let names: Vec<&str> = inputs.iter().map(|input| input.quantity.name()).collect();
    assert_eq!(names, ["thickness", "half_angle"]);
    assert!((inputs[1].uncertainty.standard_uncertainty - 1f64.to_radians()).abs() < 1e-12);
}

#[test]
fn an_instrument_that_says_nothing_is_refused() {
    let ball = "specimen = { shape = \"ball\", radius = \"35 mm\" }\n";
    for (instrument, key, message, hint) in [
        ("force = \"0.2\"", "instrument.force", "unit", ""),
        ("force = 0.2", "instrument.force", "unit", ""),
        ("force = \"0.2 mm\"", "instrument.force", "mm", ""),
        ("force = \"-0.2 N\"", "instrument.force", "0 or more", ""),
        ("force = {}", "instrument.force", "standard", ""),
        ("force = { standard = \"-1 N\" }", "instrument.force.standard", "0 or more", ""),
        ("force = { standard = \"1 N\", limits = \"1 N\" }", "instrument.force.limits", "force.standard", ""),
        ("force = { expanded = \"1 N\" }", "instrument.force.coverage_factor", "coverage factor", ""),
        (
            "force = { standard = \"1 N\", coverage_factor = 2 }",
            "instrument.force.coverage_factor",
            "expanded",
            "",
        ),
        (
            "force = { expanded = \"1 N\", coverage_factor = 0 }",
            "instrument.force.coverage_factor",
            "above 0",
            "",
        ),
        (
            "force = { limits = \"1 N\", distribution = \"normal\" }",
            "instrument.force.distribution",
            "rectangular",
            "",
        ),
        ("force = { standard = \"1 N\", freedom = 0 }", "instrument.force.freedom", "1 or more", ""),
        ("force = { standard = \"1 N\", type = \"C\" }", "instrument.force.type", "\"A\" or \"B\"", ""),
        (
            "force = { standard = \"1 N\", rate_per_k = \"1 %/K\" }",
            "instrument.force.rate_per_k",
            "temperature",
            "",
        ),
        ("temperature = \"0.5 K\"", "instrument.temperature.modulus_per_k", "what it changes", ""),
        ("modulus = \"1 kPa\"", "instrument.modulus", "given modulus", ""),
        ("area = \"1 mm^2\"", "instrument.area", "whose sizes are radius", "state radius"),
        ("radius = \"70 mm\"", "instrument.radius", "below 0.035 m", ""),
        ("force = \"1e300 N\"", "instrument.force", "below 1000000 N", ""),
        ("loadcell = \"1 N\"", "instrument.loadcell", "force", ""),
    ] {
        says(test(&format!("{ball}[instrument]\n{instrument}")), key, message, hint);
    }
    says(test("[instrument]\nradius = \"1 mm\""), "instrument.radius", "without a [specimen]", "");
}

/// A block or a cylinder was analysed far beyond its own length: its jaws count as bonded, as the grips of a strip do.
#[test]
fn a_block_is_squeezed_and_what_is_in_grips_is_pulled() {
    let squeezed = |shape: &str| {
        let text = format!("[specimen]\nlength = \"20 mm\"\n{shape}");
        test(&text).unwrap().analysis.squeezed
    };
    let block = "shape = \"block\"\narea = \"400 mm^2\"\n";
    assert!(squeezed(block) && squeezed("shape = \"cylinder\"\ndiameter = \"22 mm\"\n"));
    assert!(!squeezed(&format!("{block}[contact]\nseparation = false\n")));
    assert!(!squeezed("shape = \"strip\"\nwidth = \"20 mm\"\nthickness = \"2 mm\"\n"));
}
