//! Words that headers of records use, in English, German, French, Spanish, Italian, Russian, Chinese, Japanese and Korean.

use super::quantity::Quantity;

/// Whether a word is one of a list, whose words have blanks between them.
pub(crate) fn is_listed(word: &str, list: &str) -> bool {
    list.split_whitespace().any(|known| known == word)
}

/// Words for a quantity, with blanks between them: those that mean it and nothing else, then those that stand in for it.
#[derive(Debug)]
pub(crate) struct Vocabulary {
    pub(crate) quantity: Quantity,
    pub(crate) plain: &'static str,
    pub(crate) loose: &'static str,
    /// Ends of German compounds, such as "Standardkraft".
    pub(crate) endings: &'static str,
    /// Parts of Chinese, Japanese and Korean names, which have no gaps between words.
    pub(crate) characters: &'static str,
    /// One letter that stands for the quantity, in this case alone.
    pub(crate) letter: Option<&'static str>,
}

pub(crate) const VOCABULARY: [Vocabulary; 4] = [
    Vocabulary {
        quantity: Quantity::Time,
        plain: "time zeit temps tiempo tempo время времени",
        loose: "elapsed seconds secondes sekunden segundos minutes minuten minutos hours stunden heures timestamp stamp zeitstempel horodatage epoch durée duree secondi секунды минуты часы",
        endings: "zeit",
        characters: "时间 時間 시간",
        letter: Some("t"),
    },
    Vocabulary {
        quantity: Quantity::Displacement,
        plain: "displacement verschiebung weg déplacement deplacement desplazamiento spostamento перемещение смещение",
        loose: "extension travel stroke crosshead traverse position pos indentation allongement deflection course \
            recorrido carrera disp distance distanz distancia depth tiefe profondeur profundidad elongation pd \
            extensión alargamiento deformation verformung déformation deformación deformacion compression \
            stauchung eindrückung eindrueckung eindruckung compresión compresion penetration eindringtiefe eindringung eindrucktiefe pénétration \
            penetración penetracion enfoncement corsa posizione allungamento deformazione compressione penetrazione profondità profondita indentación indentacion posición posicion hub 变形 變形 压缩量 压入深度 伸長 \
            伸び 変形量 圧縮量 押込み量 押込量 押込み深さ ход удлинение деформация сжатие положение координата глубина вдавливание \
            внедрение траверса прогиб осадка 신장 연신 변형량 압축량 압입량 압입깊이 위치 이동량",
        endings: "weg",
        characters: "位移 変位 變位 ストローク 변위 스트로크 이동거리",
        letter: None,
    },
    Vocabulary {
        quantity: Quantity::Force,
        plain: "force load kraft fuerza forza сила усилие нагрузка силы",
        loose: "loadcell effort charge carga carico fx fy fz fn",
        endings: "kraft",
        characters: "力 载荷 荷重 负荷 負荷 하중 힘 시험력",
        letter: Some("F"),
    },
    Vocabulary {
        quantity: Quantity::Stress,
        plain: "stress spannung contrainte esfuerzo tensione sforzo напряжение",
        loose: "",
        endings: "spannung",
        characters: "应力 応力 응력",
        letter: None,
    },
];

/// The words of a name that say that its column is no measurement of the quantity that it names. A nominal stress or strain is one per section or
/// length of the body at rest, and no setpoint.
pub(crate) fn other_words(words: &[String]) -> impl Iterator<Item = &String> {
    let is_engineering = words.iter().any(|word| is_listed(word, PER_DIMENSION));
    let is_other = |word: &str| is_listed(word, OTHER) || is_listed(word, EXTREMES);
    words.iter().filter(move |word| is_other(word) && !(is_engineering && *word == "nominal"))
}

/// Words of what is a force per section, or a travel per length.
const PER_DIMENSION: &str =
    "strain dehnung deformation déformation deformación verformung stress spannung contrainte esfuerzo tensione";

/// Words of the largest, the smallest and the spread of values.
const EXTREMES: &str =
    "max min maximum minimum peak std sd stdev макс мин максимум минимум максимальная максимальное минимальная";

/// Words of the mean of values.
pub(crate) const MEANS: &str =
    "mean average avg moyenne moyen mittel mittelwert mittelwertkurve media promedio médiane median среднее 平均 평균";

/// Words of their spread beside those.
const SPREADS: &str = "standardabweichung standardabw stabw abweichung écart ecart desviación desviacion deviazione отклонение range spannweite \
    cov variance varianz";

