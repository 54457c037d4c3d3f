//! Figures observed from outside: well-formed, the same every time, and calm about odd data.

use palpate_report::figure::{Arrangement, Axis, Figure, FigureError, Layer, Map, Panel, Role};

fn time_panel() -> Panel {
    Panel::new(Axis::linear("Time", "s"), Axis::linear("Force", "N"))
}

fn ramp(count: usize) -> Vec<f64> {
    (0..count).map(|i| i as f64).collect()
}

fn map(x: Vec<f64>, y: Vec<f64>, values: Vec<f64>, label: &str, unit: &str) -> Map {
    let colours = Axis::linear(label, unit);
    Map { x, y, values, colours }
}

fn drawn(figure: &Figure) -> String {
    let svg = figure.to_svg().expect("a drawing");
    roxmltree::Document::parse(&svg).expect("well-formed");
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    svg
}

#[test]
fn every_kind_of_layer_is_well_formed_and_repeatable() {
    let x = ramp(50);
    let grid: Vec<f64> = (0..150).map(|i| f64::from(i).sin()).collect();
    let figure = Figure::new("all", "Everything & <more> \"quoted\"")
        .arrangement(Arrangement::Grid(2))
        .panel(
            time_panel()
                .title("a < b & c")
                .layer(Layer::span(3.0, 9.0, Role::Simulated).label("hold <1>"))
                .layer(Layer::band(x.clone(), x.clone(), ramp(50), Role::Fitted).label("95 %"))
                .layer(Layer::line(x.clone(), x.clone(), Role::Measured).label("F₀ & F¹"))
                .layer(Layer::points(x.clone(), x.clone(), Role::Series(3)).error_bars(&[0.5; 50]).label("'points'"))
                .layer(Layer::horizontal(10.0, Role::Reference).label("limit"))
                .layer(Layer::vertical(20.0, Role::Alternative(200)).label("start")),
        )
        .panel(time_panel().layer(Layer::map(map(x, ramp(3), grid, "Strain", "%"))));
    let svg = drawn(&figure);
    assert_eq!(svg, drawn(&figure));
    let document = roxmltree::Document::parse(&svg).expect("well-formed");
    assert_eq!(document.root_element().attribute("aria-label"), Some("Everything & <more> \"quoted\""));
    let texts: Vec<_> = document.descendants().filter_map(|node| node.text()).collect();
    assert!(texts.contains(&"a < b & c") && texts.contains(&"Time (s)"));
    assert!(!svg.contains(" id="));
    let png = figure.to_png(72.0).expect("a picture");
    assert_eq!(png, figure.to_png(72.0).expect("a picture"));
    assert_eq!(&png[1..4], b"PNG");
}

#[test]
fn stacked_panels_share_their_horizontal_axis() {
    let figure = Figure::new("two", "Two panels.")
        .panel(time_panel().layer(Layer::line(ramp(11), ramp(11), Role::Measured)))
        .panel(time_panel().layer(Layer::line(ramp(101), ramp(101), Role::Measured)));
    let svg = drawn(&figure);
    assert_eq!(svg.matches(">Time (s)<").count(), 1);
    let beside = drawn(&figure.arrangement(Arrangement::SideBySide));
    assert_eq!(beside.matches(">Time (s)<").count(), 2);
}

#[test]
fn data_with_nothing_to_show_say_so() {
    let nothing: [(Vec<f64>, Vec<f64>); 3] =
        [(vec![], vec![]), (vec![f64::NAN], vec![1.0]), (vec![1.0], vec![f64::INFINITY])];
    for (x, y) in nothing {
        for layer in [
            Layer::line(x.clone(), y.clone(), Role::Measured).label("gone"),
            Layer::points(x.clone(), y.clone(), Role::Measured).label("gone"),
            Layer::band(x.clone(), y.clone(), y.clone(), Role::Measured).label("gone"),
        ] {
            let svg = drawn(&Figure::new("none", "").panel(time_panel().layer(layer)));
            assert!(svg.contains("No data to show") && !svg.contains("gone"));
        }
    }
    drawn(&Figure::new("no-panels", ""));
    drawn(&Figure::new("bare", "").panel(time_panel()));
}

#[test]
fn odd_data_and_sizes_are_drawn_without_panic() {
    let odd = [
        vec![0.0; 5],
        vec![1e300, -1e300, 0.0, f64::NAN, 1.0],
        vec![5e-324, 1e-320, 0.0, 0.0, 0.0],
        vec![1e6, 1e6 + 1e-7, 1e6, 1e6, 1e6],
        vec![-1.0, f64::NAN, -2.0, f64::NEG_INFINITY, -3.0],
        vec![f64::MAX, f64::MIN, 0.0, 1.0, 2.0],
    ];
    for x in &odd {
        for y in &odd {
            for axis in [Axis::linear("q", ""), Axis::log("q", "Pa")] {
                let panel = Panel::new(axis.clone(), axis)
                    .layer(Layer::line(x.clone(), y.clone(), Role::Fitted).label("l"))
                    .layer(Layer::points(x.clone(), y.clone(), Role::Measured).error_bars(y).label("p"))
                    .layer(Layer::band(x.clone(), y.clone(), x.clone(), Role::Simulated))
                    .layer(Layer::map(map(x.clone(), y.clone(), vec![x[0]; 25], "m", "")))
                    .layer(Layer::span(y[1], x[0], Role::Measured).label("s"))
                    .layer(Layer::horizontal(y[3], Role::Reference).label("h"));
                drawn(&Figure::new("odd", "").width_mm(1.0).height_mm(f64::NAN).panel(panel));
            }
        }
    }
}

#[test]
fn columns_that_do_not_belong_together_are_refused() {
    let layer = Layer::line(ramp(3), ramp(2), Role::Measured);
    let error = Figure::new("bad", "").panel(time_panel().layer(layer)).to_svg();
    assert!(matches!(
        error,
        Err(FigureError::Length {
            found: 2,
            expected: 3,
            ..
        })
    ));
    let short = Layer::map(map(ramp(2), ramp(2), ramp(3), "", ""));
    let error = Figure::new("bad", "").panel(time_panel().layer(short)).to_svg();
    assert!(matches!(
        error,
        Err(FigureError::Length {
            found: 3,
            expected: 4,
            ..
        })
    ));
    assert!(matches!(Figure::new("big", "").to_png(1e9), Err(FigureError::Raster { .. })));
}

#[test]
fn a_long_noisy_record_stays_small() {
    let x = ramp(500_000);
    let noisy = |scale: f64| x.iter().map(|x| scale * (x * 1.7).sin()).collect::<Vec<_>>();
    let panel = |y: Vec<f64>| time_panel().layer(Layer::line(x.clone(), y, Role::Measured));
    let loops = time_panel().layer(Layer::line(noisy(3.0), noisy(1.0), Role::Measured));
    let figure = Figure::new("long", "").panel(panel(noisy(1.0))).panel(panel(noisy(20.0)));
    let svg = drawn(&figure.panel(loops));
    assert!(svg.len() < 300_000, "{}", svg.len());
}
