//! Units as machines and people write them, in the languages of headers.

use palpate::units::{self, Dimension};

use super::quantity::Quantity;
use super::vocabulary::is_listed;

/// Words and spellings that machines write for a unit: a line a unit. Compared in lower case, so that none is here whose
/// meaning hangs on its case: "mpa" may be mega or milli.
const SYNONYMS: [(Dimension, &str); 5] = [
    (
        Dimension::Time,
        "s: s sec secs second seconds sekunde sekunden seconde secondes segundo segundos с сек секунда секунды секунд 秒 초 mm:ss m:ss min:s min:sec mm:ss.0
         ms: msec millisecond milliseconds millisekunde millisekunden milliseconde millisecondes milisegundo milisegundos мс 毫秒 ミリ秒 밀리초
         us: microsecond microseconds mikrosekunde mikrosekunden microseconde microsecondes microsegundo microsegundos мкс 微秒 マイクロ秒 마이크로초
         min: min mins minute minutes minuten minuto minutos мин минуты минут 分 分钟 분 hh:mm h:mm h:min
         h: h hr hrs hour hours stunde stunden std heure heures hora horas ч час часы часов 小时 時間
         d: d day days tag tage tagen jour jours día días dia dias giorno giorni 天 日",
    ),
    (
        Dimension::Length,
        "mm: mm millimeter millimeters millimetre millimetres millimètre millimètres milímetro milímetros milimetro milimetros мм миллиметры 毫米 ミリメートル ミリ 밀리미터
         cm: cm centimeter centimeters centimetre centimetres zentimeter centimètre centimètres centímetro centímetros см 厘米 センチメートル センチ 센티미터
         m: meter meters metre metres mètre mètres metro metros м 米 メートル 미터
         um: micron microns micrometer micrometers micrometre micrometres mikrometer micromètre micromètres micrómetro micrómetros micra micras мкм 微米 マイクロメートル ミクロン 마이크로미터
         nm: nanometer nanometers nanometre nanometres nanomètre nanomètres nanómetro nanómetros нм 纳米 ナノメートル 나노미터
         in: inch inches zoll pouce pouces pulgada pulgadas 英寸 インチ
         mil: mils thou thousandths
         ft: foot feet",
    ),
    (
        Dimension::Force,
        "N: n newton newtons neutonio neutonios н ньютон ньютоны 牛 牛顿 ニュートン 뉴턴
         kN: kn kilonewton kilonewtons кн 千牛 キロニュートン 킬로뉴턴
         mN: millinewton millinewtons milinewton milinewtons 毫牛 ミリニュートン 밀리뉴턴
         nN: nanonewton nanonewtons 纳牛 ナノニュートン
         gf: gf gram-force grams-force gramme-force grammes-force gramo-fuerza gramos-fuerza гс 克力 グラム重
         kgf: kgf kilogram-force kilograms-force kp kilopond kilogramme-force kilogrammes-force kilogramo-fuerza kilogramos-fuerza кгс 千克力 公斤力 キログラム重
         lbf: lbf lbsf pound-force pounds-force pfund-kraft livre-force livres-force libra-fuerza libras-fuerza 磅力 重量ポンド ポンド重
         kip: kips kilopound-force kilopounds-force
         tf: tonne-force tonnes-force тс 吨力",
    ),
    (
        Dimension::Pressure,
        "Pa: pa pascal pascals pascales па паскаль 帕 帕斯卡 パスカル 파스칼
         kPa: kpa kilopascal kilopascals kilopascales кпа 千帕 キロパスカル 킬로파스칼
         MPa: megapascal megapascals mégapascal mégapascals megapascales 兆帕 メガパスカル 메가파스칼
         GPa: gpa gigapascal gigapascals gigapascales гпа 吉帕 ギガパスカル
         psi: psi lbf/in² lbf/in^2 lbf/in2",
    ),
    (
        Dimension::Voltage,
        "V: v volt volts voltio voltios в вольт 伏 伏特 ボルト 볼트
         mV: millivolt millivolts milivoltio milivoltios мв 毫伏 ミリボルト",
    ),
];

