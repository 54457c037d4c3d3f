//! JSON Schemas.

use palpate_files::description::{schema_material, schema_protocol, schema_test};

#[test]
fn schemas_have_titles_words_and_strict_keys() {
    let protocol = schema_protocol();
    assert_eq!(protocol["title"], "palpate protocol");
    assert_eq!(protocol["additionalProperties"], false);
    let bodies = serde_json::json!([{ "required": ["specimen", "law"] }, { "required": ["material"] }]);
    assert_eq!(protocol["anyOf"], bodies);
    let material = schema_material();
    assert_eq!(material["required"], serde_json::json!(["specimen", "law", "calibration"]));
    assert!(material["$defs"]["CalibratedParameter"]["properties"]["interval"].is_object());
    let text = protocol.to_string();
    for word in ["two sides", "layer_thickness", "such as \\\"35 mm\\\"", "a flat punch; outer radius of a pad."] {
        assert!(text.contains(word), "{word}");
    }
    let test = schema_test();
    assert_eq!(test["title"], "palpate test description");
    assert!(test["properties"]["columns"].is_object() && test["properties"]["fit"].is_object());
    let column = &test["$defs"]["ColumnRef"]["anyOf"];
    assert_eq!(column[0]["type"], "integer");
    assert_eq!(column[1]["type"], "string");
    assert!(test["$defs"]["Quantity"]["pattern"].is_string());
}

#[test]
fn schemas_bound_numbers_and_exclude_pairs() {
    let (protocol, test) = (schema_protocol(), schema_test());
    assert_eq!(protocol["$defs"]["Law"]["properties"]["exponent"]["exclusiveMinimum"], 0);
    assert_eq!(protocol["$defs"]["Contact"]["properties"]["layers"]["minimum"], 1);
    assert_eq!(protocol["$defs"]["Output"]["not"]["required"], serde_json::json!(["sample_rate", "times"]));
    assert_eq!(test["$defs"]["Fit"]["properties"]["exponents"]["items"]["exclusiveMinimum"], 0);
    let excluded = &test["$defs"]["Columns"]["not"]["anyOf"];
    assert_eq!(excluded[0]["required"], serde_json::json!(["force", "stress"]));
    assert_eq!(excluded.as_array().map(Vec::len), Some(12));
}
