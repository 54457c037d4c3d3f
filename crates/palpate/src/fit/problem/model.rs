//! A law made ready for a fit: which parameters are free, and within which bounds.

use crate::laws::{BasisFunction, Column, Form, Kernel, Loading, ShapeParameterKind, Superposition};
use crate::optimise::{Few, Shapes, Spare, Termination};

/// A nonlinear parameter of the law.
#[derive(Debug, Clone)]
pub(crate) struct ModelParameter {
    /// Which shape has it.
    pub(crate) shape: usize,
    /// Its name in results.
    pub(crate) name: String,
    pub(crate) kind: ShapeParameterKind,
    /// Bounds in the units of the fit.
    pub(crate) bounds: (f64, f64),
    /// Width of the range that a hold can tell of, whatever the bounds.
    pub(crate) room: f64,
    /// Held at this value, in the units of the fit.
    pub(crate) fixed: Option<f64>,
}

/// A law with some parameters held, some bounded, in the units of the fit (times over the hold's duration).
#[derive(Debug, Clone)]
pub(crate) struct Model {
    pub(crate) form: Form,
    /// Whether the constant is one of the linear parameters.
    pub(crate) constant: bool,
    /// All nonlinear parameters, shape by shape.
    pub(crate) parameters: Vec<ModelParameter>,
    /// Bounds of every linear parameter.
    pub(crate) linear_bounds: Vec<(f64, f64)>,
    /// Which of `parameters` are free.
    pub(crate) free: Vec<usize>,
    columns: Vec<Column>,
    /// What shapes are averaged over; none for a step.
    pub(crate) loading: Option<Superposition>,
}

