//! The encoding of a text that is no UTF-8.

use encoding_rs::{
    BIG5, EUC_JP, EUC_KR, Encoding, GBK, SHIFT_JIS, UTF_16BE, UTF_16LE, WINDOWS_1251, WINDOWS_1252,
};

/// What measurements are called in the languages of an encoding: a header of any of them holds one of these words, and no letters of Western
/// Europe happen to read so.
const WORDS: [(&Encoding, &[&str]); 6] = [
    (
        SHIFT_JIS,
        &[
            "時間",
            "時刻",
            "変位",
            "荷重",
            "位置",
            "速度",
            "温度",
            "圧力",
            "電圧",
            "電流",
            "角度",
            "トルク",
            "指令",
            "測定",
            "℃",
        ],
    ),
    (
        EUC_JP,
        &[
            "時間",
            "時刻",
            "変位",
            "荷重",
            "位置",
            "速度",
            "温度",
            "圧力",
            "電圧",
            "電流",
            "角度",
            "トルク",
            "指令",
            "測定",
        ],
    ),
    (
        GBK,
        &[
            "时间", "位移", "载荷", "位置", "速度", "温度", "压力", "电压", "电流", "角度", "转速", "扭矩",
            "试验", "力值", "序号",
        ],
    ),
    (
        BIG5,
        &[
            "時間", "位移", "荷重", "位置", "速度", "溫度", "壓力", "電壓", "電流", "角度", "轉速", "扭矩",
            "測試",
        ],
    ),
    (
        EUC_KR,
        &["시간", "변위", "하중", "위치", "속도", "온도", "압력", "전압", "전류", "각도", "토크", "시험"],
    ),
    (
        WINDOWS_1251,
        &[
            "время",
            "перемещ",
            "сила",
            "усилие",
            "положение",
            "скорость",
            "температура",
            "давление",
            "напряжение",
            "угол",
            "момент",
            "нагрузка",
            "канал",
            "дата",
            "испытан",
        ],
    ),
];

/// UTF-16 without a mark: every other of the first bytes is zero.
pub(crate) fn unmarked(bytes: &[u8]) -> Option<&'static Encoding> {
    /// Bytes that are enough.
    const LOOKED_AT: usize = 64;
    let first = &bytes[..bytes.len().min(LOOKED_AT) / 2 * 2];
    let are_zero = |from: usize| {
        let zeros = |from: usize| first.iter().skip(from).step_by(2);
        first.len() >= 8 && zeros(from).all(|byte| *byte == 0) && zeros(1 - from).all(|byte| *byte != 0)
    };
    if are_zero(1) { Some(UTF_16LE) } else { are_zero(0).then_some(UTF_16BE) }
}

/// The encoding in which bytes that are no UTF-8 are likely text: Windows-1252 (its printable part is Latin-1) unless another is proved.
pub(crate) fn of(bytes: &[u8]) -> &'static Encoding {
    // What is cut off within a letter is no fault of the text.
    let end = bytes.iter().rposition(|byte| *byte == b'\n').map_or(bytes.len(), |end| end + 1);
    let bytes = &bytes[..end];
    let decoded = |encoding: &'static Encoding| {
        encoding.decode_without_bom_handling_and_without_replacement(bytes).map(|text| text.to_lowercase())
    };
    let count = |(encoding, words): &(&'static Encoding, &[&str])| {
        let text = decoded(encoding)?;
        let found = words.iter().filter(|word| text.contains(*word)).count();
        (found > 0).then_some((found, *encoding))
    };
    // Of equal counts the first.
    let best = WORDS.iter().rev().filter_map(count).max_by_key(|(found, _)| *found);
    match best {
        Some((_, encoding)) => encoding,
        None if is_japanese(bytes) => SHIFT_JIS,
        None => WINDOWS_1252,
    }
}

