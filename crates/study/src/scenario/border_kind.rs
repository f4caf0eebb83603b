//! The kinds of borders and their keys, one wire type a kind.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use switchback_model::hysteresis::{
    BorderError, BorderPair, Discontinuous, General, LeafSpring, Line, NonMonotone, Piece, Relay,
    SaturatingCurve, StraightLines, Table, TablePoint, Wave,
};
use toml::de::{Error, ValueDeserializer};

/// Makes the pair of borders anew, once for each interval it is put on.
pub(super) type Shape = Box<dyn Fn() -> Box<dyn BorderPair>>;

/// Reads a kind's parameters: the outer error is the file's (keys, types), the inner the border's (values).
pub(super) type Reader = fn(ValueDeserializer<'_>) -> Result<Result<Shape, BorderError>, Error>;

/// Every kind.
pub(super) const NAMES: [&str; 7] =
    ["straight_lines", "leaf_spring", "relay", "discontinuous", "non_monotone", "general", "table"];

/// The reader of a kind.
pub(super) fn reader(kind: &str) -> Option<Reader> {
    Some(match kind {
        "straight_lines" => read::<WireStraightLines>,
        "leaf_spring" => read::<WireLeafSpring>,
        "relay" => read::<WireRelay>,
        "discontinuous" => read::<WireDiscontinuous>,
        "non_monotone" => read::<WireNonMonotone>,
        "general" => read::<WireGeneral>,
        "table" => read::<WireTable>,
        _ => return None,
    })
}

fn read<W: Wire + DeserializeOwned>(
    value: ValueDeserializer<'_>,
) -> Result<Result<Shape, BorderError>, Error> {
    Ok(W::deserialize(value)?.shape())
}

trait Wire {
    fn shape(self) -> Result<Shape, BorderError>;
}

fn shape<B: BorderPair + Clone + 'static>(borders: B) -> Shape {
    Box::new(move || Box::new(borders.clone()))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireStraightLines {
    ascending: WireLine,
    descending: WireLine,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireLine {
    slope: f64,
    offset: f64,
}

impl Wire for WireStraightLines {
    fn shape(self) -> Result<Shape, BorderError> {
        let line = |w: WireLine| Line { slope: w.slope, offset: w.offset };
        StraightLines::new(line(self.ascending), line(self.descending)).map(shape)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireLeafSpring {
    stiffness: f64,
    #[serde(default)]
    hardening: f64,
    friction: f64,
}

impl Wire for WireLeafSpring {
    fn shape(self) -> Result<Shape, BorderError> {
        LeafSpring::hardening(self.stiffness, self.hardening, self.friction).map(shape)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireRelay {
    low: f64,
    high: f64,
    ascending_threshold: f64,
    descending_threshold: f64,
}

impl Wire for WireRelay {
    fn shape(self) -> Result<Shape, BorderError> {
        Relay::new((self.low, self.high), self.ascending_threshold, self.descending_threshold).map(shape)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireDiscontinuous {
    ascending: Vec<WirePiece>,
    descending: Vec<WirePiece>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WirePiece {
    from: f64,
    value: f64,
    #[serde(default)]
    slope: f64,
}

impl Wire for WireDiscontinuous {
    fn shape(self) -> Result<Shape, BorderError> {
        let pieces = |list: Vec<WirePiece>| {
            list.into_iter().map(|w| Piece { from: w.from, value: w.value, slope: w.slope }).collect()
        };
        Discontinuous::new(pieces(self.ascending), pieces(self.descending)).map(shape)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireNonMonotone {
    ascending: WireWave,
    descending: WireWave,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireWave {
    offset: f64,
    slope: f64,
    amplitude: f64,
    wavelength: f64,
    #[serde(default)]
    phase: f64,
}

impl Wire for WireNonMonotone {
    fn shape(self) -> Result<Shape, BorderError> {
        let wave = |w: WireWave| Wave {
            offset: w.offset,
            slope: w.slope,
            amplitude: w.amplitude,
            wavelength: w.wavelength,
            phase: w.phase,
        };
        NonMonotone::new(wave(self.ascending), wave(self.descending)).map(shape)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireGeneral {
    ascending: WireSaturatingCurve,
    descending: WireSaturatingCurve,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireSaturatingCurve {
    offset: f64,
    amplitude: f64,
    centre: f64,
    width: f64,
    #[serde(default)]
    slope: f64,
    #[serde(default)]
    curvature: f64,
}

impl Wire for WireGeneral {
    fn shape(self) -> Result<Shape, BorderError> {
        let curve = |w: WireSaturatingCurve| SaturatingCurve {
            offset: w.offset,
            amplitude: w.amplitude,
            centre: w.centre,
            width: w.width,
            slope: w.slope,
            curvature: w.curvature,
        };
        General::new(curve(self.ascending), curve(self.descending)).map(shape)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireTable {
    ascending: Vec<WireTablePoint>,
    descending: Vec<WireTablePoint>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireTablePoint {
    v: f64,
    u: f64,
}

impl Wire for WireTable {
    fn shape(self) -> Result<Shape, BorderError> {
        let points =
            |list: Vec<WireTablePoint>| list.into_iter().map(|w| TablePoint { v: w.v, u: w.u }).collect();
        Table::new(points(self.ascending), points(self.descending)).map(shape)
    }
}
