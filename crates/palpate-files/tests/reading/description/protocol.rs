//! Protocols.

use palpate::{
    contact::{Base, Equilibrium, Shape, Sides, ThinLayer, Tip},
    simulate::{Contact, LinearLaw, Memory, ProgramStep, Sampling, Separation, simulate},
};

use palpate_files::description::read_protocol;

use super::{SQUEEZE, protocol, says, with};

#[test]
fn a_short_protocol_has_the_usual_rest() {
    let squeeze = protocol(SQUEEZE).unwrap();
    assert_eq!(squeeze.title, None);
    assert_eq!(squeeze.contact.specimen().shape(), &Shape::Ball { radius: 0.035 });
    assert_eq!(squeeze.contact.specimen().modulus(), 28_000.0);
    assert_eq!(squeeze.contact.specimen().sides(), Sides::Two);
    assert_eq!(squeeze.contact.latency().unwrap().layers.count(), 8.0);
    assert_eq!(squeeze.contact.separation(), Separation::Unilateral);
    let law = squeeze.contact.latency().unwrap().law;
    assert_eq!((law.exponent(), law.rate_coefficient()), (5.0, 2e4));
    assert_eq!(squeeze.sampling, Sampling::Rate(100.0));
    let (to, rate) = (0.005, 0.5 / 60.0);
    assert_eq!(squeeze.steps, [ProgramStep::Move { to, rate }, ProgramStep::HoldPosition { duration: 10.0 }]);
    let no_hold = protocol(&with("hold = \"10 s\"", "")).unwrap();
    assert_eq!(no_hold.steps, [ProgramStep::Move { to, rate }]);
}

#[test]
fn bodies_by_their_tables_and_laws_of_the_equilibrium_force() {
    let rows = "areas = [[\"0 mm\", \"0 mm^2\"], [\"1 mm\", \"40 mm^2\"], [\"5 mm\", \"1 cm^2\"]]";
    let punch = with("\"ball\"\nradius = \"35 mm\"", &format!("\"profile\"\ndepth = \"2 cm\"\n{rows}"));
    let body = protocol(&punch).unwrap().contact.specimen().clone();
    assert_eq!((body.depth(), body.sides()), (0.02, Sides::One));
    assert!((body.contact_area(0.001) - 4e-5).abs() < 1e-19 && (body.contact_area(0.004) - 1e-4).abs() < 3e-5);
    let short = punch.replace("[\"5 mm\"", "[\"2 mm\"");
    says(protocol(&short), "step[1].to", "below 2 mm, the last row of the table of areas", "");
    says(
        protocol(&punch.replace("1 cm^2", "1 mm^2")),
        "specimen.areas",
        "row 3: values must be 0 or more and must not fall",
        "",
    );
    says(protocol(&punch.replace("\"1 mm\"", "\"1 N\"")), "specimen.areas", "\"1 N\"", "");
    says(protocol(&punch.replace(rows, "areas = []")), "specimen.areas", "at least 2 rows", "");
    says(protocol(&punch.replace(rows, "")), "specimen.areas", "the areas of a profile", "");

    let hertz = with("radius", "equilibrium = \"hertz\"\npoisson_ratio = 0.5\nradius");
    let body = protocol(&hertz).unwrap().contact.specimen().clone();
    let expected = 4.0 / 3.0 * 28e3 / 0.75 * 0.035f64.sqrt() * 1e-3f64.powf(1.5);
    assert!((body.force(body.equilibrium_strain(1e-3), 1e-3) / expected - 1.0).abs() < 1e-14);
    says(
        protocol(&hertz.replace("= 0.5", "= 0.6")),
        "specimen.poisson_ratio",
        "expected a number from 0 to 0.5, found 0.6",
        "",
    );
    says(protocol(&hertz.replace("poisson_ratio = 0.5", "")), "specimen.poisson_ratio", "Hertz's law", "");
    says(protocol(&with("radius", "poisson_ratio = 0.4\nradius")), "specimen.poisson_ratio", "hertz", "");

    let rows = "equilibrium_forces = [[\"0 mm\", \"0 N\"], [\"1 mm\", \"0.2 N\"], [\"4 mm\", \"2 N\"]]";
    let measured = with("modulus = \"28 kPa\"", rows);
    let body = protocol(&measured).unwrap().contact.specimen().clone();
    assert!((body.force(body.equilibrium_strain(0.004), 0.004) - 2.0).abs() < 1e-14);
    says(
        protocol(&measured.replace("\"2 N\"", "\"0.5 N\"")),
        "specimen.equilibrium_forces",
        "row 3: force over displacement must not fall",
        "",
    );
    says(
        protocol(&with("radius", &format!("{rows}\nradius"))),
        "specimen.equilibrium_forces",
        "specimen.modulus",
        "",
    );
}

