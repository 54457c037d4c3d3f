//! Tables as CSV after RFC 4180, or as the readers of another language write it.

use std::borrow::Cow;

use super::{Cell, CsvLocale, Table};

/// What a spreadsheet takes for the beginning of a formula (OWASP, CSV injection), also as wide letters.
const FORMULA: [char; 11] = ['=', '+', '-', '@', '\t', '\r', '\n', '＝', '＋', '－', '＠'];

/// Whether a spreadsheet would compute a text as a formula.
pub(crate) fn is_formula(text: &str) -> bool {
    text.starts_with(FORMULA)
}

/// A text as a cell of CSV: one that a spreadsheet would compute as a formula is marked as text by an apostrophe. Titles and names of files
/// come from anywhere.
#[must_use]
pub fn text_cell(text: &str) -> Cow<'_, str> {
    if is_formula(text) { Cow::Owned(format!("'{text}")) } else { Cow::Borrowed(text) }
}

/// What writes CSV for the readers of a language.
#[must_use]
pub fn csv_writer(locale: CsvLocale) -> csv::WriterBuilder {
    let mut builder = csv::WriterBuilder::new();
    // Every separator is one byte.
    builder.delimiter(locale.separator() as u8);
    builder
}

pub(crate) fn write(table: &Table, locale: CsvLocale) -> String {
    let mut writer = csv_writer(locale).terminator(csv::Terminator::CRLF).from_writer(Vec::new());
    // Nothing refuses to be written to memory.
    let _ = writer.write_record(table.columns.iter().flat_map(|column| {
        let errors = ["standard_error", "low", "high"].map(|what| format!("{}_{what}", column.key));
        [column.key.clone()].into_iter().chain(errors.into_iter().filter(|_| column.is_estimate))
    }));
    for row in 0..table.rows.len() {
        let _ = writer.write_record(table.columns.iter().enumerate().flat_map(|(index, column)| {
            let cell = table.cell(row, index);
            let own = match cell {
                Cell::Text(text) => text_cell(text).into_owned(),
                number => locale.number(number.stored()),
            };
            let errors = cell.stored_errors().into_iter().map(move |error| locale.number(error));
            [own].into_iter().chain(errors.filter(|_| column.is_estimate))
        }));
    }
    let bytes = writer.into_inner().unwrap_or_default();
    String::from_utf8(bytes).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_reader_gets_every_value_back() {
        let values = [0.1 + 0.2, -1e-300, 6.022e23, 42.0];
        let words = ["plain", "a,b", "say \"so\"", "two\r\nlines"];
        let mut table = Table::new("t", "").column("Value", "value_n", "N").column("Remark, free", "remark", "");
        for (value, word) in values.iter().zip(words) {
            table = table.row(vec![Cell::Number(*value, 3), Cell::text(word)]);
        }
        table = table.row(vec![Cell::missing("lost"), Cell::Integer(-7)]);

        let text = table.to_csv(CsvLocale::En);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        assert_eq!(reader.headers().expect("a header"), vec!["value_n", "remark"]);
        let rows: Vec<csv::StringRecord> = reader.records().flatten().collect();
        for (i, (value, word)) in values.iter().zip(words).enumerate() {
            assert_eq!(rows[i][0].parse::<f64>().map(f64::to_bits), Ok(value.to_bits()));
            assert_eq!(&rows[i][1], word);
        }
        assert_eq!(rows[4], vec!["", "-7"]);
    }

    #[test]
    fn a_text_that_a_spreadsheet_would_compute_is_marked() {
        let mut table = Table::new("t", "").column("Title", "title", "").column("Force", "force_n", "N");
        for title in ["=1+1", "+1", "-1", "@SUM(A1)", "1=1"] {
            table = table.row(vec![Cell::text(title), Cell::Number(-1.0, 3)]);
        }
        let rows = "title,force_n\r\n'=1+1,-1\r\n'+1,-1\r\n'-1,-1\r\n'@SUM(A1),-1\r\n1=1,-1\r\n";
        assert_eq!(table.to_csv(CsvLocale::En), rows);
    }

    #[test]
    fn a_lone_missing_value_is_not_a_blank_line() {
        let table = Table::new("t", "").column("A", "a", "").row(vec![Cell::missing("none")]);
        assert_eq!(table.to_csv(CsvLocale::En), "a\r\n\"\"\r\n");
    }

    #[test]
    fn readers_with_a_decimal_comma_get_semicolons() {
        let table =
            Table::new("t", "").estimates("Force", "force_n", "N").column("Title, free", "title", "").row(vec![
                Cell::Estimate(palpate::fit::Estimate {
                    standard_error: Some(0.25),
                    interval: Some((-2.0, f64::INFINITY)),
                    ..palpate::fit::Estimate::fixed(-1.5)
                }),
                Cell::text("a;b 1.5, c"),
            ]);
        let expected =
            "force_n;force_n_standard_error;force_n_low;force_n_high;title\r\n-1,5;0,25;-2;;\"a;b 1.5, c\"\r\n";
        assert_eq!(table.to_csv(CsvLocale::De), expected);
    }
}
