//! What every basis function can do, from its file.

use super::continuous::diffusion::Diffusion;
use super::continuous::fractional_zener::MittagLeffler;
use super::continuous::fung_continuous::FungContinuous;
use super::continuous::latency::{FixedLatency, FreeLatency};
use super::continuous::logarithmic::Logarithm;
use super::continuous::power::{PowerDecay, PowerGrowth};
use super::continuous::stretched::Stretched;
use super::discrete::exponential::Exponential;
use super::discrete::maxwell::Straight;
use super::{BasisFunction, Kernel, ShapeParameter};

fn with<R>(basis: &BasisFunction, act: impl FnOnce(&dyn Kernel) -> R) -> R {
    match *basis {
        BasisFunction::Latency => act(&FreeLatency),
        BasisFunction::LatencyWith(exponent) => act(&FixedLatency { exponent }),
        BasisFunction::Exponential => act(&Exponential),
        BasisFunction::Stretched => act(&Stretched),
        BasisFunction::PowerDecay => act(&PowerDecay),
        BasisFunction::PowerGrowth => act(&PowerGrowth),
        BasisFunction::Logarithm => act(&Logarithm),
        BasisFunction::MittagLeffler => act(&MittagLeffler),
        BasisFunction::FungContinuous => act(&FungContinuous),
        BasisFunction::Diffusion => act(&Diffusion),
        BasisFunction::Straight => act(&Straight),
        BasisFunction::Custom(custom) => act(custom.kernel),
    }
}

impl Kernel for BasisFunction {
    fn parameters(&self) -> &'static [ShapeParameter] {
        with(self, |kernel| kernel.parameters())
    }

    fn decays(&self) -> bool {
        with(self, |kernel| kernel.decays())
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        with(self, |kernel| kernel.value(times, theta, value));
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        with(self, |kernel| kernel.gradient(times, theta, value, derivatives));
    }
}
