//! From stored numbers to quantities: the scaling of the encoder, then conversions that build upon one another.
//!
//! A channel of deflection is stored as whole numbers; its encoder makes them volts, the conversion `distance`
//! (the sensitivity) makes metres of volts, and `force` (the spring constant) newtons of metres.

use super::properties::Properties;
use crate::formats::afm::curve::Line;

/// Most conversions one upon the other; more run in a circle.
const DEEPEST: usize = 16;

/// A quantity that a channel can be read as.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slot {
    pub(super) line: Line,
    pub(super) unit: Option<String>,
}

/// A property that is not as it should be: its name, what was expected, what was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct BadProperty {
    pub(super) key: String,
    pub(super) expected: &'static str,
    pub(super) found: String,
}

/// The scalings of one channel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scalings<'a> {
    properties: &'a Properties<'a>,
    name: &'a str,
}

impl<'a> Scalings<'a> {
    pub(super) fn of(properties: &'a Properties<'a>, name: &'a str) -> Self {
        Self { properties, name }
    }

    /// The channel as its encoder makes it, from stored numbers in `channel`.
    pub(super) fn encoded(self, channel: usize) -> Result<Slot, BadProperty> {
        let mut slot = Slot {
            line: Line::of(channel),
            unit: None,
        };
        for encoder in [format!("channel.{}.data.encoder", self.name), format!("channel.{}.encoder", self.name)] {
            if let Some((multiplier, offset)) = self.scaling(&encoder)? {
                slot.line = slot.line.then(multiplier, offset);
                slot.unit = self.unit(&format!("{encoder}.scaling"));
                break;
            }
        }
        // Numbers without encoder are in the unit of the channel.
        slot.unit = slot.unit.or_else(|| self.unit(&format!("channel.{}", self.name)));
        Ok(slot)
    }

    /// The channel in a slot such as `force`; `None` where the file does not define it.
    pub(super) fn slot(self, name: &str, channel: usize) -> Result<Option<Slot>, BadProperty> {
        let base = self.properties.value(&format!("channel.{}.conversion-set.conversions.base", self.name));
        let mut chain = Vec::new();
        let mut at = name.to_owned();
        while Some(at.as_str()) != base {
            let key = self.conversion(&at);
            if chain.len() >= DEEPEST {
                return Err(BadProperty {
                    key,
                    expected: "conversions that end at the base",
                    found: format!("more than {DEEPEST} one upon the other"),
                });
            }
            if self.properties.value(&format!("{key}.defined")) == Some("false") {
                return Ok(None);
            }
            let Some(scaling) = self.scaling(&key)? else {
                return Ok(None);
            };
            chain.push(scaling);
            match self.properties.value(&format!("{key}.base-calibration-slot")) {
                Some(below) => at = below.to_owned(),
                None => break,
            }
        }
        let mut slot = self.encoded(channel)?;
        for (multiplier, offset) in chain.iter().rev() {
            slot.line = slot.line.then(*multiplier, *offset);
        }
        if !chain.is_empty() {
            slot.unit = self.unit(&format!("{}.scaling", self.conversion(name)));
        }
        Ok(Some(slot))
    }

    /// The slot that the file shows by default.
    pub(super) fn usual(self, channel: usize) -> Result<Slot, BadProperty> {
        let usual = self.properties.value(&format!("channel.{}.conversion-set.conversions.default", self.name));
        let slot = usual.map_or(Ok(None), |name| self.slot(name, channel))?;
        slot.map_or_else(|| self.encoded(channel), Ok)
    }

    fn conversion(self, slot: &str) -> String {
        format!("channel.{}.conversion-set.conversion.{slot}", self.name)
    }

    /// Multiplier and offset of the scaling under a key; `None` where there is none.
    fn scaling(self, key: &str) -> Result<Option<(f64, f64)>, BadProperty> {
        let text = |end: &str| self.properties.value(&format!("{key}.scaling.{end}"));
        for (end, only) in [("type", "linear"), ("style", "offsetmultiplier")] {
            if let Some(found) = text(end).filter(|found| *found != only) {
                return Err(BadProperty {
                    key: format!("{key}.scaling.{end}"),
                    expected: only,
                    found: found.to_owned(),
                });
            }
        }
        let number = |end: &str| match text(end).map(|text| (text, text.parse::<f64>())) {
            None => Ok(None),
            Some((_, Ok(value))) if value.is_finite() => Ok(Some(value)),
            Some((text, _)) => Err(BadProperty {
                key: format!("{key}.scaling.{end}"),
                expected: "a finite number",
                found: text.to_owned(),
            }),
        };
        let (multiplier, offset) = (number("multiplier")?, number("offset")?);
        match (multiplier, offset) {
            (Some(0.0), _) => Err(BadProperty {
                key: format!("{key}.scaling.multiplier"),
                expected: "a number other than 0",
                found: "0".to_owned(),
            }),
            (Some(multiplier), offset) => Ok(Some((multiplier, offset.unwrap_or(0.0)))),
            (None, None) => Ok(None),
            (None, Some(_)) => Err(BadProperty {
                key: format!("{key}.scaling.multiplier"),
                expected: "a number",
                found: "nothing".to_owned(),
            }),
        }
    }

    /// Old files write the unit right away, newer ones one level deeper.
    fn unit(self, key: &str) -> Option<String> {
        let unit = self.properties.first(&[format!("{key}.unit.unit"), format!("{key}.unit")]);
        unit.map(str::to_owned)
    }
}
