//! What the numbers of a rig are measured in.

use crate::identification::unit;
use switchback_diagnose::CellUnit;
use switchback_model::rig::Rig;

/// Units and scales of a rig, to show dimensionless figures in the user's own.
#[derive(Debug, Clone, PartialEq)]
pub struct Units {
    /// Unit of the input, `input units` where its label names none.
    pub input: String,
    /// Unit of the output, `output units` where its label names none.
    pub output: String,
    /// Seconds between samples.
    pub sample_time: f64,
    /// Width of the working interval, input units: the stroke that dimensionless lengths are shares of.
    pub stroke: f64,
}

impl Units {
    /// The units of a rig; without a declared interval the stroke is the range of the fit records' input.
    pub fn of(rig: &Rig) -> Self {
        let named = |label: &str, otherwise: &str| match unit(label) {
            "" => otherwise.to_owned(),
            unit => unit.to_owned(),
        };
        let input = rig.fit_records().flat_map(|record| record.record.v());
        let (low, high) =
            input.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)));
        Self {
            input: named(&rig.input_label, "input units"),
            output: named(&rig.output_label, "output units"),
            sample_time: rig.sample_time,
            stroke: rig.interval.map_or(high - low, |interval| interval.width()),
        }
    }

    /// The unit of a cell's ends, in words.
    pub fn of_cell(&self, unit: CellUnit) -> String {
        match unit {
            CellUnit::Input => self.input.clone(),
            CellUnit::InputPerSecond => format!("{}/s", self.input),
            CellUnit::Output => self.output.clone(),
            CellUnit::Samples => "samples".to_owned(),
            CellUnit::Hertz => "Hz".to_owned(),
            CellUnit::ShareOfDataset => "share of the dataset".to_owned(),
        }
    }
}
