//! All layers over time: figure 7 of the paper as a map.

use palpate::simulate::StrainWave;

use crate::figure::{Axis, Figure, Layer, Map, Panel, Role};

/// Strain of every layer as a map over time, and as lines.
#[must_use]
pub fn wave_figure(name: &str, wave: &StrainWave, caption: &str) -> Figure {
    let layers = wave.strain.len();
    let strains = Map {
        x: wave.time.clone(),
        y: (1..=layers).map(|i| i as f64).collect(),
        values: wave.strain.iter().flatten().copied().collect(),
        colours: Axis::linear("Strain", ""),
    };
    let map = Panel::over_time("Layer (1 = contact)", "").layer(Layer::map(strains)).share(1.2);
    let mut lines = Panel::over_time("Strain", "");
    for (series, layer) in shown(layers).into_iter().enumerate() {
        let line = Layer::line(wave.time.clone(), wave.strain[layer].clone(), Role::Series(series as u8));
        lines = lines.layer(line.label(format!("layer {}", layer + 1)));
    }
    Figure::new(name, caption).panel(map).panel(lines)
}

/// Layers that have a line: the contact, every second one behind it, and the innermost; of many the contact, the quarters and the innermost.
fn shown(layers: usize) -> Vec<usize> {
    let innermost = layers - 1;
    let between: Vec<usize> = if layers <= 16 {
        (1..innermost).step_by(2).collect()
    } else {
        (1..=3).map(|quarter| quarter * layers / 4 - 1).collect()
    };
    let mut shown: Vec<usize> = [0].into_iter().chain(between).chain([innermost]).collect();
    shown.dedup();
    shown
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::Mark;

    #[test]
    fn few_or_many_layers_each_have_a_colour_of_their_own() {
        assert_eq!(shown(1), [0]);
        assert_eq!(shown(2), [0, 1]);
        assert_eq!(shown(8), [0, 1, 3, 5, 7]);
        assert_eq!(shown(9), [0, 1, 3, 5, 7, 8]);
        assert_eq!(shown(512), [0, 127, 255, 383, 511]);
        let wave = StrainWave {
            time: vec![0.0, 1.0],
            strain: vec![vec![0.0, 0.1]; 512],
            displacement: vec![vec![0.0, 0.1]; 512],
            work: palpate::simulate::SimulationWork::default(),
        };
        let figure = wave_figure("layers", &wave, "Many layers.");
        let lines = &figure.panels[1].layers;
        assert!(lines.iter().all(|layer| matches!(layer.mark, Mark::Line { .. })));
        let roles: Vec<Role> = lines.iter().map(|layer| layer.role).collect();
        assert_eq!(roles, [0, 1, 2, 3, 4].map(Role::Series));
    }
}