impl Model {
    pub(crate) fn new(
        form: Form,
        constant: bool,
        parameters: Vec<ModelParameter>,
        linear_bounds: Vec<(f64, f64)>,
    ) -> Self {
        let free = (0..parameters.len()).filter(|&i| parameters[i].fixed.is_none()).collect();
        let columns = form.shapes.iter().map(|shape| Column::of(shape, form.response)).collect();
        Self {
            form,
            constant,
            parameters,
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

    /// Linear parameters.
    pub(crate) fn linear(&self) -> usize {
        usize::from(self.constant) + self.form.shapes.len()
    }

    /// Names of the parameters that are sought, the nonlinear ones as requested.
    pub(crate) fn names(&self, of: impl Fn(&ModelParameter) -> String) -> Vec<String> {
        let constant = self.constant.then(|| self.form.constant_name().to_owned());
        let nonlinear = self.free().map(of);
        constant.into_iter().chain(self.form.amplitude_names()).chain(nonlinear).collect()
    }

    /// Free nonlinear parameters.
    pub(crate) fn free(&self) -> impl ExactSizeIterator<Item = &ModelParameter> {
        self.free.iter().map(|&i| &self.parameters[i])
    }

    /// All nonlinear parameters where the free ones have these values.
    pub(crate) fn complete(&self, theta: &[f64]) -> Few {
        let mut all: Few = self.parameters.iter().map(|parameter| parameter.fixed.unwrap_or(0.0)).collect();
        for (&i, value) in self.free.iter().zip(theta) {
            all[i] = *value;
        }
        all
    }

    /// Range of the parameters of a shape among all.
    pub(crate) fn parameters_of(&self, shape: usize) -> std::ops::Range<usize> {
        let from = self
            .parameters
            .iter()
            .position(|parameter| parameter.shape == shape)
            .unwrap_or(self.parameters.len());
        from..from + self.form.shapes[shape].parameters().len()
    }

    /// One shape as it stands in the signal, at all its parameters.
    pub(crate) fn shape_value(&self, shape: usize, times: &[f64], parameters: &[f64], value: &mut [f64]) {
        match &self.loading {
            None => self.form.shapes[shape].value(times, parameters, value),
            Some(loading) => loading.value(&self.form.shapes[shape], times, parameters, value),
        }
        orient(value, self.columns[shape]);
    }

    /// One shape and its derivatives, as they stand in the signal but for offset and sign.
    fn gradient(
        &self,
        shape: usize,
        times: &[f64],
        parameters: &[f64],
        value: &mut [f64],
        derivatives: &mut [Vec<f64>],
    ) {
        match &self.loading {
            None => self.form.shapes[shape].gradient(times, parameters, value, derivatives),
            Some(loading) => loading.gradient(&self.form.shapes[shape], times, parameters, value, derivatives),
        }
    }

    /// Shapes that have a free parameter, and those that have none.
    pub(crate) fn moving(&self) -> (Vec<usize>, Vec<usize>) {
        (0..self.form.shapes.len()).partition(|&shape| self.free().any(|parameter| parameter.shape == shape))
    }

    /// Whether terms of a series have bounds that tell them apart.
    pub(crate) fn has_own_bounds(&self) -> bool {
        let (moving, _) = self.moving();
        let bounds = |shape: usize| {
            let rate = self.parameters[self.parameters_of(shape).start].bounds;
            (rate, self.linear_bounds.get(usize::from(self.constant) + shape))
        };
        let is_series = moving.len() > 1 && self.free.len() == moving.len();
        is_series && moving.iter().any(|shape| bounds(*shape) != bounds(moving[0]))
    }

    /// The model at these times.
    pub(crate) fn at<'a>(&'a self, times: &'a [f64]) -> Sampled<'a> {
        Sampled {
            model: self,
            times,
            spare: Spare::default(),
        }
    }

    /// The same with only its first shapes, whose linear parameters nothing bounds.
    pub(crate) fn first_shapes(&self, count: usize) -> Self {
        let form = Form {
            shapes: self.form.shapes[..count].to_vec(),
            ..self.form.clone()
        };
        let parameters = self.parameters.iter().filter(|parameter| parameter.shape < count).cloned().collect();
        Self::new(form, self.constant, parameters, Vec::new())
    }

    /// Whether this is a series of exponentials with all their rates free.
    pub(crate) fn is_series(&self) -> bool {
        let alike = self.form.shapes.iter().all(|shape| *shape == BasisFunction::Exponential);
        alike && self.form.shapes.len() > 1 && self.free.len() == self.parameters.len()
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
        usize::from(self.model.constant) + self.model.parameters[self.model.free[index]].shape
    }

    fn bounds(&self, index: usize) -> (f64, f64) {
        self.model.parameters[self.model.free[index]].bounds
    }

    fn room(&self, index: usize) -> f64 {
        self.model.parameters[self.model.free[index]].room
    }

    fn linear_bounds(&self) -> &[(f64, f64)] {
        &self.model.linear_bounds
    }

    fn spare(&self) -> Option<&Spare> {
        Some(&self.spare)
    }

    fn at_bound(&self, index: usize) -> Termination {
        match self.model.parameters[self.model.free[index]].kind {
            ShapeParameterKind::Rate | ShapeParameterKind::Time | ShapeParameterKind::Reference => {
                Termination::RateAtBound
            }
            ShapeParameterKind::Pure { .. } => Termination::ExponentAtBound,
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
            let range = model.parameters_of(index);
            let mut parameters = [0.0; 2];
            let parameters = &mut parameters[..range.len()];
            let mut free = 0;
            for (parameter, place) in model.parameters[range.clone()].iter().zip(parameters.iter_mut()) {
                *place = parameter.fixed.unwrap_or_else(|| {
                    free += 1;
                    theta[next + free - 1]
                });
            }
            if free == 0 {
                model.shape_value(index, self.times, parameters, column);
                continue;
            } else if free == range.len() {
                model.gradient(index, self.times, parameters, column, &mut derivatives[next..next + free]);
            } else {
                // One of two is held: its derivative goes nowhere.
                let mut all = vec![vec![0.0; self.times.len()]; range.len()];
                model.gradient(index, self.times, parameters, column, &mut all);
                let kept = model.parameters[range].iter().position(|parameter| parameter.fixed.is_none());
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

/// What the searched form of a nonlinear parameter is called: rates and times are searched as ln of a rate.
pub(crate) fn searched_name(name: &str, kind: ShapeParameterKind) -> String {
    match kind {
        ShapeParameterKind::Pure { .. } => name.to_owned(),
        ShapeParameterKind::Time => format!("-ln {name}"),
        _ => format!("ln {name}"),
    }
}
