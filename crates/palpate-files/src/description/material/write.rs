//! A calibrated body as the text of its file.

use palpate::{
    calibrate::SystematicEffect,
    contact::{Base, Equilibrium, Shape, Sides, Tip},
    number::{exact, significant},
    simulate::{Contact, LinearContact, Memory, Separation},
};

use super::{
    convert::rate_law,
    file::{MATERIAL_VERSION, MaterialFile},
    tables::{CalibratedEquilibriumName, UNITS},
};
use crate::description::{
    text::quoted,
    uncertainty::{CauseText, DistributionName, EvaluationName},
};

impl MaterialFile {
    /// The file as text, with intervals in comments.
    #[must_use]
    pub fn to_toml(&self) -> String {
        [self.head(), self.body(), self.law(), self.calibration()].concat()
    }

    fn head(&self) -> String {
        let Self { material, origin } = self;
        let batch = origin.specimens.map_or_else(String::new, |specimens| {
            format!(
                "# A specimen of the batch that was not tested: intervals contain the spread between the {specimens} specimens that were.\n"
            )
        });
        format!(
            "# Calibrated by palpate {} on {}: {}, {} samples,\n# {} N of residual noise. palpate predict takes this file, and a protocol that says material = \"…\".\n{batch}",
            origin.palpate,
            // A text that ends no comment.
            origin.record.replace(|letter: char| letter.is_control(), " "),
            material.candidate(),
            origin.samples,
            significant(material.noise(), 3)
        )
    }

    /// The interval of a parameter as a comment, in `factor` of its SI unit.
    fn interval(&self, name: &str, factor: f64, unit: &str) -> String {
        let interval = self.material.estimate(name).and_then(|estimate| estimate.interval);
        let (Some((low, high)), Some(uncertainty)) = (interval, self.material.uncertainty()) else {
            return String::new();
        };
        let end = |value: f64| significant(factor * value, 4);
        // Without the last digits of the product with 100.
        let share = (1e9 * (100.0 * uncertainty.confidence)).round() / 1e9;
        format!("   # {} to {}{unit} ({} %)", end(low), end(high), exact(share))
    }

    fn body(&self) -> String {
        let body = self.material.body();
        let shape = match &body.shape {
            Shape::Ball { radius } => format!("\"ball\"\nradius = {}", si(*radius, "m")),
            Shape::Pad { radius, thickness } => {
                format!("\"pad\"\nradius = {}\nthickness = {}", si(*radius, "m"), si(*thickness, "m"))
            }
            Shape::Prism { area, length } => {
                format!("\"block\"\narea = {}\nlength = {}", si(*area, "m^2"), si(*length, "m"))
            }
            Shape::Profile { depth, area } => {
                let row = |(place, area): (f64, f64)| format!("  [{}, {}],\n", si(place, "m"), si(area, "m^2"));
                let rows: String = area.points().into_iter().map(row).collect();
                format!("\"profile\"\ndepth = {}\nareas = [\n{rows}]", si(*depth, "m"))
            }
            Shape::Indenter { tip, layer } => {
                let (name, key, size, unit) = match *tip {
                    Tip::Sphere { radius } => ("spherical tip", "radius", radius, "m"),
                    Tip::Cone { half_angle } => ("conical tip", "half_angle", half_angle, "rad"),
                    Tip::Pyramid { half_angle } => ("pyramidal tip", "half_angle", half_angle, "rad"),
                    Tip::Punch { radius } => ("flat punch", "radius", radius, "m"),
                };
                let layer = layer.map_or_else(String::new, |layer| {
                    let base = if layer.base == Base::Bonded { "bonded" } else { "sliding" };
                    format!("\nthickness = {}\nbase = \"{base}\"", si(layer.thickness, "m"))
                });
                format!("\"{name}\"\n{key} = {}{layer}", si(size, unit))
            }
        };
        let contact = self.material.contact();
        let specimen = contact.specimen();
        let modulus =
            || format!("modulus = {}{}\n", si(specimen.modulus(), "Pa"), self.interval("modulus_pa", 1e-3, " kPa"));
        let stiffness = match specimen.equilibrium() {
            // That of a tip is another one if none is stated.
            Equilibrium::UniformStrain => match body.shape {
                Shape::Indenter { .. } => format!("{}equilibrium = \"uniform strain\"\n", modulus()),
                _ => modulus(),
            },
            Equilibrium::Hertz { poisson_ratio } => {
                format!("{}equilibrium = \"hertz\"\npoisson_ratio = {poisson_ratio:?}\n", modulus())
            }
            Equilibrium::Measured { force_per_displacement } => {
                let row = |(row, (place, ratio)): (usize, (f64, f64))| {
                    let interval = self.interval(&format!("equilibrium_force_{row}"), 1.0, " N");
                    format!("  [{}, {}],{interval}\n", si(place, "m"), si(ratio * place, "N"))
                };
                let rows: String = force_per_displacement.points().into_iter().enumerate().map(row).collect();
                format!("equilibrium_forces = [\n{rows}]\n")
            }
        };
        let sides = match body.sides {
            Sides::One => "one side",
            Sides::Two => "two sides",
        };
        let separation = body.separation == Separation::Unilateral;
        let layers = self.material.estimate("layer_thickness_m").map_or_else(String::new, |thickness| {
            let interval = self.interval("layer_thickness_m", 1e3, " mm");
            format!("layer_thickness = {}{interval}\n", si(thickness.value, "m"))
        });
        format!(
            "\n[specimen]\nshape = {shape}\n{stiffness}\n[contact]\nsqueezed_from = \"{sides}\"\nseparation = {separation}\n{layers}"
        )
    }

