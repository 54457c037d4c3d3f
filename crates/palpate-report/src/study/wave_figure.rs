//! All layers over time: figure 7 of the paper as a map.

use palpate::simulate::StrainWave;

use crate::figure::{Arrangement, Axis, Figure, Layer, Panel, Role};

/// Strain of every layer as a map over time, and as lines.
#[must_use]
pub fn wave_figure(name: &str, wave: &StrainWave, caption: &str) -> Figure {
    let layers = wave.strain.len();
    let depth: Vec<f64> = (1..=layers).map(|i| i as f64).collect();
    let values = wave.strain.iter().flatten().copied().collect();
    let map = Panel::new(Axis::linear("Time", "s"), Axis::linear("Layer (1 = contact)", ""))
        .layer(Layer::map(wave.time.clone(), depth, values, "Strain", ""))
        .share(1.2);
    let mut lines = Panel::new(Axis::linear("Time", "s"), Axis::linear("Strain", ""));
    for (i, strain) in wave.strain.iter().enumerate() {
        // The contact, every second layer behind it, and the innermost.
        if i == 0 || i == layers - 1 || (i % 2 == 1 && layers <= 16) {
            let line = Layer::line(wave.time.clone(), strain.clone(), Role::Series((i / 2 + usize::from(i > 0)) as u8));
            lines = lines.layer(line.label(format!("layer {}", i + 1)));
        }
    }
    Figure::new(name, caption).panel(map).panel(lines).arrangement(Arrangement::Stacked)
}
