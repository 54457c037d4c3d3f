//! Writing logs: messages by hand, the container by the reference library, its chunks packed here.
//!
//! The library packs chunks itself with features that the product does without; tests that requested them would have all that
//! depends on zstd compiled twice.

use std::{collections::BTreeMap, io::Cursor};

use mcap::{
    WriteOptions, Writer,
    records::{MessageHeader, op},
};

/// When the logs written here begin, ns since 1970.
pub(crate) const START: u64 = 1_724_504_945_198_464_400;

const SEPARATOR: &str = "\n================================================================================\n";
const HEADER: &str = "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";

pub(crate) fn joint_state_schema() -> String {
    format!(
        "std_msgs/Header header\n\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n{SEPARATOR}{HEADER}"
    )
}

pub(crate) fn wrench_schema() -> String {
    format!(
        "# A wrench with reference coordinate frame and timestamp\nstd_msgs/Header header\nWrench wrench\n\
         {SEPARATOR}MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n{SEPARATOR}\
         MSG: geometry_msgs/Wrench\nVector3  force\nVector3  torque\n{SEPARATOR}{HEADER}"
    )
}

/// A message in CDR.
pub(crate) struct Cdr {
    little: bool,
    body: Vec<u8>,
}

impl Cdr {
    pub(crate) fn new(little: bool) -> Self {
        Self {
            little,
            body: Vec::new(),
        }
    }

    fn aligned<const N: usize>(mut self, little: [u8; N]) -> Self {
        self.body.resize(self.body.len().next_multiple_of(N), 0);
        let mut bytes = little;
        if !self.little {
            bytes.reverse();
        }
        self.body.extend(bytes);
        self
    }

    pub(crate) fn u8(self, value: u8) -> Self {
        self.aligned([value])
    }

    pub(crate) fn u32(self, value: u32) -> Self {
        self.aligned(value.to_le_bytes())
    }

    pub(crate) fn f32(self, value: f32) -> Self {
        self.aligned(value.to_le_bytes())
    }

    pub(crate) fn f64(self, value: f64) -> Self {
        self.aligned(value.to_le_bytes())
    }

    pub(crate) fn text(self, text: &str) -> Self {
        let mut own = self.u32(text.len() as u32 + 1);
        own.body.extend(text.as_bytes());
        own.body.push(0);
        own
    }

    pub(crate) fn numbers(self, values: &[f64]) -> Self {
        let own = self.u32(values.len() as u32);
        values.iter().fold(own, |own, value| own.f64(*value))
    }

    /// A header with a stamp, ns since 1970.
    pub(crate) fn header(self, stamp: u64) -> Self {
        let (seconds, rest) = (stamp / 1_000_000_000, stamp % 1_000_000_000);
        self.u32(seconds as u32).u32(rest as u32).text("base_link")
    }

    pub(crate) fn bytes(self) -> Vec<u8> {
        let head = [0, u8::from(self.little), 0, 0];
        [&head[..], &self.body].concat()
    }
}

pub(crate) fn joint_state(stamp: u64, joints: &[(&str, f64)], effort: f64) -> Vec<u8> {
    let positions: Vec<f64> = joints.iter().map(|joint| joint.1).collect();
    let named = Cdr::new(true).header(stamp).u32(joints.len() as u32);
    let named = joints.iter().fold(named, |named, joint| named.text(joint.0));
    named.numbers(&positions).numbers(&[]).numbers(&vec![effort; joints.len()]).bytes()
}

pub(crate) fn wrench(little: bool, stamp: u64, force: f64) -> Vec<u8> {
    let six = [0.1, 0.2, force, 0.01, 0.02, 0.03];
    six.iter().fold(Cdr::new(little).header(stamp), |message, value| message.f64(*value)).bytes()
}

/// How chunks are packed.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Packing {
    Zstd,
    Lz4,
}

/// A log in the making.
pub(crate) struct Log {
    writer: Writer<Cursor<Vec<u8>>>,
    packing: Option<Packing>,
    topics: BTreeMap<String, u16>,
}

impl Log {
    pub(crate) fn new(options: WriteOptions) -> Self {
        let options = options.profile("ros2").compression(None);
        Self {
            writer: options.create(Cursor::new(Vec::new())).expect("a log in memory"),
            packing: None,
            topics: BTreeMap::new(),
        }
    }

    /// Several chunks.
    pub(crate) fn chunked() -> Self {
        Self::new(WriteOptions::new().chunk_size(Some(2000)))
    }

    /// The same log with its chunks packed.
    pub(crate) fn packed(self, packing: Packing) -> Self {
        Self {
            packing: Some(packing),
            ..self
        }
    }

