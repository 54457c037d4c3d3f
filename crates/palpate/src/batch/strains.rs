//! Strains of all layers of all contacts.

use fearless_simd::{Simd, dispatch};

use super::cascade::{self, Cascade, Stack};
use super::contacts::{Batch, BatchError};
use super::parallel::for_each_part;
use super::stops::Stops;
use crate::simulate::{Sampling, SimulateError, strain_wave};
use crate::vector::level;

/// Strain of every layer of every contact of a batch.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerStrains {
    /// Contact by contact, sample by sample, `stride` layers each.
    strains: Vec<f64>,
    layers: Vec<usize>,
    samples: usize,
    stride: usize,
}

impl LayerStrains {
    /// Strains of the layers of a contact at a sample, the contact layer first.
    ///
    /// # Panics
    /// If there is no such contact or sample.
    #[must_use]
    pub fn of(&self, contact: usize, sample: usize) -> &[f64] {
        assert!(sample < self.samples, "sample {sample} of {}", self.samples);
        &self.strains[(contact * self.samples + sample) * self.stride..][..self.layers[contact]]
    }
}

impl Batch {
    /// Strain of every layer of every contact at rising `times` (s), which lie inside its motion.
    ///
    /// `tolerance` is the error allowed in a step of a node, in units of what the surface travels at most, from 10⁻¹³ to 0.01.
    /// The strain of a layer is m differences of nodes: 10⁻⁹ gives it to 10⁻⁷ or better.
    ///
    /// # Errors
    /// As for [`forces_at`](Self::forces_at); [`BatchError::Tolerance`]; [`SimulateError::FractionalLayers`] for a contact whose number
    /// of layers is not whole.
    ///
    /// ```
    /// use palpate::batch::Batch;
    /// use palpate::simulate::Separation;
    /// use palpate::test_problems::{paper_ball, paper_test_a};
    ///
    /// let batch = Batch::shared(&vec![paper_ball(Separation::Bonded); 20], &paper_test_a())?;
    /// let strains = batch.strains_at(&[0.6, 43.0], 1e-10)?;
    /// // excess 0.133032493898 on top of 12.5 mm/35 mm in the contact layer
    /// assert!((strains.of(7, 1)[0] - (0.133_032_493_898 + 12.5 / 35.0)).abs() < 1e-8);
    /// assert_eq!(strains.of(7, 1).len(), 8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn strains_at(&self, times: &[f64], tolerance: f64) -> Result<LayerStrains, BatchError> {
        if !(1e-13..=0.01).contains(&tolerance) {
            return Err(BatchError::Tolerance { found: tolerance });
        }
        self.check_times(times)?;
        if let Some(index) = self.layers.iter().position(|m| m.fract() != 0.0 || *m >= 1e6) {
            let found = self.layers[index];
            let source = SimulateError::FractionalLayers { found };
            return Err(BatchError::Contact { index, source });
        }
        let stride = self.layers.iter().fold(0.0, |most: f64, m| most.max(*m)) as usize;
        let row = times.len() * stride;
        let mut strains = vec![0.0; self.len() * row];
        for_each_part(&mut strains, cascade::GROUP * row, |index, part| {
            dispatch!(level(), simd => self.strains_of(simd, index * cascade::GROUP, times, (tolerance, stride), part));
        });
        self.one_by_one(&mut strains, row, |model, motion| {
            let wave = strain_wave(motion, model, &Sampling::Times(times.to_vec()))?;
            let at = |sample: usize, layer: usize| wave.strain.get(layer).map_or(0.0, |strain| strain[sample]);
            Ok((0..row).map(|i| at(i / stride, i % stride)).collect())
        })?;
        let strains = self.checked(strains, row, None)?;
        Ok(LayerStrains {
            strains,
            layers: self.layers.iter().map(|m| *m as usize).collect(),
            samples: times.len(),
            stride,
        })
    }

    /// The strains of one group, contact by contact and sample by sample.
    #[inline(always)]
    pub(super) fn strains_of<S: Simd>(
        &self,
        simd: S,
        first: usize,
        times: &[f64],
        (tolerance, stride): (f64, usize),
        part: &mut [f64],
    ) {
        const L: usize = cascade::GROUP;
        let mut stops = Stops::<L>::new(self, first);
        let (depth, layers) = (stops.column(&self.depth), stops.column(&self.layers));
        let (begin, end) = (stops.time, stops.ends());
        let stack = Stack::new(
            stops.column(&self.exponent),
            stops.column(&self.rate_coefficient),
            layers,
            std::array::from_fn(|lane| end[lane] - begin[lane]),
        );
        let reach = stops.farthest();
        let allowed = std::array::from_fn(|lane| tolerance * (reach[lane] / depth[lane]).max(f64::MIN_POSITIVE));
        let start = stops.displacement();
        let mut cascade = Cascade::new(&stack, allowed, std::array::from_fn(|lane| start[lane] / depth[lane]));
        let mut width = [0.0; L];
        for (sample, &time) in times.iter().enumerate() {
            while let Some(leg) = stops.next(&[time; L]) {
                let (mut surface, mut speed) = ([0.0; L], [0.0; L]);
                for lane in 0..L {
                    surface[lane] = leg.from[lane] / depth[lane];
                    speed[lane] = leg.speed[lane] / depth[lane];
                    if leg.is_new[lane] {
                        width[lane] = leg.piece[lane] / 64.0;
                    }
                }
                cascade.advance(simd, &stack, (&surface, &speed), &leg.elapsed, width);
                width = cascade.width();
            }
            let u = stops.displacement();
            for (lane, row) in part.chunks_exact_mut(times.len() * stride).enumerate() {
                let row = &mut row[sample * stride..][..layers[lane] as usize];
                let mut outer = u[lane] / depth[lane];
                for (layer, strain) in row.iter_mut().enumerate() {
                    let inner = if layer + 1 < layers[lane] as usize { cascade.nodes()[layer * L + lane] } else { 0.0 };
                    *strain = layers[lane] * (outer - inner);
                    outer = inner;
                }
            }
        }
    }
}
