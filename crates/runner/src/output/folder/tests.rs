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

fn write(folder: &Path, files: &[(&str, &str)]) -> Result<(), OutputError> {
    OutputFolder::claim(folder).unwrap().commit(&artefacts(files))
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
    let told = error.to_string();
    assert!(told.contains("b (changed since"), "{told}");
    assert!(told.contains("c (not written by this program)"), "{told}");
    assert!(!told.contains("a ("), "{told}");
    assert_eq!(["a", "b", "c"].map(|name| text(root.path(), name)), ["old", "edited", "measured"]);
    assert_eq!(names(root.path()), [SUMS, "a", "b", "c"]);
}

#[test]
fn names_known_beforehand_are_refused_before_the_computation() {
    let root = tempdir().unwrap();
    fs::write(root.path().join("drive.csv"), "measured").unwrap();
    let claim = || OutputFolder::claim(root.path()).unwrap();
    assert!(matches!(claim().expecting(&["drive.csv"]), Err(OutputError::Foreign { .. })));
    assert!(claim().expecting(&["rig.toml"]).is_ok());
    assert!(matches!(claim().expecting(&["rig.toml", "d*.csv"]), Err(OutputError::Foreign { .. })));
    assert!(claim().expecting(&["drive*.svg", "x*.csv", "drive.csv*v"]).is_ok());
    assert!(claim().forced(true).expecting(&["drive.csv"]).is_ok());
}

#[test]
fn a_forced_folder_replaces_all_and_calls_it_its_own() {
    let root = tempdir().unwrap();
    fs::write(root.path().join("a"), "measured").unwrap();
    OutputFolder::claim(root.path()).unwrap().forced(true).commit(&artefacts(&[("a", "new")])).unwrap();
    assert_eq!(text(root.path(), "a"), "new");
    write(root.path(), &[("a", "newer")]).unwrap();
}

#[test]
fn a_list_of_sums_that_others_ship_with_their_data_counts_for_nothing() {
    let root = tempdir().unwrap();
    fs::write(root.path().join("drive.csv"), "measured").unwrap();
    fs::write(root.path().join("SHA256SUMS"), format!("{}  drive.csv\n", super::super::sha256("measured")))
        .unwrap();
    assert!(matches!(write(root.path(), &[("drive.csv", "new")]), Err(OutputError::Foreign { .. })));
}

#[test]
fn a_dropped_claim_leaves_nothing() {
    let root = tempdir().unwrap();
    drop(OutputFolder::claim(&root.path().join("deep/new")).unwrap());
    assert!(names(root.path()).is_empty());
}

#[test]
fn a_path_below_a_file_is_refused_at_once() {
    let root = tempdir().unwrap();
    let file = root.path().join("file");
    fs::write(&file, "kept").unwrap();
    let error = OutputFolder::claim(&file.join("reports")).unwrap_err();
    assert!(matches!(error, OutputError::NotAFolder { .. }), "{error}");
    assert_eq!(fs::read_to_string(file).unwrap(), "kept");
}

#[test]
fn a_commit_that_cannot_finish_keeps_what_was_there() {
    let root = tempdir().unwrap();
    write(root.path(), &[("a", "old")]).unwrap();
    fs::create_dir(root.path().join("b")).unwrap();
    let error = write(root.path(), &[("a", "new"), ("b", "new")]).unwrap_err();
    assert!(matches!(error, OutputError::FileIsFolder { .. }), "{error}");
    assert_eq!(text(root.path(), "a"), "old");
    assert_eq!(names(root.path()), [SUMS, "a", "b"]);
}

#[test]
fn files_that_took_their_places_before_a_failure_go_again() {
    let root = tempdir().unwrap();
    let folder = OutputFolder::claim(root.path()).unwrap();
    let files = artefacts(&[("a", "new"), ("b", "new")]);
    // A folder stands where the second file goes, and another where it is moved aside to: the exchange fails half-way.
    fs::create_dir_all(root.path().join("b/full")).unwrap();
    let (fresh, replaced) =
        (folder.staging.folder("fresh").unwrap(), folder.staging.folder("replaced").unwrap());
    fs::create_dir_all(replaced.join("b/full")).unwrap();
    for (name, contents) in files.iter() {
        fs::write(fresh.join(name), contents).unwrap();
    }
    assert!(folder.exchange_all(&files, &[], [&fresh, &replaced]).is_err());
    drop(folder);
    assert_eq!(names(root.path()), ["b"]);
}

#[test]
fn files_of_a_former_run_go_unless_someone_changed_or_wrote_them() {
    let root = tempdir().unwrap();
    let claim = || OutputFolder::claim(root.path()).unwrap().expecting(&["a", "figure_*"]).unwrap();
    claim()
        .commit(&artefacts(&[("a", "1"), ("figure_1", "1"), ("figure_2", "1"), ("elsewhere", "1")]))
        .unwrap();
    fs::write(root.path().join("figure_3"), "not listed").unwrap();
    fs::write(root.path().join("figure_2"), "edited").unwrap();
    OutputFolder::claim(root.path())
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
    let claim = || OutputFolder::claim(root.path()).unwrap().forced(true);
    let error = claim().expecting(&["*.csv"]).unwrap().sparing([series.as_path()]).unwrap_err();
    assert!(matches!(error, OutputError::IsInput { .. }), "{error}");
    let error = claim().sparing([series.as_path()]).unwrap().commit(&artefacts(&[("series.csv", "new")]));
    assert!(matches!(error, Err(OutputError::IsInput { .. })));
    assert_eq!(text(root.path(), "series.csv"), "measured");
}