#[test]
fn shapes_and_choices() {
    let strip = "shape = \"strip\"\nwidth = \"10 mm\"\nthickness = \"4 mm\"\nlength = \"20 mm\"";
    let strip = with("shape = \"ball\"\nradius = \"35 mm\"", strip);
    let model = protocol(&strip).unwrap().contact;
    assert_eq!(
        model.specimen().shape(),
        &Shape::Prism {
            area: 4e-5,
            length: 0.02
        }
    );
    assert_eq!(model.specimen().sides(), Sides::One);
    let cylinder = with("shape = \"ball\"\nradius", "shape = \"cylinder\"\nlength = \"2 cm\"\ndiameter");
    let Shape::Prism { area, length } = *protocol(&cylinder).unwrap().contact.specimen().shape() else {
        panic!("no prism");
    };
    assert!((area - std::f64::consts::PI * 0.0175 * 0.0175).abs() < 1e-18 && length == 0.02);
    let block = with("\"ball\"\nradius", "\"block\"\narea = \"40 mm^2\"\nlength");
    let shape = protocol(&block).unwrap().contact.specimen().shape().clone();
    assert_eq!(
        shape,
        Shape::Prism {
            area: 4e-5,
            length: 0.035
        }
    );
    let pad = with("\"ball\"\nradius", "\"pad\"\nthickness = \"10 mm\"\nradius");
    let model = protocol(&pad).unwrap().contact;
    let shape = Shape::Pad {
        radius: 0.035,
        thickness: 0.01,
    };
    assert_eq!((model.specimen().shape(), model.specimen().sides()), (&shape, Sides::One));
    let too_thick = protocol(&pad.replace("\"10 mm\"", "\"36 mm\""));
    says(too_thick, "specimen.thickness", "at most the radius of the pad, found \"36 mm\"", "");
    let thick = with(
        "[contact]",
        "[contact]\nlayer_thickness = \"4.375 mm\"\nseparation = false\nsqueezed_from = \"one side\"",
    );
    let model = protocol(&thick).unwrap().contact;
    assert_eq!((model.latency().unwrap().layers.count(), model.separation()), (8.0, Separation::Bonded));
    assert_eq!(model.specimen().sides(), Sides::One);
    let times = with("[output]", "[output]\ntimes = [\"0.6 s\", \"600 ms\", \"10.6 s\"]");
    let squeeze = protocol(&times).unwrap();
    assert_eq!(squeeze.sampling, Sampling::Times(vec![0.6, 0.6, squeeze.motion.unwrap().end()]));
}

