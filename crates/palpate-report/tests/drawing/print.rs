//! Figures for print: files of every format, and widths of journals.

use std::io::Read as _;

use flate2::read::ZlibDecoder;
use palpate_report::figure::{Arrangement, Axis, Column, Figure, Layer, Map, Panel, PictureFormat, Role};

/// So many panels with titles, points, a band and a name on a line.
fn figure(panels: usize) -> Figure {
    let x: Vec<f64> = (1..60).map(f64::from).collect();
    let y: Vec<f64> = x.iter().map(|x| 3.0 + x.powf(-0.3)).collect();
    let panel = |number: usize| {
        Panel::new(Axis::log("Time", "s"), Axis::linear("Force", "N"))
            .title(format!("Hold {number}"))
            .layer(Layer::band(x.clone(), y.clone(), y.iter().map(|y| y + 0.1).collect(), Role::Fitted).label("95 %"))
            .layer(Layer::points(x.clone(), y.clone(), Role::Measured).label("measured"))
            .layer(Layer::horizontal(3.0, Role::Reference).label("F₀"))
    };
    Figure::new("holds", "Holds.")
        .arrangement(Arrangement::Grid(3))
        .height_mm(62.0 * panels.div_ceil(3) as f64)
        .panels((1..=panels).map(panel))
}

/// Everything that a PDF keeps packed, unpacked.
fn streams(pdf: &[u8]) -> Vec<Vec<u8>> {
    let (begin, end) = (b"stream\n", b"\nendstream");
    let find =
        |from: usize, what: &[u8]| pdf[from..].windows(what.len()).position(|found| found == what).map(|at| from + at);
    let (mut all, mut from) = (Vec::new(), 0);
    while let Some(start) = find(from, begin).map(|at| at + begin.len()) {
        let stop = find(start, end).expect("an end");
        let mut bytes = Vec::new();
        ZlibDecoder::new(&pdf[start..stop]).read_to_end(&mut bytes).expect("packed by zlib");
        all.push(bytes);
        from = stop + end.len();
    }
    all
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_pdf_has_its_typeface_inside_and_its_text_as_text() {
    let pdf = figure(2).to_file(PictureFormat::Pdf).expect("a PDF");
    assert_eq!(pdf, figure(2).to_file(PictureFormat::Pdf).expect("a PDF"));
    let plain = text(&pdf);
    assert!(
        plain.starts_with("%PDF-1.") && plain.contains("+Arimo-Bold") && plain.contains("/FontFile2"),
        "{plain}"
    );
    assert!(!plain.contains("CreationDate"));
    // 174 mm and 62 mm in points of 1/72 inch.
    assert!(plain.contains("/MediaBox [0 0 493.2"), "{plain}");
    let streams = streams(&pdf);
    let (maps, marks): (Vec<_>, Vec<_>) =
        streams.iter().map(|stream| text(stream)).partition(|stream| stream.contains("beginbfchar"));
    for letter in "Force (N)HoldTime".chars().filter(|letter| *letter != ' ') {
        let code = format!("> <{:04X}>", u32::from(letter));
        assert!(maps.iter().any(|map| map.contains(&code)), "{letter}");
    }
    let shown: usize = marks.iter().map(|marks| marks.matches(" Tj").count() + marks.matches(">Tj").count()).sum();
    assert!(shown > 40, "{shown} glyphs");
}

#[test]
fn a_heat_map_in_a_pdf_is_the_picture_of_its_svg() {
    let colours = Axis::linear("Strain", "");
    let (x, y, values) = (vec![0.0, 1.0], vec![0.0, 1.0], vec![0.0, 1.0, 2.0, f64::NAN]);
    let panel =
        Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m")).layer(Layer::map(Map { x, y, values, colours }));
    let pdf = Figure::new("map", "").panel(panel).to_file(PictureFormat::Pdf).expect("a PDF");
    let plain = text(&pdf);
    let side = |name: &str| {
        let (_, rest) = plain.split_once(&format!("/{name} ")).expect("a picture");
        rest.split(|c: char| !c.is_ascii_digit())
            .next()
            .and_then(|digits| digits.parse::<usize>().ok())
            .expect("a size")
    };
    let (width, height) = (side("Width"), side("Height"));
    let pixels = streams(&pdf).into_iter().find(|stream| stream.len() == 3 * width * height).expect("its pixels");
    let at = |x: usize, y: usize| pixels[3 * (y * width + x)..][..3].to_vec();
    // Rows of a picture go down: the cell without a value is at the top on the right, the lowest value at the bottom on the left.
    assert_eq!(at(width - 1, 0), [0xE4, 0xE4, 0xE4]);
    assert_eq!(at(0, height - 1), [0x44, 0x01, 0x54]);
    assert_eq!(at(0, 0), [0xFD, 0xE7, 0x25]);
}

#[test]
fn a_figure_fits_the_column_and_the_page_and_loses_no_panel() {
    for (column, width, parts) in [(Column::Single, "85mm", 3), (Column::Double, "174mm", 2)] {
        let figures = figure(12).for_column(column);
        assert_eq!(figures.len(), parts);
        let mut titles = Vec::new();
        for figure in &figures {
            let svg = figure.to_svg().expect("a drawing");
            let document = roxmltree::Document::parse(&svg).expect("well-formed");
            let root = document.root_element();
            assert_eq!(root.attribute("width"), Some(width));
            let height: f64 =
                root.attribute("height").and_then(|h| h.strip_suffix("mm")?.parse().ok()).expect("a height");
            assert!(height <= 225.0, "{height}");
            for node in document.descendants().filter(|node| node.has_tag_name("text")) {
                let size: f64 =
                    node.ancestors().find_map(|node| node.attribute("font-size")?.parse().ok()).expect("a size");
                assert!(size >= 7.0, "{size} pt in print");
            }
            titles.extend(
                document
                    .descendants()
                    .filter(|node| node.has_tag_name("text"))
                    .filter_map(|node| node.text())
                    .filter(|text| text.starts_with("Hold "))
                    .map(str::to_owned),
            );
        }
        assert_eq!(titles, (1..=12).map(|number| format!("Hold {number}")).collect::<Vec<_>>());
    }
    let [single] = &figure(1).for_column(Column::Single)[..] else {
        panic!("one figure")
    };
    assert_eq!(single.name, "holds");
}
