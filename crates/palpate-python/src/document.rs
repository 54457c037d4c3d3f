//! Documents of the library whose fields keep their order, as columns of tables.

use indexmap::IndexMap;
use serde::Deserialize;

/// Any JSON; fields stay in the order in which they are written.
#[derive(Clone, Deserialize)]
#[serde(untagged)]
pub(crate) enum Document {
    Null(()),
    Bool(bool),
    Integer(i64),
    Number(f64),
    Text(String),
    List(Vec<Document>),
    Fields(Fields),
}

/// A document by its fields.
pub(crate) type Fields = IndexMap<String, Document>;

impl Document {
    /// A field of a document; nothing of anything else.
    pub(crate) fn get(&self, name: &str) -> Option<&Self> {
        match self {
            Self::Fields(fields) => fields.get(name),
            _ => None,
        }
    }

    /// The entries of a list.
    pub(crate) fn entries(&self) -> &[Self] {
        match self {
            Self::List(entries) => entries,
            _ => &[],
        }
    }

    /// The fields with inner ones spread out: `standard_error.rmse` becomes `rmse_standard_error`, limits `_low` and `_high`. Lists
    /// and other documents have tables of their own and are left out.
    pub(crate) fn flat(&self, into: &mut Fields) {
        let Self::Fields(fields) = self else {
            return;
        };
        let mut put = |name: String, value: &Self| into.insert(name, value.clone());
        for (name, value) in fields {
            match value {
                Self::Fields(errors) if name == "standard_error" => {
                    for (of, error) in errors {
                        put(format!("{of}_standard_error"), error);
                    }
                }
                Self::Fields(limits) if name == "confidence_interval" => {
                    for (of, limits) in limits {
                        if let [low, high] = limits.entries() {
                            put(format!("{of}_low"), low);
                            put(format!("{of}_high"), high);
                        }
                    }
                }
                Self::Fields(_) | Self::List(_) => {}
                plain => {
                    put(name.clone(), plain);
                }
            }
        }
    }
}
