//! How every figure looks: colours, letters, lines, marks and numbers. No other file of the figures has constants of style.

use plotters::style::RGBColor;

/// Width of a page, pixels.
pub(crate) const WIDTH: f64 = 960.0;

/// Width of a figure of one diagram, pixels.
pub(crate) const NARROW: f64 = 640.0;

/// Room between the edge of a page and its contents, pixels.
pub(crate) const MARGIN: f64 = 18.0;

/// Okabe and Ito's palette (jfly.uni-koeln.de/color) without black and yellow, which serve badly as data on white.
pub(crate) const OKABE_ITO: [RGBColor; 6] = [
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xCC, 0x79, 0xA7),
    RGBColor(0xE6, 0x9F, 0x00),
    RGBColor(0x56, 0xB4, 0xE9),
];

/// Text, frames and truth.
pub(crate) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);

/// Secondary text, ticks, and measured values.
pub(crate) const GREY: RGBColor = RGBColor(0x6E, 0x6E, 0x6E);

/// Grid lines and the ground of bars.
pub(crate) const FAINT: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);

/// The background.
pub(crate) const PAPER: RGBColor = RGBColor(0xFF, 0xFF, 0xFF);

/// The border that the working point follows when the input falls.
pub(crate) const DESCENDING: RGBColor = OKABE_ITO[0];

/// … when it rises.
pub(crate) const ASCENDING: RGBColor = OKABE_ITO[1];

/// A model before it is repaired.
pub(crate) const BEFORE: RGBColor = OKABE_ITO[1];

/// … and after.
pub(crate) const AFTER: RGBColor = OKABE_ITO[0];

/// Things as they should be: found, right, within chance.
pub(crate) const GOOD: RGBColor = OKABE_ITO[0];

/// Things as they should not be: missed, wrong, beyond chance.
pub(crate) const BAD: RGBColor = OKABE_ITO[1];

/// How strongly a colour is mixed with the background where it stands behind the same colour in full.
pub(crate) const PALE: f64 = 0.35;

/// A colour mixed with the background: 1 keeps it, 0 is the background. Opaque, so that overlaps do not add up.
pub(crate) fn tint(colour: RGBColor, share: f64) -> RGBColor {
    let mix = |c: u8| (255.0 - (255.0 - f64::from(c)) * share).round() as u8;
    RGBColor(mix(colour.0), mix(colour.1), mix(colour.2))
}

/// A line's colour and width in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Pen {
    /// Ink.
    pub colour: RGBColor,
    /// Eighths of a pixel.
    eighths: u32,
}

impl Pen {
    const fn new(colour: RGBColor, eighths: u32) -> Self {
        Self { colour, eighths }
    }

    /// Frames, ticks and grid lines.
    pub(crate) const fn hair(colour: RGBColor) -> Self {
        Self::new(colour, 8)
    }

    /// Data, and bars of intervals.
    pub(crate) const fn data(colour: RGBColor) -> Self {
        Self::new(colour, 13)
    }

    /// Lines behind data, seen where both coincide.
    pub(crate) const fn broad(colour: RGBColor) -> Self {
        Self::new(colour, 40)
    }

    /// Width, pixels.
    pub(crate) fn width(self) -> f64 {
        f64::from(self.eighths) / 8.0
    }
}

/// Where a text stands relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// It begins at the point.
    Start,
    /// It is centred on the point.
    Middle,
    /// It ends at the point.
    End,
}

/// How a text looks: its purpose, and its place. Vertically it is centred on its point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TextLook {
    /// Height of the letters' box, pixels.
    pub size: f64,
    /// Ink.
    pub colour: RGBColor,
    /// Horizontal placing.
    pub anchor: Anchor,
    /// Whether it is thicker.
    pub bold: bool,
    /// Whether it runs upwards.
    pub upwards: bool,
}

impl TextLook {
    const fn new(size: f64) -> Self {
        Self { size, colour: INK, anchor: Anchor::Start, bold: false, upwards: false }
    }

    /// The subject of a figure.
    pub(crate) const fn title() -> Self {
        Self { bold: true, ..Self::new(23.0) }
    }

    /// How it is to be read.
    pub(crate) const fn note() -> Self {
        Self { colour: GREY, ..Self::new(16.0) }
    }

    /// Names of series and rows, legends.
    pub(crate) const fn label() -> Self {
        Self::new(16.0)
    }

    /// The subject of a diagram.
    pub(crate) const fn heading() -> Self {
        Self { bold: true, ..Self::new(16.0) }
    }

    /// Names of axes.
    pub(crate) const fn axis() -> Self {
        Self::new(15.5)
    }

    /// Numbers at axes and beside marks.
    pub(crate) const fn number() -> Self {
        Self::new(15.0)
    }

    /// Numbers where there is little room.
    pub(crate) const fn small() -> Self {
        Self::new(13.0)
    }

    /// The same, centred.
    pub(crate) const fn middle(self) -> Self {
        Self { anchor: Anchor::Middle, ..self }
    }

    /// The same, ending at its point.
    pub(crate) const fn end(self) -> Self {
        Self { anchor: Anchor::End, ..self }
    }

    /// The same, thicker.
    pub(crate) const fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    /// The same, running upwards.
    pub(crate) const fn upwards(self) -> Self {
        Self { upwards: true, ..self }
    }

    /// The same in another colour.
    pub(crate) const fn colour(self, colour: RGBColor) -> Self {
        Self { colour, ..self }
    }