    /// A topic with the definition of its messages.
    pub(crate) fn topic(mut self, topic: &str, encoding: &str, schema: (&str, &str, &str)) -> Self {
        let (name, kind, text) = schema;
        let schema = self.writer.add_schema(name, kind, text.as_bytes()).expect("a log in memory");
        let channel = self.writer.add_channel(schema, topic, encoding, &BTreeMap::new()).expect("a log in memory");
        self.topics.insert(topic.to_owned(), channel);
        self
    }

    pub(crate) fn joints(self, topic: &str) -> Self {
        self.topic(topic, "cdr", ("sensor_msgs/msg/JointState", "ros2msg", &joint_state_schema()))
    }

    pub(crate) fn wrenches(self, topic: &str) -> Self {
        self.topic(topic, "cdr", ("geometry_msgs/msg/WrenchStamped", "ros2msg", &wrench_schema()))
    }

    pub(crate) fn say(&mut self, topic: &str, log_time: u64, data: &[u8]) {
        let header = MessageHeader {
            channel_id: self.topics[topic],
            sequence: 0,
            log_time,
            publish_time: log_time,
        };
        self.writer.write_to_known_channel(&header, data).expect("a log in memory");
    }

    pub(crate) fn finish(mut self) -> Vec<u8> {
        self.writer.finish().expect("a log in memory");
        let log = self.writer.into_inner().into_inner();
        match self.packing {
            Some(packing) => packed(&log, packing),
            None => log,
        }
    }
}

/// A log with its chunks packed and the checksum of its data renewed.
fn packed(log: &[u8], packing: Packing) -> Vec<u8> {
    let (magic, mut rest) = log.split_at(mcap::MAGIC.len());
    let mut written = magic.to_vec();
    while let [kind, length @ ..] = rest
        && let Some((length, after)) = length.split_first_chunk::<8>()
        && after.len() >= mcap::MAGIC.len()
    {
        let (content, after) = after.split_at(u64::from_le_bytes(*length) as usize);
        rest = after;
        let content = match *kind {
            op::CHUNK => packed_chunk(content, packing),
            op::DATA_END => checksum(&written).to_le_bytes().to_vec(),
            _ => content.to_vec(),
        };
        written.push(*kind);
        written.extend((content.len() as u64).to_le_bytes());
        written.extend(content);
    }
    [&written[..], rest].concat()
}

fn checksum(bytes: &[u8]) -> u32 {
    let mut sum = flate2::Crc::new();
    sum.update(bytes);
    sum.sum()
}

/// The content of a chunk: two times, size and checksum of what it unpacks to, the name of its packing, then the records.
fn packed_chunk(content: &[u8], packing: Packing) -> Vec<u8> {
    let (head, rest) = content.split_at(8 + 8 + 8 + 4);
    let (name, length, records) = (&rest[..4], &rest[4..12], &rest[12..]);
    assert_eq!(
        (name, length),
        (&[0; 4][..], &(records.len() as u64).to_le_bytes()[..]),
        "a chunk that is not packed"
    );
    let (name, packed) = match packing {
        Packing::Zstd => ("zstd", zstd::encode_all(records, 0).expect("a packer in memory")),
        Packing::Lz4 => {
            let mut packer = lz4_flex::frame::FrameEncoder::new(Vec::new());
            std::io::Write::write_all(&mut packer, records).expect("a packer in memory");
            ("lz4", packer.finish().expect("a packer in memory"))
        }
    };
    let lengths = [
        (name.len() as u32).to_le_bytes().to_vec(),
        name.as_bytes().to_vec(),
        (packed.len() as u64).to_le_bytes().to_vec(),
    ];
    [head, &lengths.concat(), &packed].concat()
}

/// A gripper of one finger joint (m, 50 Hz) with a wrench (100 Hz): 4 mm in, at 10 mm/s, then still; the force falls.
pub(crate) fn gripper(mut log: Log) -> Vec<u8> {
    const MS: u64 = 1_000_000;
    log = log.joints("/joint_states").wrenches("/ft");
    for step in 0..100_u64 {
        let time = START + 10 * MS * step;
        if step % 2 == 0 {
            let travel = (0.01 * (step as f64) * 0.01).min(0.004);
            let state = joint_state(time + MS, &[("arm", 1.0), ("finger", travel)], f64::NAN);
            log.say("/joint_states", time + 2 * MS, &state);
        }
        log.say("/ft", time + 3 * MS, &wrench(true, time, force_at(step)));
    }
    log.finish()
}

/// The force that [`gripper`] logs.
pub(crate) fn force_at(step: u64) -> f64 {
    let step = step as f64;
    if step < 40.0 { 0.1 * step } else { 2.0 + 2.0 * (-(step - 40.0) / 20.0).exp() }
}
