//! Figures of a diagnosis: where the gap lies, the outputs, the residuals, the ranking of the candidates, the repaired model and the next
//! experiment.

mod borders;
mod candidates;
mod experiment;
mod outputs;
mod places;
mod residuals;

pub use borders::borders;
pub(crate) use experiment::experiment;

use super::Figure;
use switchback_io::diagnosis::Report;

/// Every figure of a report.
pub fn figures(report: &Report) -> Vec<Figure> {
    let mut figures = vec![
        Figure { name: "where.svg".to_owned(), svg: places::figure(report) },
        Figure { name: "candidates.svg".to_owned(), svg: candidates::figure(report) },
        Figure { name: "residuals.svg".to_owned(), svg: residuals::figure(report) },
    ];
    for series in &report.diagnosis.series {
        let name = format!("outputs_{}.svg", series.record);
        figures.push(Figure { name, svg: outputs::figure(report, series) });
    }
    figures
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::inspect::check;
    use switchback_diagnose::Candidate;
    use switchback_diagnose::Cell;
    use switchback_diagnose::Diagnosis;
    use switchback_diagnose::Effect;
    use switchback_diagnose::Gap;
    use switchback_diagnose::HoldoutSeries;
    use switchback_diagnose::ResidualPicture;
    use switchback_diagnose::Status;
    use switchback_diagnose::Verdict;
    use switchback_io::diagnosis::Source;
    use switchback_model::Record;
    use switchback_model::rig::{Rig, RigRecord, Role, Usage};

    fn rig() -> Rig {
        let v: Vec<f64> = (0..50).map(|t| f64::from(t % 10)).collect();
        let record = Record::new(v.clone(), v).expect("finite");
        let records = vec![RigRecord {
            name: "sweep".to_owned(),
            role: Role::Free,
            usage: Usage::Fit,
            record,
            predicted: None,
        }];
        Rig {
            name: "bench".to_owned(),
            sample_time: 0.01,
            order: None,
            interval: None,
            input_label: "stroke".to_owned(),
            output_label: "force".to_owned(),
            records,
        }
    }

    fn nothing() -> Report {
        let none = switchback_diagnose::Figure { estimate: 0.0, ci90: [0.0, 0.0] };
        let verdict = Verdict {
            status: Status::None,
            effects: vec![],
            class: vec![],
            stage: None,
            probability: 0.9,
            calibrated: true,
            corrected_by: None,
            refit: None,
            held_out_error_ratio: None,
        };
        let gap = Gap {
            before: none,
            after: none,
            closure: None,
            noise_floor: 0.1,
            identified_anew: None,
            predictive_gain: 0.0,
            per_record: vec![],
        };
        let diagnosis = Diagnosis {
            differences: None,
            verdict,
            classification: None,
            gap,
            where_: vec![],
            candidates: vec![],
            probability_none: 0.9,
            probability_unexplained: 0.1,
            left: 0.0,
            samples: 1,
            passes: 0,
            together: None,
            next_experiment: None,
            series: vec![],
            residuals_before: ResidualPicture::default(),
            residuals_after: ResidualPicture::default(),
            limitations: vec![],
            models: None,
            evidence: None,
        };
        Report { rig: rig(), source: Source::Identified, diagnosis, shifts: Vec::new(), stability: None }
    }

    fn cell(axis: &'static str, name: &str, share: f64) -> Cell {
        Cell {
            axis,
            cell: name.to_owned(),
            interval: None,
            share,
            exposure: 0.5,
            enrichment: 2.0 * share,
            q_value: 0.001,
            enrichment_q_value: if share > 0.5 { 0.001 } else { 0.9 },
        }
    }

    fn candidate(effect: Effect, delta_bic: f64, closure: Option<f64>) -> Candidate {
        Candidate {
            effect,
            stage: effect.stage(),
            probability: 0.3,
            parameters: vec![],
            bic: -delta_bic,
            delta_bic,
            heldout_log_score: 0.0,
            gains: vec![],
            closure,
            unstable: closure.is_none(),
        }
    }

    /// A diagnosis with something in every figure: closures below zero and far below, evidence against, a run that diverges.
    fn found() -> Report {
        let mut report = nothing();
        let diagnosis = &mut report.diagnosis;
        let names = ["descending", "ascending", "a record whose name is much longer than its place"];
        diagnosis.where_ =
            names.iter().zip([0.7, 0.2, 0.1]).map(|(n, share)| cell("branch", n, share)).collect();
        diagnosis.where_.push(cell("rest_samples", "0", 1.0));
        diagnosis.candidates = vec![
            candidate(Effect::Backlash, 16_210.0, Some(0.99)),
            candidate(Effect::Creep, -120.0, Some(-0.4)),
            candidate(Effect::Resonance, 9.0, Some(-7.0)),
            candidate(Effect::Stribeck, 3.0, None),
        ];
        let wave = |scale: f64| (0..800).map(|t| scale * (0.1 * f64::from(t)).sin()).collect::<Vec<f64>>();
        let mut runaway = wave(0.9);
        runaway[700] = 1e9;
        diagnosis.series = vec![HoldoutSeries {
            record: "held out".to_owned(),
            measured: wave(1.0),
            nominal: runaway,
            augmented: wave(1.01),
        }];
        let picture = |scale: f64| ResidualPicture {
            autocorrelation: vec![1.0, 0.4 * scale, -0.3 * scale, 0.1],
            frequency: vec![0.0, 0.1, 0.2, 0.3],
            spectrum: vec![scale, 2.0 * scale, scale, scale],
            band: 0.05,
        };
        (diagnosis.residuals_before, diagnosis.residuals_after) = (picture(1.0), picture(0.1));
        report
    }

    #[test]
    fn figures_repeat_and_stay_on_the_page() {
        let figures_of_found = figures(&found());
        assert_eq!(figures_of_found.len(), 4);
        assert_eq!(figures_of_found, figures(&found()));
        for figure in figures_of_found.iter().chain(&figures(&nothing())) {
            assert_eq!(check(&figure.svg), Ok(()), "{}", figure.name);
        }
    }

    #[test]
    fn a_diagnosis_without_evidence_gives_figures_that_say_so() {
        let figures = figures(&nothing());
        assert!(figures[0].svg.contains("nothing beyond the noise"));
        assert!(figures[1].svg.contains("nothing is missing"));
        assert!(figures[2].svg.contains("No errors one step ahead"));
    }

    #[test]
    fn a_closure_below_its_ground_is_an_arrow_and_large_counts_are_readable() {
        let figures = figures(&found());
        let candidates = &figures[1].svg;
        // One in the legend, one for −700 %.
        assert_eq!(candidates.matches("<polygon").count(), 2);
        assert!(
            candidates.contains("16,210") && candidates.contains("−120") && candidates.contains("unstable")
        );
    }

    #[test]
    fn axes_have_units_and_a_single_cell_is_reported_instead_of_drawn() {
        let figures = figures(&found());
        assert!(figures[3].svg.contains("force [output units]"));
        let places = &figures[0].svg;
        assert!(places.contains("Left out, as all samples lie in one cell: samples since the last move."));
    }
}
