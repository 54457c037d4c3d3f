//! The table `[conditions]` of a test: what reports of stress-relaxation tests state beside the forces.

use palpate::{
    analysis::Conditions,
    units::{Dimension, split_number},
};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::description::text::{error::DescriptionError, quantity::QuantityText, source::Source};

/// Conditions of the test as a report states them. What is omitted is shown as not stated.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Conditions")]
pub(crate) struct ConditionsTable {
    /// Temperature of the test, such as "23 °C" or "296 K".
    #[schemars(extend("examples" = ["23 °C", "296 K"]))]
    temperature: Option<String>,
    /// Relative humidity, such as "50 %".
    relative_humidity: Option<QuantityText>,
    /// Medium around the specimen, such as "air".
    medium: Option<String>,
    /// Conditioning before the test, mechanical and thermal.
    conditioning: Option<String>,
    /// Form of the specimen and how it was made, such as "moulded cylinder".
    specimen_form: Option<String>,
    /// What lies between specimen and plates.
    lubricant: Option<String>,
    /// Time from the start of the fit of a hold at which its initial force is taken, such as "30 min"; from there the times below count.
    /// Default: the start of the fit.
    initial_force_after: Option<QuantityText>,
    /// Times at which R(t) = (F₀ − F(t))/F₀ is stated, such as ["30 s", "1 min"]; of 1 s to 24 h those that a hold reaches, if omitted.
    relaxation_at: Option<Vec<QuantityText>>,
}

/// The conditions in SI.
pub(crate) fn checked(source: &Source<'_>, table: &ConditionsTable) -> Result<Conditions, DescriptionError> {
    let humidity =
        source.positive_if("conditions.relative_humidity", table.relative_humidity.as_ref(), Dimension::Share)?;
    if let Some(text) = table.relative_humidity.as_ref().filter(|_| humidity.is_some_and(|share| share > 1.0)) {
        let found = format!("\"{}\"", text.text);
        return Err(source.value("conditions.relative_humidity", "a share up to 100 %", &found));
    }
    let after =
        source.positive_if("conditions.initial_force_after", table.initial_force_after.as_ref(), Dimension::Time)?;
    let time = |(index, text): (usize, &QuantityText)| {
        let key = format!("conditions.relaxation_at[{}]", index + 1);
        source.positive(&key, text, Dimension::Time)
    };
    let times = |texts: &Vec<QuantityText>| {
        let mut times = texts.iter().enumerate().map(time).collect::<Result<Vec<f64>, _>>()?;
        times.sort_by(f64::total_cmp);
        times.dedup();
        Ok::<_, DescriptionError>(times)
    };
    Ok(Conditions {
        temperature: table.temperature.as_deref().map(|text| temperature(source, text)).transpose()?,
        relative_humidity: humidity,
        medium: table.medium.clone(),
        conditioning: table.conditioning.clone(),
        specimen_form: table.specimen_form.clone(),
        lubricant: table.lubricant.clone(),
        initial_force_after: after.unwrap_or_default(),
        relaxation_at: table.relaxation_at.as_ref().map(times).transpose()?,
    })
}

/// A temperature in K. It is no difference of temperatures: degrees count from the melting of ice.
fn temperature(source: &Source<'_>, text: &str) -> Result<f64, DescriptionError> {
    let (number, unit) = split_number(text.trim());
    let kelvin = number.parse::<f64>().ok().and_then(|value| match unit.trim() {
        "K" => Some(value),
        "°C" | "degC" | "C" => Some(value + 273.15),
        "°F" | "degF" => Some((value - 32.0) / 1.8 + 273.15),
        _ => None,
    });
    let expected = "a temperature above absolute zero in °C, K or °F, such as \"23 °C\"";
    let wrong = || source.value("conditions.temperature", expected, &format!("\"{text}\""));
    kelvin.filter(|kelvin| kelvin.is_finite() && *kelvin > 0.0).ok_or_else(wrong)
}
