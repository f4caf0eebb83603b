//! Evidence of a rig.

use super::columns::Evidence;
use super::nominal::nominal;
use crate::records::dimensionless::dimensionless;
use switchback_identify::free::FreeError;
use switchback_identify::record::Stretch;
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Usage};
use switchback_model::system::System;

/// A rig's nominal system and its evidence, both of the rig without units.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The system without effects: identified from the fit records, or that of the predictions.
    pub nominal: System,
    /// The evidence.
    pub evidence: Evidence,
}

impl Judged {
    /// Of a rig by itself. None where input or output is constant, the machine has no gain at rest, or its run leaves every range.
    ///
    /// # Errors
    /// [`FreeError`] where the records show no model.
    pub fn identified(rig: &Rig) -> Result<Option<Self>, FreeError> {
        let Ok(rig) = &dimensionless(rig) else { return Ok(None) };
        let fitted = rig.records.iter().filter(|r| r.usage == Usage::Fit).map(|r| &r.record);
        let known = (rig.order, rig.order.map(|_| 0));
        let Some(nominal) = nominal(&fitted.collect::<Vec<_>>(), known)? else { return Ok(None) };
        Ok(Self::of(nominal, &measured(rig), rig, false))
    }

    /// Of a rig beside the predictions of a model, one list a record. None where input or output is constant, or the model has no gain at rest.
    ///
    /// # Errors
    /// [`FreeError`] where the predictions show no model.
    pub fn beside(rig: &Rig, predictions: &[Vec<f64>]) -> Result<Option<Self>, FreeError> {
        let with = |(r, y): (&RigRecord, &Vec<f64>)| RigRecord { predicted: Some(y.clone()), ..r.clone() };
        let records = rig.records.iter().zip(predictions).map(with).collect();
        let Ok(rig) = &dimensionless(&Rig { records, ..rig.clone() }) else { return Ok(None) };
        let predictions: Vec<Vec<f64>> = rig.records.iter().filter_map(|r| r.predicted.clone()).collect();
        let of = |(r, y): (&RigRecord, &Vec<f64>)| Record::new(r.record.v().to_vec(), y.clone()).ok();
        let predicted: Vec<Record> = rig.records.iter().zip(&predictions).filter_map(of).collect();
        let known = (rig.order, rig.order.map(|_| 0));
        let Some(nominal) = nominal(&predicted.iter().collect::<Vec<_>>(), known)? else { return Ok(None) };
        let stretches = measured(rig);
        let carried = stretches.iter().zip(&predictions).map(|(s, p)| s.carrying(&nominal, p));
        let stretches: Vec<Stretch> = carried.collect();
        Ok(Self::of(nominal, &stretches, rig, true))
    }

    fn of(nominal: System, stretches: &[Stretch], rig: &Rig, is_given: bool) -> Option<Self> {
        let is_fitted: Vec<bool> = rig.records.iter().map(|r| r.usage == Usage::Fit).collect();
        let evidence = Evidence::of(&nominal, stretches, &is_fitted, is_given)?;
        Some(Self { nominal, evidence })
    }
}

fn measured(rig: &Rig) -> Vec<Stretch> {
    Stretch::all(&rig.records.iter().map(|r| (r.record.v(), r.record.y())).collect::<Vec<_>>())
}
