//! JSON Schemas of the descriptions, for editors that complete and check TOML.

use serde_json::Value;

use crate::description::{
    material::tables::MaterialTables, protocol::tables::ProtocolTables, test::tables::TestTables,
};

/// The JSON Schema of a protocol, see [`read_protocol`](crate::description::protocol::convert::read_protocol).
#[must_use]
pub fn schema_protocol() -> Value {
    schemars::schema_for!(ProtocolTables).to_value()
}

/// The JSON Schema of a material file, see [`read_material`](crate::description::read_material).
#[must_use]
pub fn schema_material() -> Value {
    schemars::schema_for!(MaterialTables).to_value()
}

/// The JSON Schema of a test description, see [`read_test`](crate::description::read_test).
#[must_use]
pub fn schema_test() -> Value {
    schemars::schema_for!(TestTables).to_value()
}
