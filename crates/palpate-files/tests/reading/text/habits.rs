//! The many ways in which machines write the same table.

use palpate_files::FileError;
use palpate_files::cell::{DecimalMark, Delimiter};
use palpate_files::formats::text::read_columns;
use palpate_files::input::{Encoding, Input};
use palpate_files::table::{ColumnKind, ReadOptions};

use super::{layout, layout_with, names, read, units, written};

fn utf16(text: &str, low_first: bool, mark: bool) -> Vec<u8> {
    let mark = mark.then_some(0xFEFF);
    mark.into_iter()
        .chain(text.encode_utf16())
        .flat_map(|unit: u16| if low_first { unit.to_le_bytes() } else { unit.to_be_bytes() })
        .collect()
}

#[test]
fn delimiters_and_decimal_marks() {
    for (text, delimiter, decimal) in [
        ("t,F\n0,1.5\n1,2.5\n", Delimiter::Comma, DecimalMark::Point),
        ("t;F\n0;1.5\n1;2.5\n", Delimiter::Semicolon, DecimalMark::Point),
        ("t;F\n0;1,5\n1;2,5\n", Delimiter::Semicolon, DecimalMark::Comma),
        ("t\tF\n0\t1,5\n1\t2,5\n", Delimiter::Tab, DecimalMark::Comma),
        ("t   F\n 0   1.5\n 1   2.5\n", Delimiter::Blanks, DecimalMark::Point),
        ("t F\n0 1,5\n1 2,5\n", Delimiter::Blanks, DecimalMark::Comma),
        ("t,F\n\"0\",\"1.5\"\n\"1\",\"2.5\"\n", Delimiter::Comma, DecimalMark::Point),
        ("t,F\n\"0\",\"1,5\"\n\"1\",\"2,5\"\n", Delimiter::Comma, DecimalMark::Comma),
    ] {
        let layout = layout(text);
        assert_eq!((layout.delimiter, layout.decimal), (delimiter, decimal), "{text}");
        assert_eq!(names(&layout), ["t", "F"], "{text}");
        let columns = read(text, &[1, 2]).expect("columns");
        assert_eq!(columns.values, [[0.0, 1.0], [1.5, 2.5]], "{text}");
    }
}

#[test]
fn encodings() {
    let text = "Zeit [s];Temp [°C]\n0,5;20,25\n1,5;21,25\n";
    let latin: Vec<u8> = text.chars().map(|character| character as u8).collect();
    for (bytes, encoding) in [
        (text.as_bytes().to_vec(), Encoding::Utf8),
        ([b"\xEF\xBB\xBF", text.as_bytes()].concat(), Encoding::Utf8),
        (latin, Encoding::Windows1252),
        (utf16(text, true, true), Encoding::Utf16Le),
        (utf16(text, false, true), Encoding::Utf16Be),
        (utf16(text, true, false), Encoding::Utf16Le),
        (utf16(text, false, false), Encoding::Utf16Be),
    ] {
        let layout = layout(&bytes);
        assert_eq!(layout.encoding, encoding);
        assert_eq!(names(&layout), ["Zeit", "Temp"]);
        assert_eq!(units(&layout), ["s", "°C"]);
        let columns = read(&bytes, &[2]).expect("columns");
        assert_eq!(columns.values, [[20.25, 21.25]]);
        assert_eq!(columns.line_of(1), Some(3));
    }
}

#[test]
fn chinese_machine_with_blank_first_line_and_units_row() {
    let text = b"\r\n\xCA\xB1\xBC\xE4,\xCE\xBB\xD2\xC6,\xC1\xA6\r\n(s),(mm),(N)\r\n\"0.0\",\"0.0\",\"-0.1\"\r\n\"0.1\",\"0.2\",\"0.3\"\r\n\r\n";
    let layout = layout(text);
    assert_eq!(layout.encoding, Encoding::Gbk);
    assert_eq!(names(&layout), ["时间", "位移", "力"]);
    assert_eq!(units(&layout), ["s", "mm", "N"]);
    assert_eq!((layout.header_line, layout.units_line), (Some(2), Some(3)));
    assert_eq!(layout.first_data_line, 4);
    let columns = read(text, &[3]).expect("columns");
    assert_eq!(columns.values, [[-0.1, 0.3]]);
    assert_eq!(columns.ignored.blank, 1);
}

