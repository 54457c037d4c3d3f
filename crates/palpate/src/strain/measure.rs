//! Strain at the contact.

use crate::contact::Specimen;

/// Strain ε = f/(E A(u₁)) of the contact layer, equations (6) and (8), or `None` where there is no contact area.
///
/// `force` in N and `displacement` of the jaw in m, both positive in the direction of loading and counted from first touch.
/// The area is taken at the contact's own share u₁ of the travel (half of it when squeezed from two sides), as in
/// equation (11). A ball at or before first touch has no area, and no strain can be told from its force.
///
/// ```
/// use palpate::contact::{Shape, Sides, Specimen};
/// use palpate::strain::contact_strain;
/// let ball = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?;
/// // 5 mm of travel, 1.5561334317 N: equilibrium 2.5/35 plus excess 0.0334037
/// let strain = contact_strain(1.556_133_431_7, 0.005, &ball).unwrap();
/// assert!((strain - (2.5 / 35.0 + 0.033_403_736_6)).abs() < 1e-9);
/// assert_eq!(contact_strain(0.1, 0.0, &ball), None);
/// # Ok::<(), palpate::contact::SpecimenError>(())
/// ```
#[must_use]
pub fn contact_strain(force: f64, displacement: f64, specimen: &Specimen) -> Option<f64> {
    let (stiffness, _) = specimen.stiffness(specimen.contact_displacement(displacement));
    (stiffness > 0.0).then(|| force / stiffness)
}
