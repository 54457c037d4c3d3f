//! Material files: what is written is read again, and nothing that was changed by hand passes for calibrated.
#![expect(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use std::path::Path;

use palpate::budget::{Cause, Distribution, InputQuantity};
use palpate::calibrate::{
    Body, CalibrationRange, Candidate, EquilibriumLaw, Material, MaterialParameter, MaterialParts, MaterialUncertainty,
    MaterialUnit, RateLaw, SystematicEffect,
};
use palpate::contact::{Base, Curve, Shape, Sides, ThinLayer, Tip};
use palpate::fit::Estimate;
use palpate::simulate::Separation;
use palpate_files::description::{
    MaterialFile, MaterialOrigin, parse_material, parse_protocol, parse_protocol_of, parse_test, read_protocol,
    read_protocol_of, self_contained,
};

fn number(name: &str, unit: MaterialUnit, value: f64) -> MaterialParameter {
    let estimate = Estimate {
        value,
        standard_error: Some(0.01 * value),
        white_standard_error: None,
        interval: Some((0.98 * value, 1.02 * value)),
    };
    MaterialParameter {
        name: name.to_owned(),
        unit,
        estimate,
    }
}

/// A material of this law with numbers that no short decimal writes.
fn material(law: &str, equilibrium: EquilibriumLaw, shape: Shape) -> MaterialFile {
    use MaterialUnit::{Metre, Newton, One, Pascal, PerSecond, Second};
    let third = 1.0 / 3.0;
    let mut numbers = match equilibrium {
        EquilibriumLaw::Table => vec![
            number("equilibrium_force_1_n", Newton, third),
            number("equilibrium_force_2_n", Newton, 1.0),
            number("equilibrium_force_3_n", Newton, 2.0 + third),
        ],
        _ => vec![number("modulus_pa", Pascal, 1e5 * third)],
    };
    match law {
        "latency" | "latency:5" => numbers.extend([
            number("exponent", One, 5.0),
            number("rate_coefficient_per_s", PerSecond, 1e5 * third),
            number("layer_thickness_m", Metre, 0.01 * third),
        ]),
        _ => {
            let terms = law.split(':').nth(1).map_or(1, |count| count.parse().unwrap());
            for term in 1..=terms {
                numbers.push(number(&format!("overshoot_{term}"), One, third * f64::from(term)));
                numbers.push(number(&format!("time_constant_{term}_s"), Second, 10.0 * third * f64::from(term)));
            }
        }
    }
    let size = numbers.len();
    let entry = |i: usize, j: usize| if i == j { 1e-4 * third } else { 1e-5 * third };
    let levels = if equilibrium == EquilibriumLaw::Table { vec![0.001, 0.002, 0.004] } else { Vec::new() };
    MaterialFile {
        material: Material::new(MaterialParts {
            body: Body {
                shape,
                sides: Sides::Two,
                separation: Separation::Unilateral,
                levels,
            },
            candidate: Candidate::new(law.parse().unwrap(), equilibrium),
            parameters: numbers,
            uncertainty: Some(MaterialUncertainty {
                confidence: 0.95,
                freedom: 2057.0,
                systematic: Vec::new(),
                covariance: (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect(),
            }),
            noise: 0.05 * third,
            range: CalibrationRange {
                longest_hold: 60.0 * third,
                longest_force_hold: 30.0 * third,
                deepest: 0.01 * third,
                fastest: 0.1 * third,
                slowest: 0.01 * third,
                largest_force: 10.0 * third,
                farthest_retreat: 0.01,
                loadings: 1,
            },
        })
        .unwrap(),
        origin: MaterialOrigin {
            record: "press \"3\"\n.csv".to_owned(),
            sha256: "ab12".to_owned(),
            specimens: None,
            test: Some("ball.toml".to_owned()),
            palpate: "0.1.0".to_owned(),
            samples: 2061,
            misfit: None,
        },
    }
}

fn ball() -> Shape {
    Shape::Ball { radius: 0.035 }
}

fn usual() -> MaterialFile {
    material("latency", EquilibriumLaw::UniformStrain, ball())
}

#[test]
fn what_is_written_is_read_again_to_the_last_digit() {
    let hertz = EquilibriumLaw::Hertz { poisson_ratio: 0.45 };
    let pad = Shape::Pad {
        radius: 0.02,
        thickness: 0.01,
    };
    let prism = Shape::Prism {
        area: 4e-5 / 3.0,
        length: 0.05 / 3.0,
    };
    let area = Curve::new(&[(0.0, 0.0), (0.001, 1e-5), (0.004, 1e-4 / 3.0)]).unwrap();
    let profile = Shape::Profile { depth: 0.02, area };
    let layer = |thickness, base| Some(ThinLayer { thickness, base });
    let bead = Shape::Indenter {
        tip: Tip::Sphere { radius: 0.01 / 3.0 },
        layer: layer(0.01, Base::Sliding),
    };
    let cone = Shape::Indenter {
        tip: Tip::Cone { half_angle: 1.0 / 3.0 },
        layer: layer(0.02, Base::Bonded),
    };
    for law in ["latency", "latency:5", "standard-linear-solid", "prony:2", "prony:3", "fung:1", "fung:2"] {
        for (equilibrium, shape) in [
            (EquilibriumLaw::UniformStrain, ball()),
            (EquilibriumLaw::UniformStrain, prism.clone()),
            (EquilibriumLaw::UniformStrain, profile.clone()),
            (EquilibriumLaw::Table, ball()),
            (hertz, ball()),
            (hertz, pad.clone()),
            (hertz, bead.clone()),
            (hertz, cone.clone()),
            (EquilibriumLaw::UniformStrain, cone.clone()),
            (EquilibriumLaw::Table, cone.clone()),
        ] {
            let file = material(law, equilibrium, shape);
            let text = file.to_toml();
            let read = parse_material(&text, Path::new("m.toml")).unwrap_or_else(|error| panic!("{error}\n{text}"));
            assert_eq!(read, file, "{text}");
        }
    }
}

#[test]
fn what_the_record_shows_against_the_law_is_kept() {
    let mut file = usual();
    // Files of before have no such key.
    assert!(!file.to_toml().contains("misfit"));
    for misfit in ["prony:2", "latency, v by strain", "residuals"] {
        file.origin.misfit = Some(misfit.parse().unwrap());
        let text = file.to_toml();
        assert!(text.contains(&format!("\nmisfit = \"{misfit}\"\n")), "{text}");
        assert_eq!(parse_material(&text, Path::new("m.toml")).unwrap(), file);
        let error = parse_material(&text.replace(misfit, "pony"), Path::new("m.toml")).unwrap_err().to_string();
        assert!(error.contains("calibration.misfit") && error.contains("\"residuals\""), "{error}");
    }
}

#[test]
fn what_the_instrument_adds_is_written_and_read() {
    let mut file = usual();
    let mut parts = file.material.into_parts();
    let limits = |name, unit, half| InputQuantity::limits(name, unit, 0.0, half, Distribution::Arcsine).unwrap();
    let effect = |input, third: f64| SystematicEffect {
        input,
        logs: vec![third, -third, 0.0, 1e-3 * third, 0.5 * third],
    };
    let touch = limits("first \"touch\"", "m", 1e-4 / 3.0)
        .type_a()
        .with_cause(Cause::EachRecord)
        .with_freedom(7.5)
        .unwrap();
    parts.uncertainty.as_mut().unwrap().systematic = vec![
        effect(touch, 1.0 / 3.0),
        effect(limits("radius", "m", 0.0).with_cause(Cause::Named("gauge".to_owned())), 0.0),
    ];
    file.material = Material::new(parts).unwrap();
    let text = file.to_toml();
    assert_eq!(parse_material(&text, Path::new("m.toml")).unwrap(), file, "{text}");
    for (from, to, key, message) in [
        ("freedom = 7.5", "freedom = 0.5", "calibration.systematic[1].freedom", "1 or more"),
        ("type = \"A\"", "type = \"C\"", "calibration.systematic[1].type", "\"A\" or \"B\""),
        ("logs = [0.0", "logs = [nan", "calibration.systematic[2].logs", "finite"),
        ("logs = [0.0, ", "logs = [", "calibration", "4 parameters"),
    ] {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text, "{from}");
        let error = parse_material(&changed, Path::new("m.toml")).unwrap_err().to_string();
        assert!(error.contains(key) && error.contains(message), "{error}");
    }
}

