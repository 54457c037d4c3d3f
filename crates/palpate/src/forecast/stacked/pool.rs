//! All that a forecast is weighed by: what laws have predicted of the hold so far, and of other holds of the record.

use super::trial::Trial;
use super::weights::stacked;

/// What first parts of the other holds count together, where those of the hold itself count 1.
const OTHERS: f64 = 0.2;

/// The same for first parts that are as long as the hold itself.
const AS_LONG: f64 = 10.0;

/// An error that matters to nobody, as a share of the change.
const NEGLIGIBLE: f64 = 1e-6;

/// Trials by what is left out together: one of the hold itself, or all of another hold.
pub(super) struct Pool<'a> {
    /// Numbers of the members that are weighed.
    members: &'a [usize],
    groups: Vec<Group<'a>>,
}

/// Trials of another hold.
pub(super) struct OfAnother {
    /// Of its first parts.
    pub(super) trials: Vec<Trial>,
    /// Of a first part as long as the hold that is forecast, where it is longer.
    pub(super) as_long: Option<Trial>,
}

struct Group<'a> {
    trials: Vec<Counted<'a>>,
    /// Sum of the mean products of errors of two members, row by row.
    products: Vec<f64>,
}

struct Counted<'a> {
    trial: &'a Trial,
    /// Its share of the error.
    importance: f64,
    /// What its products are multiplied by, so that on one hold the least mean square error of a member is 1.
    scale: f64,
}

impl<'a> Pool<'a> {
    /// The trials of a hold and of others, each with that of a first part as long as the hold, where there is one.
    pub(super) fn new(members: &'a [usize], own: &'a [Trial], others: &'a [OfAnother]) -> Self {
        let group = |trials: Vec<Counted<'a>>| Group::new(trials, members);
        let own = counted(own, 1.0, members).map(|trial| group(vec![trial]));
        let mut groups: Vec<Group<'a>> = own.collect();
        let (count, longer) = (others.len() as f64, others.iter().filter(|other| other.as_long.is_some()).count());
        groups.extend(others.iter().map(|OfAnother { trials, as_long }| {
            // Their errors contain the noise of another hold, beside another change.
            let unlike = |part| Counted {
                importance: 0.0,
                ..part
            };
            let parts = counted(trials, OTHERS / count, members).map(unlike);
            group(parts.chain(counted(as_long, AS_LONG / longer as f64, members)).collect())
        }));
        Self { members, groups }
    }

    /// Weights of the members by all trials.
    pub(super) fn weights(&self) -> Vec<f64> {
        self.weights_without(None)
    }

    fn weights_without(&self, left_out: Option<usize>) -> Vec<f64> {
        let count = self.members.len();
        let mut sums = vec![0.0; count * count];
        let kept = self.groups.iter().enumerate().filter(|(index, _)| Some(*index) != left_out);
        for (_, group) in kept {
            sums.iter_mut().zip(&group.products).for_each(|(sum, product)| *sum += product);
        }
        stacked(&sums, count)
    }

    /// Root mean square of what the weights by the other groups would have been off by, over the change until the cut and ln(t/c) + 0.1, at the
    /// cuts of the hold and after first parts of others that are as long as it.
    pub(super) fn error(&self) -> f64 {
        let (mut square, mut importance) = (0.0, 0.0);
        for (index, group) in self.groups.iter().enumerate() {
            let weights = self.weights_without(Some(index));
            for Counted {
                trial,
                importance: counts,
                ..
            } in &group.trials
            {
                let errors = |node: usize| self.members.iter().map(move |member| trial.errors[*member][node]);
                let off = |node: usize| weights.iter().zip(errors(node)).map(|(w, error)| w * error).sum::<f64>();
                let nodes = trial.nodes.iter().enumerate();
                let squares = nodes.map(|(node, (weight, growth))| weight * (off(node) / growth).powi(2));
                square += counts * squares.sum::<f64>();
                importance += counts;
            }
        }
        (square / importance).sqrt()
    }
}

impl<'a> Group<'a> {
    fn new(trials: Vec<Counted<'a>>, members: &[usize]) -> Self {
        let sum = |i: usize, j: usize| trials.iter().map(|counted| counted.scale * counted.trial.product(i, j)).sum();
        let products = members.iter().flat_map(|i| members.iter().map(|j| sum(*i, *j)).collect::<Vec<f64>>()).collect();
        Self { trials, products }
    }
}

/// Trials of one hold that together count this much.
fn counted<'a>(
    trials: impl IntoIterator<Item = &'a Trial> + Clone,
    counts: f64,
    members: &[usize],
) -> impl Iterator<Item = Counted<'a>> {
    let all: f64 = trials.clone().into_iter().map(|trial| trial.importance).sum();
    let square = |member: &usize| -> f64 {
        trials.clone().into_iter().map(|trial| trial.importance * trial.product(*member, *member)).sum()
    };
    let least = members.iter().map(square).fold(f64::INFINITY, f64::min);
    let unit = if least.is_finite() { least.max(all * NEGLIGIBLE * NEGLIGIBLE) } else { 1.0 };
    trials.into_iter().map(move |trial| Counted {
        trial,
        importance: counts * trial.importance / all,
        scale: counts * trial.importance / unit,
    })
}
