//! What a contact is at an instant: its stiffness against the jaw and its excess strain.

use super::{ContactModel, ContactState, Separation};

impl ContactState {
    /// Tangent stiffness dF/dd of the contact against the displacement d of the jaw (N/m): the slope of [`step`](Self::step) for dt → 0.
    ///
    /// An instant leaves the node behind the contact layer in its position, u₂, so that of F = S(u₁) ε₁, ε₁ = (u₁ − u₂)/ℓ,
    ///
    /// dF/dd = (du₁/dd) [S(u₁)/ℓ + S′(u₁) ε₁],
    ///
    /// with du₁/dd = 1/2 of a body squeezed from two sides and 1 from one, and S = E A(u₁) for equation (11); other laws of the equilibrium
    /// force have their own S. Implicit integrators and stability limits of explicit ones need it.
    ///
    /// Zero while the jaw is off; at first touch the slope of the way in. It is the derivative of the closed form of S, or of the cubic
    /// between two rows of a table.
    ///
    /// ```
    /// use palpate::simulate::{ContactState, Separation};
    /// use palpate::test_problems::paper_ball;
    ///
    /// let model = paper_ball(Separation::Unilateral);
    /// let mut contact = ContactState::default();
    /// contact.step(&model, 0.0, 0.01)?; // 5 mm of each contact at once: ε = 5 mm/4.375 mm
    /// // 28 kPa/2 · [π (2 · 35 − 5) 5 mm²/4.375 mm + 2 π (35 − 5) mm · 5/4.375]
    /// assert!((contact.stiffness(&model) - 6_283.185).abs() < 1e-3); // N/m
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn stiffness(&self, model: &ContactModel) -> f64 {
        if !self.is_touching(model) {
            return 0.0;
        }
        let specimen = &model.specimen;
        let per_thickness = 1.0 / model.layers.thickness(specimen.depth());
        let (stiffness, growth) = specimen.stiffness(self.jaw);
        let strain = (self.jaw - self.behind) * per_thickness;
        specimen.contact_displacement(1.0) * (stiffness * per_thickness + growth * strain)
    }

    /// Excess strain x = ε₁ − u₁/depth of the contact layer: what drives the law.
    ///
    /// Once the jaw is off, that of the free surface, which has no strain: x = −u₁/depth with u₁ the [surface](Self::surface).
    ///
    /// ```
    /// use palpate::simulate::{ContactState, Separation};
    /// use palpate::test_problems::paper_ball;
    ///
    /// let model = paper_ball(Separation::Unilateral);
    /// let mut contact = ContactState::default();
    /// contact.step(&model, 0.0, 0.007)?; // 3.5 mm of each contact: ε = 0.8, of which 0.1 stays
    /// assert!((contact.excess_strain(&model) - 0.7).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn excess_strain(&self, model: &ContactModel) -> f64 {
        let depth = model.specimen.depth();
        let strain = (self.jaw - self.behind) * (1.0 / model.layers.thickness(depth));
        match model.separation {
            Separation::Unilateral if strain < 0.0 => -self.behind / depth,
            _ => strain - self.jaw / depth,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Base, Curve, Equilibrium, Layers, Shape, Sides, Specimen, ThinLayer, Tip};
    use crate::latency::LatencyLaw;

    fn model(shape: Shape, equilibrium: Option<Equilibrium>, sides: Sides, separation: Separation) -> ContactModel {
        let specimen = Specimen::new(shape, 4e4, sides).unwrap();
        ContactModel {
            specimen: equilibrium.map_or(specimen.clone(), |law| specimen.with_equilibrium(law).unwrap()),
            law: LatencyLaw::new(3.4, 50.0).unwrap(),
            layers: Layers::new(5.5).unwrap(),
            separation,
        }
    }

