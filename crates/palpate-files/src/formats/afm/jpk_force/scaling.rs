//! From stored numbers to quantities: the scaling of the encoder, then conversions that build upon one another.
//!
//! A channel of deflection is stored as whole numbers; its encoder makes them volts, the conversion `distance`
//! (the sensitivity) makes metres of volts, and `force` (the spring constant) newtons of metres.

use super::segment::Header;
use crate::{
    error::FileError,
    formats::afm::{assemble::Channel, curve::Line},
};

/// Most conversions one upon the other; more run in a circle.
const DEEPEST: usize = 16;

impl Header<'_> {
    /// The channel called `name` as its encoder makes it, from stored numbers in `channel`.
    fn encoded(&self, name: &str, channel: usize) -> Result<Channel, FileError> {
        let (mut line, mut unit) = (Line::of(channel), None);
        for encoder in [format!("channel.{name}.data.encoder"), format!("channel.{name}.encoder")] {
            if let Some((multiplier, offset)) = self.scaling(&encoder)? {
                line = line.then(multiplier, offset);
                unit = self.unit(&format!("{encoder}.scaling"));
                break;
            }
        }
        Ok(Channel {
            name: name.to_owned(),
            // Numbers without encoder are in the unit of the channel.
            unit: unit.or_else(|| self.unit(&format!("channel.{name}"))),
            line,
        })
    }

    /// The channel in a slot such as `force`; `None` where the file does not define it.
    pub(super) fn slot(&self, name: &str, channel: usize, slot: &str) -> Result<Option<Channel>, FileError> {
        let conversions = format!("channel.{name}.conversion-set.conversion");
        let base = self.properties.value(&format!("{conversions}s.base"));
        let mut chain = Vec::new();
        let mut at = slot;
        while Some(at) != base {
            let key = format!("{conversions}.{at}");
            if chain.len() >= DEEPEST {
                let found = format!("more than {DEEPEST} one upon the other");
                return Err(self.bad(&key, "conversions that end at the base", found));
            }
            if self.properties.value(&format!("{key}.defined")) == Some("false") {
                return Ok(None);
            }
            let Some(scaling) = self.scaling(&key)? else {
                return Ok(None);
            };
            chain.push(scaling);
            match self.properties.value(&format!("{key}.base-calibration-slot")) {
                Some(below) => at = below,
                None => break,
            }
        }
        let mut found = self.encoded(name, channel)?;
        for (multiplier, offset) in chain.iter().rev() {
            found.line = found.line.then(*multiplier, *offset);
        }
        if !chain.is_empty() {
            found.unit = self.unit(&format!("{conversions}.{slot}.scaling"));
        }
        Ok(Some(found))
    }

    /// The channel in the slot that the file shows by default.
    pub(super) fn usual(&self, name: &str, channel: usize) -> Result<Channel, FileError> {
        let usual = self.properties.value(&format!("channel.{name}.conversion-set.conversions.default"));
        let slot = usual.map_or(Ok(None), |slot| self.slot(name, channel, slot))?;
        slot.map_or_else(|| self.encoded(name, channel), Ok)
    }

    /// Multiplier and offset of the scaling under a key; `None` where there is none.
    fn scaling(&self, key: &str) -> Result<Option<(f64, f64)>, FileError> {
        for (end, only) in [("type", "linear"), ("style", "offsetmultiplier")] {
            let key = format!("{key}.scaling.{end}");
            if let Some(found) = self.properties.value(&key).filter(|found| *found != only) {
                return Err(self.bad(&key, only, found.to_owned()));
            }
        }
        let multiplier = format!("{key}.scaling.multiplier");
        match (self.number(&multiplier)?, self.number(&format!("{key}.scaling.offset"))?) {
            (Some(0.0), _) => Err(self.bad(&multiplier, "a number other than 0", "0".to_owned())),
            (Some(multiplier), offset) => Ok(Some((multiplier, offset.unwrap_or(0.0)))),
            (None, None) => Ok(None),
            (None, Some(_)) => Err(self.bad(&multiplier, "a number", "nothing".to_owned())),
        }
    }

    /// Old files write the unit right away, newer ones one level deeper.
    fn unit(&self, key: &str) -> Option<String> {
        let unit = self.properties.first(&[format!("{key}.unit.unit"), format!("{key}.unit")]);
        unit.map(str::to_owned)
    }
}
