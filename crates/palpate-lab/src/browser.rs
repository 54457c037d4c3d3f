//! Opening the page in a browser.

use std::fs;
use std::io;

use palpate_jobs::output::TemporaryFolder;

/// Opens the page, by a file that only this user can read: the arguments of a process, such as an address, are shown to every user of the
/// machine.
pub(crate) fn open(address: &str) -> io::Result<TemporaryFolder> {
    let folder = TemporaryFolder::make(&std::env::temp_dir())?;
    let path = folder.path().join("palpate-lab.html");
    let page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"referrer\" content=\"no-referrer\">\n\
         <meta http-equiv=\"refresh\" content=\"0; url={address}\">\n<title>palpate lab</title>\n</head>\n\
         <body><p><a href=\"{address}\">palpate lab</a></p></body>\n</html>\n"
    );
    fs::write(&path, page)?;
    open::that_detached(&path)?;
    Ok(folder)
}