#[test]
fn tips_of_indenters_and_dumbbells() {
    let body = |text: &str| {
        let text = with("shape = \"ball\"\nradius = \"35 mm\"", text);
        protocol(&text.replace("to = \"5 mm\"", "to = \"3 um\""))
    };
    let sphere = "shape = \"spherical tip\"\nradius = \"5 um\"\npoisson_ratio = 0.5";
    let specimen = body(sphere).unwrap().contact.specimen().clone();
    let tip = Tip::Sphere { radius: 5e-6 };
    assert_eq!(specimen.shape(), &Shape::Indenter { tip, layer: None });
    assert_eq!(specimen.equilibrium(), &Equilibrium::Hertz { poisson_ratio: 0.5 });
    assert_eq!((specimen.depth(), specimen.sides()), (5e-6, Sides::One));
    let thin = body(&format!("{sphere}\nthickness = \"8 um\"\nbase = \"sliding\"")).unwrap();
    let layer = Some(ThinLayer {
        thickness: 8e-6,
        base: Base::Sliding,
    });
    assert_eq!(thin.contact.specimen().shape(), &Shape::Indenter { tip, layer });
    // √(R u) = h/2 at u = h²/(4 R)
    says(
        body(&format!("{sphere}\nthickness = \"7 um\"")),
        "step[1].to",
        "the contact is as wide as the layer is thick, found \"3 um\"",
        "",
    );
    let cone = "shape = \"conical tip\"\nhalf_angle = \"35 deg\"\nthickness = \"1 mm\"\npoisson_ratio = 0.4";
    let Shape::Indenter {
        tip: Tip::Cone { half_angle },
        layer: Some(ThinLayer { base: Base::Bonded, .. }),
    } = *body(cone).unwrap().contact.specimen().shape()
    else {
        panic!("no cone on a layer that is bonded");
    };
    assert!((half_angle - 35f64.to_radians()).abs() < 1e-15);
    assert!(body(&cone.replace("conical", "pyramidal")).is_ok());
    says(body(&sphere.replace("poisson_ratio = 0.5", "")), "specimen.poisson_ratio", "Hertz's law", "");
    says(
        body(&format!("{sphere}\nbase = \"bonded\"")),
        "specimen.base",
        "without thickness",
        "give the thickness",
    );
    says(
        body(&format!("{sphere}\nhalf_angle = \"3 deg\"")),
        "specimen.half_angle",
        "takes radius, thickness, base",
        "",
    );
    says(
        body(&cone.replace("thickness = \"1 mm\"", "")),
        "specimen.thickness",
        "the thickness of a conical tip",
        "",
    );
    says(body(&cone.replace("35 deg", "95 deg")), "specimen.half_angle", "an angle below 90 deg", "");
    says(body(&cone.replace("35 deg", "35 mm")), "specimen.half_angle", "\"35 mm\"", "rad, deg");
    let punch = sphere.replace("spherical tip", "flat punch");
    says(
        body(&format!("{punch}\nthickness = \"8 um\"")),
        "specimen.equilibrium",
        "at most as wide as the layer is thick",
        "",
    );

    let rows = "widths = [[\"0 mm\", \"12 mm\"], [\"10 mm\", \"4 mm\"], [\"30 mm\", \"4 mm\"], [\"40 mm\", \"12 mm\"]]";
    let dumbbell = format!("shape = \"dumbbell\"\nthickness = \"2 mm\"\n{rows}");
    let Shape::Prism { area, length } = *body(&dumbbell).unwrap().contact.specimen().shape() else {
        panic!("no prism");
    };
    assert!((area - 8e-6).abs() < 1e-18 && (length - (0.02 + 0.01 * 3f64.ln())).abs() < 1e-15);
    says(body(&dumbbell.replace("30 mm", "9 mm")), "specimen.widths", "row 3 of the widths", "");
    says(body(&dumbbell.replace(rows, "")), "specimen.widths", "the widths of a dumbbell", "");
}

