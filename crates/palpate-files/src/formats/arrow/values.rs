//! Columns of a type as numbers or texts.

use arrow_array::{
    Array, ArrayRef, ArrowPrimitiveType,
    cast::AsArray,
    types::{Decimal128Type, Float64Type, Int32Type, Int64Type},
};
use arrow_cast::cast;
use arrow_schema::{DataType, TimeUnit};

/// What a column of a type can be read as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reading {
    /// Numbers in the unit that the column says.
    Number,
    /// Times, read as seconds.
    Seconds,
    /// Texts and truths.
    Text,
}

/// What a column of a type can be read as; `None` of nested columns, bytes and the like.
pub(super) fn reading(of: &DataType) -> Option<Reading> {
    use DataType as T;
    match of {
        T::Dictionary(_, values) => reading(values).filter(|reading| *reading == Reading::Text),
        T::Decimal32(..) | T::Decimal64(..) | T::Decimal128(..) => Some(Reading::Number),
        T::Timestamp(..) | T::Duration(_) | T::Time32(_) | T::Time64(_) | T::Date32 | T::Date64 => {
            Some(Reading::Seconds)
        }
        T::Utf8 | T::LargeUtf8 | T::Utf8View | T::Boolean => Some(Reading::Text),
        other => (other.is_integer() || other.is_floating()).then_some(Reading::Number),
    }
}

/// The numbers of a column; `None` where there is none, and of a column that cannot be read as numbers.
pub(super) fn numbers(array: &ArrayRef) -> Option<Vec<Option<f64>>> {
    use DataType as T;
    let per = |unit: &TimeUnit| match unit {
        TimeUnit::Second => 1,
        TimeUnit::Millisecond => 1_000,
        TimeUnit::Microsecond => 1_000_000,
        TimeUnit::Nanosecond => 1_000_000_000,
    };
    // Whole seconds and the rest apart, so that nanoseconds since 1970 lose no more than a f64 must.
    let seconds = |per: i64| {
        cast_to::<Int64Type>(array, &T::Int64, |ticks| {
            ticks.div_euclid(per) as f64 + ticks.rem_euclid(per) as f64 / per as f64
        })
    };
    match array.data_type() {
        T::Timestamp(unit, _) | T::Duration(unit) | T::Time64(unit) => seconds(per(unit)),
        T::Date64 => seconds(1_000),
        T::Time32(unit) => cast_to::<Int32Type>(array, &T::Int32, |ticks| f64::from(ticks) / per(unit) as f64),
        T::Date32 => cast_to::<Int32Type>(array, &T::Int32, |days| f64::from(days) * 86_400.0),
        T::Decimal32(_, scale) | T::Decimal64(_, scale) | T::Decimal128(_, scale) => {
            let power = 10_f64.powi(i32::from(*scale).abs());
            cast_to::<Decimal128Type>(array, &T::Decimal128(38, *scale), |digits| {
                if *scale > 0 { digits as f64 / power } else { digits as f64 * power }
            })
        }
        kind if reading(kind) == Some(Reading::Number) => cast_to::<Float64Type>(array, &T::Float64, |value| value),
        _ => None,
    }
}

/// The values of a column as those of another type, and as what is made of these.
fn cast_to<P: ArrowPrimitiveType>(
    array: &ArrayRef,
    to: &DataType,
    further: impl Fn(P::Native) -> f64,
) -> Option<Vec<Option<f64>>> {
    let array = cast(array, to).ok()?;
    Some(array.as_primitive_opt::<P>()?.iter().map(|value| value.map(&further)).collect())
}

/// The texts of a column, whole numbers as they are printed; `None` as for [`numbers`].
pub(super) fn texts(array: &ArrayRef) -> Option<Vec<Option<String>>> {
    if array.data_type().is_integer() {
        let numbers = numbers(array)?;
        return Some(numbers.into_iter().map(|number| number.map(|number| number.to_string())).collect());
    }
    reading(array.data_type()).filter(|reading| *reading == Reading::Text)?;
    let texts = cast(array, &DataType::Utf8).ok()?;
    Some(texts.as_string_opt::<i32>()?.iter().map(|text| text.map(str::to_owned)).collect())
}