#[test]
fn a_rate_coefficient_that_depends_on_the_state_is_written_and_read() {
    for rate in [RateLaw::ByStrain, RateLaw::ByDirection] {
        let mut file = usual();
        let name = rate.factor_name().unwrap();
        let factor = 0.1 + 0.2;
        let mut parts = file.material.into_parts();
        parts.candidate.rate = rate;
        parts.parameters.push(number(name, MaterialUnit::One, factor));
        let covariance = &mut parts.uncertainty.as_mut().unwrap().covariance;
        covariance.iter_mut().for_each(|row| row.push(0.0));
        covariance.push(vec![0.0, 0.0, 0.0, 0.0, 1e-3]);
        file.material = Material::new(parts).unwrap();
        let text = file.to_toml();
        assert!(text.contains(&format!("{name} = 0.30000000000000004")), "{text}");
        assert_eq!(parse_material(&text, Path::new("m.toml")).unwrap(), file, "{text}");
        // The same in a protocol, which is not calibrated.
        let steps = "[[step]]\nto = \"5 mm\"\nrate = \"10 mm/s\"\nhold = \"10 s\"\n";
        let protocol = parse_protocol(&format!("{text}\n{steps}"), Path::new("p.toml")).unwrap();
        assert_eq!(&protocol.contact, file.material.contact());
        let changed = text.replacen(&format!("{name} = 0.3"), &format!("{name} = 0.4"), 1);
        let error = parse_material(&changed, Path::new("m.toml")).unwrap_err().to_string();
        assert!(error.contains(&format!("law.{name}")) && error.contains("no longer calibrated"), "{error}");
        let none = text.replacen(&format!("{name} = 0.3"), &format!("{name} = -0.3"), 1);
        let error = parse_material(&none, Path::new("m.toml")).unwrap_err().to_string();
        assert!(error.contains(&format!("law.{name}")) && error.contains("above 0"), "{error}");
    }
    let both = "specimen = { shape = \"ball\", radius = \"35 mm\", modulus = \"28 kPa\" }\nlaw = { name = \"latency\", exponent = 5, rate_coefficient = \"2e4 /s\", strain_factor = 2, unloading_factor = 3 }\nstep = [{ to = \"5 mm\", rate = \"10 mm/s\" }]";
    let error = parse_protocol(both, Path::new("p.toml")).unwrap_err().to_string();
    assert!(error.contains("v depends on only one of them"), "{error}");
    let linear = both.replace(
        "name = \"latency\", exponent = 5, rate_coefficient = \"2e4 /s\", strain_factor = 2, unloading_factor = 3",
        "name = \"standard-linear-solid\", overshoot = 2, time = \"1 s\", strain_factor = 2",
    );
    let error = parse_protocol(&linear, Path::new("p.toml")).unwrap_err().to_string();
    assert!(error.contains("law.strain_factor"), "{error}");
}

