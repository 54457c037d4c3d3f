//! A law made ready for a fit: which numbers are free, and within which bounds.

use crate::laws::{BasisFunction, Column, Form, Kernel, Loading, NumberKind, Superposition};
use crate::optimise::{Few, Shapes, Spare, Termination};

/// A nonlinear number of the law.
#[derive(Debug, Clone)]
pub(crate) struct Number {
    /// Which shape has it.
    pub(crate) shape: usize,
    /// Its name in results.
    pub(crate) name: String,
    pub(crate) kind: NumberKind,
    /// Bounds in the units of the fit.
    pub(crate) bounds: (f64, f64),
    /// Held at this value, in the units of the fit.
    pub(crate) fixed: Option<f64>,
}

/// A law with some numbers held, some bounded, in the units of the fit (times over the hold's duration).
#[derive(Debug, Clone)]
pub(crate) struct Model {
    pub(crate) form: Form,
    /// Whether the constant is one of the linear numbers.
    pub(crate) constant: bool,
    /// All nonlinear numbers, shape by shape.
    pub(crate) numbers: Vec<Number>,
    /// Bounds of every linear number.
    pub(crate) linear_bounds: Vec<(f64, f64)>,
    /// Which of `numbers` are free.
    pub(crate) free: Vec<usize>,
    columns: Vec<Column>,
    /// What shapes are averaged over; none for a step.
    pub(crate) loading: Option<Superposition>,
}

impl Model {
    pub(crate) fn new(form: Form, constant: bool, numbers: Vec<Number>, linear_bounds: Vec<(f64, f64)>) -> Self {
        let free = (0..numbers.len()).filter(|&i| numbers[i].fixed.is_none()).collect();
        let columns = form.shapes.iter().map(|shape| Column::of(shape, form.response)).collect();
        Self {
            form,
            constant,
            numbers,
            linear_bounds,
            free,
            columns,
            loading: None,
        }
    }

    /// The same after a loading, its times in the units of the fit, rather than a step; to a law that knows no superposition it is one.
    pub(crate) fn after(self, loading: &Loading) -> Self {
        let superposes = self.form.shapes.iter().any(BasisFunction::superposes);
        Self {
            loading: superposes.then(|| Superposition::new(loading)),
            ..self
        }
    }

    /// Linear numbers.
    pub(crate) fn linear(&self) -> usize {
        usize::from(self.constant) + self.form.shapes.len()
    }

    /// Names of the numbers that are sought, the nonlinear ones as asked for.
    pub(crate) fn names(&self, of: impl Fn(&Number) -> String) -> Vec<String> {
        let constant = self.constant.then(|| self.form.constant_name().to_owned());
        let nonlinear = self.free().map(of);
        constant.into_iter().chain(self.form.amplitude_names()).chain(nonlinear).collect()
    }

    /// Free nonlinear numbers.
    pub(crate) fn free(&self) -> impl ExactSizeIterator<Item = &Number> {
        self.free.iter().map(|&i| &self.numbers[i])
    }

    /// All nonlinear numbers where the free ones have these values.
    pub(crate) fn complete(&self, theta: &[f64]) -> Few {
        let mut all: Few = self.numbers.iter().map(|number| number.fixed.unwrap_or(0.0)).collect();
        for (&i, value) in self.free.iter().zip(theta) {
            all[i] = *value;
        }
        all
    }

    /// Range of the numbers of a shape among all.
    pub(crate) fn numbers_of(&self, shape: usize) -> std::ops::Range<usize> {
        let from = self.numbers.iter().position(|number| number.shape == shape).unwrap_or(self.numbers.len());
        from..from + self.form.shapes[shape].numbers().len()
    }

    /// One shape as it stands in the signal, at all its numbers.
    pub(crate) fn shape_value(&self, shape: usize, times: &[f64], numbers: &[f64], value: &mut [f64]) {
        match &self.loading {
            None => self.form.shapes[shape].value(times, numbers, value),
            Some(loading) => loading.value(&self.form.shapes[shape], times, numbers, value),
        }
        orient(value, self.columns[shape]);
    }

    /// One shape and its derivatives, as they stand in the signal but for offset and sign.
    fn gradient(&self, shape: usize, times: &[f64], numbers: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        match &self.loading {
            None => self.form.shapes[shape].gradient(times, numbers, value, derivatives),
            Some(loading) => loading.gradient(&self.form.shapes[shape], times, numbers, value, derivatives),
        }
    }

    /// Shapes that have a free number, and those that have none.
    pub(crate) fn moving(&self) -> (Vec<usize>, Vec<usize>) {
        (0..self.form.shapes.len()).partition(|&shape| self.free().any(|number| number.shape == shape))
    }

