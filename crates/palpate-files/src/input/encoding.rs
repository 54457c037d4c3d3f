//! Telling character encodings apart by content.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Character encoding of a text file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
pub enum Encoding {
    /// UTF-8, with or without a byte order mark; plain ASCII too.
    #[serde(rename = "utf-8")]
    Utf8,
    /// UTF-16, low byte first.
    #[serde(rename = "utf-16le")]
    Utf16Le,
    /// UTF-16, high byte first.
    #[serde(rename = "utf-16be")]
    Utf16Be,
    /// GBK (simplified Chinese), which contains GB 2312; read as its superset GB 18030 where it is one.
    #[serde(rename = "gbk")]
    Gbk,
    /// Shift JIS (Japanese), as Windows writes it.
    #[serde(rename = "shift_jis")]
    ShiftJis,
    /// EUC-KR (Korean), as Windows writes it (code page 949).
    #[serde(rename = "euc-kr")]
    EucKr,
    /// Windows-1251 (Cyrillic).
    #[serde(rename = "windows-1251")]
    Windows1251,
    /// Windows-1252, which contains Latin-1.
    #[serde(rename = "windows-1252")]
    Windows1252,
}

impl Encoding {
    /// Every encoding that can be read.
    const ALL: [Self; 8] = [
        Self::Utf8,
        Self::Utf16Le,
        Self::Utf16Be,
        Self::Gbk,
        Self::ShiftJis,
        Self::EucKr,
        Self::Windows1251,
        Self::Windows1252,
    ];

    /// Whether line ends, delimiters, quotes and digits are the same bytes as in ASCII and occur in no other
    /// role, so that rows can be split without decoding. Second bytes of GBK, Shift JIS and EUC-KR start at 0x40 ('@'); the digits
    /// inside four-byte GB 18030 sequences are harmless, because no digit splits anything.
    pub(crate) fn splits_like_ascii(self) -> bool {
        !matches!(self, Self::Utf16Le | Self::Utf16Be)
    }

    pub(crate) fn codec(self) -> &'static encoding_rs::Encoding {
        match self {
            Self::Utf8 => encoding_rs::UTF_8,
            Self::Utf16Le => encoding_rs::UTF_16LE,
            Self::Utf16Be => encoding_rs::UTF_16BE,
            Self::Gbk => encoding_rs::GBK,
            Self::ShiftJis => encoding_rs::SHIFT_JIS,
            Self::EucKr => encoding_rs::EUC_KR,
            Self::Windows1251 => encoding_rs::WINDOWS_1251,
            Self::Windows1252 => encoding_rs::WINDOWS_1252,
        }
    }

    /// Length in bytes of the byte order mark of this encoding at the start of `bytes`, 0 if there is none.
    pub(crate) fn mark_length(self, bytes: &[u8]) -> usize {
        match encoding_rs::Encoding::for_bom(bytes) {
            Some((codec, length)) if codec == self.codec() => length,
            _ => 0,
        }
    }
}

shown_as_written!(
    /// Its usual name, in lower case.
    Encoding
);

/// The encoding that `sample`, the beginning of a file, is most likely written in.
///
/// `None`: it holds NUL bytes and is no UTF-16, so it is no text.
pub(crate) fn recognise(sample: &[u8]) -> Option<Encoding> {
    if let Some((codec, _)) = encoding_rs::Encoding::for_bom(sample) {
        return Encoding::ALL.into_iter().find(|own| own.codec() == codec);
    }
    if sample.contains(&0) {
        return unmarked_utf16(sample);
    }
    match std::str::from_utf8(sample) {
        Ok(_) => Some(Encoding::Utf8),
        // No error length: the sample merely ends inside a character.
        Err(error) if error.error_len().is_none() => Some(Encoding::Utf8),
        Err(_) if looks_japanese(sample) => Some(Encoding::ShiftJis),
        Err(_) if looks_cyrillic(sample) => Some(Encoding::Windows1251),
        Err(_) if looks_korean(sample) => Some(Encoding::EucKr),
        Err(_) if looks_chinese(sample) => Some(Encoding::Gbk),
        Err(_) => Some(Encoding::Windows1252),
    }
}

