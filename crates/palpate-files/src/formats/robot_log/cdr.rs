//! The numbers in a message of ROS 2: Common Data Representation, laid out by a [`Schema`].
//!
//! Four bytes say the order of bytes; behind them every number is aligned to its own size, counted from there.

use super::{
    fields::{Fields, MOST_ELEMENTS, distinct, fault, names_elements},
    schema::{Count, Field, Kind, Schema},
};
use crate::input::Number;

/// Length of the head that says how the rest is written.
const HEAD: usize = 4;

/// Most bytes that may stand behind the last field: rounding up to a whole number of words.
const MOST_LEFT: usize = 7;

/// Reads the numbers of a message.
pub(super) fn read(schema: &Schema, message: &[u8], named: bool) -> Result<Fields, String> {
    let mut walk = Walk {
        schema,
        bytes: Bytes::of(message)?,
        fields: Fields::none(named),
        path: String::new(),
        named,
    };
    walk.structure(0, true, Place::Message)?;
    let left = walk.bytes.data.len() - walk.bytes.at;
    if left > MOST_LEFT {
        return Err(walk.bytes.fault("the end of the message", &format!("{left} bytes more")));
    }
    Ok(walk.fields)
}

struct Bytes<'a> {
    /// The message behind its head.
    data: &'a [u8],
    at: usize,
    little: bool,
    /// What the largest numbers are aligned to.
    widest: usize,
}

impl<'a> Bytes<'a> {
    fn of(message: &'a [u8]) -> Result<Self, String> {
        let head = message.get(..HEAD).map(|head| u16::from_be_bytes([head[0], head[1]]));
        let (little, widest) = match head {
            Some(0x0000) => (false, 8),
            Some(0x0001) => (true, 8),
            // The second version of the encoding, of types that never change.
            Some(0x0006) => (false, 4),
            Some(0x0007) => (true, 4),
            other => {
                let found = other.map_or_else(|| format!("{} bytes", message.len()), |head| format!("{head:#06x}"));
                return Err(fault(Some(0), "a head of plain CDR", &found));
            }
        };
        Ok(Self {
            data: &message[HEAD..],
            at: 0,
            little,
            widest,
        })
    }

    fn fault(&self, expected: &str, found: &str) -> String {
        fault(Some(HEAD + self.at), expected, found)
    }

    /// The next `count` elements of `size` bytes each, aligned.
    fn take(&mut self, count: usize, size: usize) -> Result<&'a [u8], String> {
        if count == 0 {
            return Ok(&[]);
        }
        let start = self.at.next_multiple_of(size.min(self.widest));
        let end = count.checked_mul(size).and_then(|length| start.checked_add(length));
        match end.and_then(|end| self.data.get(start..end)) {
            Some(taken) => {
                self.at = start + taken.len();
                Ok(taken)
            }
            None => {
                let left = self.data.len().saturating_sub(start);
                Err(self.fault(&format!("{count} × {size} bytes"), &format!("{left} bytes to the end of the message")))
            }
        }
    }

    fn whole(&mut self) -> Result<u32, String> {
        Ok(self.number(Number::U32)? as u32)
    }

    fn text(&mut self) -> Result<&'a [u8], String> {
        let length = self.whole()? as usize;
        let bytes = self.take(length, 1)?;
        Ok(bytes.strip_suffix(b"\0").unwrap_or(bytes))
    }

    fn number(&mut self, number: Number) -> Result<f64, String> {
        let taken = self.take(1, number.size())?;
        Ok(number.read(taken, self.little))
    }
}

/// Where a structure stands, as far as the time stamp is concerned.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// It is the message.
    Message,
    /// It is the header of the message.
    Header,
    /// It is another part.
    Part,
}

struct Walk<'a> {
    schema: &'a Schema,
    bytes: Bytes<'a>,
    fields: Fields,
    /// Name of the structure that is walked through, where names are requested.
    path: String,
    named: bool,
}

