//! A calibrated body as the text of its file.

use std::fmt::Write;

use palpate::{
    calibrate::EquilibriumLaw,
    contact::{Equilibrium, Shape, Sides},
    latency::LatencyLaw,
    number::{exact, significant},
    simulate::{Contact, LinearContact, Memory, Separation},
};

use super::{
    convert::{factor, rate_law},
    file::{MATERIAL_VERSION, MaterialFile},
    tables::UNITS,
};

impl MaterialFile {
    /// The file as text, with intervals in comments.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut out = self.head();
        self.write_body(&mut out);
        self.write_law(&mut out);
        self.write_calibration(&mut out);
        out
    }

    fn head(&self) -> String {
        let Self { material, origin } = self;
        format!(
            "# Calibrated by palpate {} on {}: {}, {} samples,\n# {} N left over. palpate predict takes this file, and a protocol that says material = \"…\".\n",
            origin.palpate,
            comment(&origin.record),
            material.candidate,
            origin.samples,
            significant(material.noise, 3)
        )
    }

    /// The interval of a number as a comment, in `factor` of its SI unit.
    fn interval(&self, name: &str, factor: f64, unit: &str) -> String {
        let share = self.material.uncertainty.as_ref().map(|uncertainty| 100.0 * uncertainty.confidence);
        let interval = self.material.estimate(name).and_then(|estimate| estimate.interval);
        match (interval, share) {
            (Some((low, high)), Some(share)) => format!(
                "   # {} to {}{unit} ({} %)",
                significant(factor * low, 4),
                significant(factor * high, 4),
                exact(round(share))
            ),
            _ => String::new(),
        }
    }

    fn write_body(&self, out: &mut String) {
        let body = &self.material.body;
        out.push_str("\n[specimen]\n");
        let mut line = |text: String| {
            out.push_str(&text);
            out.push('\n');
        };
        let length = |value: f64| format!("\"{} m\"", exact(value));
        match &body.shape {
            Shape::Ball { radius } => line(format!("shape = \"ball\"\nradius = {}", length(*radius))),
            Shape::Pad { radius, thickness } => {
                line(format!("shape = \"pad\"\nradius = {}\nthickness = {}", length(*radius), length(*thickness)));
            }
            Shape::Prism { area, length: free } => {
                line(format!("shape = \"block\"\narea = \"{} m^2\"\nlength = {}", exact(*area), length(*free)));
            }
            Shape::Profile { depth, area } => {
                let row = |(place, area): (f64, f64)| format!("  [{}, \"{} m^2\"],", length(place), exact(area));
                let rows: Vec<String> = area.points().into_iter().map(row).collect();
                line(format!("shape = \"profile\"\ndepth = {}\nareas = [\n{}\n]", length(*depth), rows.join("\n")));
            }
        }
        let contact = self.material.contact();
        let specimen = contact.specimen();
        let modulus =
            format!("modulus = \"{} Pa\"{}", exact(specimen.modulus()), self.interval("modulus", 1e-3, " kPa"));
        match specimen.equilibrium() {
            Equilibrium::EvenStrain => line(modulus),
            Equilibrium::Hertz { poisson_ratio } => {
                line(format!("{modulus}\nequilibrium = \"hertz\"\npoisson_ratio = {poisson_ratio:?}"));
            }
            Equilibrium::Measured { force_per_displacement } => {
                line("equilibrium_forces = [".to_owned());
                for (row, (place, ratio)) in force_per_displacement.points().into_iter().enumerate() {
                    let interval = self.interval(&format!("equilibrium_force_{row}"), 1.0, " N");
                    line(format!("  [{}, \"{} N\"],{interval}", length(place), exact(ratio * place)));
                }
                line("]".to_owned());
            }
        }
        let sides = match body.sides {
            Sides::One => "one side",
            Sides::Two => "two sides",
        };
        line(format!(
            "\n[contact]\nsqueezed_from = \"{sides}\"\nseparation = {}",
            body.separation == Separation::Unilateral
        ));
        if let Some(thickness) = self.material.estimate("layer_thickness") {
            let interval = self.interval("layer_thickness", 1e3, " mm");
            line(format!("layer_thickness = {}{interval}", length(thickness.value)));
        }
    }

    fn write_law(&self, out: &mut String) {
        out.push_str("\n[law]\n");
        match self.material.contact() {
            Contact::Latency { model, rate } => {
                self.write_latency(out, model.law);
                if let (Some(name), Some(factor)) = (rate_law(rate).factor_name(), factor(rate)) {
                    let _ = writeln!(out, "{name} = {factor:?}{}", self.interval(name, 1.0, ""));
                }
            }
            Contact::Linear(LinearContact { law, memory, .. }) => {
                let time = |rate: f64| format!("\"{} s\"", exact(1.0 / rate));
                let _ = match law.terms() {
                    [only] if memory == Memory::Strain => writeln!(
                        out,
                        "name = \"standard-linear-solid\"\novershoot = {:?}{}\ntime = {}{}",
                        only.overshoot,
                        self.interval("overshoot_1", 1.0, ""),
                        time(only.rate),
                        self.interval("time_1", 1.0, " s"),
                    ),
                    terms => {
                        let row = |(index, term): (usize, &palpate::simulate::LinearTerm)| {
                            let interval = self.interval(&format!("time_{}", index + 1), 1.0, " s");
                            format!("  {{ overshoot = {:?}, time = {} }},{interval}", term.overshoot, time(term.rate))
                        };
                        let rows: Vec<String> = terms.iter().enumerate().map(row).collect();
                        let memory = if memory == Memory::Force { "\nmemory = \"force\"" } else { "" };
                        writeln!(out, "name = \"prony\"{memory}\nterms = [\n{}\n]", rows.join("\n"))
                    }
                };
            }
        }
    }

    fn write_latency(&self, out: &mut String, law: LatencyLaw) {
        let _ = writeln!(
            out,
            "name = \"latency\"\nexponent = {:?}{}\nrate_coefficient = \"{} /s\"{}",
            law.exponent(),
            self.interval("exponent", 1.0, ""),
            exact(law.rate_coefficient()),
            self.interval("rate_coefficient", 1.0, " /s"),
        );
    }

    fn write_calibration(&self, out: &mut String) {
        let Self { material, origin } = self;
        let equilibrium = match material.candidate.equilibrium {
            EquilibriumLaw::EvenStrain => "even strain",
            EquilibriumLaw::Hertz { .. } => "hertz",
            EquilibriumLaw::Table => "table",
        };
        let _ = write!(
            out,
            "\n# What follows is not for editing: the numbers above with their errors, and where they come from.\n[calibration]\nversion = {MATERIAL_VERSION}\nrecord = {}\nsha256 = {}\n",
            quoted(&origin.record),
            quoted(&origin.sha256)
        );
        if let Some(test) = &origin.test {
            let _ = writeln!(out, "test = {}", quoted(test));
        }
        let _ = writeln!(
            out,
            "palpate = {}\nsamples = {}\nlaw = {}\nequilibrium = \"{equilibrium}\"\nresidual = \"{} N\"",
            quoted(&origin.palpate),
            origin.samples,
            quoted(&material.candidate.law.to_string()),
            exact(material.noise)
        );
        let list = |values: &[f64]| {
            let values: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
            format!("[{}]", values.join(", "))
        };
        if let Some(uncertainty) = &material.uncertainty {
            let rows: Vec<String> = uncertainty.covariance.iter().map(|row| format!("  {},", list(row))).collect();
            let _ = writeln!(
                out,
                "confidence = {:?}\nfreedom = {:?}\n# of the natural logarithms of the numbers, in their order\ncovariance = [\n{}\n]",
                uncertainty.confidence,
                uncertainty.freedom,
                rows.join("\n")
            );
        }
        let shown = &material.shown;
        let _ = writeln!(
            out,
            "\n[calibration.shown]\nlongest_hold = \"{} s\"\ndeepest = \"{} m\"\nfastest = \"{} m/s\"\nslowest = \"{} m/s\"\nlargest_force = \"{} N\"",
            exact(shown.longest_hold),
            exact(shown.deepest),
            exact(shown.fastest),
            exact(shown.slowest),
            exact(shown.largest_force)
        );
        for number in &material.numbers {
            let estimate = &number.estimate;
            let _ = writeln!(out, "\n[[calibration.number]]\nname = {}", quoted(&number.name));
            if let Some((_, Some(unit))) = UNITS.iter().find(|(unit, _)| *unit == number.unit) {
                let _ = writeln!(out, "unit = \"{unit}\"");
            }
            let _ = writeln!(out, "value = {:?}", estimate.value);
            if let Some(error) = estimate.standard_error {
                let _ = writeln!(out, "standard_error = {error:?}");
            }
            if let Some((low, high)) = estimate.interval {
                let _ = writeln!(out, "interval = {}", list(&[low, high]));
            }
        }
    }
}

/// A share in per cent without the last digits of its product with 100.
fn round(share: f64) -> f64 {
    (1e9 * share).round() / 1e9
}

/// A text as TOML has it.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// A text that ends no comment.
fn comment(text: &str) -> String {
    text.replace(|letter: char| letter.is_control(), " ")
}
