//! Colours that everybody can tell apart.

use plotters::style::RGBColor;

/// Okabe and Ito's palette (jfly.uni-koeln.de/color) without black and yellow, which serve badly as data on white.
pub const OKABE_ITO: [RGBColor; 6] = [
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xCC, 0x79, 0xA7),
    RGBColor(0xE6, 0x9F, 0x00),
    RGBColor(0x56, 0xB4, 0xE9),
];

/// Text, frames and truth.
pub const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);

/// Secondary text and ticks.
pub const GREY: RGBColor = RGBColor(0x77, 0x77, 0x77);

/// Grid lines.
pub const FAINT: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);

/// The background.
pub const PAPER: RGBColor = RGBColor(0xFF, 0xFF, 0xFF);

/// A colour mixed with the background: 1 keeps it, 0 is the background. Opaque, so that overlaps do not add up.
pub fn tint(colour: RGBColor, share: f64) -> RGBColor {
    let mix = |c: u8| (255.0 - (255.0 - f64::from(c)) * share).round() as u8;
    RGBColor(mix(colour.0), mix(colour.1), mix(colour.2))
}