/// Whether a text is what a line of statistics begins with: `Max`, `Mean value`, `Std. dev.`.
pub(crate) fn names_statistic(words: &[String]) -> bool {
    let is_one = |list| words.iter().any(|word| is_listed(word, list));
    is_one(EXTREMES) || is_one(MEANS) || is_one(SPREADS)
}

/// Words of commands and limits, of errors and counts, and of quantities derived from one.
const OTHER: &str = "goal target set setpoint command commanded cmd demand desired reference ref nominal soll consigne objetivo \
    limit threshold schwelle seuil umbral per error count offset rate \
    speed velocity acceleration strain size dehnung velocità velocita stiffness modulus constant compliance viscosity oscillation oscillatory complex \
    storage loss amplitude temperature temperatur température temperatura temp humidity скорость задание заданная заданное уставка \
    предел ошибка температура относительная модуль";

/// Beginnings of German words for what was commanded, not measured: `Sollweg`, `Sollkraft`, `Sollwert`.
pub(crate) const COMMANDED: &str = "soll vorgabe";

/// Words of a stress on the section as it is and of a strain of the length as it is, or of another measure of large strain: true, Cauchy, Hencky,
/// logarithmic, Green, Lagrange, Almansi.
pub(crate) const TRUE_MEASURES: &str = "true cauchy hencky green lagrange lagrangian almansi logarithmic log ln natural wahr wahre wahrer wahres logarithmisch logarithmische \
    vrai vraie rationnelle logarithmique verdadero verdadera real logarítmica logaritmica vero vera reale истинное истинная истинные \
    логарифмическая";

/// The same in Chinese, Japanese and Korean.
pub(crate) const TRUE_CHARACTERS: &str = "真应 真應 真实应 真応 真ひずみ 対数 对数 진응력 진변형";

/// Words of a time that begins anew with each part of a test.
pub(crate) const OF_A_PART: &str = "step action interval segment intervalle abschnitt schritt étape etape";

/// Words of what one test has many of.
pub(crate) const WITHIN_A_TEST: &str = "cycle cycles zyklus zyklen ciclo ciclos cicli цикл циклы scan scans point points punkt punkte punto puntos \
    punti точка row rows readings block blocks steps segments intervals";

/// Words for the number of something.
pub(crate) const NUMBERS: &str = "no nr number nummer numéro numero número номер count index";

/// Words of a force along the axis of a machine, which is not the load of a body in shear.
pub(crate) const AXIAL: &str = "normal normale axial axiale normalkraft axialkraft";

/// Words of quantities of a body in shear.
pub(crate) const SHEAR: &str = "shear cisaillement scherung schub schubspannung scherdeformation torque couple drehmoment cizalla \
    cizallamiento";

/// Words that make a rate of shear of a name with one of those, and those that say it alone.
pub(crate) const RATES_OF_SHEAR: &str = "rate gradient vitesse taux velocidad geschwindigkeit";
pub(crate) const SHEAR_RATES: &str = "scherrate schergeschwindigkeit schergefälle";

/// Words of the modulus that an oscillation gives: strain and stress beside it are its amplitudes.
pub(crate) const STORAGE: &str = "storage speichermodul stockage conservation almacenamiento";

/// Words of columns that count or label rows.
pub(crate) const COUNTS: &str =
    "sample samples index point points row rows nr no number nummer numéro id cycle cycles status state segment";

/// The same in Chinese, Japanese and Korean: target, set, command, strain, rate, greatest, least.
pub(crate) const OTHER_CHARACTERS: &str =
    "目标 目標 设定 設定 指令 应变 ひずみ 速度 最大 最小 목표 설정 지령 변형률 변형율 속도 최대 최소";

/// Names of the cantilever's bending in force curves, which is no travel of a jaw though it is a length.
pub(crate) const BENDING: &[&str] = &["vDeflection", "hDeflection", "cantilever deflection"];

/// Names, bare of any unit, that may well mean a displacement.
pub(crate) const SIGNS_OF_LENGTH: &str = "x y z d s u w h δ delta dx dz dl Δl";

/// Words of an extensometer, which measures on the body and not at the crosshead.
pub(crate) const EXTENSOMETERS: &str = "extensometer extensomètre extensometre extensómetro estensometro dehnungsaufnehmer \
    dehnungsmesser wegaufnehmer feindehnung экстензометр 신율계 引伸计 伸び計";

/// Words of a strain gauge, which may be that of a load cell.
pub(crate) const STRAIN_GAUGES: &str = "gauge gauges gage gages dms jauge galga";

/// Words of quantities that some machines give as a length, though they mean a ratio.
pub(crate) const STRAINS: &str = "strain dehnung";

/// The column of a bending that the file does not make a force of.
pub(crate) const UNCALIBRATED: &str = "uncalibrated force";