/// Words and spellings for shares, most of them of strains, with their factors.
const STRAINS: [(f64, &str); 4] = [
    (1.0, "- mm/mm m/m cm/cm µm/µm um/um in/in inch/inch ft/ft strain"),
    (1e-2, "percent pct"),
    (1e-3, "mm/m millistrain mstrain mε"),
    (1e-6, "µm/m um/m µin/in uin/in microstrain microstrains µstrain ustrain µε uε µe"),
];

/// Symbols in Cyrillic letters whose meaning hangs on their case.
const CYRILLIC: [(&str, &str); 4] = [("мН", "mN"), ("мкН", "uN"), ("МПа", "MPa"), ("мПа", "mPa")];

/// The symbols of a dimension with the words for them.
fn synonyms(dimension: Dimension) -> impl Iterator<Item = (&'static str, &'static str)> {
    let tables = SYNONYMS.into_iter().filter(move |(of, _)| *of == dimension);
    tables.flat_map(|(_, table)| table.lines().filter_map(|line| line.trim().split_once(": ")))
}

/// The factor that turns a unit, as people and machines write it in a header, into SI; `None` for what is no unit of `dimension`.
///
/// A scale is part of the unit: `x10^-3 N`, `10³ N`, `1e-3 N` and `N x 1000` count multiples of 1 N, as the axes of diagrams do.
#[must_use]
pub fn unit_factor(unit: &str, dimension: Dimension) -> Option<f64> {
    plain_factor(unit, dimension).or_else(|| {
        let (scale, unit) = scaled(unit)?;
        let factor = scale * plain_factor(&unit, dimension)?;
        (factor.is_finite() && factor > 0.0).then_some(factor)
    })
}

/// The factor of a unit without a scale.
fn plain_factor(unit: &str, dimension: Dimension) -> Option<f64> {
    let unit = unit.trim();
    let unit = CYRILLIC.iter().find(|(own, _)| *own == unit).map_or(unit, |(_, symbol)| symbol);
    units::factor(unit, dimension).or_else(|| {
        let word = unit.to_lowercase();
        // Clocks of computers count them; no description does.
        if dimension == Dimension::Time && matches!(word.as_str(), "ns" | "nsec" | "nanosecond" | "nanoseconds") {
            return Some(1e-9);
        }
        if dimension == Dimension::Share
            && let Some((factor, _)) =
                STRAINS.iter().find(|(_, words)| is_listed(&word.replace('\u{3bc}', "\u{b5}"), words))
        {
            return Some(*factor);
        }
        if matches!(dimension, Dimension::Angle) && matches!(word.as_str(), "degree" | "degrees" | "radian" | "radians")
        {
            return units::factor(&word[..3], dimension);
        }
        if dimension == Dimension::Torque {
            // "N.m", "mN-m", "N*mm": a force and a length with anything between them.
            let plain = |text: &str| text.chars().filter(|letter| letter.is_alphanumeric()).collect::<String>();
            let known = dimension
                .units()
                .iter()
                .find(|(symbol, _)| plain(symbol) == plain(&unit.replace('\u{3bc}', "\u{b5}")));
            return known.map(|(_, factor)| *factor);
        }
        let (symbol, _) = synonyms(dimension).find(|(_, words)| is_listed(&word, words))?;
        units::factor(symbol, dimension)
    })
}

/// Signs between a scale and a unit.
const TIMES: [char; 5] = ['x', 'X', '×', '*', '·'];

/// The scale and the unit of `x10^-3 N`, `10³ N`, `1e-3 N` or `N x 1000`. A number alone is none: a channel of `(100 N)` may be named after
/// its range.
fn scaled(text: &str) -> Option<(f64, String)> {
    let text = plain_powers(text.trim());
    let front = text.trim_start_matches(TIMES).trim_start();
    let is_marked = front.len() < text.len();
    let leading = leading_scale(front).filter(|(_, is_power, unit)| (is_marked || *is_power) && !unit.is_empty());
    if let Some((scale, _, unit)) = leading {
        return Some((scale, unit.trim_start_matches(TIMES).trim().to_owned()));
    }
    let (unit, behind) = text.rsplit_once(TIMES)?;
    let (scale, _, rest) = leading_scale(behind.trim())?;
    rest.is_empty().then(|| (scale, unit.trim().to_owned()))
}

