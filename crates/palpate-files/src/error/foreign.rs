//! Recognising files that hold no record in any format known here.

use std::fmt;

/// What a file looks like that holds no record in any format known here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Foreign {
    /// A zip archive that is none of the formats known here.
    Zip,
    /// A document of LibreOffice, such as a spreadsheet (`.ods`).
    OpenDocument,
    /// A file compressed in another way (bzip2, xz, zstd, 7z), or twice.
    Compressed,
    /// HDF5, or a MATLAB file of version 7.3.
    Hdf5,
    /// A MATLAB file of version 5 to 7.
    Matlab,
    /// A NumPy array.
    Numpy,
    /// A National Instruments TDMS record.
    Tdms,
    /// An SQLite database.
    Sqlite,
    /// A picture (PNG or JPEG).
    Picture,
    /// A PDF document.
    Pdf,
    /// XML or HTML, which some programs save under the name `.xls`.
    Markup,
    /// JSON.
    Json,
    /// Bytes that are no text in any encoding that is known here.
    Binary,
}

impl fmt::Display for Foreign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Zip => "a zip archive",
            Self::OpenDocument => "an OpenDocument file",
            Self::Compressed => "a compressed file",
            Self::Hdf5 => "an HDF5 file",
            Self::Matlab => "a MATLAB file",
            Self::Numpy => "a NumPy array",
            Self::Tdms => "a TDMS record",
            Self::Sqlite => "an SQLite database",
            Self::Picture => "a picture",
            Self::Pdf => "a PDF document",
            Self::Markup => "XML or HTML",
            Self::Json => "JSON",
            Self::Binary => "binary data",
        })
    }
}

/// First bytes that belong to one format only.
const SIGNATURES: [(&[u8], Foreign); 16] = [
    (b"\x1F\x8B\x08", Foreign::Compressed),
    (b"PK\x03\x04", Foreign::Zip),
    (b"\x89HDF\r\n", Foreign::Hdf5),
    (b"MATLAB 5.0 MAT-file", Foreign::Matlab),
    (b"\x93NUMPY", Foreign::Numpy),
    (b"TDSm", Foreign::Tdms),
    (b"SQLite format 3\0", Foreign::Sqlite),
    (b"\x89PNG", Foreign::Picture),
    (b"\xFF\xD8\xFF", Foreign::Picture),
    (b"%PDF-", Foreign::Pdf),
    (b"7z\xBC\xAF\x27\x1C", Foreign::Compressed),
    (b"\xFD7zXZ\0", Foreign::Compressed),
    (b"\x28\xB5\x2F\xFD", Foreign::Compressed),
    (b"BZh91AY&SY", Foreign::Compressed),
    (b"<?xml", Foreign::Markup),
    (b"<html", Foreign::Markup),
];

/// What `sample`, the beginning of a file, looks like if no format known here is right.
pub(crate) fn recognise_foreign(sample: &[u8]) -> Option<Foreign> {
    // The standard wants this first member, not compressed.
    if sample
        .get(30..)
        .is_some_and(|member| member.starts_with(b"mimetypeapplication/vnd.oasis.opendocument."))
    {
        return Some(Foreign::OpenDocument);
    }
    let signed = SIGNATURES
        .iter()
        .find(|(start, _)| sample.get(..start.len()).is_some_and(|first| first.eq_ignore_ascii_case(start)));
    if let Some((_, foreign)) = signed {
        return Some(*foreign);
    }
    let text = sample.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(sample);
    let head: Vec<u8> = text.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).take(9).collect();
    if head.starts_with(b"{\"") || head.starts_with(b"[{\"") {
        return Some(Foreign::Json);
    }
    if head.starts_with(b"<?xml") || head.to_ascii_lowercase().starts_with(b"<!doctype") {
        return Some(Foreign::Markup);
    }
    None
}

/// Whether `text`, decoded already, has more control characters than any text would.
pub(crate) fn mostly_control(text: &str) -> bool {
    let (mut all, mut control) = (0_usize, 0_usize);
    for character in text.chars() {
        all += 1;
        control += usize::from(character.is_control() && !"\t\n\r\u{c}\u{1a}\u{85}".contains(character));
        control += usize::from(character == '\0');
    }
    control * 20 > all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signatures() {
        for (start, expected) in SIGNATURES {
            let file = [start, b" more"].concat();
            assert_eq!(recognise_foreign(&file), Some(expected));
        }
        assert_eq!(recognise_foreign(b" \n{ \"a\": 1}"), Some(Foreign::Json));
        assert_eq!(recognise_foreign(b"<!DOCTYPE html>"), Some(Foreign::Markup));
        assert_eq!(recognise_foreign(b"Time,Force\n"), None);
        assert_eq!(recognise_foreign(b"[Header]\n1,2\n"), None);
    }

    #[test]
    fn control_characters() {
        assert!(mostly_control("\u{1}\u{2}\u{3}abc"));
        assert!(!mostly_control("1\t2\r\n3\t4\r\n\u{1a}"));
    }
}