#[test]
fn japanese_machine_in_shift_jis() {
    // 時間(s),変位(mm),荷重(N)
    let text = b"\x8E\x9E\x8A\xD4(s),\x95\xCF\x88\xCA(mm),\x89\xD7\x8F\x64(N)\r\n0.0,0.0,-0.1\r\n0.1,0.2,0.3\r\n";
    let layout = layout(text);
    assert_eq!(layout.encoding, Encoding::ShiftJis);
    assert_eq!(names(&layout), ["時間", "変位", "荷重"]);
    assert_eq!(units(&layout), ["s", "mm", "N"]);
    assert_eq!(read(text, &[3]).expect("columns").values, [[-0.1, 0.3]]);
}

#[test]
fn line_ends() {
    for end in ["\n", "\r\n", "\r"] {
        let text = ["t,F", "0,1.5", "1,2.5", ""].join(end);
        let columns = read(&text, &[2]).expect("columns");
        assert_eq!(columns.values, [[1.5, 2.5]]);
        assert_eq!(columns.line_of(0), Some(2));
        assert_eq!(columns.line_of(2), None);
    }
    assert_eq!(read("t,F\n0,1.5\n1,2.5", &[2]).expect("no end").rows(), 2);
}

#[test]
fn named_values_above_the_names() {
    let text = "Properties : Label,\"one\"\r\nProperties : Diameter,\"0.399\",mm\r\nTest : Rate,\"5.0\",mm/min\r\n\r\nExtension,Load,Count\r\n(mm),(N),\r\n\"0.0\",\"0.1\",\"0\"\r\n\"0.1\",\"0.2\",\"0\"\r\n";
    let layout = layout(text);
    assert_eq!(names(&layout), ["Extension", "Load", "Count"]);
    assert_eq!(units(&layout), ["mm", "N", "-"]);
    assert_eq!(layout.metadata.len(), 3);
    let diameter = &layout.metadata[1];
    assert_eq!(diameter.name, "Properties : Diameter");
    assert_eq!(diameter.value, "0.399");
    assert_eq!(diameter.unit.as_deref(), Some("mm"));
}

#[test]
fn units_in_the_names() {
    let text = "Force (N),displacement_mm,Force_N,Time_S,Kraft [N],Displacement / mm\n0,1,2,3,4,5.5\n1,2,3,4,5,6.5\n";
    let layout = layout(text);
    assert_eq!(names(&layout), ["Force", "displacement", "Force", "Time", "Kraft", "Displacement"]);
    assert_eq!(units(&layout), ["N", "mm", "N", "S", "N", "mm"]);
}

#[test]
fn units_on_a_line_without_brackets() {
    let text = "chem=PE;T=150;\nt\tstrain\tstress\ns\t-\tPa\n0.01\t1E-5\t10\n0.02\t2E-5\t10\n";
    let layout = layout(text);
    assert_eq!(names(&layout), ["t", "strain", "stress"]);
    assert_eq!(units(&layout), ["s", "-", "Pa"]);
    assert_eq!(layout.metadata.len(), 2);
}

#[test]
fn symbols_that_are_also_units() {
    let layout = layout("Operator,me\ns,F\n0,1.5\n1,2.5\n");
    assert_eq!(names(&layout), ["s", "F"]);
    assert_eq!(layout.units_line, None);
    assert_eq!(layout.metadata[0].value, "me");
}

#[test]
fn separator_reported_to_a_spreadsheet() {
    let layout = layout("sep=;\nt;F\n0;1,5\n1;2,5\n");
    assert_eq!((layout.header_line, layout.first_data_line), (Some(2), 3));
    assert_eq!(layout.metadata, []);
}

#[test]
fn index_column_and_no_header() {
    let indexed = layout(",Time,Force\n0,1724504945.19,0.5\n1,1724504945.20,0.6\n");
    assert_eq!(names(&indexed), ["-", "Time", "Force"]);
    let bare = layout("0.5,1.5\n0.6,1.6\n");
    assert_eq!((bare.header_line, bare.first_data_line), (None, 1));
    assert_eq!(names(&bare), ["-", "-"]);
    let labelled = layout("\"Time\" \"Force\"\n\"1\" 0.5 1.5\n\"2\" 0.6 1.6\n");
    assert_eq!(names(&labelled), ["-", "Time", "Force"]);
}

#[test]
fn text_columns_and_trailing_delimiter() {
    let text = "Set,Cycle,Time_S,Force_N,\nfoam one,1-Hold,0.1,2.5,\nfoam one,1-Hold,0.2,2.6,\n";
    let layout = layout(text);
    let kinds: Vec<ColumnKind> = layout.columns.iter().map(|column| column.kind).collect();
    let (word, number) = (ColumnKind::Text, ColumnKind::Number);
    assert_eq!(kinds, [word, word, number, number]);
    assert_eq!(layout.columns[1].sample, "1-Hold");
    assert_eq!(read(text, &[4, 3]).expect("columns").values, [[2.5, 2.6], [0.1, 0.2]]);
}