    /// Every shape with every equilibrium that goes with it.
    fn models() -> Vec<ContactModel> {
        let layer = |base| Some(ThinLayer { thickness: 0.02, base });
        let tips = [
            Tip::Sphere { radius: 0.01 },
            Tip::Cone { half_angle: 0.6 },
            Tip::Pyramid { half_angle: 0.5 },
            Tip::Punch { radius: 0.004 },
        ];
        let measured = || Equilibrium::measured(&[(0.0, 0.0), (0.002, 0.3), (0.005, 1.1), (0.02, 9.0)]).unwrap();
        let hertz = || Equilibrium::Hertz { poisson_ratio: 0.45 };
        let area = Curve::new(&[(0.0, 0.0), (0.002, 2e-4), (0.006, 5e-4), (0.015, 8e-4)]).unwrap();
        let round = [
            Shape::Ball { radius: 0.03 },
            Shape::Pad {
                radius: 0.03,
                thickness: 0.02,
            },
        ];
        let flat = [
            Shape::Prism {
                area: 4e-4,
                length: 0.05,
            },
            Shape::Profile { depth: 0.02, area },
        ];
        let mut models = Vec::new();
        let mut add = |shape: &Shape, equilibrium: Option<Equilibrium>| {
            for (sides, separation) in [(Sides::Two, Separation::Unilateral), (Sides::One, Separation::Bonded)] {
                models.push(model(shape.clone(), equilibrium.clone(), sides, separation));
            }
        };
        for shape in round.iter().chain(&flat) {
            add(shape, None);
            add(shape, Some(measured()));
        }
        for shape in &round {
            add(shape, Some(hertz()));
        }
        for tip in tips {
            for layer in [layer(Base::Bonded), layer(Base::Sliding), None] {
                if layer.is_none() && matches!(tip, Tip::Cone { .. } | Tip::Pyramid { .. }) {
                    continue;
                }
                let shape = Shape::Indenter { tip, layer };
                add(&shape, None);
                add(&shape, Some(hertz()));
            }
        }
        models
    }

    #[test]
    fn stiffness_is_the_slope_of_an_instant() {
        let models = models();
        assert_eq!(models.len(), 60);
        for model in models {
            let scale = 1.0 / model.specimen.contact_displacement(1.0);
            let mut contact = ContactState::default();
            // Loading, a hold, a little of the way back.
            for (dt, place) in [(0.02, 0.0033), (3.0, 0.0033), (0.02, 0.0031)] {
                contact.step(&model, dt, scale * place).unwrap();
                assert!(contact.is_touching(&model), "{model:?}");
                let h = 1e-7 * scale;
                let force = |by: f64| {
                    let mut moved = contact;
                    moved.step(&model, 0.0, scale * place + by).unwrap()
                };
                let slope = (force(h) - force(-h)) / (2.0 * h);
                let found = contact.stiffness(&model);
                assert!(found > 0.0 && (found / slope - 1.0).abs() < 1e-6, "{model:?}: {found}, {slope}");
            }
        }
    }

    #[test]
    fn a_jaw_that_is_off_feels_no_stiffness_and_first_touch_has_that_of_the_way_in() {
        let strip = model(
            Shape::Prism {
                area: 4e-4,
                length: 0.05,
            },
            None,
            Sides::One,
            Separation::Unilateral,
        );
        let mut contact = ContactState::default();
        // E A m/length of the contact layer alone.
        let whole = 4e4 * 4e-4 * 5.5 / 0.05;
        assert!((contact.stiffness(&strip) / whole - 1.0).abs() < 1e-15);
        contact.step(&strip, 1.0, 0.01).unwrap();
        contact.step(&strip, 1e-3, 0.0).unwrap();
        assert!(!contact.is_touching(&strip) && contact.stiffness(&strip) == 0.0);
        assert!((contact.excess_strain(&strip) + contact.surface(&strip) / 0.05).abs() < 1e-15);
        let ball = model(Shape::Ball { radius: 0.03 }, None, Sides::Two, Separation::Unilateral);
        assert_eq!(ContactState::default().stiffness(&ball), 0.0);
    }
}