#[test]
fn quantities_want_units() {
    let length = "accepted";
    for (found, shown) in [("\"35\"", "\"35\""), ("35", "= 35:"), ("35.0", "= 35:")] {
        let text = with("\"35 mm\"", found);
        says(protocol(&text), "specimen.radius", shown, "radius = \"35 mm\"");
        says(protocol(&text), "specimen.radius", "squeeze.toml, line 4: specimen.radius", "");
        says(protocol(&text), "specimen.radius", "expected a unit after the number", "");
        says(protocol(&text), "specimen.radius", "a length: m, cm, mm", "");
    }
    let text = with("\"35 mm\"", "\"35 kPa\"");
    says(protocol(&text), "specimen.radius", "\"35 kPa\"", "m, cm, mm");
    says(protocol(&text), "specimen.radius", length, "use one of");
    let text = with("\"35 mm\"", "\"wide\"");
    says(
        protocol(&text),
        "specimen.radius",
        "\"wide\"",
        "write a number and a unit, such as radius = \"10 mm\"",
    );
    let text = with("\"35 mm\"", "true");
    says(
        protocol(&text),
        "specimen.radius",
        "expected a number with its unit in quotes, such as \"35 mm\", found true",
        "",
    );
    let text = with("\"2e4 /s\"", "2e4");
    says(protocol(&text), "law.rate_coefficient", "expected a unit", "rate_coefficient = \"20000 /s\"");
    let text = with("[output]", "[output]\ntimes = [\"1 s\", 2]");
    says(protocol(&text), "output.times[2]", "expected a unit", "\"2 s\"");
}

#[test]
fn absurd_values_name_their_keys() {
    for (old, new, key, message) in [
        ("\"35 mm\"", "\"0 mm\"", "specimen.radius", "a length above 0 m, found \"0 mm\""),
        (
            "\"28 kPa\"",
            "\"-28 kPa\"",
            "specimen.modulus",
            "a pressure or modulus above 0 Pa, found \"-28 kPa\"",
        ),
        ("exponent = 5", "exponent = 0", "law.exponent", "a number above 0, found 0"),
        ("exponent = 5", "exponent = nan", "law.exponent", "a number above 0, found NaN"),
        ("exponent = 5", "exponent = \"5\"", "law.exponent", "a number, found \"5\""),
        ("\"2e4 /s\"", "\"0 /s\"", "law.rate_coefficient", "a rate above 0 /s, found \"0 /s\""),
        ("[contact]", "[contact]\nlayers = 0.5", "contact.layers", "a number of 1 or more, found 0.5"),
        (
            "[contact]",
            "[contact]\nlayer_thickness = \"36 mm\"",
            "contact.layer_thickness",
            "at most 35 mm, the depth of the body, found \"36 mm\"",
        ),
        (
            "[contact]",
            "[contact]\nlayer_thickness = \"0 mm\"",
            "contact.layer_thickness",
            "a length above 0 m",
        ),
        ("\"5 mm\"", "\"70 mm\"", "step[1].to", "a displacement below 70 mm"),
        ("\"500 mm/min\"", "\"0 mm/min\"", "step[1].rate", "a speed above 0 m/s, found \"0 mm/min\""),
        ("\"500 mm/min\"", "\"-5 mm/s\"", "step[1].rate", "a speed above 0 m/s, found \"-5 mm/s\""),
        ("\"10 s\"", "\"-1 s\"", "step[1].hold", "a time of 0 s or more, found \"-1 s\""),
        (
            "\"5 mm\"\nrate = \"500 mm/min\"\nhold = \"10 s\"",
            "\"0 mm\"\nrate = \"1 mm/s\"",
            "step[1].to",
            "a displacement different from the previous one, or a hold",
        ),
        ("[output]", "[output]\nsample_rate = \"0 Hz\"", "output.sample_rate", "a frequency above 0 Hz"),
        (
            "[output]",
            "[output]\ntimes = [\"11 s\"]",
            "output.times[1]",
            "a time from 0 s to 10.6 s, the end of the motion, found \"11 s\"",
        ),
        (
            "[output]",
            "[output]\ntimes = [\"2 s\", \"1 s\"]",
            "output.times[2]",
            "a time after the one before it",
        ),
        ("[output]", "[output]\ntimes = []", "output.times", "one time or more, found an empty list"),
        (
            "\"ball\"",
            "\"bal\"",
            "specimen.shape",
            "\"ball\", \"pad\", \"strip\", \"dumbbell\", \"cylinder\", \"cone and plate\", \"block\", \"profile\", \"spherical tip\", \"conical tip\", \"pyramidal tip\", \"flat punch\" or \"none\", found \"bal\"",
        ),
        ("\"latency\"", "\"maxwell\"", "law.name", "or \"fractional-zener\", found \"maxwell\""),
        (
            "[contact]",
            "[contact]\nsqueezed_from = \"top\"",
            "contact.squeezed_from",
            "\"two sides\" or \"one side\", found \"top\"",
        ),
        ("[contact]", "[contact]\nseparation = \"yes\"", "contact.separation", "true or false, found \"yes\""),
        (
            "shape = \"ball\"\nradius = \"35 mm\"",
            "shape = \"none\"",
            "specimen.shape",
            "the shape of a body, such as \"ball\", found \"none\"",
        ),
        (
            "\"35 mm\"",
            "\"35 mm\"\nlength = \"1 m\"",
            "specimen.length",
            "not used with shape = \"ball\", which takes radius (found \"1 m\")",
        ),
    ] {
        says(protocol(&with(old, new)), key, message, "");
    }
    let bonded = with("[contact]", "[contact]\nseparation = false").replace("\"5 mm\"", "\"-5 mm\"");
    says(
        protocol(&bonded),
        "step[1].to",
        "0 mm or more for a bonded body whose contact grows, found \"-5 mm\"",
        "",
    );
    says(protocol(&with("\"ball\"", "\"bal\"")), "specimen.shape", "found \"bal\"", "did you mean \"ball\"?");
    let second = format!("{SQUEEZE}[[step]]\nto = \"80 mm\"\nrate = \"1 mm/s\"\n");
    says(protocol(&second), "step[2].to", "squeeze.toml, line 17: step[2].to", "");
}