#[test]
fn comments_and_titles_above() {
    let text = "# made by hand\n# Length: 12.5 mm\n# time (s)  force (N)\n 0.0  1.0\n 0.1  1.5\n";
    let layout = layout(text);
    assert_eq!(names(&layout), ["time", "force"]);
    assert_eq!(units(&layout), ["s", "N"]);
    assert_eq!(layout.metadata[0].unit.as_deref(), Some("mm"));
}

#[test]
fn rheometer_export() {
    let text = "Test:\tstep\r\nInterval:\t1\r\nPoint No.\tTime\tStress\tStatus\r\n\t\t\t\r\n\t[s]\t[Pa]\t\r\n1\t0,010\t1,1347E+05\tDy_auto\r\n2\t0,021\t-2,9152\tDy_auto\r\n\r\n";
    let layout = layout(utf16(text, true, true));
    assert_eq!(names(&layout), ["Point No.", "Time", "Stress", "Status"]);
    assert_eq!(units(&layout), ["-", "s", "Pa", "-"]);
    assert_eq!(layout.metadata[0].value, "step");
    let columns = read(utf16(text, true, true), &[3]).expect("columns");
    assert_eq!(columns.values, [[113_470.0, -2.9152]]);
}

#[test]
fn footer_is_passed_over_and_reported() {
    let text = "t,F\n0,1.5\n\n1,2.5\n\nEnd of test\nOperator,me\n,\n,,\n";
    let columns = read(text, &[1, 2]).expect("columns");
    assert_eq!(columns.rows(), 2);
    assert_eq!(columns.ignored.blank, 4);
    let footer = columns.ignored.footer.as_ref().expect("a footer");
    assert_eq!((footer.first_line, footer.lines), (6, 2));
    assert_eq!(footer.sample, "End of test");
    assert_eq!((columns.line_of(0), columns.line_of(1)), (Some(2), Some(4)));
}

#[test]
fn summary_behind_the_data_is_no_row() {
    // Only the second column is requested, but the first tells the summary from a row.
    let columns = read("t,F\n0,1.5\n1,2.5\nMax,2.5\n", &[2]).expect("columns");
    assert_eq!(columns.values, [[1.5, 2.5]]);
    assert!(columns.ignored.footer.is_some());
}

#[test]
fn columns_in_any_order_and_repeated() {
    let columns = read("1,2,3.5\n4,5,6.5\n", &[3, 1, 3]).expect("columns");
    assert_eq!(columns.values, [[3.5, 6.5], [1.0, 4.0], [3.5, 6.5]]);
}

#[test]
fn options_override() {
    let fixed = ReadOptions {
        decimal: Some(DecimalMark::Comma),
        ..ReadOptions::default()
    };
    let thousands = "1,234;5,678\n2,345;6,789\n";
    assert_eq!(layout_with(thousands, &fixed).expect("a layout").decimal, DecimalMark::Comma);
    let named = ReadOptions {
        header: Some(true),
        ..ReadOptions::default()
    };
    let numbered = layout_with("0,1\n0.5,1.5\n0.6,1.6\n", &named).expect("a layout");
    assert_eq!((names(&numbered), numbered.first_data_line), (vec!["0", "1"], 2));
    let nameless = ReadOptions {
        header: Some(false),
        ..ReadOptions::default()
    };
    assert_eq!(layout_with("t,F\n0,1.5\n1,2.5\n", &nameless).expect("a layout").header_line, None);
    let skipping = ReadOptions {
        skip_lines: Some(2),
        ..ReadOptions::default()
    };
    let skipped = layout_with("7,8\nold,names\nt,F\n0,1.5\n", &skipping).expect("a layout");
    assert_eq!((skipped.header_line, skipped.first_data_line), (Some(3), 4));
    let blanks = ReadOptions {
        delimiter: Some(Delimiter::Blanks),
        encoding: Some(Encoding::Windows1252),
        ..ReadOptions::default()
    };
    let layout = layout_with("1\t2.5\n2\t3.5\n", &blanks).expect("a layout");
    assert_eq!((layout.delimiter, layout.encoding), (Delimiter::Blanks, Encoding::Windows1252));
}

