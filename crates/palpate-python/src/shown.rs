//! Classes that show what a result says.

/// The methods of such a class: a getter for each array and for each value, with Python where it needs that, and methods of its own. The
/// arrays are the columns of a table too.
///
/// Objects of a class with `values` go into a pickle as what they hold. A class with `getters` says itself how it is pickled; one with
/// `copied getters` is changed in place, and its copies go their own way.
macro_rules! shown {
    (
        $class:ident: $me:ident
        getters { $($(#[$doc:meta])* $name:ident$(<$life:lifetime>($py:ident))?: $of:ty = $value:expr,)* }
        $($methods:tt)*
    ) => {
        #[pymethods]
        impl $class {
            $(
                $(#[$doc])*
                #[getter]
                pub(crate) fn $name$(<$life>)?(&$me $(, $py: Python<$life>)?) -> $of {
                    $value
                }
            )*

            $($methods)*
        }
    };
    ($class:ident: $me:ident copied getters { $($getters:tt)* } $($methods:tt)*) => {
        $crate::shown::shown! {
            $class: $me
            getters { $($getters)* }

            fn __copy__(&self) -> Self {
                self.clone()
            }

            fn __deepcopy__(&self, _memo: &Bound<'_, pyo3::types::PyDict>) -> Self {
                self.clone()
            }

            $($methods)*
        }
    };
    ($class:ident: $me:ident values { $($values:tt)* } $($methods:tt)*) => {
        $crate::shown::shown! {
            $class: $me
            getters { $($values)* }

            #[classmethod]
            #[pyo3(signature = (json, format=0))]
            fn _from_json(
                class: &Bound<'_, pyo3::types::PyType>,
                json: $crate::pickles::Pieces,
                format: u32,
            ) -> PyResult<Self> {
                $crate::pickles::unpickled(class.py(), json, format)
            }

            fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<$crate::pickles::Made<'py, (Vec<$crate::pickles::Piece>, u32)>> {
                $crate::pickles::made_again::<Self>(py, self)
            }

            $($methods)*
        }
    };
    (
        $class:ident: $me:ident
        arrays { $($(#[$about:meta])* $array:ident: $numbers:expr,)* }
        values { $($values:tt)* }
        $($methods:tt)*
    ) => {
        impl $class {
            fn columns(&$me) -> Vec<(&'static str, arrow_array::ArrayRef)> {
                vec![$((stringify!($array), $crate::table::Column::column($numbers.into_iter()))),*]
            }
        }

        $crate::shown::shown! {
            $class: $me
            values {
                $($(#[$about])* $array<'py>(py): Bound<'py, numpy::PyArray1<f64>> = numpy::PyArray1::from_vec(py, $numbers),)*
                $($values)*
            }

            #[pyo3(signature = (requested_schema=None))]
            fn __arrow_c_stream__(&self, py: Python<'_>, requested_schema: Option<Py<PyAny>>) -> PyResult<Py<PyAny>> {
                self.to_arrow()?.__arrow_c_stream__(py, requested_schema)
            }

            /// The rows of the table, a dict each: ``pandas.DataFrame`` takes them.
            fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                self.to_arrow()?.__iter__(py)
            }

            $($methods)*
        }
    };
}
pub(crate) use shown;