    /// Height of a line of such text, pixels.
    pub(crate) fn line(self) -> f64 {
        (1.4 * self.size).round()
    }

    /// How wide a text comes out, pixels, roughly: letters are about half as wide as their box is high.
    pub(crate) fn width(self, text: &str) -> f64 {
        let letter = if self.bold { 0.49 } else { 0.465 };
        letter * self.size * text.chars().count() as f64
    }

    /// A text cut to so many pixels, with an ellipsis where something was cut off.
    pub(crate) fn fitted(self, text: &str, width: f64) -> String {
        if self.width(text) <= width {
            return text.to_owned();
        }
        let kept = (width / self.width("n")) as usize;
        text.chars().take(kept.saturating_sub(1)).chain(['…']).collect()
    }

    /// Breaks a text at spaces into lines no wider than so many pixels.
    pub(crate) fn wrapped(self, text: &str, width: f64) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for word in text.split_whitespace() {
            match lines.last_mut() {
                Some(line) if self.width(line) + self.width(word) + self.size / 2.0 <= width => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_owned()),
            }
        }
        lines
    }
}

/// Shapes of marks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// A disc.
    Disc,
    /// A square.
    Square,
    /// A square on its corner.
    Diamond,
    /// A triangle on its side.
    Triangle,
    /// Two lines that cross.
    Cross,
}

impl Shape {
    /// Those with an inside, in the order in which they are used up.
    pub(crate) const ALL: [Self; 4] = [Self::Disc, Self::Square, Self::Diamond, Self::Triangle];
}

/// Radius of a mark that stands for itself, pixels.
pub(crate) const RADIUS: f64 = 4.0;

/// … where there are many.
pub(crate) const SMALL_RADIUS: f64 = 2.5;

/// U+2212 in place of a hyphen before a number; hyphens within words and names stay.
pub(crate) fn minus(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut before = ' ';
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        let begins = before.is_whitespace() || "([±×=<>≤≥|,;/".contains(before);
        let number = letters.peek().is_some_and(|next| next.is_ascii_digit() || *next == '.' || *next == '∞');
        out.push(if letter == '-' && begins && number { '−' } else { letter });
        before = letter;
    }
    out
}

/// A short number: plain where it has few digits, `3·10⁻⁵` elsewhere.
pub(crate) fn plain(x: f64) -> String {
    if x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
        return minus(&format!("{}", (x * 1e9).round() / 1e9));
    }
    let text = format!("{x:e}");
    let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
    let power = power_of_ten(power.parse().unwrap_or(0));
    minus(&if digits == "1" { power } else { format!("{digits}·{power}") })
}

/// A number to so many digits.
pub(crate) fn rounded(x: f64, digits: usize) -> String {
    plain(format!("{x:.*e}", digits.max(1) - 1).parse().unwrap_or(x))
}

/// `10⁻³`; `1` and `10` as they are.
pub(crate) fn power_of_ten(power: i32) -> String {
    if let 0 | 1 = power {
        return if power == 0 { "1" } else { "10" }.to_owned();
    }
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits: String =
        power.unsigned_abs().to_string().bytes().map(|b| DIGITS[usize::from(b - b'0')]).collect();
    format!("10{}{digits}", if power < 0 { "⁻" } else { "" })
}

/// A count, its digits in groups of three: `100,000`.
pub(crate) fn count(n: usize) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

/// A share in percent to so many decimals.
pub(crate) fn percent(share: f64, decimals: usize) -> String {
    let unit = 10f64.powi(decimals as i32);
    // Adding zero turns the −0 of rounding into 0.
    minus(&format!("{:.decimals$} %", (100.0 * share * unit).round() / unit + 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minus_signs_stand_before_numbers_only() {
        assert_eq!(minus("-0.5 to -3"), "−0.5 to −3");
        assert_eq!(minus("paper-descendant, n-1, [-2, 3]"), "paper-descendant, n-1, [−2, 3]");
        assert_eq!(minus("2026-11-26 and sweep_-down"), "2026-11-26 and sweep_-down");
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(plain(0.05), "0.05");
        assert_eq!(plain(-2.5e-5), "−2.5·10⁻⁵");
        assert_eq!(plain(1e6), "10⁶");
        assert_eq!([0, 1, 2, -1].map(power_of_ten), ["1", "10", "10²", "10⁻¹"]);
        assert_eq!(rounded(1132.69, 3), "1130");
        assert_eq!(count(100_000), "100,000");
        assert_eq!((count(0), count(999), count(1_000)), ("0".into(), "999".into(), "1,000".into()));
        assert_eq!(percent(-1e-9, 0), "0 %");
    }

    #[test]
    fn lines_are_broken_at_spaces_and_long_words_stay_whole() {
        let look = TextLook::note();
        let lines = look.wrapped("one two three four five six seven", 120.0);
        assert!(lines.len() > 1 && lines.iter().all(|line| look.width(line) <= 120.0));
        assert_eq!(lines.join(" "), "one two three four five six seven");
        assert_eq!(look.wrapped("unbreakably-long", 10.0), ["unbreakably-long"]);
        assert!(look.wrapped("", 10.0).is_empty());
        assert_eq!(look.fitted("short", 100.0), "short");
        let cut = look.fitted("much too long for its place", 100.0);
        assert!(cut.ends_with('…') && look.width(&cut) <= 100.0, "{cut}");
    }
}
