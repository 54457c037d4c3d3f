//! Columns of a type as numbers or texts.

use arrow_array::{
    Array, ArrayRef,
    cast::AsArray,
    types::{
        ArrowDictionaryKeyType, Date32Type, Date64Type, Decimal32Type, Decimal64Type, Decimal128Type,
        DurationMicrosecondType, DurationMillisecondType, DurationNanosecondType, DurationSecondType, Float16Type,
        Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, Time32MillisecondType, Time32SecondType,
        Time64MicrosecondType, Time64NanosecondType, TimestampMicrosecondType, TimestampMillisecondType,
        TimestampNanosecondType, TimestampSecondType, UInt8Type, UInt16Type, UInt32Type, UInt64Type,
    },
};
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
        T::Int8 | T::Int16 | T::Int32 | T::Int64 | T::UInt8 | T::UInt16 | T::UInt32 | T::UInt64 => {
            Some(Reading::Number)
        }
        T::Float16 | T::Float32 | T::Float64 => Some(Reading::Number),
        T::Decimal32(..) | T::Decimal64(..) | T::Decimal128(..) => Some(Reading::Number),
        T::Timestamp(..) | T::Duration(_) | T::Time32(_) | T::Time64(_) | T::Date32 | T::Date64 => {
            Some(Reading::Seconds)
        }
        T::Utf8 | T::LargeUtf8 | T::Utf8View | T::Boolean => Some(Reading::Text),
        _ => None,
    }
}

/// The numbers of a column; `None` where there is none, and of a column that cannot be read as numbers.
pub(super) fn numbers(array: &ArrayRef) -> Option<Vec<Option<f64>>> {
    macro_rules! all {
        ($kind:ty, $to:expr) => {{
            let to = $to;
            Some(array.as_primitive_opt::<$kind>()?.iter().map(|value| value.map(&to)).collect())
        }};
    }
    let per = |unit: TimeUnit| match unit {
        TimeUnit::Second => 1,
        TimeUnit::Millisecond => 1_000,
        TimeUnit::Microsecond => 1_000_000,
        TimeUnit::Nanosecond => 1_000_000_000,
    };
    // Whole seconds and the rest apart, so that nanoseconds since 1970 lose no more than a f64 must.
    let seconds = |unit: TimeUnit| {
        let per: i64 = per(unit);
        move |ticks: i64| ticks.div_euclid(per) as f64 + ticks.rem_euclid(per) as f64 / per as f64
    };
    let scaled = |scale: i8| {
        move |digits: f64| {
            if scale > 0 { digits / 10_f64.powi(scale.into()) } else { digits * 10_f64.powi(-i32::from(scale)) }
        }
    };
    use {DataType as T, TimeUnit as U};
    match array.data_type() {
        T::Int8 => all!(Int8Type, f64::from),
        T::Int16 => all!(Int16Type, f64::from),
        T::Int32 => all!(Int32Type, f64::from),
        T::Int64 => all!(Int64Type, |value| value as f64),
        T::UInt8 => all!(UInt8Type, f64::from),
        T::UInt16 => all!(UInt16Type, f64::from),
        T::UInt32 => all!(UInt32Type, f64::from),
        T::UInt64 => all!(UInt64Type, |value| value as f64),
        T::Float16 => all!(Float16Type, f64::from),
        T::Float32 => all!(Float32Type, f64::from),
        T::Float64 => all!(Float64Type, |value| value),
        T::Decimal32(_, scale) => all!(Decimal32Type, |value| scaled(*scale)(f64::from(value))),
        T::Decimal64(_, scale) => all!(Decimal64Type, |value| scaled(*scale)(value as f64)),
        T::Decimal128(_, scale) => all!(Decimal128Type, |value| scaled(*scale)(value as f64)),
        T::Timestamp(U::Second, _) => all!(TimestampSecondType, seconds(U::Second)),
        T::Timestamp(U::Millisecond, _) => all!(TimestampMillisecondType, seconds(U::Millisecond)),
        T::Timestamp(U::Microsecond, _) => all!(TimestampMicrosecondType, seconds(U::Microsecond)),
        T::Timestamp(U::Nanosecond, _) => all!(TimestampNanosecondType, seconds(U::Nanosecond)),
        T::Duration(U::Second) => all!(DurationSecondType, seconds(U::Second)),
        T::Duration(U::Millisecond) => all!(DurationMillisecondType, seconds(U::Millisecond)),
        T::Duration(U::Microsecond) => all!(DurationMicrosecondType, seconds(U::Microsecond)),
        T::Duration(U::Nanosecond) => all!(DurationNanosecondType, seconds(U::Nanosecond)),
        T::Time32(U::Second) => all!(Time32SecondType, f64::from),
        T::Time32(_) => all!(Time32MillisecondType, |value| f64::from(value) / 1e3),
        T::Time64(U::Microsecond) => all!(Time64MicrosecondType, seconds(U::Microsecond)),
        T::Time64(_) => all!(Time64NanosecondType, seconds(U::Nanosecond)),
        T::Date32 => all!(Date32Type, |days| f64::from(days) * 86_400.0),
        T::Date64 => all!(Date64Type, seconds(U::Millisecond)),
        _ => None,
    }
}

/// The texts of a column, whole numbers as they are printed; `None` as for [`numbers`].
pub(super) fn texts(array: &ArrayRef) -> Option<Vec<Option<String>>> {
    use DataType as T;
    let owned = |text: Option<&str>| text.map(str::to_owned);
    match array.data_type() {
        T::Utf8 => Some(array.as_string_opt::<i32>()?.iter().map(owned).collect()),
        T::LargeUtf8 => Some(array.as_string_opt::<i64>()?.iter().map(owned).collect()),
        T::Utf8View => Some(array.as_string_view_opt()?.iter().map(owned).collect()),
        T::Boolean => Some(array.as_boolean_opt()?.iter().map(|truth| truth.map(|truth| truth.to_string())).collect()),
        T::Dictionary(key, _) => match key.as_ref() {
            T::Int8 => keyed::<Int8Type>(array),
            T::Int16 => keyed::<Int16Type>(array),
            T::Int32 => keyed::<Int32Type>(array),
            T::Int64 => keyed::<Int64Type>(array),
            T::UInt8 => keyed::<UInt8Type>(array),
            T::UInt16 => keyed::<UInt16Type>(array),
            T::UInt32 => keyed::<UInt32Type>(array),
            T::UInt64 => keyed::<UInt64Type>(array),
            _ => None,
        },
        kind if kind.is_integer() => {
            let numbers = numbers(array)?;
            Some(numbers.into_iter().map(|number| number.map(|number| number.to_string())).collect())
        }
        _ => None,
    }
}

fn keyed<K: ArrowDictionaryKeyType>(array: &ArrayRef) -> Option<Vec<Option<String>>> {
    let array = array.as_dictionary_opt::<K>()?;
    let words = texts(array.values())?;
    let word = |row: usize| array.key(row).and_then(|key| words.get(key)?.clone());
    Some((0..array.len()).map(word).collect())
}