#[test]
fn a_material_without_intervals_is_one_too() {
    let mut file = usual();
    let mut parts = file.material.into_parts();
    parts.uncertainty = None;
    for parameter in &mut parts.parameters {
        parameter.estimate = Estimate::fixed(parameter.estimate.value);
    }
    file.material = Material::new(parts).unwrap();
    file.origin.test = None;
    assert_eq!(parse_material(&file.to_toml(), Path::new("m.toml")).unwrap(), file);
}

#[test]
fn a_specimen_of_a_batch_says_that_it_is_one() {
    let mut file = usual();
    file.origin.specimens = Some(5);
    let text = file.to_toml();
    assert!(text.contains(
        "\n# A specimen of the batch that was not tested: intervals contain the spread between the 5 specimens"
    ));
    assert!(text.contains("\nspecimens = 5\n"));
    assert_eq!(parse_material(&text, Path::new("m.toml")).unwrap(), file);
    assert!(!usual().to_toml().contains("specimens"));
}

#[test]
fn a_material_is_the_body_of_a_protocol_and_of_a_test() {
    let file = usual();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("soft.toml");
    std::fs::write(&path, file.to_toml()).unwrap();
    let steps = "[[step]]\nto = \"5 mm\"\nrate = \"10 mm/s\"\nhold = \"10 s\"\n";
    let named = folder.path().join("named.toml");
    std::fs::write(&named, format!("material = \"soft.toml\"\n{steps}")).unwrap();
    let protocol = read_protocol(&named).unwrap();
    let contact = file.material.contact().clone();
    assert_eq!(protocol.contact, contact);
    let text = self_contained(&std::fs::read_to_string(&named).unwrap(), &named).unwrap();
    assert_eq!(parse_protocol(&text, Path::new("elsewhere.toml")).unwrap(), protocol);
    // The file itself is a protocol, once it has steps.
    let whole = parse_protocol(&format!("{}\n{steps}", file.to_toml()), Path::new("p.toml")).unwrap();
    assert_eq!(whole.contact, contact);
    // Another body in the protocol is left aside only where that is requested.
    let other = format!(
        "specimen = {{ shape = \"ball\", radius = \"20 mm\", modulus = \"1 kPa\" }}\nlaw = {{ name = \"latency\", exponent = 2, rate_coefficient = \"1 /s\" }}\n{steps}"
    );
    let bodied = folder.path().join("bodied.toml");
    std::fs::write(&bodied, &other).unwrap();
    assert_eq!(read_protocol_of(&bodied, &file).unwrap().contact, contact);
    std::fs::write(&bodied, format!("material = \"soft.toml\"\n{other}")).unwrap();
    let both = read_protocol(&bodied).unwrap_err();
    assert!(both.to_string().contains("specimen") && both.to_string().contains("material"), "{both}");
    // A missing file is recognised by its own name.
    std::fs::write(&named, format!("material = \"none.toml\"\n{steps}")).unwrap();
    assert!(read_protocol(&named).unwrap_err().to_string().contains("none.toml: no such file"));

    let test = parse_test(&file.to_toml(), &path).unwrap();
    let body = test.analysis.geometry.unwrap();
    assert_eq!((body.shape, body.sides, test.analysis.separation), (ball(), Sides::Two, Separation::Unilateral));
    assert_eq!(body.modulus, Some(1e5 * (1.0 / 3.0)));
    // A law in a test that is no material stays refused.
    let text = "law = { name = \"latency\", exponent = 2, rate_coefficient = \"1 /s\" }";
    assert!(parse_test(text, &path).unwrap_err().to_string().contains("law"));
}

