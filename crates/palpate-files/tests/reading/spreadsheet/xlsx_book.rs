//! A minimal writer of `.xlsx`.

use std::io::{Cursor, Write};

use zip::{ZipWriter, write::SimpleFileOptions};

/// A workbook as the XML of its sheets, each with a name.
#[derive(Debug, Clone, Default)]
pub(crate) struct Book {
    pub(crate) sheets: Vec<(String, String)>,
    pub(crate) strings: String,
    /// How many shared texts it says there are.
    pub(crate) strings_stated: u64,
    pub(crate) formats: Vec<&'static str>,
    /// Where its styles are stated to be, if not where they are.
    pub(crate) styles: &'static str,
    pub(crate) from_1904: bool,
    pub(crate) charts: Vec<&'static str>,
}

/// What a cell holds: nothing, a number, a text, or XML as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum C {
    E,
    N(f64),
    T(&'static str),
    /// Number under the style of this number: 0 is plain, others as in [`Book::formats`].
    S(f64, usize),
    X(&'static str),
}

pub(crate) fn letters(column: usize) -> String {
    let low = char::from(b'A' + (column % 26) as u8);
    if column < 26 { low.to_string() } else { format!("{}{low}", letters(column / 26 - 1)) }
}

/// The XML of the rows of a sheet that begins at A1.
pub(crate) fn rows(table: &[Vec<C>]) -> String {
    let mut xml = String::new();
    for (row, cells) in table.iter().enumerate() {
        xml.push_str(&format!("<row r=\"{}\">", row + 1));
        for (column, cell) in cells.iter().enumerate() {
            let place = format!("{}{}", letters(column), row + 1);
            match cell {
                C::E => {}
                C::N(number) => xml.push_str(&format!("<c r=\"{place}\"><v>{number}</v></c>")),
                C::T(text) => {
                    xml.push_str(&format!("<c r=\"{place}\" t=\"inlineStr\"><is><t>{text}</t></is></c>"));
                }
                C::S(number, style) => xml.push_str(&format!("<c r=\"{place}\" s=\"{style}\"><v>{number}</v></c>")),
                C::X(inner) => xml.push_str(&inner.replace("PLACE", &place)),
            }
        }
        xml.push_str("</row>");
    }
    xml
}

impl Book {
    pub(crate) fn of(sheets: &[(&str, &[Vec<C>])]) -> Self {
        Self {
            sheets: sheets.iter().map(|(name, table)| ((*name).to_owned(), rows(table))).collect(),
            ..Self::default()
        }
    }

    pub(crate) fn bytes(&self) -> Vec<u8> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        let mut put = |path: &str, xml: &str| {
            zip.start_file(path, SimpleFileOptions::default()).expect("a member");
            zip.write_all(xml.as_bytes()).expect("its bytes");
        };
        let office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
        put("[Content_Types].xml", "<Types/>");
        put(
            "_rels/.rels",
            &format!(
                "<Relationships><Relationship Id=\"a\" Type=\"{office}/officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>"
            ),
        );
        let (mut list, mut related) = (String::new(), String::new());
        for (index, (name, xml)) in self.sheets.iter().enumerate() {
            list.push_str(&format!("<sheet name=\"{name}\" sheetId=\"{0}\" r:id=\"s{0}\"/>", index + 1));
            related.push_str(&format!(
                "<Relationship Id=\"s{0}\" Type=\"{office}/worksheet\" Target=\"worksheets/sheet{0}.xml\"/>",
                index + 1
            ));
            // A dimension that lies: it must not be trusted.
            put(
                &format!("xl/worksheets/sheet{}.xml", index + 1),
                &format!("<worksheet><dimension ref=\"A1:XFD1048576\"/><sheetData>{xml}</sheetData></worksheet>"),
            );
        }
        for (index, name) in self.charts.iter().enumerate() {
            list.push_str(&format!("<sheet name=\"{name}\" sheetId=\"{0}\" r:id=\"c{0}\"/>", index + 90));
            related.push_str(&format!(
                "<Relationship Id=\"c{0}\" Type=\"{office}/chartsheet\" Target=\"chartsheets/sheet1.xml\"/>",
                index + 90
            ));
        }
        related.push_str(&format!(
            "<Relationship Id=\"t\" Type=\"{office}/sharedStrings\" Target=\"/xl/sharedStrings.xml\"/>"
        ));
        let styles = if self.styles.is_empty() { "styles.xml" } else { self.styles };
        related.push_str(&format!("<Relationship Id=\"f\" Type=\"{office}/styles\" Target=\"{styles}\"/>"));
        put(
            "xl/workbook.xml",
            &format!(
                "<workbook><workbookPr date1904=\"{}\"/><sheets>{list}</sheets></workbook>",
                u8::from(self.from_1904)
            ),
        );
        put("xl/_rels/workbook.xml.rels", &format!("<Relationships>{related}</Relationships>"));
        put(
            "xl/sharedStrings.xml",
            &format!("<sst uniqueCount=\"{}\">{}</sst>", self.strings_stated, self.strings),
        );
        let format =
            |(index, code): (usize, &&str)| format!("<numFmt numFmtId=\"{}\" formatCode=\"{code}\"/>", 164 + index);
        let formats: String = self.formats.iter().enumerate().map(format).collect();
        let style = |index: usize| format!("<xf numFmtId=\"{}\"/>", 164 + index);
        let styles: String = (0..self.formats.len()).map(style).collect();
        put(
            "xl/styles.xml",
            &format!(
                "<styleSheet><numFmts>{formats}</numFmts><cellXfs><xf numFmtId=\"0\"/>{styles}</cellXfs></styleSheet>"
            ),
        );
        zip.finish().expect("an archive").into_inner()
    }
}