/// UTF-16 of mostly Western text has NUL as every second byte; which second byte gives the order.
fn unmarked_utf16(sample: &[u8]) -> Option<Encoding> {
    let pairs = sample.len() / 2;
    let zeros = |odd: usize| sample.iter().skip(odd).step_by(2).filter(|&&byte| byte == 0).count();
    let (even, odd) = (zeros(0), zeros(1));
    let only = |many: usize, few: usize| pairs >= 2 && many * 10 > pairs * 6 && few * 100 <= pairs;
    match only(odd, even) {
        true => Some(Encoding::Utf16Le),
        false => only(even, odd).then_some(Encoding::Utf16Be),
    }
}

/// Whether the bytes above ASCII are words of Cyrillic letters: three or more in a row, all small but perhaps the first, or all large;
/// two words or a long one.
///
/// Letters with accents stand alone in Western words, and pairs of Chinese and Korean mix what would be small and large letters.
fn looks_cyrillic(sample: &[u8]) -> bool {
    const LARGE: std::ops::RangeInclusive<u8> = 0xC0..=0xDF;
    let is_small = |byte: &u8| *byte >= 0xE0 || *byte == 0xB8;
    let is_word = |run: &[u8]| match run {
        [first, rest @ ..] => {
            let is_capital = LARGE.contains(first) || *first == 0xA8;
            let all_large = rest.iter().all(|byte| LARGE.contains(byte));
            run.len() > 2 && (is_capital || is_small(first)) && (rest.iter().all(is_small) || is_capital && all_large)
        }
        [] => false,
    };
    // The blank that breaks no line stands between thousands.
    let runs = sample.split(|byte| *byte < 0x80 || *byte == 0xA0);
    let (in_words, others) = runs.fold((0, 0), |(in_words, others), run| match is_word(run) {
        true => (in_words + run.len(), others),
        false => (in_words, others + run.len()),
    });
    in_words > 5 && in_words > 2 * others
}

/// Whether the bytes above ASCII pair up as Korean syllables, of which there are four or more.
///
/// All of them begin in the first half of the rows that Chinese has its common characters in, as these never do for long.
fn looks_korean(sample: &[u8]) -> bool {
    let (mut syllables, mut bytes) = (0_usize, sample.iter().copied());
    while let Some(lead) = bytes.next() {
        if lead < 0x80 {
            continue;
        }
        match (lead, bytes.next()) {
            (_, None) => break,
            (0xB0..=0xC8, Some(0xA1..=0xFE)) => syllables += 1,
            (0xA1..=0xA3, Some(0xA1..=0xFE)) => {}
            _ => return false,
        }
    }
    syllables >= 4
}

/// Whether the bytes above ASCII pair up as everyday Chinese.
///
/// Almost any Latin-1 text decodes as GBK without an error ("°C" is one rare character), so validity says
/// little. What tells is the share of pairs in the rows of GB 2312 that hold punctuation (A1-A3) and the
/// common characters (B0-D7).
fn looks_chinese(sample: &[u8]) -> bool {
    let (mut common, mut rare) = (0_usize, 0_usize);
    let mut bytes = sample.iter().copied();
    while let Some(lead) = bytes.next() {
        if lead < 0x80 {
            continue;
        }
        match (lead, bytes.next()) {
            // The sample ends between the two bytes of a pair.
            (_, None) => break,
            (0xA1..=0xA3 | 0xB0..=0xD7, Some(0xA1..=0xFE)) => common += 1,
            (0x81..=0xFE, Some(0x40..=0x7E | 0x80..=0xFE)) => rare += 1,
            _ => return false,
        }
    }
    common > 0 && common >= 2 * rare
}