#[test]
fn what_is_missing_or_too_much_is_named() {
    says(
        protocol(&with("radius = \"35 mm\"", "")),
        "specimen.radius",
        "missing, expected the radius of a ball, such as \"35 mm\"",
        "add a line such as radius = \"35 mm\"",
    );
    says(
        protocol(&with("modulus = \"28 kPa\"", "")),
        "specimen.modulus",
        "such as \"28 kPa\"",
        "modulus = \"28 kPa\"",
    );
    says(protocol(&with("shape = \"ball\"", "")), "specimen.shape", "\"ball\", \"pad\", \"strip\"", "");
    says(
        protocol(&with("exponent = 5", "")),
        "law.exponent",
        "line 6: law.exponent: missing, expected a number above 0",
        "add a line such as exponent = 5",
    );
    says(protocol(&with("to = \"5 mm\"", "")), "step[1].to", "such as \"5 mm\"", "to = \"5 mm\"");
    says(protocol(""), "specimen", "a table [specimen]", "");
    let no_steps = SQUEEZE.split("[[step]]").next().unwrap();
    says(protocol(no_steps), "step", "one or more [[step]] tables", "");
    says(protocol(&format!("step = []\n{no_steps}")), "step", "one or more [[step]] tables", "");
    let both = with("[contact]", "[contact]\nlayers = 8\nlayer_thickness = \"1 mm\"");
    says(
        protocol(&both),
        "contact.layers",
        "either this or contact.layer_thickness, found both",
        "remove layers",
    );
    let both = with("[output]", "[output]\nsample_rate = \"9 Hz\"\ntimes = [\"1 s\"]");
    says(protocol(&both), "output.sample_rate", "either this or output.times, found both", "remove");
}

const STEP: &str = "to = \"5 mm\"\nrate = \"500 mm/min\"\nhold = \"10 s\"";

