//! Methods of others.

use super::check::{at_most, distinct, non_empty, positive, unknown};
use crate::results::Group;
use crate::scenario::error::Fault;
use crate::scenario::foreign_method::{ForeignMethod, PATIENCE, Program};
use crate::scenario::wire::WireMethod;
use crate::{ForeignName, MethodName};
use std::time::Duration;
use toml::Spanned;

/// One entry a `[[method]]`.
pub(super) fn foreign(wire: &[WireMethod]) -> Result<Vec<ForeignMethod>, Fault> {
    distinct(wire.iter().map(|method| &method.name))?;
    let methods: Vec<ForeignMethod> = wire.iter().map(method).collect::<Result<_, _>>()?;
    for (k, method) in methods.iter().enumerate() {
        let same = |other: &ForeignMethod| other.name.as_str().eq_ignore_ascii_case(method.name.as_str());
        if methods[..k].iter().any(same) {
            let why =
                "another method has this name but for capital letters, and figures are named after methods";
            return Err(Fault::new(wire[k].name.span(), why, "rename one of them"));
        }
    }
    Ok(methods)
}

fn method(wire: &WireMethod) -> Result<ForeignMethod, Fault> {
    let name = ForeignName::new(wire.name.get_ref()).ok_or_else(|| {
        Fault::new(
            wire.name.span(),
            "this cannot be the name of a method",
            format!("write {}", ForeignName::RULE),
        )
    })?;
    let patience = match &wire.patience {
        None => PATIENCE,
        Some(seconds) => {
            let most = LONGEST_PATIENCE.as_secs_f64();
            let value = positive(seconds)?;
            if value > most {
                let why = format!("more than {most} seconds");
                return Err(Fault::new(seconds.span(), why, "write the seconds that one estimate may take"));
            }
            Duration::from_secs_f64(value)
        }
    };
    let workers = match &wire.workers {
        None => None,
        Some(workers) if *workers.get_ref() == 0 => {
            return Err(Fault::new(workers.span(), "no process answers nothing", "write 1 or more"));
        }
        Some(workers) => Some(at_most(workers, MOST_WORKERS, "processes")?),
    };
    Ok(ForeignMethod {
        name,
        program: Program::Command(command(&wire.command)?),
        groups: groups(wire.parameters.as_ref())?,
        patience,
        antithetic: wire.antithetic.unwrap_or(true),
        workers,
    })
}

/// Beyond it a study would never end.
const LONGEST_PATIENCE: Duration = Duration::from_secs(86_400);

/// More than any machine has cores.
const MOST_WORKERS: usize = 4096;

fn command(wire: &Spanned<Vec<Spanned<String>>>) -> Result<Vec<String>, Fault> {
    let words = non_empty(wire)?;
    for (k, word) in words.iter().enumerate() {
        if word.get_ref().contains('\0') || (k == 0 && word.get_ref().trim().is_empty()) {
            let remedy = "write the program and its arguments, as in [\"python\", \"estimator.py\"]";
            return Err(Fault::new(word.span(), "no system starts such a command", remedy));
        }
    }
    Ok(words.iter().map(|word| word.get_ref().clone()).collect())
}

/// The groups that are estimated, in the order of the results; all where none is named.
fn groups(wire: Option<&Spanned<Vec<Spanned<String>>>>) -> Result<Vec<Group>, Fault> {
    let Some(wire) = wire else { return Ok(Group::ALL.to_vec()) };
    distinct(non_empty(wire)?.iter())?;
    let group = |name: &Spanned<String>| {
        let found = Group::ALL.into_iter().find(|group| group.name() == name.get_ref());
        found.ok_or_else(|| unknown(name, "group of parameters", &Group::ALL.map(Group::name)))
    };
    let mut groups: Vec<Group> = wire.get_ref().iter().map(group).collect::<Result<_, _>>()?;
    groups.sort_unstable();
    Ok(groups)
}

/// All methods of a sweep by their names: ours as `sweep.methods` lists them, then those of others.
pub(super) fn all(own: &[switchback_identify::Method], foreign: &[ForeignMethod]) -> Vec<MethodName> {
    let own = own.iter().map(|method| MethodName::Own(*method));
    own.chain(foreign.iter().map(|method| MethodName::Foreign(method.name.clone()))).collect()
}
