//! Random intervals and borders that the property tests share.

use proptest::collection::{btree_set, vec};
use proptest::prelude::*;
use switchback_model::hysteresis::{
    BorderPair, Discontinuous, General, Interval, LeafSpring, Line, NonMonotone, Piece, Relay,
    SaturatingCurve, StraightLines, SwitchedHysteresis, Table, TablePoint, Wave,
};

/// Intervals of width 0.1 to 20 around centres of up to ten.
pub(crate) fn interval() -> impl Strategy<Value = Interval> {
    (-10.0..10.0, 0.1..20.0).prop_map(|(low, width)| Interval::new(low, low + width).unwrap())
}

/// A switched hysteresis of any kind that satisfies Assumption 1, on a random interval.
pub(crate) fn hysteresis() -> impl Strategy<Value = SwitchedHysteresis> {
    interval()
        .prop_flat_map(|interval| (Just(interval), borders(interval)))
        .prop_filter_map("Assumption 1", |(interval, borders)| {
            SwitchedHysteresis::new(interval, borders).ok()
        })
}

fn borders(interval: Interval) -> impl Strategy<Value = Box<dyn BorderPair>> {
    prop_oneof![
        (line(), line()).prop_map(|(up, down)| boxed(StraightLines::new(up, down))),
        (0.0..5.0, -0.1..0.1, 0.0..3.0).prop_map(|(k0, k2, fc)| boxed(LeafSpring::hardening(k0, k2, fc))),
        (-3.0..0.0, 0.1..3.0, inside(interval), inside(interval))
            .prop_map(|(low, high, up, down)| boxed(Relay::new((low, high), up, down))),
        (pieces(interval), pieces(interval)).prop_map(|(up, down)| boxed(Discontinuous::new(up, down))),
        (wave(), wave()).prop_map(|(up, down)| boxed(NonMonotone::new(up, down))),
        (curve(interval), curve(interval)).prop_map(|(up, down)| boxed(General::new(up, down))),
        (points(interval), points(interval)).prop_map(|(up, down)| boxed(Table::new(up, down))),
    ]
}

fn boxed<B: BorderPair + 'static, E: std::fmt::Debug>(borders: Result<B, E>) -> Box<dyn BorderPair> {
    Box::new(borders.unwrap())
}

fn inside(interval: Interval) -> impl Strategy<Value = f64> {
    interval.low()..interval.high()
}

/// Up to six increasing positions, some beyond the interval.
fn positions(interval: Interval) -> impl Strategy<Value = Vec<f64>> {
    let at = move |k: u32| interval.low() + interval.width() * (f64::from(k) / 40.0 - 0.25);
    btree_set(0..60u32, 1..7).prop_map(move |set| set.into_iter().map(at).collect())
}

fn line() -> impl Strategy<Value = Line> {
    (-1.0..4.0, -3.0..3.0).prop_map(|(slope, offset)| Line { slope, offset })
}

fn pieces(interval: Interval) -> impl Strategy<Value = Vec<Piece>> {
    (positions(interval), vec((-3.0..3.0, -1.0..1.0), 7)).prop_map(|(from, rest)| {
        from.into_iter().zip(rest).map(|(from, (value, slope))| Piece { from, value, slope }).collect()
    })
}

fn points(interval: Interval) -> impl Strategy<Value = Vec<TablePoint>> {
    (positions(interval), vec(-3.0..3.0, 7))
        .prop_map(|(v, u)| v.into_iter().zip(u).map(|(v, u)| TablePoint { v, u }).collect())
}

fn wave() -> impl Strategy<Value = Wave> {
    (-2.0..2.0, -0.5..0.5, 0.5..2.0, 0.2..5.0, 0.0..6.0).prop_map(
        |(offset, slope, amplitude, wavelength, phase)| Wave { offset, slope, amplitude, wavelength, phase },
    )
}

fn curve(interval: Interval) -> impl Strategy<Value = SaturatingCurve> {
    (-1.0..1.0, -0.5..3.0, inside(interval), 0.1..3.0, -0.2..1.0, -0.1..0.1).prop_map(
        |(offset, amplitude, centre, width, slope, curvature)| SaturatingCurve {
            offset,
            amplitude,
            centre,
            width,
            slope,
            curvature,
        },
    )
}
