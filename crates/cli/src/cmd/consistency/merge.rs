//! `switchback merge` where the parts are of a consistency study.

use super::part::Part;
use super::{FILES, Order, write};
use crate::build::BUILD;
use crate::failure::{CommandResult, Outcome};
use crate::interrupt;
use crate::options::Threads;
use crate::progress::Meter;
use miette::IntoDiagnostic;
use std::path::{Path, PathBuf};
use switchback_io::provenance::{PROVENANCE_FILE, Provenance};
use switchback_study::checkpoint::Checkpoint;
use switchback_study::consistency::{RunState, Study, Unusable};
use switchback_study::parts::{MergeError, check_whole};

/// Adds parts up in the order of one run; where a precision is asked for and not reached, shows what to run next, once what there is has been
/// written into the folder `next`, or else into that of the report.
///
/// # Errors
/// Folders that make no whole, or one that cannot be written.
pub(crate) fn merge(folders: &[PathBuf], next: Option<&Path>, order: Order<'_>) -> CommandResult {
    let provenance = Provenance::begin(BUILD, Threads::default().at_once());
    let mut parts: Vec<Part> = folders.iter().map(|folder| Part::read(folder)).collect::<Result<_, _>>()?;
    parts.sort_by_key(|part| part.label.shard);
    let first = &parts[0];
    let scenario = first.scenario()?;
    let study = order.threads.install(|| Study::plan(&scenario))?.into_diagnostic()?;
    let mut run_state = added_up(&parts, &study)?;
    let meter = Meter::new(order.quiet);
    meter.begin(run_state.target(), run_state.replicates());
    let is_whole = !study.next_round(&mut run_state, &meter);
    let kept = Checkpoint::new(
        order.out.unwrap_or(Path::new("")),
        study.origin(BUILD.study_sources),
        interrupt::is_wished,
    );
    let out = order.out.unwrap_or(Path::new("."));
    let inputs: Vec<PathBuf> = parts.iter().flat_map(Part::inputs).collect();
    let shards: Vec<String> = parts.iter().filter_map(|part| Some(part.label.shard?.to_string())).collect();
    let provenance = provenance.end(shards);
    let order = Order { command: &first.label.command, ..order };
    if is_whole {
        let folder = order.force.claim(out, &FILES)?.sparing(inputs.iter().map(PathBuf::as_path))?;
        let results = order.threads.install(|| study.results(&run_state, order.command.to_owned()))?;
        return write(&results, (&scenario, &run_state, &kept, &provenance), folder, order);
    }
    let out = next.unwrap_or(out);
    let merged = first.of_all();
    let folder = order.force.claim(out, &merged.files())?.sparing(inputs.iter().map(PathBuf::as_path))?;
    let mut artefacts = merged.artefacts(kept.bytes(&run_state));
    artefacts.add_beside(PROVENANCE_FILE, provenance.text());
    folder.commit(&artefacts)?;
    order.quiet.note(&how_to_go_on(&run_state, &first.label.scenario, out));
    Ok(Outcome::Stopped)
}

/// What to run to go on.
fn how_to_go_on(run_state: &RunState, scenario: &str, out: &Path) -> String {
    format!(
        "{} replicates, and not precise enough yet; written to {out}.\n\
         Run those up to {} in parts: switchback {scenario} --shard K/N --from {out} --out DIR\n\
         then merge the parts with {out}.\n",
        run_state.replicates(),
        run_state.target(),
        out = out.display(),
    )
}

/// The parts of a round, and the rounds before it if they are given.
fn added_up(parts: &[Part], study: &Study<'_>) -> Result<RunState, MergeError> {
    let name = |part: &Part| part.folder.display().to_string();
    let (before, parts) = parts.split_at(parts.partition_point(|part| part.label.shard.is_none()));
    if let [one, other, ..] = before {
        return Err(MergeError::TwoWholes { folder: name(other), first: name(one) });
    }
    let mut run_state = match before.first() {
        Some(whole) => whole.run_state(study)?,
        None => study.begin(),
    };
    let round = run_state.clone();
    check_whole(&parts.iter().filter_map(Part::piece).collect::<Vec<_>>())?;
    for part in parts {
        let more = part.run_state_in(&round, study)?;
        if run_state.differs_in_versions(&more) {
            return Err(MergeError::Unusable { folder: name(part), why: Unusable::OtherMethod });
        }
        run_state.add(more);
    }
    match run_state.missing() {
        None => Ok(run_state),
        Some(gap) => Err(MergeError::Gap { start: gap.start, end: gap.end }),
    }
}
