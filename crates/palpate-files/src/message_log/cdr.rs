//! Messages in Common Data Representation, the least significant byte first.
//!
//! Four bytes state the order of bytes; behind them every number is aligned to its own size, counted from there.

use super::{
    error::LogError,
    message::{Diagnostic, JointState, Message, Wrench},
    stamp::Stamp,
};

/// Plain CDR, little endian.
const HEAD: [u8; 4] = [0, 1, 0, 0];

/// Writes a message over what `into` holds.
pub(super) fn encode(message: &Message<'_>, stamp: Stamp, into: &mut Vec<u8>) -> Result<(), LogError> {
    into.clear();
    into.extend(HEAD);
    let mut bytes = Bytes { into };
    match message {
        Message::JointState(state) => bytes.joint_state(state, stamp),
        Message::Wrench(wrench) => bytes.wrench(wrench, stamp),
        Message::Float64(value) => {
            bytes.number(value.to_le_bytes());
            Ok(())
        }
        Message::Bool(value) => {
            bytes.number([u8::from(*value)]);
            Ok(())
        }
        Message::Diagnostic(diagnostic) => bytes.diagnostic(diagnostic, stamp),
    }
}

struct Bytes<'a> {
    into: &'a mut Vec<u8>,
}

impl Bytes<'_> {
    /// A number, aligned to its size.
    fn number<const N: usize>(&mut self, little: [u8; N]) {
        let end = (self.into.len() - HEAD.len()).next_multiple_of(N) + HEAD.len();
        self.into.resize(end, 0);
        self.into.extend(little);
    }

    fn count(&mut self, count: usize) -> Result<(), LogError> {
        let count = u32::try_from(count).map_err(|_| LogError::Container(format!("{count} bytes in a text")))?;
        self.number(count.to_le_bytes());
        Ok(())
    }

    /// A text, with the zero byte that ends it.
    fn text(&mut self, text: &str) -> Result<(), LogError> {
        // A zero inside would end the text for readers in C.
        let text = text.split('\0').next().unwrap_or_default();
        self.count(text.len() + 1)?;
        self.into.extend(text.as_bytes());
        self.into.push(0);
        Ok(())
    }

    fn header(&mut self, stamp: Stamp, frame: &str) -> Result<(), LogError> {
        let (seconds, nanoseconds) = stamp.parts();
        self.number(seconds.to_le_bytes());
        self.number(nanoseconds.to_le_bytes());
        self.text(frame)
    }

    /// A sequence of the one number, or of none.
    fn known(&mut self, value: Option<f64>) {
        self.number(u32::from(value.is_some()).to_le_bytes());
        if let Some(value) = value {
            self.number(value.to_le_bytes());
        }
    }

    fn joint_state(&mut self, state: &JointState<'_>, stamp: Stamp) -> Result<(), LogError> {
        self.header(stamp, "")?;
        self.count(1)?;
        self.text(state.name)?;
        [state.position, state.velocity, state.effort].into_iter().for_each(|value| self.known(value));
        Ok(())
    }

    fn wrench(&mut self, wrench: &Wrench<'_>, stamp: Stamp) -> Result<(), LogError> {
        self.header(stamp, wrench.frame)?;
        let torque = [0.0; 3];
        wrench.force.into_iter().chain(torque).for_each(|value: f64| self.number(value.to_le_bytes()));
        Ok(())
    }

    fn diagnostic(&mut self, diagnostic: &Diagnostic<'_>, stamp: Stamp) -> Result<(), LogError> {
        self.header(stamp, "")?;
        self.count(1)?;
        self.number([diagnostic.level as u8]);
        [diagnostic.name, diagnostic.message, ""].into_iter().try_for_each(|text| self.text(text))?;
        self.count(diagnostic.values.len())?;
        diagnostic.values.iter().try_for_each(|(key, value)| {
            self.text(key)?;
            self.text(value)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{message::Level, stamp::LogClock};
    use super::*;

    fn encoded(message: &Message<'_>) -> Vec<u8> {
        let (stamp, mut bytes) = (LogClock::beginning_at(0.0).stamp(0.5).unwrap(), vec![9; 40]);
        encode(message, stamp, &mut bytes).unwrap();
        bytes
    }

    /// The bytes of a header at 1.5 s with an empty frame.
    const STAMPED: [u8; 13] = [1, 0, 0, 0, 0, 0x65, 0xCD, 0x1D, 1, 0, 0, 0, 0];

    #[test]
    fn numbers_are_aligned_behind_the_head() {
        let state = JointState {
            name: "finger",
            position: Some(0.005),
            velocity: None,
            effort: Some(-2.5),
        };
        let expected = [
            &HEAD[..],
            &STAMPED,
            &[0; 3],
            &1_u32.to_le_bytes(),
            &7_u32.to_le_bytes(),
            b"finger\0",
            &[0],
            &1_u32.to_le_bytes(),
            &[0; 4],
            &0.005_f64.to_le_bytes(),
            &0_u32.to_le_bytes(),
            &1_u32.to_le_bytes(),
            &(-2.5_f64).to_le_bytes(),
        ];
        assert_eq!(encoded(&Message::JointState(state)), expected.concat());
        assert_eq!(encoded(&Message::Float64(0.1)), [&HEAD[..], &0.1_f64.to_le_bytes()].concat());
        assert_eq!(encoded(&Message::Bool(true)), [0, 1, 0, 0, 1]);
    }

    #[test]
    fn a_text_ends_at_its_first_zero() {
        let diagnostic = Diagnostic {
            level: Level::Error,
            name: "n",
            message: "a\0b",
            values: &[("k".to_owned(), String::new())],
        };
        let text = |text: &[u8]| [&(text.len() as u32 + 1).to_le_bytes()[..], text, &[0]].concat();
        let expected = [
            &HEAD[..],
            &STAMPED,
            &[0; 3],
            &1_u32.to_le_bytes(),
            &[2, 0, 0, 0],
            &text(b"n"),
            &[0; 2],
            &text(b"a"),
            &[0; 2],
            &text(b""),
            &[0; 3],
            &1_u32.to_le_bytes(),
            &text(b"k"),
            &[0; 2],
            &text(b""),
        ];
        assert_eq!(encoded(&Message::Diagnostic(diagnostic)), expected.concat());
    }
}
