//! Words that headers of records use, in English, German, French, Spanish, Italian, Chinese and Japanese.

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
    /// Parts of Chinese and Japanese names, which have no gaps between words.
    pub(crate) characters: &'static str,
    /// One letter that stands for the quantity, in this case alone.
    pub(crate) letter: Option<&'static str>,
}

pub(crate) const VOCABULARY: [Vocabulary; 4] = [
    Vocabulary {
        quantity: Quantity::Time,
        plain: "time zeit temps tiempo tempo",
        loose: "elapsed seconds secondes sekunden segundos minutes minuten minutos hours stunden heures timestamp stamp zeitstempel horodatage epoch durée duree secondi",
        endings: "zeit",
        characters: "时间 時間",
        letter: Some("t"),
    },
    Vocabulary {
        quantity: Quantity::Displacement,
        plain: "displacement verschiebung weg déplacement deplacement desplazamiento spostamento",
        loose: "extension travel stroke crosshead traverse position pos indentation allongement deflection course \
            recorrido carrera disp distance distanz distancia depth tiefe profondeur profundidad elongation pd \
            extensión alargamiento deformation verformung déformation deformación deformacion compression \
            stauchung eindrückung eindrueckung eindruckung compresión compresion penetration eindringtiefe eindringung eindrucktiefe pénétration \
            penetración penetracion enfoncement corsa posizione allungamento deformazione compressione penetrazione profondità profondita indentación indentacion posición posicion hub 变形 變形 压缩量 压入深度 伸長 \
            伸び 変形量 圧縮量 押込み量 押込量 押込み深さ",
        endings: "weg",
        characters: "位移 変位 變位 ストローク",
        letter: None,
    },
    Vocabulary {
        quantity: Quantity::Force,
        plain: "force load kraft fuerza forza",
        loose: "loadcell effort charge carga carico fx fy fz fn",
        endings: "kraft",
        characters: "力 载荷 荷重 负荷 負荷",
        letter: Some("F"),
    },
    Vocabulary {
        quantity: Quantity::Stress,
        plain: "stress spannung contrainte esfuerzo tensione sforzo",
        loose: "",
        endings: "spannung",
        characters: "应力 応力",
        letter: None,
    },
];

/// Words of columns that are no measurement of the quantity they name: commands, limits, statistics, and
/// quantities derived from it.
pub(crate) const OTHER: &str = "goal target set setpoint command commanded cmd demand desired reference ref nominal soll consigne objetivo \
    limit threshold schwelle seuil umbral per max min maximum minimum peak std sd stdev error count offset rate \
    speed velocity acceleration strain size dehnung velocità velocita stiffness modulus constant compliance viscosity oscillation oscillatory complex \
    storage loss amplitude temperature temperatur température temperatura temp humidity";

/// Beginnings of German words for what was commanded, not measured: `Sollweg`, `Sollkraft`, `Sollwert`.
pub(crate) const COMMANDED: &str = "soll vorgabe";

/// Words of a time that begins anew with each part of a test.
pub(crate) const OF_A_PART: &str = "step action interval segment intervalle abschnitt schritt étape etape";

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

/// The same in Chinese and Japanese: target, set, command, strain, rate, greatest, least.
pub(crate) const OTHER_CHARACTERS: &str = "目标 目標 设定 設定 指令 应变 ひずみ 速度 最大 最小";

/// Names of the cantilever's bending in force curves, which is no travel of a jaw though it is a length.
pub(crate) const BENDING: &[&str] = &["vDeflection", "hDeflection", "cantilever deflection"];

/// Names, bare of any unit, that may well mean a displacement.
pub(crate) const SIGNS_OF_LENGTH: &str = "x y z d s u w h δ delta dx dz dl Δl";

/// Words of quantities that some machines give as a length, though they mean a ratio.
pub(crate) const STRAINS: &str = "strain dehnung";

/// The column of a bending that the file does not make a force of.
pub(crate) const UNCALIBRATED: &str = "uncalibrated force";