#[test]
fn steps_in_force_and_in_displacement() {
    let text = with(
        STEP,
        "to_force = \"10 N\"\nrate = \"50 mm/min\"\nhold = \"30 s\"\n[[step]]\nhold_force = \"0.5 min\"\n\
         [[step]]\nto_force = \"2 N\"\nforce_rate = \"60 N/min\"\n[[step]]\nto = \"0 mm\"\nrate = \"1 mm/s\"",
    );
    let mixed = protocol(&text).unwrap();
    assert_eq!(mixed.motion, None);
    let rate = 0.05 / 60.0;
    let expected = [
        ProgramStep::MoveToForce { force: 10.0, rate },
        ProgramStep::HoldPosition { duration: 30.0 },
        ProgramStep::HoldForce { duration: 30.0 },
        ProgramStep::Press { to: 2.0, rate: 1.0 },
        ProgramStep::Move { to: 0.0, rate: 1e-3 },
    ];
    assert_eq!(mixed.steps, expected);
    let result = simulate(mixed.drive(), &mixed.contact, &mixed.sampling).unwrap();
    assert!(result.force.iter().any(|force| (force - 10.0).abs() < 1e-12));
    // A hold alone is a step too.
    let still = with(STEP, &format!("{STEP}\n[[step]]\nhold = \"5 s\""));
    let still = protocol(&still).unwrap();
    assert!((still.motion.unwrap().end() - 15.6).abs() < 1e-12);
}

/// A hold is a step of its own to the simulation, and not to who wrote it.
#[test]
fn what_a_simulation_refuses_names_the_step_as_it_was_written() {
    let text = with(
        STEP,
        "to_force = \"5 N\"\nrate = \"1 mm/s\"\nhold = \"2 s\"\n[[step]]\nto_force = \"5 N\"\nforce_rate = \"1 N/s\"\n\
         hold_force = \"2 s\"\n[[step]]\nto_force = \"500 N\"\nrate = \"1 mm/s\"",
    );
    let error = protocol(&text).unwrap_err().to_string();
    assert!(error.contains("step 3: the jaw never reaches a force of 500 N"), "{error}");
}

#[test]
fn steps_that_say_too_much_or_too_little() {
    for (step, key, message) in [
        ("to = \"5 mm\"\nto_force = \"1 N\"\nrate = \"1 mm/s\"", "step[1].to_force", "step[1].to"),
        ("to = \"5 mm\"", "step[1].rate", "the speed of the jaw"),
        ("to_force = \"5 N\"", "step[1].rate", "force_rate"),
        ("rate = \"1 mm/s\"", "step[1].to", "a displacement to go to, such as \"5 mm\" (or to_force"),
        ("hold = \"1 s\"\nhold_force = \"1 s\"", "step[1].hold_force", "step[1].hold"),
        ("to_force = \"5 kPa\"\nrate = \"1 mm/s\"", "step[1].to_force", "N, kN"),
        ("to_force = \"1 N\"\nforce_rate = \"0 N/s\"", "step[1].force_rate", "a rate of force above 0 N/s"),
        ("to_force = \"10 kN\"\nrate = \"1 mm/s\"", "step", "never reaches a force of 10000 N"),
        ("to_force = \"-1 N\"\nrate = \"1 mm/s\"", "step", "a jaw that is not bonded"),
    ] {
        let result = protocol(&with(STEP, step));
        let error = result.err().unwrap_or_else(|| panic!("{step} is accepted")).to_string();
        assert!(error.contains(key) && error.contains(message), "{step}: {error}");
    }
}

const LINEAR: &str = r#"
    specimen = { shape = "ball", radius = "35 mm", modulus = "28 kPa" }
    law = { name = "prony", terms = [{ overshoot = 2, time = "0.5 s" }, { overshoot = 1, time = "20 s" }] }
    step = [{ to = "5 mm", rate = "500 mm/min", hold = "10 s" }]
"#;

