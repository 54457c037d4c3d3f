//! One axis: its quantity, unit, spacing and limits.

/// How an axis spaces its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences take equal room.
    Linear,
    /// Equal ratios take equal room; values at or below zero are left out.
    Log,
}

/// One axis: what it shows, in which unit, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name of the quantity.
    pub label: String,
    /// Unit; empty for a dimensionless number.
    pub unit: String,
    /// Spacing of the values.
    pub scale: Scale,
    /// Limits to show; found from the data when absent or unusable.
    pub range: Option<(f64, f64)>,
}

impl Axis {
    /// An axis with equal spacing.
    #[must_use]
    pub fn linear(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            unit: unit.into(),
            scale: Scale::Linear,
            range: None,
        }
    }

    /// An axis with logarithmic spacing.
    #[must_use]
    pub fn log(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label, unit)
        }
    }

    /// The same axis with fixed limits.
    #[must_use]
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }

    /// `Time (s)`, or `Strain rate (10⁻³ s⁻¹)` when the tick labels leave a power of ten out.
    pub(crate) fn caption(&self, exponent: i32) -> String {
        let power = (exponent != 0).then(|| format!("10{}", crate::number::superscript(exponent)));
        match (power, self.unit.as_str()) {
            (None, "") => self.label.clone(),
            (None, unit) => format!("{} ({unit})", self.label),
            (Some(power), "") => format!("{} ({power})", self.label),
            (Some(power), unit) => format!("{} ({power} {unit})", self.label),
        }
    }
}

/// Whether a value has a place on an axis of this scale.
pub(crate) fn shows(value: f64, scale: Scale) -> bool {
    value.is_finite() && (scale == Scale::Linear || value > 0.0)
}
