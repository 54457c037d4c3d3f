//! `palpate schema`: JSON Schemas.

use palpate_files::description::{schema_material, schema_protocol, schema_test};
use palpate_report::document::{
    AnalysisDocument, CalibrationDocument, ComparisonDocument, GripDocument, ReproductionDocument, WatchDocument,
};
use schemars::schema_for;

use crate::arguments::{SchemaArguments, SchemaName};
use crate::failure::{Failure, Outcome};
use crate::terminal::print;

pub(crate) fn run(arguments: &SchemaArguments) -> Result<Outcome, Failure> {
    let schema = match arguments.name {
        SchemaName::Protocol => schema_protocol(),
        SchemaName::Test => schema_test(),
        SchemaName::Material => schema_material(),
        SchemaName::Calibration => schema_for!(CalibrationDocument).to_value(),
        SchemaName::Analysis => schema_for!(AnalysisDocument).to_value(),
        SchemaName::Comparison => schema_for!(ComparisonDocument).to_value(),
        SchemaName::Grip => schema_for!(GripDocument).to_value(),
        SchemaName::Watch => schema_for!(WatchDocument).to_value(),
        SchemaName::Reproduction => schema_for!(ReproductionDocument).to_value(),
    };
    let text = serde_json::to_string_pretty(&schema).map_err(|error| Failure::new(error, None))?;
    print(&format!("{text}\n"))?;
    Ok(Outcome::Done)
}
