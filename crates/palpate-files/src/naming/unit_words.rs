//! Units as machines and people write them, in the languages of headers.

use palpate::units::{self, Dimension};

use super::quantity::Quantity;
use super::vocabulary::is_listed;

/// Words and spellings that machines write for a unit: a line a unit. Compared in lower case, so that none is here whose
/// meaning hangs on its case: "mpa" may be mega or milli.
const SYNONYMS: [(Dimension, &str); 5] = [
    (
        Dimension::Time,
        "s: s sec secs second seconds sekunde sekunden seconde secondes segundo segundos 秒
         ms: msec millisecond milliseconds millisekunde millisekunden milliseconde millisecondes milisegundo milisegundos 毫秒 ミリ秒
         us: microsecond microseconds mikrosekunde mikrosekunden microseconde microsecondes microsegundo microsegundos 微秒 マイクロ秒
         min: min mins minute minutes minuten minuto minutos 分 分钟
         h: h hr hrs hour hours stunde stunden std heure heures hora horas 小时 時間",
    ),
    (
        Dimension::Length,
        "mm: mm millimeter millimeters millimetre millimetres millimètre millimètres milímetro milímetros milimetro milimetros 毫米 ミリメートル ミリ
         cm: cm centimeter centimeters centimetre centimetres zentimeter centimètre centimètres centímetro centímetros 厘米 センチメートル センチ
         m: meter meters metre metres mètre mètres metro metros 米 メートル
         um: micron microns micrometer micrometers micrometre micrometres mikrometer micromètre micromètres micrómetro micrómetros micra micras 微米 マイクロメートル ミクロン
         nm: nanometer nanometers nanometre nanometres nanomètre nanomètres nanómetro nanómetros 纳米 ナノメートル
         in: inch inches zoll pouce pouces pulgada pulgadas 英寸 インチ",
    ),
    (
        Dimension::Force,
        "N: n newton newtons neutonio neutonios 牛 牛顿 ニュートン
         kN: kn kilonewton kilonewtons 千牛 キロニュートン
         mN: millinewton millinewtons milinewton milinewtons 毫牛 ミリニュートン
         nN: nanonewton nanonewtons 纳牛 ナノニュートン
         gf: gf gram-force grams-force gramme-force grammes-force gramo-fuerza gramos-fuerza 克力 グラム重
         kgf: kgf kilogram-force kilograms-force kp kilopond kilogramme-force kilogrammes-force kilogramo-fuerza kilogramos-fuerza 千克力 公斤力 キログラム重
         lbf: lbf lbsf pound-force pounds-force pfund-kraft livre-force livres-force libra-fuerza libras-fuerza 磅力 重量ポンド ポンド重",
    ),
    (
        Dimension::Pressure,
        "Pa: pa pascal pascals pascales 帕 帕斯卡 パスカル
         kPa: kpa kilopascal kilopascals kilopascales 千帕 キロパスカル
         MPa: megapascal megapascals mégapascal mégapascals megapascales 兆帕 メガパスカル
         GPa: gpa gigapascal gigapascals gigapascales 吉帕 ギガパスカル
         psi: psi lbf/in² lbf/in^2 lbf/in2",
    ),
    (
        Dimension::Voltage,
        "V: v volt volts voltio voltios 伏 伏特 ボルト
         mV: millivolt millivolts milivoltio milivoltios 毫伏 ミリボルト",
    ),
];

/// The symbols of a dimension with the words for them.
fn synonyms(dimension: Dimension) -> impl Iterator<Item = (&'static str, &'static str)> {
    let tables = SYNONYMS.into_iter().filter(move |(of, _)| *of == dimension);
    tables.flat_map(|(_, table)| table.lines().filter_map(|line| line.trim().split_once(": ")))
}

/// The factor that turns a unit, as people and machines write it in a header, into SI; `None` for what is no unit of `dimension`.
#[must_use]
pub fn unit_factor(unit: &str, dimension: Dimension) -> Option<f64> {
    let unit = unit.trim();
    units::factor(unit, dimension).or_else(|| {
        let word = unit.to_lowercase();
        // Clocks of computers count them; no description does.
        if dimension == Dimension::Time && matches!(word.as_str(), "ns" | "nsec" | "nanosecond" | "nanoseconds") {
            return Some(1e-9);
        }
        if dimension == Dimension::Share
            && matches!(word.as_str(), "-" | "mm/mm" | "m/m" | "percent" | "pct" | "strain")
        {
            return Some(if word.starts_with('p') { 1e-2 } else { 1.0 });
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
            ("pulgadas", Dimension::Length, 0.0254),
            ("ミリメートル", Dimension::Length, 1e-3),
            ("キロニュートン", Dimension::Force, 1e3),
            ("Stunden", Dimension::Time, 3600.0),
            ("minutos", Dimension::Time, 60.0),
            ("メガパスカル", Dimension::Pressure, 1e6),
        ] {
            assert_eq!(unit_factor(unit, dimension), Some(factor), "{unit}");
        }
        for (unit, dimension) in [
            ("mpa", Dimension::Pressure),
            ("MN", Dimension::Force),
            ("kg", Dimension::Force),
            ("mm", Dimension::Force),
            ("V", Dimension::Force),
            ("lb", Dimension::Force),
            ("", Dimension::Time),
        ] {
            assert_eq!(unit_factor(unit, dimension), None, "{unit}");
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
