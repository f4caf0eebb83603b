//! Which method, where the user names none.

use switchback_identify::Method;
use switchback_model::rig::{Rig, Role};

/// The best method that the rig's fit records allow: both designed experiments beat one, one beats a free record.
///
/// A single experiment goes to the paper's estimator where the step experiment it needs is there too.
pub fn default_method(rig: &Rig) -> Method {
    let has = |role| rig.fit_records().any(|record| record.role == role);
    match (has(Role::Descendant), has(Role::Ascendant)) {
        (true, true) => Method::Efficient,
        (true, false) if has(Role::StepHigh) => Method::PaperDescendant,
        (false, true) if has(Role::StepLow) => Method::PaperAscendant,
        (true, false) | (false, true) => Method::Efficient,
        (false, false) => Method::Free,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_model::Record;
    use switchback_model::rig::{RigRecord, Usage};

    fn rig(roles: &[Role]) -> Rig {
        let record = |role: &Role| RigRecord {
            name: format!("{role:?}"),
            role: *role,
            usage: Usage::Fit,
            record: Record::new(vec![0.0, 1.0], vec![0.0, 1.0]).expect("a record"),
            predicted: None,
        };
        Rig {
            name: "any".to_owned(),
            sample_time: 1.0,
            order: None,
            interval: None,
            input_label: "v".to_owned(),
            output_label: "y".to_owned(),
            records: roles.iter().map(record).collect(),
        }
    }

    #[test]
    fn the_records_decide_the_method() {
        use Role::{Ascendant, Descendant, Free, StepHigh, StepLow};
        for (roles, method) in [
            (&[Descendant, Ascendant, Free][..], Method::Efficient),
            (&[Descendant, StepHigh], Method::PaperDescendant),
            (&[Ascendant, StepLow, Free], Method::PaperAscendant),
            (&[Descendant, StepLow], Method::Efficient),
            (&[Free, StepHigh], Method::Free),
        ] {
            assert_eq!(default_method(&rig(roles)), method, "{roles:?}");
        }
    }
}