#[test]
fn linear_laws_stand_in_a_protocol() {
    let law = |text: &str| match protocol(text).unwrap().contact {
        Contact::Linear(contact) => (contact.law, contact.memory),
        Contact::Latency { .. } => panic!("expected a linear law"),
    };
    let (prony, memory) = law(LINEAR);
    assert_eq!((prony.relaxation(0.0), memory), (4.0, Memory::Strain));
    assert!((prony.relaxation(20.0) - (1.0 + (-1f64).exp() + 2.0 * (-40f64).exp())).abs() < 1e-15);
    let terms = "terms = [{ overshoot = 2, time = \"0.5 s\" }, { overshoot = 1, time = \"20 s\" }]";
    let other = |name: &str, numbers: &str| LINEAR.replace("prony", name).replace(terms, numbers);
    let (zener, _) = law(&other("standard-linear-solid", "overshoot = 3, time = \"2 s\""));
    assert_eq!(zener, LinearLaw::standard(3.0, 2.0).unwrap());
    let shares = "shares = [{ share = 0.3, rate = \"1 /s\" }, { share = 0.2, rate = \"0.1 /s\" }]";
    assert_eq!(law(&other("fung", shares)), (LinearLaw::fung(&[(0.3, 1.0), (0.2, 0.1)]).unwrap(), Memory::Force));
    assert_eq!(law(&other("fung", &format!("memory = \"strain\", {shares}"))).1, Memory::Strain);
    let (fractional, _) = law(&other("fractional-zener", "overshoot = 2, time = \"5 s\", order = 0.5"));
    assert!((fractional.relaxation(5.0) - (1.0 + 2.0 * 0.427_583_576_155_807)).abs() < 1e-7);
    assert!(protocol(LINEAR).unwrap().contact.latency().is_none());
}

#[test]
fn numbers_that_make_no_linear_law_are_refused_with_their_key() {
    let changed = |from: &str, to: &str| {
        assert!(LINEAR.contains(from), "{from}");
        let error = protocol(&LINEAR.replace(from, to)).unwrap_err();
        let text = error.to_string();
        (error.key().map(str::to_owned), text)
    };
    for (from, to, key, says) in [
        ("overshoot = 2", "overshoot = -2", "law.terms[1].overshoot", "above 0"),
        ("\"20 s\"", "\"0 s\"", "law.terms[2].time", "above 0"),
        ("\"20 s\"", "\"20 N\"", "law.terms[2].time", "20 N"),
        ("name = \"prony\"", "name = \"fung\"", "law.terms", "which takes shares"),
        ("name = \"prony\"", "exponent = 5, name = \"prony\"", "law.exponent", "which takes terms"),
        ("name = \"prony\"", "name = \"latency\"", "law.exponent", "exponent"),
        ("name = \"prony\"", "name = \"maxwell\"", "law.name", "maxwell"),
        ("step =", "contact = { layers = 8 }\n    step =", "contact.layers", "linear law"),
    ] {
        let (found, text) = changed(from, to);
        assert_eq!(found.as_deref(), Some(key), "{text}");
        assert!(text.contains(says), "{text}");
    }
    let whole = LINEAR.replace("prony", "fung").replace("terms =", "shares =");
    let whole = whole.replace("overshoot = 2, time = \"0.5 s\"", "share = 0.7, rate = \"1 /s\"");
    let whole = whole.replace("overshoot = 1, time = \"20 s\"", "share = 0.4, rate = \"0.1 /s\"");
    let error = protocol(&whole).unwrap_err();
    assert_eq!(error.key(), Some("law.shares"), "{error}");
}

#[test]
fn a_protocol_of_thirty_thousand_steps_is_read_and_one_of_a_record_s_length_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.toml");
    let step = |i: u32| format!("[[step]]\nto = \"{} mm\"\nrate = \"50 mm/s\"\nhold = \"0.01 s\"\n", 4 + i % 2);
    let steps: String = (0..30_000).map(step).collect();
    std::fs::write(&path, format!("{SQUEEZE}{steps}")).unwrap();
    assert!(std::fs::metadata(&path).unwrap().len() > 1 << 20);
    // A move and a hold each.
    assert_eq!(read_protocol(&path).unwrap().steps.len(), 60_002);

    std::fs::File::create(&path).unwrap().set_len((64 << 20) + 1).unwrap();
    let error = read_protocol(&path).unwrap_err();
    assert!(error.to_string().contains("at most 67108864 bytes"), "{error}");
}
