//! `palpate lab`: records, laws and grips in the browser.

use palpate_jobs::{JobError, Verdict};
use palpate_lab::Lab;

use crate::arguments::LabArguments;
use crate::terminal::{note, print};

pub(crate) fn run(arguments: &LabArguments) -> Result<Verdict, JobError> {
    let lab = Lab {
        folder: arguments.folder.clone(),
        port: arguments.port,
        open: !arguments.no_open,
    };
    let listening = lab.listen()?;
    print(&format!("{}\n", listening.address()))?;
    if listening.is_temporary() {
        note("the records lie in a temporary folder, which is removed at the end; `palpate lab FOLDER` keeps them");
    }
    note("whoever has this address can use the lab; Ctrl-C ends it");
    listening.serve(note)?;
    Ok(Verdict::Positive)
}