    fn law(&self) -> String {
        let law = match self.material.contact() {
            Contact::Latency { model, rate } => {
                let (rate_law, factor) = rate_law(*rate);
                let factor = rate_law.factor_name().zip(factor).map_or_else(String::new, |(name, factor)| {
                    format!("{name} = {factor:?}{}\n", self.interval(name, 1.0, ""))
                });
                format!(
                    "\"latency\"\nexponent = {:?}{}\nrate_coefficient = {}{}\n{factor}",
                    model.law.exponent(),
                    self.interval("exponent", 1.0, ""),
                    si(model.law.rate_coefficient(), "/s"),
                    self.interval("rate_coefficient_per_s", 1.0, " /s"),
                )
            }
            Contact::Linear(LinearContact { law, memory, .. }) => match law.terms() {
                [only] if *memory == Memory::Strain => format!(
                    "\"standard-linear-solid\"\novershoot = {:?}{}\ntime = {}{}\n",
                    only.overshoot,
                    self.interval("overshoot_1", 1.0, ""),
                    si(1.0 / only.rate, "s"),
                    self.interval("time_constant_1_s", 1.0, " s"),
                ),
                terms => {
                    let row = |(index, term): (usize, &palpate::simulate::LinearTerm)| {
                        let (overshoot, time) = (term.overshoot, si(1.0 / term.rate, "s"));
                        let interval = self.interval(&format!("time_{}", index + 1), 1.0, " s");
                        format!("  {{ overshoot = {overshoot:?}, time = {time} }},{interval}\n")
                    };
                    let rows: String = terms.iter().enumerate().map(row).collect();
                    let memory = if *memory == Memory::Force { "\nmemory = \"force\"" } else { "" };
                    format!("\"prony\"{memory}\nterms = [\n{rows}]\n")
                }
            },
        };
        format!("\n[law]\nname = {law}")
    }

    fn calibration(&self) -> String {
        let Self { material, origin } = self;
        let equilibrium = CalibratedEquilibriumName::from(material.candidate().equilibrium);
        let specimens = origin.specimens.map_or_else(String::new, |specimens| format!("specimens = {specimens}\n"));
        let misfit = origin
            .misfit
            .map_or_else(String::new, |misfit| format!("misfit = {}\n", quoted(&misfit.to_string())));
        let test = origin.test.as_ref().map_or_else(String::new, |test| format!("test = {}\n", quoted(test)));
        let mut out = format!(
            "\n# What follows is not for editing: the parameters above with their errors, and where they come from.\n[calibration]\nversion = {MATERIAL_VERSION}\nrecord = {}\nsha256 = {}\n{specimens}{test}palpate = {}\nsamples = {}\nlaw = {}\n{misfit}equilibrium = \"{equilibrium}\"\nresidual = {}\n",
            quoted(&origin.record),
            quoted(&origin.sha256),
            quoted(&origin.palpate),
            origin.samples,
            quoted(&material.candidate().law.to_string()),
            si(material.noise(), "N")
        );
        if let Some(uncertainty) = material.uncertainty() {
            let rows: String = uncertainty.covariance.iter().map(|row| format!("  {row:?},\n")).collect();
            out += &format!(
                "confidence = {:?}\nfreedom = {:?}\n# of the natural logarithms of the parameters, in their order\ncovariance = [\n{rows}]\n",
                uncertainty.confidence, uncertainty.freedom
            );
        }
        let systematic = material.uncertainty().map_or(&[][..], |uncertainty| &uncertainty.systematic);
        for SystematicEffect { input, logs } in systematic {
            out += &format!(
                "\n[[calibration.systematic]]\nname = {}\nunit = {}\nstandard_uncertainty = {:?}\n",
                quoted(&input.name),
                quoted(&input.unit),
                input.standard_uncertainty
            );
            if input.freedom.is_finite() {
                out += &format!("freedom = {:?}\n", input.freedom);
            }
            if let Some(cause) = CauseText::of(&input.cause) {
                out += &format!("cause = {}\n", quoted(cause.text()));
            }
            out += &format!(
                "distribution = \"{}\"\ntype = \"{}\"\nlogs = {logs:?}\n",
                DistributionName::from(input.distribution),
                EvaluationName::from(input.evaluation)
            );
        }
        let range = material.range();
        out += "\n[calibration.range]\n";
        for (name, value, unit) in [
            ("longest_hold", range.longest_hold, "s"),
            ("longest_force_hold", range.longest_force_hold, "s"),
            ("deepest", range.deepest, "m"),
            ("fastest", range.fastest, "m/s"),
            ("slowest", range.slowest, "m/s"),
            ("largest_force", range.largest_force, "N"),
            ("farthest_retreat", range.farthest_retreat, "m"),
        ] {
            out += &format!("{name} = {}\n", si(value, unit));
        }
        out += &format!("loadings = {}\n", range.loadings);
        for parameter in material.parameters() {
            let estimate = &parameter.estimate;
            out += &format!("\n[[calibration.parameter]]\nname = {}\n", quoted(&parameter.name));
            if let Some((_, Some(unit))) = UNITS.iter().find(|(unit, _)| *unit == parameter.unit) {
                out += &format!("unit = \"{unit}\"\n");
            }
            out += &format!("value = {:?}\n", estimate.value);
            if let Some(error) = estimate.standard_error {
                out += &format!("standard_error = {error:?}\n");
            }
            if let Some(error) = estimate.white_standard_error {
                out += &format!("white_standard_error = {error:?}\n");
            }
            if let Some((low, high)) = estimate.interval {
                out += &format!("interval = [{low:?}, {high:?}]\n");
            }
        }
        out
    }
}

/// A parameter with its unit, as text of TOML.
fn si(value: f64, unit: &str) -> String {
    format!("\"{} {unit}\"", exact(value))
}
