//! A law of the equilibrium force from the rows of a table.

use alloc::vec::Vec;

use super::{Curve, Equilibrium, EquilibriumError};

/// Share by which F_e/u may fall from row to row: the product and the quotient of a constant ratio are rounded.
const ROUNDED: f64 = 1e-12;

impl Equilibrium {
    /// A measured law from rows of contact displacement (m) and equilibrium force (N), the first of them first touch: (0, 0).
    ///
    /// Between rows F_e/u is a cubic that rises as the rows do; at first touch it is that of the line through the first two rows after.
    ///
    /// ```
    /// use palpate::contact::{Equilibrium, Shape, Sides, Specimen};
    /// let measured = Equilibrium::measured(&[(0.0, 0.0), (0.001, 0.1), (0.002, 0.28), (0.004, 0.8)])?;
    /// let ball = Specimen::new(Shape::Ball { radius: 0.02 }, 1e5, Sides::One)?.with_equilibrium(measured)?;
    /// let relaxed = |u: f64| ball.force(ball.equilibrium_strain(u), u);
    /// assert!((relaxed(0.002) - 0.28).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`EquilibriumError`] for rows that do not begin at first touch, do not rise, or whose force per displacement falls.
    pub fn measured(rows: &[(f64, f64)]) -> Result<Self, EquilibriumError> {
        // Rows that make no curve are recognised by it.
        Curve::named(rows, "forces")?;
        if rows[0].1 != 0.0 {
            return Err(EquilibriumError::Touch { found: rows[0].1 });
        }
        let mut ratios: Vec<(f64, f64)> = rows[1..].iter().map(|(u, force)| (*u, force / u)).collect();
        for index in 1..ratios.len() {
            let (before, found) = (ratios[index - 1].1, ratios[index].1);
            if found < before * (1.0 - ROUNDED) {
                return Err(EquilibriumError::Softening {
                    row: index + 2,
                    found,
                    before,
                });
            }
            ratios[index].1 = found.max(before);
        }
        let touch = match *ratios.as_slice() {
            [(near, low), (far, high), ..] => (low - near * (high - low) / (far - near)).max(0.0),
            [(_, only), ..] => only,
            [] => 0.0,
        };
        ratios.insert(0, (0.0, touch));
        Ok(Self::Measured {
            force_per_displacement: Curve::named(&ratios, "forces over displacements")?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A calibrated table of a block in proportion was refused: the quotient of a rounded product fell by its last digit.
    #[test]
    fn forces_in_proportion_are_no_softening() {
        for ratio in (1..200).map(|k| (0.17 * f64::from(k)).exp()) {
            let rows: Vec<(f64, f64)> = (0..=12).map(|i| 3.1e-4 * f64::from(i)).map(|u| (u, u * ratio)).collect();
            assert!(Equilibrium::measured(&rows).is_ok(), "{ratio}");
        }
        let falls = Equilibrium::measured(&[(0.0, 0.0), (1.0, 2.0), (2.0, 4.0 * (1.0 - 1e-9))]);
        assert!(matches!(falls, Err(EquilibriumError::Softening { row: 3, .. })), "{falls:?}");
    }
}
