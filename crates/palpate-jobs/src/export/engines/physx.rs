//! PhysX: a compliant material in C++.
//!
//! Documentation: PhysX 5, class PxMaterial: `setRestitution` ("If a negative value is provided it is interpreted as stiffness term for an
//! implicit spring"), `setDamping`, PxMaterialFlag::eCOMPLIANT_ACCELERATION_SPRING (nvidia-omniverse.github.io/PhysX).

use palpate::export::SpringDamper;

use super::super::card::Card;
use super::super::numbers::plain;
use super::marked;

/// Friction of PhysX where none is given.
const FRICTION: f64 = 0.5;

pub(super) fn text(card: &Card, fit: &SpringDamper) -> String {
    let note = "Use: PhysX 5.2 or later, lengths in m. Each contact point has the spring: let shapes meet in one point, as a ball and a \
                flat do, or divide both parameters by the number of points";
    let head = card.head(&[note.to_owned()]);
    let mu = plain(card.options.friction.unwrap_or(FRICTION));
    format!(
        r"{comment}#include <PxPhysicsAPI.h>

// A negative restitution is the stiffness of an implicit spring in N/m; the damping is in N s/m.
inline physx::PxMaterial* palpateMaterial(physx::PxPhysics& physics)
{{
    physx::PxMaterial* material = physics.createMaterial({mu}f, {mu}f, -{stiffness}f);
    material->setDamping({damping}f);
    // A spring of forces, not of accelerations.
    material->setFlag(physx::PxMaterialFlag::eCOMPLIANT_ACCELERATION_SPRING, false);
    return material;
}}
",
        comment = marked(&head, "// "),
        mu = with_point(&mu),
        stiffness = with_point(&plain(fit.stiffness)),
        damping = with_point(&plain(fit.damping))
    )
}

/// A number as C++ takes it before the letter f.
fn with_point(number: &str) -> String {
    if number.contains(['.', 'e']) { number.to_owned() } else { format!("{number}.0") }
}