/// `palpate grip ball.toml` and `palpate simulate ball.toml` stated which keys were wrong, and not that the file was another one.
#[test]
fn a_description_of_another_kind_is_refused_as_what_it_is() {
    let test = "[about]\ntitle = \"Ball\"\n[specimen]\nshape = \"ball\"\nradius = \"35 mm\"\n";
    let protocol = "[specimen]\nshape = \"ball\"\nradius = \"35 mm\"\n[[step]]\nto = \"5 mm\"\nrate = \"1 mm/s\"\n";
    let material = usual().to_toml();
    let path = Path::new("x.toml");
    let errors = [
        (
            parse_material(test, path).unwrap_err(),
            "a material file, found a test description",
            "palpate calibrate",
        ),
        (
            parse_material(protocol, path).unwrap_err(),
            "a material file, found a protocol",
            "palpate calibrate",
        ),
        (parse_protocol(test, path).unwrap_err(), "a protocol, found a test description", "palpate analyze"),
        (parse_protocol(&material, path).unwrap_err(), "a protocol, found a material file", "[[step]]"),
        (parse_test(protocol, path).unwrap_err(), "a test description, found a protocol", "palpate inspect"),
    ];
    for (error, says, helps) in errors {
        assert_eq!(error.to_string(), format!("x.toml: expected {says}"));
        assert!(error.hint().unwrap().contains(helps), "{error}: {:?}", error.hint());
    }
    assert!(parse_test(&material, path).is_ok());
    // With a material given beside it.
    for (text, found) in [(test, "a test description"), (&material, "a material file")] {
        let error = parse_protocol_of(text, path, &usual()).unwrap_err();
        assert_eq!(error.to_string(), format!("x.toml: expected a protocol, found {found}"));
    }
}

