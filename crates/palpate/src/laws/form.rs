//! What a law is made of: a constant or none, and shapes.

use super::{BasisFunction, Kernel, Response, ShapeParameterKind, name_of_term, term_of_name};

/// Columns of a law, in the order of its linear parameters: the constant if it has one, then the shapes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Form {
    /// Relaxation or creep.
    pub(crate) response: Response,
    /// Whether the constant is found from the data (else it is 0 unless given).
    pub(crate) constant: bool,
    /// Shapes, each with its amplitude.
    pub(crate) shapes: Vec<BasisFunction>,
}

/// How a shape stands in the signal: offset + sign × shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Column {
    pub(crate) offset: f64,
    pub(crate) sign: f64,
}

impl Form {
    /// What the constant is called: the end of a relaxation that ends, else the start.
    pub(crate) fn constant_name(&self) -> &'static str {
        match self.response {
            Response::Creep => "instantaneous",
            Response::Relaxation if self.shapes.iter().all(Kernel::decays) => "equilibrium",
            Response::Relaxation => "start",
        }
    }

    /// Names of the amplitudes, numbered where there are several.
    pub(crate) fn amplitude_names(&self) -> Vec<String> {
        let name = |shape: &BasisFunction| if *shape == BasisFunction::Straight { "flow" } else { "amplitude" };
        self.numbered(|shape| [name(shape)]).into_iter().map(|(_, name)| name).collect()
    }

    /// Name, kind and shape of every nonlinear parameter.
    pub(crate) fn parameters(&self) -> Vec<(usize, String, ShapeParameterKind)> {
        let names = self.numbered(|shape| shape.parameters().iter().map(|parameter| parameter.name));
        let kinds = self.shapes.iter().flat_map(|shape| shape.parameters().iter().map(|parameter| parameter.kind));
        names.into_iter().zip(kinds).map(|((shape, name), kind)| (shape, name, kind)).collect()
    }

    /// A nonlinear parameter by its name: the name without the number of its term, and that number.
    pub(crate) fn parameter(&self, written: &str) -> Option<(&'static str, Option<usize>)> {
        self.shapes.iter().flat_map(Kernel::parameters).find_map(|parameter| {
            let term = term_of_name(parameter.name, written);
            (parameter.name == written || term.is_some()).then_some((parameter.name, term))
        })
    }

    /// Names of each shape, with the number of the shape among its like where there are several.
    fn numbered<N: IntoIterator<Item = &'static str>>(
        &self,
        names: impl Fn(&BasisFunction) -> N,
    ) -> Vec<(usize, String)> {
        let like = |shape: &BasisFunction| self.shapes.iter().filter(|other| *other == shape).count();
        let mut all = Vec::new();
        for (index, shape) in self.shapes.iter().enumerate() {
            let place = self.shapes[..=index].iter().filter(|other| *other == shape).count();
            for name in names(shape) {
                let name = if like(shape) > 1 { name_of_term(name, place) } else { name.to_owned() };
                all.push((index, name));
            }
        }
        all
    }
}

impl Column {
    /// How a shape stands in a signal that relaxes or creeps.
    pub(crate) fn of(shape: &BasisFunction, response: Response) -> Self {
        let (offset, sign) = match (response, shape.decays()) {
            (Response::Relaxation, true) => (0.0, 1.0),
            (Response::Relaxation, false) => (0.0, -1.0),
            (Response::Creep, true) => (1.0, -1.0),
            (Response::Creep, false) => (0.0, 1.0),
        };
        Self { offset, sign }
    }
}
