//! Isaac Sim and Isaac Lab: a physics material in USD.
//!
//! Documentation: PhysxMaterialAPI of the Omniverse physics schema, `physxMaterial:compliantContactStiffness` (N/m),
//! `physxMaterial:compliantContactDamping` and `physxMaterial:compliantContactAccelerationSpring`; `RigidBodyMaterialCfg` of Isaac Lab.

use palpate::export::SpringDamper;

use super::super::card::Card;
use super::super::numbers::plain;
use super::marked;

/// Friction of PhysX where none is given.
const FRICTION: f64 = 0.5;

pub(super) fn text(card: &Card, fit: &SpringDamper) -> String {
    let (stiffness, damping) = (plain(fit.stiffness), plain(fit.damping));
    let mu = plain(card.options.friction.unwrap_or(FRICTION));
    let notes = [
        "Use: reference this layer and bind the material to the collider with purpose physics. In Isaac Lab: \
         RigidBodyMaterialCfg(compliant_contact_stiffness=..., compliant_contact_damping=...) with these two numbers"
            .to_owned(),
        "Each contact point has the spring: let shapes meet in one point, as a ball and a flat do, or divide both parameters by the \
         number of points"
            .to_owned(),
    ];
    format!(
        r#"#usda 1.0
{comment}(
    defaultPrim = "PalpateContact"
    kilogramsPerUnit = 1
    metersPerUnit = 1
)

def Material "PalpateContact" (
    prepend apiSchemas = ["PhysicsMaterialAPI", "PhysxMaterialAPI"]
)
{{
    float physics:dynamicFriction = {mu}
    float physics:restitution = 0
    float physics:staticFriction = {mu}
    bool physxMaterial:compliantContactAccelerationSpring = 0
    float physxMaterial:compliantContactDamping = {damping}
    float physxMaterial:compliantContactStiffness = {stiffness}
}}
"#,
        comment = marked(&card.head(&notes), "# ")
    )
}