/// Whether the bytes above ASCII pair up as everyday Japanese.
///
/// Kana and the common characters begin with 0x81 to 0x84 and 0x88 to 0x98. In Western text quotes and dashes do so, too, but
/// stand alone, whereas words of Japanese have several characters. Narrow kana (0xA1 to 0xDF) are single bytes and tell nothing.
fn looks_japanese(sample: &[u8]) -> bool {
    let (mut in_words, mut alone, mut run) = (0_usize, 0_usize, 0_usize);
    let mut bytes = sample.iter().copied();
    let mut ended = |run: &mut usize| {
        *(if *run > 1 { &mut in_words } else { &mut alone }) += *run;
        *run = 0;
    };
    while let Some(lead) = bytes.next() {
        match lead {
            0xA1..=0xDF => continue,
            0..0x80 => {
                ended(&mut run);
                continue;
            }
            _ => {}
        }
        match (lead, bytes.next()) {
            (_, None) => break,
            (0x81..=0x84 | 0x88..=0x98, Some(0x40..=0x7E | 0x80..=0xFC)) => run += 1,
            _ => return false,
        }
    }
    ended(&mut run);
    in_words > alone
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_and_plain_text() {
        assert_eq!(recognise(b"\xEF\xBB\xBFa,b"), Some(Encoding::Utf8));
        assert_eq!(recognise(b"\xFF\xFEa\0"), Some(Encoding::Utf16Le));
        assert_eq!(recognise(b"\xFE\xFF\0a"), Some(Encoding::Utf16Be));
        assert_eq!(recognise(b"a,b\n1,2\n"), Some(Encoding::Utf8));
        assert_eq!(recognise("Kraft µ".as_bytes()), Some(Encoding::Utf8));
        assert_eq!(recognise(&"µ".as_bytes()[..1]), Some(Encoding::Utf8));
    }

    #[test]
    fn utf16_without_a_mark() {
        assert_eq!(recognise(b"1\0,\x002\0\n\x003\0,\0"), Some(Encoding::Utf16Le));
        assert_eq!(recognise(b"\x001\0,\x002\0\n\x003\0,"), Some(Encoding::Utf16Be));
        assert_eq!(recognise(b"1,2\0\0\0\0\0\0"), None);
    }

    #[test]
    fn chinese_against_western() {
        // "时间,位移,力"
        assert_eq!(recognise(b"\xCA\xB1\xBC\xE4,\xCE\xBB\xD2\xC6,\xC1\xA6\n"), Some(Encoding::Gbk));
        for western in
            [&b"Temp (\xB0C), d (\xB5m)"[..], b"Gr\xF6\xDFe;Weg (\xB5m)", b"d\xE9placement,temps", b"fin \xE9\n"]
        {
            assert_eq!(recognise(western), Some(Encoding::Windows1252));
        }
    }

    #[test]
    fn cyrillic_and_korean_against_the_others() {
        let encoded = |text: &str, encoding: Encoding| encoding.codec().encode(text).0.into_owned();
        for text in [
            "Время, с; Сила, Н; Перемещение, мм\n",
            "ПРОТОКОЛ\nУсилие (кН)\n1\u{a0}250,5\n",
            "Ход, мм; Время, с; Ёмкость",
        ] {
            assert_eq!(recognise(&encoded(text, Encoding::Windows1251)), Some(Encoding::Windows1251), "{text}");
        }
        for text in ["시간(s), 하중(N), 변위(mm)\n", "시간(초),하중(뉴턴),변위(밀리미터)\n", "시험력 (kN)\n시간"]
        {
            assert_eq!(recognise(&encoded(text, Encoding::EucKr)), Some(Encoding::EucKr), "{text}");
        }
        for text in ["时间,位移,力\n", "试验力(N)\n", "试验时间,变形,载荷\n", "时间(秒),力,负荷\n"]
        {
            assert_eq!(recognise(&encoded(text, Encoding::Gbk)), Some(Encoding::Gbk), "{text}");
        }
        for text in ["Déplacement (µm);Température (°C)\n", "Größe;Prüfkraft\n", "Übersicht: »Länge«\n", "ÄÖÜ\n"]
        {
            assert_eq!(recognise(&encoded(text, Encoding::Windows1252)), Some(Encoding::Windows1252), "{text}");
        }
    }

    #[test]
    fn japanese_against_western_and_chinese() {
        // "時間(s),変位(μm),荷重(N)"
        let header = b"\x8E\x9E\x8A\xD4(s),\x95\xCF\x88\xCA(\x83\xCAm),\x89\xD7\x8F\x64(N)\n";
        assert_eq!(recognise(header), Some(Encoding::ShiftJis));
        // "ストローク"
        assert_eq!(recognise(b"\x83X\x83g\x83\x8D\x81[\x83N\n"), Some(Encoding::ShiftJis));
        for western in [&b"Vitesse d\x92essai (mm/min)"[..], b"l\x92\xE9paisseur", b"10 \x96 20 mm", b"d\x92\xE9t\xE9 "]
        {
            assert_eq!(recognise(western), Some(Encoding::Windows1252));
        }
    }
}
