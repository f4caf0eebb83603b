use super::super::faults::Faults;
use super::super::hash_list::SUMS;
use super::*;
use tempfile::tempdir;

fn artefacts(files: &[(&str, &str)]) -> Artefacts {
    let mut artefacts = Artefacts::default();
    for (name, contents) in files {
        artefacts.add(*name, *contents);
    }
    artefacts
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn write(folder: &Path, files: &[(&str, &str)]) -> Result<(), FolderError> {
    OutputFolder::claim(folder, false).unwrap().commit(&artefacts(files))
}

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

#[test]
fn a_new_folder_appears_with_all_its_files_and_their_list() {
    let root = tempdir().unwrap();
    let target = root.path().join("deep/new");
    write(&target, &[("a", "1"), ("b", "2")]).unwrap();
    assert_eq!(names(&target), [SUMS, "a", "b"]);
    assert_eq!(names(root.path()), ["deep"]);
}

#[test]
fn the_programs_own_files_are_replaced_and_others_are_kept() {
    let root = tempdir().unwrap();
    write(root.path(), &[("a", "old"), ("stays", "listed")]).unwrap();
    fs::write(root.path().join("other"), "kept").unwrap();
    for new in ["new", "newer"] {
        write(root.path(), &[("a", new)]).unwrap();
        assert_eq!(text(root.path(), "a"), new);
    }
    assert_eq!(text(root.path(), "other"), "kept");
    assert_eq!(names(root.path()), [SUMS, "a", "other", "stays"]);
    write(root.path(), &[("stays", "listed still")]).unwrap();
}

#[test]
fn what_someone_else_wrote_or_changed_is_refused_in_one_message() {
    let root = tempdir().unwrap();
    write(root.path(), &[("a", "old"), ("b", "old")]).unwrap();
    fs::write(root.path().join("b"), "edited").unwrap();
    fs::write(root.path().join("c"), "measured").unwrap();
    let error = write(root.path(), &[("a", "new"), ("b", "new"), ("c", "new")]).unwrap_err();
    let reported = error.to_string();
    assert!(reported.contains("b (changed since"), "{reported}");
    assert!(reported.contains("c (not written by this program)"), "{reported}");
    assert!(!reported.contains("a ("), "{reported}");
    assert_eq!(["a", "b", "c"].map(|name| text(root.path(), name)), ["old", "edited", "measured"]);
    assert_eq!(names(root.path()), [SUMS, "a", "b", "c"]);
}

#[test]
fn names_known_beforehand_are_refused_before_the_computation() {
    let root = tempdir().unwrap();
    fs::write(root.path().join("drive.csv"), "measured").unwrap();
    let claim = || OutputFolder::claim(root.path(), false).unwrap();
    assert!(matches!(claim().expecting(&["drive.csv"]), Err(FolderError::Foreign(..))));
    assert!(claim().expecting(&["rig.toml"]).is_ok());
    assert!(matches!(claim().expecting(&["rig.toml", "d*.csv"]), Err(FolderError::Foreign(..))));
    assert!(claim().expecting(&["drive*.svg", "x*.csv", "drive.csv*v"]).is_ok());
    assert!(OutputFolder::claim(root.path(), true).unwrap().expecting(&["drive.csv"]).is_ok());
}

#[test]
fn a_forced_folder_replaces_all_and_calls_it_its_own() {
    let root = tempdir().unwrap();
    fs::write(root.path().join("a"), "measured").unwrap();
    OutputFolder::claim(root.path(), true).unwrap().commit(&artefacts(&[("a", "new")])).unwrap();
    assert_eq!(text(root.path(), "a"), "new");
    write(root.path(), &[("a", "newer")]).unwrap();
}

#[test]
fn a_list_of_sums_that_others_ship_with_their_data_counts_for_nothing() {
    let root = tempdir().unwrap();
    fs::write(root.path().join("drive.csv"), "measured").unwrap();
    fs::write(root.path().join("SHA256SUMS"), format!("{}  drive.csv\n", crate::output::sha256("measured")))
        .unwrap();
    assert!(matches!(write(root.path(), &[("drive.csv", "new")]), Err(FolderError::Foreign(..))));
}

#[test]
fn a_dropped_claim_leaves_nothing() {
    let root = tempdir().unwrap();
    drop(OutputFolder::claim(&root.path().join("deep/new"), false).unwrap());
    assert!(names(root.path()).is_empty());
}

#[test]
fn a_path_below_a_file_is_refused_at_once() {
    let root = tempdir().unwrap();
    let file = root.path().join("file");
    fs::write(&file, "kept").unwrap();
    let error = OutputFolder::claim(&file.join("reports"), false).unwrap_err();
    assert!(matches!(error, FolderError::NotAFolder(..)), "{error}");
    assert_eq!(fs::read_to_string(file).unwrap(), "kept");
}

#[test]
fn a_commit_that_cannot_finish_keeps_what_was_there() {
    let root = tempdir().unwrap();
    write(root.path(), &[("a", "old")]).unwrap();
    fs::create_dir(root.path().join("b")).unwrap();
    let error = write(root.path(), &[("a", "new"), ("b", "new")]).unwrap_err();
    assert!(matches!(error, FolderError::FileIsFolder(..)), "{error}");
    assert_eq!(text(root.path(), "a"), "old");
    assert_eq!(names(root.path()), [SUMS, "a", "b"]);
}

#[test]
fn files_of_a_former_run_go_unless_someone_changed_or_wrote_them() {
    let root = tempdir().unwrap();
    let claim = || OutputFolder::claim(root.path(), false).unwrap().expecting(&["a", "figure_*"]).unwrap();
    claim()
        .commit(&artefacts(&[("a", "1"), ("figure_1", "1"), ("figure_2", "1"), ("elsewhere", "1")]))
        .unwrap();
    fs::write(root.path().join("figure_3"), "not listed").unwrap();
    fs::write(root.path().join("figure_2"), "edited").unwrap();
    OutputFolder::claim(root.path(), false)
        .unwrap()
        .clearing(&["a", "figure_*"])
        .commit(&artefacts(&[("a", "2")]))
        .unwrap();
    assert_eq!(names(root.path()), [SUMS, "a", "elsewhere", "figure_2", "figure_3"]);
    assert!(!text(root.path(), SUMS).contains("figure_1"));
}

#[test]
fn what_is_read_is_not_replaced_even_by_force() {
    let root = tempdir().unwrap();
    let series = root.path().join("series.csv");
    fs::write(&series, "measured").unwrap();
    let claim = || OutputFolder::claim(root.path(), true).unwrap();
    let error = claim().expecting(&["*.csv"]).unwrap().sparing([series.as_path()]).unwrap_err();
    assert!(matches!(error, FolderError::IsInput(_)), "{error}");
    let error = claim().sparing([series.as_path()]).unwrap().commit(&artefacts(&[("series.csv", "new")]));
    assert!(matches!(error, Err(FolderError::IsInput(_))));
    assert_eq!(text(root.path(), "series.csv"), "measured");
}

/// All files under a folder with their contents, and all folders.
fn everything(folder: &Path) -> Vec<(PathBuf, Option<Vec<u8>>)> {
    let mut found = Vec::new();
    for name in names(folder) {
        let place = folder.join(name);
        found.push((place.clone(), fs::read(&place).ok()));
        if place.is_dir() {
            found.extend(everything(&place));
        }
    }
    found
}

/// A report, among it a file that the next run will not write, with a file and a folder of someone else.
fn report(target: &Path) {
    write(target, &[("a", "old"), ("figure_1", "old")]).unwrap();
    fs::write(target.join("notes.txt"), "mine").unwrap();
    fs::create_dir(target.join("deep")).unwrap();
    fs::write(target.join("deep/x"), "mine").unwrap();
}

fn replace(target: &Path, faults: Faults) -> Result<(), FolderError> {
    let folder = OutputFolder::claim_on(Disk::with(faults), target, false)?;
    folder.expecting(&["a", "b", "figure_*"])?.commit(&artefacts(&[("a", "new"), ("b", "new")]))
}

#[track_caller]
fn is_new(target: &Path) {
    assert_eq!(names(target), [SUMS, "a", "b", "deep", "notes.txt"]);
    assert_eq!(
        ["a", "b", "notes.txt", "deep/x"].map(|name| text(target, name)),
        ["new", "new", "mine", "mine"]
    );
    assert!(crate::output::verify(target, |_| true).is_ok());
}

#[test]
fn a_call_that_fails_leaves_everything_as_it_was() {
    for no_exchange in [false, true] {
        let mut failures = 0;
        for call in 1..40 {
            let root = tempdir().unwrap();
            let target = root.path().join("out");
            report(&target);
            let before = everything(root.path());
            match replace(&target, Faults { no_exchange, fail: Some(call), ..Faults::default() }) {
                Ok(()) => is_new(&target),
                Err(error) => {
                    failures += 1;
                    assert!(error.to_string().contains("injected"), "{error}");
                    assert!(everything(root.path()) == before, "call {call} changed something");
                }
            }
            assert_eq!(names(root.path()), ["out"], "call {call}");
        }
        // Three files written and synchronised, their folder; the exchange, one thing carried over, two folders synchronised; else
        // the renames of three old and three new files.
        assert_eq!(failures, if no_exchange { 7 + 1 + 6 + 2 } else { 7 + 1 + 1 + 2 });
    }
}

#[test]
fn a_call_that_fails_leaves_no_trace_of_a_new_folder() {
    for call in 1..=8 {
        let root = tempdir().unwrap();
        let faults = Faults { fail: Some(call), ..Faults::default() };
        let failed = replace(&root.path().join("far/out"), faults);
        assert!(failed.is_err() && names(root.path()).is_empty(), "call {call}");
    }
}

#[cfg(unix)]
#[test]
fn folders_are_exchanged_where_they_can_be() {
    use std::os::unix::fs::MetadataExt;
    for no_exchange in [false, true] {
        let root = tempdir().unwrap();
        let target = root.path().join("out");
        report(&target);
        let inode = || fs::metadata(&target).unwrap().ino();
        let before = inode();
        replace(&target, Faults { no_exchange, ..Faults::default() }).unwrap();
        is_new(&target);
        assert_eq!(inode() == before, no_exchange);
    }
}

#[cfg(unix)]
#[test]
fn a_link_to_a_folder_stays_one() {
    let root = tempdir().unwrap();
    let (target, link) = (root.path().join("out"), root.path().join("link"));
    report(&target);
    std::os::unix::fs::symlink("out", &link).unwrap();
    replace(&link, Faults::default()).unwrap();
    is_new(&target);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    fs::remove_dir_all(&target).unwrap();
    let error = replace(&link, Faults::default()).unwrap_err();
    assert!(matches!(error, FolderError::NotAFolder(..)), "{error}");
}

#[test]
fn a_second_claim_is_refused_while_the_first_lives() {
    let root = tempdir().unwrap();
    let target = root.path().join("new/out");
    let first = OutputFolder::claim(&target, false).unwrap();
    let error = OutputFolder::claim(&target, true).unwrap_err();
    let reported = error.to_string();
    assert!(
        matches!(error, FolderError::Busy(..)) && reported.contains(&std::process::id().to_string()),
        "{reported}"
    );
    assert!(OutputFolder::claim(&root.path().join("new/other"), false).is_ok());
    first.commit(&artefacts(&[("a", "1")])).unwrap();
    OutputFolder::claim(&target, false).unwrap();
    assert_eq!(names(&root.path().join("new")), ["out"]);
}

#[test]
fn a_part_is_replaced_by_the_same_part_only() {
    let root = tempdir().unwrap();
    let target = root.path().join("out");
    let label = |shard: &str| format!("{{\"scenario\": \"a.toml\", \"shard\": {shard}, \"sha256\": \"…\"}}");
    write(&target, &[(PART, &label("1")), ("sums", "1")]).unwrap();
    let is_refused = |written: Result<(), FolderError>| matches!(written, Err(FolderError::Part(_)));
    assert!(is_refused(write(&target, &[("report", "1")])));
    assert!(is_refused(write(&target, &[(PART, &label("2"))])));
    let claimed = OutputFolder::claim(&target, false).unwrap();
    assert!(is_refused(claimed.expecting(&["report"]).map(drop)), "before the computation");
    assert_eq!((names(&target).len(), text(&target, PART)), (3, label("1")));
    write(&target, &[(PART, &label("1")), ("sums", "2")]).unwrap();
    OutputFolder::claim(&target, true).unwrap().commit(&artefacts(&[("report", "1")])).unwrap();
    // What only has the name is nothing of a study.
    let other = root.path().join("other");
    write(&other, &[(PART, "{\"shard\": 1}")]).unwrap();
    write(&other, &[("report", "1")]).unwrap();
}
