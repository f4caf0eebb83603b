//! A rig without units: what follows from it is the same in all units and for all zeros.

use super::scale::Scale;
use crate::error::DiagnoseError;
use switchback_model::Record;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::{Rig, RigRecord};

/// Dimensionless values are whole multiples of this, 2⁻²⁶: in other units rounding alone would differ. A converter of 24 bits resolves 6·10⁻⁸ of
/// its range.
const GRAIN: f64 = 1.0 / 67_108_864.0;

impl Scale {
    fn dimensionless(self, x: f64) -> f64 {
        ((x - self.origin) / self.size / GRAIN).round() * GRAIN
    }
}

/// The rig with inputs from 0 to 1 over the working interval and outputs in standard deviations from their mean, over the fit records.
///
/// # Errors
/// [`DiagnoseError`] where input or output is constant, or leaves every range.
pub(crate) fn dimensionless(rig: &Rig) -> Result<Rig, DiagnoseError> {
    let (of_v, of_y) = (Scale::of_input(rig)?, Scale::of_output(rig)?);
    let all = |x: &[f64], scale: Scale| x.iter().map(|x| scale.dimensionless(*x)).collect::<Vec<f64>>();
    let one = |r: &RigRecord| {
        let record = Record::new(all(r.record.v(), of_v), all(r.record.y(), of_y));
        let record = record.map_err(|_| DiagnoseError::ConstantOutput)?;
        let predicted = r.predicted.as_ref().map(|y| all(y, of_y));
        Ok(RigRecord { record, predicted, ..r.clone() })
    };
    let records = rig.records.iter().map(one).collect::<Result<Vec<_>, DiagnoseError>>()?;
    let interval = rig.interval.and_then(|_| Interval::new(0.0, 1.0).ok());
    Ok(Rig { records, interval, ..rig.clone() })
}
