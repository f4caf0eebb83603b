//! Units of one quantity.

use switchback_table::signals::Measured;
use switchback_table::table::Column;

/// A unit of a quantity that is known here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unit {
    quantity: &'static str,
    size: f64,
}

/// Units by their quantity, with their sizes.
const UNITS: [(&str, &[(&str, f64)]); 8] = [
    ("length", &[("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9), ("inch", 0.0254)]),
    ("force", &[("N", 1.0), ("kN", 1e3), ("mN", 1e-3), ("lbf", 4.448_221_615_260_5)]),
    ("torque", &[("Nm", 1.0), ("kNm", 1e3), ("mNm", 1e-3)]),
    ("voltage", &[("V", 1.0), ("mV", 1e-3), ("kV", 1e3)]),
    ("current", &[("A", 1.0), ("mA", 1e-3)]),
    (
        "pressure",
        &[("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("mbar", 1e2), ("bar", 1e5), ("psi", 6_894.757_293_168)],
    ),
    ("angle", &[("rad", 1.0), ("mrad", 1e-3), ("urad", 1e-6), ("deg", std::f64::consts::PI / 180.0)]),
    ("speed", &[("m/s", 1.0), ("mm/s", 1e-3)]),
];

impl Unit {
    /// That of a column, if it is known.
    pub(super) fn of(column: &Column) -> Option<Self> {
        let name =
            column.unit.as_deref()?.replace(['µ', 'μ'], "u").replace(['·', '*'], "").replace('°', "deg");
        UNITS.into_iter().find_map(|(quantity, units)| {
            units.iter().find(|(known, _)| *known == name).map(|(_, size)| Self { quantity, size: *size })
        })
    }

    /// Its size in another unit of the same quantity; none where that is of another.
    pub(super) fn ratio(self, other: Self) -> Option<f64> {
        (self.quantity == other.quantity).then_some(self.size / other.size)
    }
}

/// The factor from the unit of a record's predictions to that of its output, where the header has two units of one quantity.
pub(super) fn of_predictions(measured: &Measured) -> Option<f64> {
    let ratio = Unit::of(measured.prediction()?)?.ratio(Unit::of(measured.output()?)?)?;
    (ratio != 1.0).then_some(ratio)
}
