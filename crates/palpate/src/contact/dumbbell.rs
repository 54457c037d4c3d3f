//! A tensile specimen with shoulders, as the prism that stretches as much.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::Shape;
use super::specimen::{SpecimenError, positive};

impl Shape {
    /// A dumbbell in tension, of even `thickness` (m), as the prism of its narrowest section that stretches as much as all of it.
    ///
    /// `widths` are places along its axis and widths there, in m, from grip to grip; between two of them the width is a straight line. A bar of
    /// varying section stretches by u = F ∫ dx/(E t w(x)), so that its section is t w_min and its length ∫ w_min/w(x) dx; between two rows that
    /// is w_min Δx ln(w₂/w₁)/(w₂ − w₁), the tapered bar of Gere and Timoshenko (Mechanics of Materials). For small strains, and up to 20°
    /// between the sides of a taper, where the stress is within 3 % of uniform across the section; ε is that of the narrow part.
    ///
    /// ```
    /// use palpate::contact::Shape;
    /// // 20 mm at 4 mm wide, with tapers to 12 mm over 10 mm on each side: 4 ln 3/8 · 10 mm = 5.493 mm each
    /// let widths = [(0.0, 0.012), (0.01, 0.004), (0.03, 0.004), (0.04, 0.012)];
    /// let Shape::Prism { area, length } = Shape::dumbbell(2e-3, &widths)? else { unreachable!() };
    /// assert!((area - 8e-6).abs() < 1e-18 && (length - 0.030_986_123).abs() < 1e-9);
    /// # Ok::<(), palpate::contact::SpecimenError>(())
    /// ```
    ///
    /// # Errors
    /// [`SpecimenError::NotPositive`] for the thickness, [`SpecimenError::Widths`] for rows that are fewer than two, whose places do not rise
    /// or whose widths are not above zero.
    pub fn dumbbell(thickness: f64, widths: &[(f64, f64)]) -> Result<Self, SpecimenError> {
        positive("thickness", "m", thickness)?;
        let is_sound = |row: usize| {
            let (place, width) = widths[row];
            let rises = row == 0 || place > widths[row - 1].0;
            place.is_finite() && width.is_finite() && width > 0.0 && rises
        };
        if let Some(row) = (0..widths.len().max(2)).find(|row| *row >= widths.len() || !is_sound(*row)) {
            return Err(SpecimenError::Widths { row: row + 1 });
        }
        let narrowest = widths.iter().fold(f64::INFINITY, |least, (_, width)| least.min(*width));
        let stretched = |pair: &[(f64, f64)]| {
            let taper = pair[1].1 / pair[0].1 - 1.0;
            let mean = if taper.abs() < 1e-12 { 1.0 } else { taper.ln_1p() / taper };
            (pair[1].0 - pair[0].0) * narrowest / pair[0].1 * mean
        };
        Ok(Self::Prism {
            area: thickness * narrowest,
            length: widths.windows(2).map(stretched).sum(),
        })
    }
}
