//! `palpate schema`: JSON Schemas.

use palpate_files::description::{schema_material, schema_protocol, schema_test};
use palpate_jobs::{self as jobs, JobError, Verdict};
use palpate_report::document::{
    AnalysisDocument, CalibrationDocument, ComparisonDocument, GripDocument, ReproductionDocument, WatchDocument,
};
use schemars::schema_for;

use crate::arguments::{SchemaArguments, SchemaName};
use crate::terminal::print;

pub(crate) fn run(arguments: &SchemaArguments) -> Result<Verdict, JobError> {
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
        SchemaName::JobInspect => schema_for!(jobs::Inspect).to_value(),
        SchemaName::JobAnalyze => schema_for!(jobs::Analyze).to_value(),
        SchemaName::JobCompare => schema_for!(jobs::Compare).to_value(),
        SchemaName::JobCalibrate => schema_for!(jobs::Calibrate).to_value(),
        SchemaName::JobPredict => schema_for!(jobs::Predict).to_value(),
        SchemaName::JobGrip => schema_for!(jobs::PlanGrip).to_value(),
        SchemaName::JobWatch => schema_for!(jobs::WatchLog).to_value(),
        SchemaName::JobSimulate => schema_for!(jobs::Simulate).to_value(),
        SchemaName::JobSweep => schema_for!(jobs::Sweep).to_value(),
        SchemaName::JobBatch => schema_for!(jobs::Batch).to_value(),
        SchemaName::JobConvert => schema_for!(jobs::Convert).to_value(),
        SchemaName::JobReproduce => schema_for!(jobs::Reproduce).to_value(),
    };
    print(&format!("{}\n", serde_json::to_string_pretty(&schema)?))?;
    Ok(Verdict::Positive)
}
