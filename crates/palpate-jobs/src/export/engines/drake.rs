//! Drake: an SDFormat model whose link has a point contact and a hydroelastic one.
//!
//! Documentation: "Modeling Compliant Contact" and "Hydroelastic Contact User Guide"; parsing tags `drake:proximity_properties`,
//! `drake:compliant_hydroelastic`, `drake:hydroelastic_modulus`, `drake:mesh_resolution_hint`, `drake:hunt_crossley_dissipation`,
//! `drake:point_contact_stiffness`, `drake:mu_static`, `drake:mu_dynamic` (drake.mit.edu, group "multibody_parsing").

use palpate::contact::Shape;
use palpate::export::{Dissipative, HuntCrossley};

use super::super::card::Card;
use super::super::numbers::plain;
use super::xml_comment;

/// Edge of the mesh of the pressure field as a share of the radius.
const MESH: f64 = 0.05;

/// By how much the radius of the mesh is larger, as a share: a polyhedron of such edges in a ball lies that much below its surface, on average
/// where a flat presses (from forces of Drake 1.51 at indentations of 0.7 to 11 % of the radius).
const MESH_MARGIN: f64 = 4.0e-4;

pub(super) fn text(card: &Card, fit: &HuntCrossley) -> String {
    let notes = [
        "Use: contact model hydroelastic_with_fallback. The jaw's geometry needs drake:rigid_hydroelastic, and a \
         drake:point_contact_stiffness of 1e9 or more and a drake:hunt_crossley_dissipation of 0, which leave those of the body as they are"
            .to_owned(),
        "The two collision geometries act side by side, and friction acts at both. The one without hydroelastic properties falls back to \
         point contact; its surface may lie a little deeper, so that it is touched later"
            .to_owned(),
    ];
    let head = card.head(&notes);
    let friction = card.options.friction.map_or(String::new(), |mu| {
        let mu = plain(mu);
        format!(
            "          <drake:mu_static>{mu}</drake:mu_static>\n          <drake:mu_dynamic>{mu}</drake:mu_dynamic>\n"
        )
    });
    let collision = |name: &str, gap: f64, properties: String| {
        let shape = geometry(card.shape(), gap);
        format!(
            r#"      <collision name="{name}">
        <geometry>{shape}</geometry>
        <drake:proximity_properties>
{properties}{friction}        </drake:proximity_properties>
      </collision>
"#
        )
    };
    let property = |name: &str, value: f64| format!("          <drake:{name}>{}</drake:{name}>\n", plain(value));
    let point = |part: Dissipative| {
        let properties = property("point_contact_stiffness", part.elastic)
            + &property("hunt_crossley_dissipation", part.dissipation);
        collision("point", fit.gap, properties)
    };
    let field = |part: Dissipative| {
        let properties = "          <drake:compliant_hydroelastic/>\n".to_owned()
            + &property("hydroelastic_modulus", part.elastic)
            + &property("mesh_resolution_hint", MESH * fit.radius.unwrap_or(1.0))
            + &property("hunt_crossley_dissipation", part.dissipation);
        collision("hydroelastic", -MESH_MARGIN * fit.radius.unwrap_or(0.0), properties)
    };
    let collisions = fit.point.map_or(String::new(), point) + &fit.hydroelastic.map_or(String::new(), field);
    let inertia = inertia(card);
    format!(
        r#"{comment}<sdf version="1.7" xmlns:drake="http://drake.mit.edu">
  <model name="palpate_body">
    <link name="palpate_body">
{inertia}{collisions}    </link>
  </model>
</sdf>
"#,
        comment = xml_comment(&head)
    )
}

/// Geometry of SDFormat whose surface lies deeper by a gap (m); a jaw closes along x.
fn geometry(shape: &Shape, gap: f64) -> String {
    match shape {
        Shape::Prism { area, length } => {
            let size = [length - 2.0 * gap, area.sqrt(), area.sqrt()].map(plain).join(" ");
            format!("<box><size>{size}</size></box>")
        }
        shape => {
            let radius = plain(super::super::model::radius(shape).unwrap_or(0.01) - gap);
            format!("<sphere><radius>{radius}</radius></sphere>")
        }
    }
}

/// Mass and inertia of a uniform body, where the mass is given.
fn inertia(card: &Card) -> String {
    let Some(mass) = card.options.mass_kg else {
        return String::new();
    };
    let [x, y, z] = match card.shape() {
        Shape::Prism { area, length } => {
            let cross = mass * (area + length * length) / 12.0;
            [mass * area / 6.0, cross, cross]
        }
        shape => [0.4 * mass * super::super::model::radius(shape).unwrap_or(0.01).powi(2); 3],
    };
    format!(
        r"      <inertial>
        <mass>{}</mass>
        <inertia>
          <ixx>{}</ixx> <iyy>{}</iyy> <izz>{}</izz>
          <ixy>0</ixy> <ixz>0</ixz> <iyz>0</iyz>
        </inertia>
      </inertial>
",
        plain(mass),
        plain(x),
        plain(y),
        plain(z)
    )
}