#[test]
fn what_is_no_material_is_refused_with_its_place() {
    let text = usual().to_toml();
    let cases = [
        ("version = 1", "version = 2", "calibration.version", "calibrate again"),
        ("version = 1\n", "", "calibration.version", "the version of the table"),
        ("exponent = 5.0", "exponent = 4.0", "law.exponent", "no longer calibrated"),
        ("radius = \"0.035 m\"", "radius = \"0.035\"", "specimen.radius", "unit"),
        (
            "interval = [4.9, 5.1]",
            "interval = [5.1, 4.9]",
            "calibration.parameter[2].interval",
            "not below the lower",
        ),
        (
            "interval = [4.9, 5.1]",
            "interval = [7.0, 9.0]",
            "calibration.parameter[2].value",
            "within its interval, 7 to 9",
        ),
        ("interval = [4.9, 5.1]", "interval = [nan, 5.1]", "calibration.parameter[2].interval", "above 0"),
        (
            "standard_error = 0.05\n",
            "standard_error = -0.05\n",
            "calibration.parameter[2].standard_error",
            "0 or more",
        ),
        ("name = \"exponent\"", "name = \"order\"", "calibration.parameter", "parameters of the law latency"),
        ("confidence = 0.95", "confidence = 95.0", "calibration.confidence", "between 0 and 1"),
        ("freedom = 2057.0", "freedom = nan", "calibration.freedom", "above 0"),
        (
            "law = \"latency\"\nequilibrium",
            "law = \"lantency\"\nequilibrium",
            "calibration.law",
            "a law such as",
        ),
        (
            "equilibrium = \"uniform strain\"",
            "equilibrium = \"hertz\"",
            "calibration.equilibrium",
            "[specimen]",
        ),
        ("unit = \"Pa\"", "unit = \"kPa\"", "calibration.parameter[1].unit", "Pa, N, m, s or /s"),
        ("covariance = [\n  [", "covariance = [\n  [1.0],\n  [", "calibration.covariance", "4 rows of 4"),
        ("covariance = [\n  [3.", "covariance = [\n  [-3.", "calibration.covariance", "4 rows of 4"),
        ("residual = \"", "residual = \"x", "calibration.residual", "a force such as"),
        ("residual = \"", "residual = \"-", "calibration.residual", "0 N or more"),
        (
            "interval = [4.9, 5.1]",
            "interval = [4.9, 5.1, 5.3]",
            "calibration.parameter[2].interval",
            "two numbers",
        ),
        (
            "standard_error = 0.05\n",
            "standard_error = 50.0\n",
            "calibration.parameter[2].standard_error",
            "no longer calibrated",
        ),
        (
            "covariance = [\n  [",
            "covariance = [\n  [100",
            "calibration.parameter[1].interval",
            "no longer calibrated",
        ),
        ("slowest = \"", "slowest = \"900", "calibration.range.slowest", "no more than the fastest"),
        ("sha256 = \"ab12\"\n", "", "calibration.sha256", "missing"),
    ];
    for (from, to, key, reported) in cases {
        assert!(text.contains(from), "{from}: {text}");
        let error = parse_material(&text.replacen(from, to, 1), Path::new("m.toml")).unwrap_err();
        let message = error.to_string();
        assert!(message.contains(key) && message.contains(reported), "{from} -> {to}: {message}");
        assert!(error.hint().is_some(), "{message}");
    }
    let plain = text.split("# What follows").next().unwrap();
    let error = parse_material(plain, Path::new("m.toml")).unwrap_err();
    assert!(error.to_string().contains("calibration: missing"), "{error}");
}