#[test]
fn progress_reaches_the_end() {
    let rows: String = (0..200_000).map(|row| format!("{row},0.25\n")).collect();
    let file = written(&rows);
    let layout = layout(&rows);
    let mut reported = Vec::new();
    let input = Input::open(&file.path).expect("a file");
    let columns = read_columns(&input, &layout, &[1, 2], &mut |done, total| {
        reported.push((done, total));
        Ok(())
    })
    .expect("columns");
    assert_eq!(columns.rows(), 200_000);
    assert_eq!(columns.values[0][199_999], 199_999.0);
    assert_eq!(columns.line_of(199_999), Some(200_000));
    let size = rows.len() as u64;
    assert_eq!(columns.bytes, size);
    assert_eq!(reported.last(), Some(&(size, size)));
    assert!(reported.len() > 5 && reported.is_sorted());
}

/// Long files are read many rows at once, on all processors, wherever rows are plain; nobody can tell.
#[test]
fn a_long_file_is_read_like_a_short_one() {
    const ROWS: usize = 300_000;
    for end in ["\n", "\r\n", "\r"] {
        let mut text = format!("Time (s),Displacement (mm),Force (N){end}");
        for row in 0..ROWS {
            match row {
                90_000 => text.push_str(&format!("{end}{row},\"1.5\",-2e-3{end}")),
                150_000 => text.push_str(&format!("{row} , +1.5, -.002{end}")),
                _ => text.push_str(&format!("{row},1.5,-0.002{end}")),
            }
        }
        let footer = format!("{text}end of test{end}");
        let columns = read(&footer, &[1, 3]).expect("columns");
        assert_eq!(columns.rows(), ROWS, "{end:?}");
        assert!(columns.values[0].iter().enumerate().all(|(row, time)| *time == row as f64), "{end:?}");
        assert!(columns.values[1].iter().all(|force| *force == -0.002), "{end:?}");
        assert_eq!((columns.ignored.blank, columns.ignored.footer.map(|footer| footer.lines)), (1, Some(1)), "{end:?}");
        let columns = read(&text, &[2]).expect("columns");
        // One line of names, one blank line before row 90,000.
        let lines = [0, 89_999, 90_000, ROWS - 1].map(|row| columns.line_of(row));
        assert_eq!(lines, [Some(2), Some(90_001), Some(90_003), Some(ROWS + 2)], "{end:?}");
        let broken = text.replacen("200000,1.5", "200000,x", 1);
        let error = read(&broken, &[1, 2, 3]).expect_err("a word").to_string();
        assert!(error.contains("line 200003") && error.contains("column 2"), "{end:?}: {error}");
    }
}

/// Odd lines anywhere in a long file: with its first cells in quotes, so that every row is read with care, it gives the same.
#[test]
fn odd_lines_in_a_long_file_are_observed_as_in_any() {
    const ODD: [&str; 8] = ["", " 1.5 , 2,3", "+1,2,3", "1e0,2,3", "1,2,3,", "1,2", "x,y,z", "1,2\r,3"];
    let mut state = 7_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for run in 0..6 {
        let rows = 30_000 + random(40_000);
        let odd: Vec<(usize, &str)> = (0..random(4)).map(|_| (random(rows), ODD[random(ODD.len())])).collect();
        let text = |quote: &str| {
            let mut text = "a,b,c\n".to_owned();
            for row in 0..rows {
                match odd.iter().find(|(place, _)| *place == row) {
                    Some((_, line)) => text.push_str(line),
                    None => text.push_str(&format!("{quote}{row}{quote},{}.25,-{}", row % 977, row % 13)),
                }
                text.push('\n');
            }
            text
        };
        // Without the folder of the file.
        let message = |error: FileError| error.to_string().rsplit('/').next().map(str::to_owned);
        let outcome = |text: String| read(text, &[1, 2, 3]).map_err(message);
        match (outcome(text("")), outcome(text("\""))) {
            (Ok(plain), Ok(careful)) => {
                assert_eq!(plain.values, careful.values, "{run}: {odd:?}");
                assert_eq!(plain.ignored.blank, careful.ignored.blank, "{run}: {odd:?}");
                let lines = [0, rows / 2, plain.rows() - 1];
                assert_eq!(
                    lines.map(|row| plain.line_of(row)),
                    lines.map(|row| careful.line_of(row)),
                    "{run}: {odd:?}"
                );
            }
            (plain, careful) => assert_eq!(plain.err(), careful.err(), "{run}: {odd:?}"),
        }
    }
}