impl Walk<'_> {
    fn structure(&mut self, index: usize, reported: bool, place: Place) -> Result<(), String> {
        let schema = self.schema;
        let mut labels: Option<Vec<String>> = None;
        for field in &schema.types[index] {
            let start = self.path.len();
            if self.named && reported {
                if start > 0 {
                    self.path.push('.');
                }
                self.path.push_str(&field.name);
            }
            let inner = if place == Place::Message && field.name == "header" { Place::Header } else { Place::Part };
            let is_stamp = place != Place::Part && field.name == "stamp" && field.kind == Kind::Time;
            match field.count {
                Count::One if is_stamp => {
                    let (seconds, nanoseconds) = (self.bytes.whole()?, self.bytes.whole()?);
                    self.fields.stamped(i64::from(seconds as i32), i64::from(nanoseconds));
                }
                Count::One => self.element(field.kind, reported && place != Place::Header, inner)?,
                Count::Array(count) => self.elements(field, count, reported, &mut labels)?,
                Count::Sequence => {
                    let count = self.bytes.whole()? as usize;
                    if reported {
                        let observed = u32::try_from(count.min(MOST_ELEMENTS + 1)).unwrap_or(u32::MAX);
                        self.fields.signature.extend(observed.to_le_bytes());
                    }
                    self.elements(field, count, reported, &mut labels)?;
                }
            }
            self.path.truncate(start);
        }
        Ok(())
    }

    fn element(&mut self, kind: Kind, reported: bool, place: Place) -> Result<(), String> {
        match kind {
            Kind::Number(number) => {
                let value = self.bytes.number(number)?;
                if reported { self.fields.push(&self.path, value) } else { Ok(()) }
            }
            Kind::Text => self.bytes.text().map(drop),
            Kind::Time => self.bytes.take(2, 4).map(drop),
            Kind::Filler => self.bytes.take(1, 1).map(drop),
            Kind::Structure(index) => self.structure(index, reported, place),
        }
    }

    /// The elements of an array or sequence.
    fn elements(
        &mut self,
        field: &Field,
        count: usize,
        reported: bool,
        labels: &mut Option<Vec<String>>,
    ) -> Result<(), String> {
        // Single bytes are pictures and identifiers, never measurements.
        let bytes = matches!(field.kind, Kind::Number(Number::U8 | Number::I8));
        let reported = reported && count <= MOST_ELEMENTS && !bytes;
        if let Kind::Number(number) = field.kind
            && !reported
        {
            return self.bytes.take(count, number.size()).map(drop);
        }
        if field.kind == Kind::Text && reported && names_elements(&field.name) {
            return self.labels(count, labels);
        }
        let labels = labels.as_ref().filter(|labels| labels.len() == count);
        let start = self.path.len();
        for index in 0..count {
            if self.named && reported {
                let label = labels.map_or_else(|| index.to_string(), |labels| labels[index].clone());
                self.path.push_str(&format!("[{label}]"));
            }
            self.element(field.kind, reported, Place::Part)?;
            self.path.truncate(start);
        }
        Ok(())
    }

    /// Texts that name the elements of the arrays behind them.
    fn labels(&mut self, count: usize, labels: &mut Option<Vec<String>>) -> Result<(), String> {
        let mut found = Vec::new();
        for _ in 0..count {
            let text = self.bytes.text()?;
            self.fields.signature.extend(text);
            self.fields.signature.push(0);
            if self.named {
                found.push(String::from_utf8_lossy(text).into_owned());
            }
        }
        *labels = (self.named && distinct(&found)).then_some(found);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn schema(text: &str) -> Schema {
        Schema::parse("a/B", text).unwrap()
    }

    #[test]
    fn numbers_are_aligned_behind_the_head_in_both_byte_orders() {
        let schema = schema("uint8 a\nfloat64 b\nint16 c\nuint32 d\nbool e\nint64 f\n");
        let little = [
            &[0, 1, 0, 0, 200][..],
            &[0; 7],
            &1.5_f64.to_le_bytes(),
            &(-2_i16).to_le_bytes(),
            &[0; 2],
            &7_u32.to_le_bytes(),
            &[1],
            &[0; 7],
            &(-9_i64).to_le_bytes(),
        ]
        .concat();
        let expected = vec![200.0, 1.5, -2.0, 7.0, 1.0, -9.0];
        let read_little = read(&schema, &little, true).unwrap();
        assert_eq!(read_little.values, expected);
        assert_eq!(read_little.names.unwrap(), ["a", "b", "c", "d", "e", "f"]);
        let big = [
            &[0, 0, 0, 0, 200][..],
            &[0; 7],
            &1.5_f64.to_be_bytes(),
            &(-2_i16).to_be_bytes(),
            &[0; 2],
            &7_u32.to_be_bytes(),
            &[1],
            &[0; 7],
            &(-9_i64).to_be_bytes(),
        ]
        .concat();
        assert_eq!(read(&schema, &big, false).unwrap().values, expected);
    }

    #[test]
    fn the_second_version_aligns_to_four_bytes() {
        let schema = schema("uint32 a\nfloat64 b\n");
        let message = [&[0, 7, 0, 0][..], &5_u32.to_le_bytes(), &2.5_f64.to_le_bytes()].concat();
        assert_eq!(read(&schema, &message, false).unwrap().values, [5.0, 2.5]);
    }

    #[test]
    fn cut_at_any_byte_is_a_fault() {
        let schema = schema("string s\nfloat64[] v\nC[2] c\n===\nMSG: a/C\nfloat32 x\nbool y\n");
        let message = [
            &[0, 1, 0, 0][..],
            &3_u32.to_le_bytes(),
            b"ab\0",
            &[0],
            &2_u32.to_le_bytes(),
            &[0; 4],
            &1.0_f64.to_le_bytes(),
            &2.0_f64.to_le_bytes(),
            &0.5_f32.to_le_bytes(),
            &[1, 0, 0, 0],
            &0.25_f32.to_le_bytes(),
            &[0],
        ]
        .concat();
        let whole = read(&schema, &message, true).unwrap();
        assert_eq!(whole.names.unwrap(), ["v[0]", "v[1]", "c[0].x", "c[0].y", "c[1].x", "c[1].y"]);
        assert_eq!(whole.values, [1.0, 2.0, 0.5, 1.0, 0.25, 0.0]);
        for length in 0..message.len() {
            assert!(read(&schema, &message[..length], false).is_err(), "{length}");
        }
        let longer = [&message[..], &[0; 8]].concat();
        assert!(read(&schema, &longer, false).is_err());
    }

    #[test]
    fn counts_that_lie_cost_nothing() {
        for text in ["float64[] v\n", "string[] v\n", "C[] v\n===\nMSG: a/C\nbool y\n", "E[] v\n===\nMSG: a/E\n"] {
            let message = [&[0, 1, 0, 0][..], &u32::MAX.to_le_bytes(), &[0; 16]].concat();
            assert!(read(&schema(text), &message, false).is_err(), "{text}");
        }
        let text = "float64[4000000000] v\n";
        assert!(read(&schema(text), &[0, 1, 0, 0, 1, 2, 3], false).is_err());
    }

    #[test]
    fn long_arrays_and_bytes_are_no_columns() {
        let schema = schema("float64[100] a\nuint8[16] b\nfloat32 c\n");
        let message = [&[0, 1, 0, 0][..], &[0; 816], &1.0_f32.to_le_bytes()].concat();
        let read = read(&schema, &message, true).unwrap();
        assert_eq!((read.values, read.names.unwrap()), (vec![1.0], vec!["c".to_owned()]));
    }
}