/// The number that a text begins with, whether it is a power of ten, and what stands behind.
fn leading_scale(text: &str) -> Option<(f64, bool, &str)> {
    let power = text.strip_prefix("10^");
    let (number, rest) = units::split_number(power.unwrap_or(text));
    let written = if power.is_some() { format!("1e{number}") } else { number.to_owned() };
    let is_power = power.is_some() || number.contains(['e', 'E']);
    Some((written.parse().ok()?, is_power, rest))
}

/// A text with powers of ten as `10^-3` that are written `10⁻³` or `10**-3`.
fn plain_powers(text: &str) -> String {
    const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    let mut plain = String::new();
    for letter in text.replace("10**", "10^").chars() {
        let digit = RAISED.chars().position(|raised| raised == letter).map(|digit| digit.to_string());
        let raised = digit.or_else(|| (letter == '⁻').then(|| "-".to_owned()));
        match raised {
            Some(raised) if plain.ends_with("10") => plain.extend(["^", &raised]),
            Some(raised) if plain.contains("10^") => plain.push_str(&raised),
            _ => plain.push(if letter == '\u{2212}' { '-' } else { letter }),
        }
    }
    plain
}

/// The unit of which a header counts the number that it has before it, as in `(100 N)`: multiples, unless that is the range of the channel.
pub(crate) fn unit_behind_number(text: &str) -> Option<&str> {
    let (number, unit) = units::split_number(text.trim());
    (!number.is_empty() && is_unit_in_words(unit)).then_some(unit)
}

/// Whether a unit is a share: of a full scale, of a length.
pub(crate) fn is_share(unit: &str) -> bool {
    unit.trim_start().starts_with('%') || plain_factor(unit, Dimension::Share).is_some_and(|factor| factor < 1.0)
}

/// Whether a text is a unit of time, length, force, pressure, voltage or angle in words, or one of mass, which many write for a force.
pub(crate) fn is_unit_in_words(text: &str) -> bool {
    const DIMENSIONS: [Dimension; 6] = [
        Dimension::Time,
        Dimension::Length,
        Dimension::Force,
        Dimension::Pressure,
        Dimension::Voltage,
        Dimension::Angle,
    ];
    let is_mass = || Quantity::Force.unit_meant(text) != Quantity::Force.usual_unit();
    DIMENSIONS.iter().any(|dimension| unit_factor(text, *dimension).is_some()) || is_mass()
}