/// Numbers above 999 of a German, an English and a Swiss machine were refused.
#[test]
fn thousands_are_read_where_the_column_shows_them() {
    for text in [
        "t;F\n0,0;998,5\n0,1;1.185,1\n0,2;-1.001\n0,3;12.345,5\n",
        "t;F\n0.0;998.5\n0.1;1,185.1\n0.2;-1,001\n0.3;12,345.5\n",
        "t;F\n0.0;998.5\n0.1;1'185.1\n0.2;-1'001\n0.3;12'345.5\n",
        "t;F\n0,0;998,5\n0,1;1 185,1\n0,2;-1 001\n0,3;12 345,5\n",
        "t,F\n0.0,998.5\n0.1,\"1,185.1\"\n0.2,\"-1,001\"\n0.3,\"12,345.5\"\n",
    ] {
        let found = read(text, &[1, 2]).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(found.values, [vec![0.0, 0.1, 0.2, 0.3], vec![998.5, 1185.1, -1001.0, 12_345.5]], "{text}");
        assert!(layout(text).to_string().contains("thousands set off"), "{text}");
    }
    // Latin-1 has the blank that breaks no line in one byte.
    let latin = read(b"t;F (\xb5N)\n0,0;998,5\n0,1;1\xa0185,1\n", &[2]).expect("Latin-1");
    assert_eq!(latin.values, [vec![998.5, 1185.1]]);
    // Three decimals of one column beside decimal commas of another.
    assert!(read("t;F\n0,1;1.185\n0,2;1.190\n", &[1, 2]).is_err());
}

/// A line of statistics with a number a column was refused as a faulty row.
#[test]
fn statistics_below_the_rows_are_a_footer() {
    for (text, lines) in [
        ("t,d,F\n0,1,1.5\n1,2,2.5\nMax,2,2.5\n", 1),
        ("t,d,F\n0,1,1.5\n1,2,2.5\n\nMaximum,2,2.5\nMinimum,1,1.5\nMean value,1.5,2\nStd. dev.,0.5,0.5\n", 4),
        ("t;d;F\n0;1;1,5\n1;2;2,5\nMittelwert;1,5;2\nStandardabweichung;0,5;0,5\n", 2),
    ] {
        let columns = read(text, &[1, 2, 3]).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(columns.values, [[0.0, 1.0], [1.0, 2.0], [1.5, 2.5]], "{text}");
        assert_eq!(columns.ignored.footer.map(|footer| footer.lines), Some(lines), "{text}");
    }
    // Any other word is a row that is damaged, and statistics between rows are no footer.
    assert!(read("t,d,F\n0,1,1.5\nx,2,2.5\n", &[1, 2, 3]).is_err());
    assert!(read("t,d,F\n0,1,1.5\nMax,1,1.5\n1,2,2.5\n", &[1, 2, 3]).is_err());
}

#[test]
fn russian_and_korean_machines() {
    let russian = "Время, с; Сила, Н; Перемещение, мм\n0,0;0,5;1,5\n0,1;0,6;1,6\n";
    let korean = "시간(s), 하중(N), 변위(mm)\n0.0,0.5,1.5\n0.1,0.6,1.6\n";
    for (text, encoding) in [
        (russian, Encoding::Utf8),
        (russian, Encoding::Windows1251),
        (korean, Encoding::Utf8),
        (korean, Encoding::EucKr),
    ] {
        let codec = if encoding == Encoding::EucKr { encoding_rs::EUC_KR } else { encoding_rs::WINDOWS_1251 };
        let bytes = if encoding == Encoding::Utf8 {
            text.as_bytes().to_vec()
        } else {
            codec.encode(text).0.into_owned()
        };
        let layout = layout(&bytes);
        assert_eq!(layout.encoding, encoding);
        assert_eq!(read(&bytes, &[2]).expect("columns").values, [[0.5, 0.6]]);
        assert!(matches!(units(&layout)[..], ["с", "Н", "мм"] | ["s", "N", "mm"]), "{:?}", units(&layout));
    }
}

/// A stated decimal mark left `1,234` a text.
#[test]
fn a_stated_decimal_mark_makes_thousands_of_the_other() {
    for (text, mark, values) in [
        ("t;F\n0;1,900\n1;1,910\n", DecimalMark::Point, [1900.0, 1910.0]),
        ("t;F\n0;1,900\n1;1,910\n", DecimalMark::Comma, [1.9, 1.91]),
        ("t;F\n0,1;2.000\n0,2;2.010\n", DecimalMark::Comma, [2000.0, 2010.0]),
    ] {
        assert!(layout_with(text, &ReadOptions::default()).is_err(), "{text}");
        let options = ReadOptions {
            decimal: Some(mark),
            ..ReadOptions::default()
        };
        let file = written(text);
        let input = Input::open(&file.path).expect("a file");
        let layout = layout_with(text, &options).expect("a layout");
        let columns = read_columns(&input, &layout, &[2], &mut |_, _| Ok(())).expect("columns");
        assert_eq!(columns.values, [values], "{text}");
    }
}
