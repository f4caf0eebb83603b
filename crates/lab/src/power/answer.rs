//! What a diagnosis says of a fault that was put in.

use crate::examination::{Reply, WIDEST_CLASS};

/// The worth of an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// The effect is named.
    Named,
    /// It stands in a class or a shortlist of at most three.
    InClass,
    /// Something else is said, in a few words.
    Other(String),
}

impl Answer {
    /// What a reply is worth to an effect.
    pub(crate) fn of(reply: &Reply, effect: &str) -> Self {
        let listed = reply.listed();
        match reply.status {
            _ if !listed.contains(&effect) => Self::Other(reported(reply)),
            "named" => Self::Named,
            _ if listed.len() <= WIDEST_CLASS => Self::InClass,
            _ => Self::Other(reported(reply)),
        }
    }

    /// Whether the fault is found.
    pub fn is_found(&self) -> bool {
        !matches!(self, Self::Other(_))
    }
}

fn reported(reply: &Reply) -> String {
    let listed = reply.listed();
    match reply.status {
        "none" => "nothing".to_owned(),
        "refit" => "other parameters".to_owned(),
        "unexplained" => "none of these".to_owned(),
        "named" => listed.join(" with "),
        _ if listed.is_empty() => "no diagnosis".to_owned(),
        _ if listed.len() > WIDEST_CLASS => format!("one of {} effects", listed.len()),
        _ => listed.join(" or "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reply(status: &'static str, said: &[&'static str]) -> Reply {
        let (effects, class) = if status == "named" { (said, &[][..]) } else { (&[][..], said) };
        Reply { status, effects: effects.to_vec(), class: class.to_vec(), ..Reply::refused() }
    }

    #[test]
    fn a_fault_is_found_by_name_or_in_a_narrow_class() {
        let of = |status, said: &[&'static str]| Answer::of(&reply(status, said), "creep");
        assert_eq!(of("named", &["creep"]), Answer::Named);
        assert_eq!(of("named", &["creep", "backlash"]), Answer::Named);
        assert_eq!(of("class", &["backlash", "creep", "stribeck"]), Answer::InClass);
        assert_eq!(of("ambiguous", &["creep", "backlash"]), Answer::InClass);
        assert_eq!(of("shortlist", &["backlash", "creep"]), Answer::InClass);
        let wide = of("class", &["backlash", "creep", "stribeck", "resonance"]);
        assert_eq!(wide, Answer::Other("one of 4 effects".to_owned()));
        assert_eq!(of("named", &["backlash"]), Answer::Other("backlash".to_owned()));
        assert_eq!(of("class", &["backlash", "stribeck"]), Answer::Other("backlash or stribeck".to_owned()));
        for (status, reported) in
            [("none", "nothing"), ("unexplained", "none of these"), ("failed", "no diagnosis")]
        {
            assert_eq!(of(status, &[]), Answer::Other(reported.to_owned()));
        }
        assert!(Answer::Named.is_found() && Answer::InClass.is_found() && !wide.is_found());
    }
}