/// What a scale such as `12.5 N/V` makes of one volt, in SI; `None` for any other text.
pub(crate) fn volts_are(scale: &str, dimension: Dimension) -> Option<f64> {
    let (number, unit) = units::split_number(scale.trim());
    let (measured, volts) = unit.rsplit_once('/')?;
    let value: f64 = number.parse().ok()?;
    let factor = units::scale(value, unit_factor(measured, dimension)?) / unit_factor(volts, Dimension::Voltage)?;
    (factor.is_finite() && factor != 0.0).then_some(factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_as_machines_write_them() {
        for (unit, dimension, factor) in [
            ("S", Dimension::Time, 1.0),
            ("seconds", Dimension::Time, 1.0),
            ("毫秒", Dimension::Time, 1e-3),
            ("ns", Dimension::Time, 1e-9),
            ("MM", Dimension::Length, 1e-3),
            ("\u{3bc}m", Dimension::Length, 1e-6),
            (" Newton ", Dimension::Force, 1.0),
            ("mN", Dimension::Force, 1e-3),
            ("N/mm²", Dimension::Pressure, 1e6),
            ("kgf", Dimension::Force, 9.806_65),
            ("Kilopond", Dimension::Force, 9.806_65),
            ("Pounds-Force", Dimension::Force, 4.448_221_615_260_5),
            ("gramos-fuerza", Dimension::Force, 9.806_65e-3),
            ("Millimètres", Dimension::Length, 1e-3),
            ("Zoll", Dimension::Length, 0.0254),
            ("thou", Dimension::Length, 0.0254 * 1e-3),
            ("kips", Dimension::Force, 4_448.221_615_260_5),
            ("pulgadas", Dimension::Length, 0.0254),
            ("ミリメートル", Dimension::Length, 1e-3),
            ("キロニュートン", Dimension::Force, 1e3),
            ("Stunden", Dimension::Time, 3600.0),
            ("minutos", Dimension::Time, 60.0),
            ("メガパスカル", Dimension::Pressure, 1e6),
            ("days", Dimension::Time, 86_400.0),
            ("с", Dimension::Time, 1.0),
            ("Н", Dimension::Force, 1.0),
            ("мН", Dimension::Force, 1e-3),
            ("мм", Dimension::Length, 1e-3),
            ("뉴턴", Dimension::Force, 1.0),
            ("초", Dimension::Time, 1.0),
            ("mm:ss", Dimension::Time, 1.0),
        ] {
            assert_eq!(unit_factor(unit, dimension), Some(factor), "{unit}");
        }
        for (unit, dimension) in [
            ("mpa", Dimension::Pressure),
            ("MN", Dimension::Force),
            ("МН", Dimension::Force),
            ("kg", Dimension::Force),
            ("mm", Dimension::Force),
            ("V", Dimension::Force),
            ("lb", Dimension::Force),
            ("", Dimension::Time),
        ] {
            assert_eq!(unit_factor(unit, dimension), None, "{unit}");
        }
    }

    /// `Displacement (x10^-3 m)` was passed over, and a hint took `Force (10^3 N)` for N.
    #[test]
    fn a_scale_is_part_of_the_unit() {
        for (unit, factor) in [
            ("x10^-3 N", 1e-3),
            ("x 10^-3 N", 1e-3),
            ("10^3 N", 1e3),
            ("×10⁻³ N", 1e-3),
            ("10³N", 1e3),
            ("10**-6 N", 1e-6),
            ("x1000 N", 1e3),
            ("N x 1e-3", 1e-3),
            ("N*1000", 1e3),
            ("1e-3 kN", 1.0),
            ("10^\u{2212}3·N", 1e-3),
        ] {
            assert_eq!(unit_factor(unit, Dimension::Force), Some(factor), "{unit}");
        }
        assert_eq!(unit_factor("10^-6 m", Dimension::Length), Some(1e-6));
        for unit in [
            "100 N", "0.001 N", "10 N", "x10", "10^3", "N/10", "N^-1", "x N", "10^x N", "x0 N", "x-1 N", "10^999 N",
        ] {
            assert_eq!(unit_factor(unit, Dimension::Force), None, "{unit}");
        }
    }

    /// A strain in `in/in` or `µε` was passed over.
    #[test]
    fn strains_have_units_of_their_own() {
        for (unit, factor) in [
            ("in/in", 1.0),
            ("-", 1.0),
            ("microstrain", 1e-6),
            ("ustrain", 1e-6),
            ("\u{b5}\u{3b5}", 1e-6),
            ("\u{3bc}\u{3b5}", 1e-6),
            ("µm/m", 1e-6),
            ("mm/m", 1e-3),
            ("Percent", 1e-2),
        ] {
            assert_eq!(unit_factor(unit, Dimension::Share), Some(factor), "{unit}");
        }
        for unit in ["mm", "strains", "e", "V", ""] {
            assert_eq!(unit_factor(unit, Dimension::Share), None, "{unit}");
        }
    }

    #[test]
    fn volts_become_what_the_scale_says() {
        assert_eq!(volts_are("12.5 N/V", Dimension::Force), Some(12.5));
        assert_eq!(volts_are("2 mm/mV", Dimension::Length), Some(2.0));
        assert_eq!(volts_are("-3 N/mm²/V", Dimension::Pressure), Some(-3e6));
        for scale in ["12.5", "12.5 N", "N/V", "12.5 N/s", "12.5 mm/V", "0 N/V", "nan N/V", ""] {
            assert_eq!(volts_are(scale, Dimension::Force), None, "{scale}");
        }
    }

    #[test]
    fn every_synonym_stands_for_one_unit() {
        for (dimension, table) in SYNONYMS {
            let all: Vec<(&str, &str)> = synonyms(dimension).collect();
            assert_eq!(all.len(), table.lines().count());
            for (index, (symbol, words)) in all.iter().enumerate() {
                assert!(units::factor(symbol, dimension).is_some(), "{symbol}");
                assert_eq!(*words, words.to_lowercase(), "{symbol}");
                for (other, more) in &all[index + 1..] {
                    let twice = words.split_whitespace().find(|word| is_listed(word, more));
                    assert_eq!(twice, None, "{symbol} and {other}");
                }
            }
        }
    }
}