    /// The model at these times.
    pub(crate) fn at<'a>(&'a self, times: &'a [f64]) -> Sampled<'a> {
        Sampled {
            model: self,
            times,
            spare: Spare::default(),
        }
    }

    /// The same with only its first shapes, whose linear numbers nothing bounds.
    pub(crate) fn first_shapes(&self, count: usize) -> Self {
        let form = Form {
            shapes: self.form.shapes[..count].to_vec(),
            ..self.form.clone()
        };
        let numbers = self.numbers.iter().filter(|number| number.shape < count).cloned().collect();
        Self::new(form, self.constant, numbers, Vec::new())
    }

    /// Whether this is a series of exponentials with all their rates free.
    pub(crate) fn is_series(&self) -> bool {
        let alike = self.form.shapes.iter().all(|shape| *shape == BasisFunction::Exponential);
        alike && self.form.shapes.len() > 1 && self.free.len() == self.numbers.len()
    }
}

fn orient(values: &mut [f64], column: Column) {
    if column != (Column { offset: 0.0, sign: 1.0 }) {
        for value in values {
            *value = column.offset + column.sign * *value;
        }
    }
}

/// A model at the times of a fit.
pub(crate) struct Sampled<'a> {
    model: &'a Model,
    times: &'a [f64],
    spare: Spare,
}

impl Sampled<'_> {
    /// Times, and whether there is a constant, if the columns span plain exponentials with free rates.
    pub(crate) fn exponentials(&self) -> Option<(&[f64], bool)> {
        let model = self.model;
        let plain = model.columns.iter().all(|column| column.offset == 0.0);
        (model.is_series() && model.loading.is_none() && (model.constant || plain))
            .then_some((self.times, model.constant))
    }
}

impl Shapes for Sampled<'_> {
    fn columns(&self) -> usize {
        self.model.linear()
    }

    fn column_of(&self, index: usize) -> usize {
        usize::from(self.model.constant) + self.model.numbers[self.model.free[index]].shape
    }

    fn bounds(&self, index: usize) -> (f64, f64) {
        self.model.numbers[self.model.free[index]].bounds
    }

    fn linear_bounds(&self) -> &[(f64, f64)] {
        &self.model.linear_bounds
    }

    fn spare(&self) -> Option<&Spare> {
        Some(&self.spare)
    }

    fn at_bound(&self, index: usize) -> Termination {
        match self.model.numbers[self.model.free[index]].kind {
            NumberKind::Rate | NumberKind::Time | NumberKind::Reference => Termination::RateAtBound,
            NumberKind::Pure { .. } => Termination::ExponentAtBound,
        }
    }

    fn fill(&self, theta: &[f64], columns: &mut [Vec<f64>], derivatives: &mut [Vec<f64>]) {
        let model = self.model;
        let (constant, shapes) = columns.split_at_mut(usize::from(model.constant));
        for column in constant {
            column.fill(1.0);
        }
        let mut next = 0;
        for (index, column) in shapes.iter_mut().enumerate() {
            let range = model.numbers_of(index);
            let mut numbers = [0.0; 2];
            let numbers = &mut numbers[..range.len()];
            let mut free = 0;
            for (number, place) in model.numbers[range.clone()].iter().zip(numbers.iter_mut()) {
                *place = number.fixed.unwrap_or_else(|| {
                    free += 1;
                    theta[next + free - 1]
                });
            }
            if free == 0 {
                model.shape_value(index, self.times, numbers, column);
                continue;
            } else if free == range.len() {
                model.gradient(index, self.times, numbers, column, &mut derivatives[next..next + free]);
            } else {
                // One of two is held: its derivative goes nowhere.
                let mut all = vec![vec![0.0; self.times.len()]; range.len()];
                model.gradient(index, self.times, numbers, column, &mut all);
                let kept = model.numbers[range].iter().position(|number| number.fixed.is_none());
                std::mem::swap(&mut derivatives[next], &mut all[kept.unwrap_or(0)]);
            }
            for derivative in &mut derivatives[next..next + free] {
                let sign = model.columns[index].sign;
                if sign != 1.0 {
                    derivative.iter_mut().for_each(|entry| *entry *= sign);
                }
            }
            orient(column, model.columns[index]);
            next += free;
        }
    }
}

/// What the searched form of a nonlinear number is called: rates and times are searched as ln of a rate.
pub(crate) fn searched_name(name: &str, kind: NumberKind) -> String {
    match kind {
        NumberKind::Pure { .. } => name.to_owned(),
        NumberKind::Time => format!("log_rate{}", name.trim_start_matches(|c: char| c != '_')),
        _ => format!("log_{name}"),
    }
}