/// Whether most letters beyond ASCII are pairs that begin with a byte from 0x81 to 0x9F and follow each other: Windows-1252 has marks of printers
/// there, which stand alone.
fn is_japanese(bytes: &[u8]) -> bool {
    let is_valid = SHIFT_JIS.decode_without_bom_handling_and_without_replacement(bytes).is_some();
    let (mut at, mut pairs, mut neighbours, mut others) = (0, 0, 0, 0);
    let mut last_end = 0;
    while at < bytes.len() {
        match bytes[at] {
            0x81..=0x9f => {
                pairs += 1;
                neighbours += usize::from(pairs > 1 && last_end == at);
                at += 2;
                last_end = at;
            }
            0x80.. => {
                others += 1;
                at += 1;
            }
            _ => at += 1,
        }
    }
    is_valid && pairs >= 4 && 2 * neighbours >= pairs && pairs > others
}

/// Whether a name read as Windows-1252 is hardly one: signs of printers between letters, or three letters beyond ASCII in a row.
pub(crate) fn is_unlikely(name: &str) -> bool {
    let is_sign = |c: char| {
        ('\u{80}'..='\u{9f}').contains(&c)
            || c == '\u{fffd}'
            || "‚ƒ„…†‡ˆ‰‹•˜™›€¡¢£¤¥¦¨©ª«»¬®¯¶¸¹º¼½¾¿".contains(c)
    };
    let letters: Vec<char> = name.chars().collect();
    let is_between = letters
        .windows(3)
        .any(|three| three[0].is_alphabetic() && is_sign(three[1]) && three[2].is_alphabetic());
    let is_run = letters.windows(3).any(|three| three.iter().all(|c| !c.is_ascii()));
    is_between || is_run || letters.iter().filter(|c| is_sign(**c)).count() >= 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_of_its_language_proves_an_encoding() {
        for (encoding, header) in [
            (SHIFT_JIS, "時間,変位,荷重\ns,mm,N\n"),
            (EUC_JP, "時間,変位,荷重\ns,mm,N\n"),
            (GBK, "时间,位移,力\ns,mm,N\n"),
            (BIG5, "時間,位移,荷重,溫度\n"),
            (EUC_KR, "시간(s),변위(mm),하중(N)\n"),
            (WINDOWS_1251, "Время, с;Перемещение, мм;Сила, Н\n"),
        ] {
            let (bytes, ..) = encoding.encode(header);
            assert_eq!(of(&bytes), encoding, "{header}");
        }
        let (kana, ..) = SHIFT_JIS.encode("ストローク,ロードセル\n");
        assert_eq!(of(&kana), SHIFT_JIS, "pairs that follow each other");
    }

    #[test]
    fn letters_of_western_europe_stay() {
        for header in [
            "Prüfzeit;Weg Stößel;Kraft;Temperatur [°C]\n",
            "Déplacement (mm);Température (°C);Élévation;N° cycle\n",
            "Señal;Posición;Ángulo – “bruto”\n",
            "Öl;Übermaß;Größe;ÄÖÜ;µm;±5‰\n",
        ] {
            let (bytes, ..) = WINDOWS_1252.encode(header);
            assert_eq!(of(&bytes), WINDOWS_1252, "{header}");
            assert!(header.trim().split(';').all(|name| name == "ÄÖÜ" || !is_unlikely(name)), "{header}");
        }
        for name in ["ŽžŠÔ", "Î»ÒÆ", "Âðåìÿ", "½Ã°£", "L„nge", "Po³o¿enie"] {
            assert!(is_unlikely(name), "{name}");
        }
    }

    #[test]
    fn every_other_byte_of_sixteen_bit_letters_is_zero() {
        let little: Vec<u8> = "Time\t1".encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = "Time\t1".encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!((unmarked(&little), unmarked(&big)), (Some(UTF_16LE), Some(UTF_16BE)));
        assert_eq!(unmarked(b"Time,Force\n"), None);
    }
}
