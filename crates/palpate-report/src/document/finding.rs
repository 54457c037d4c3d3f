//! A finding with its words.

use palpate::analysis;

use crate::page::Finding;
use crate::spelling::with_flags;

impl From<&analysis::Finding> for Finding {
    fn from(finding: &analysis::Finding) -> Self {
        Self {
            code: finding.code().to_owned(),
            severity: finding.severity(),
            observation: finding.observation(),
            meaning: finding.meaning().to_owned(),
            remedy: with_flags(finding.remedy()),
        }
    }
}
