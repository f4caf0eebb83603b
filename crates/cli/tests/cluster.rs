//! Studies in 24 parts on three workers of a real Slurm and of a real HyperQueue, while things go wrong: the report has the bytes of one run.
//!
//! `.ci/cluster` installs both engines. `SWITCHBACK_CLUSTER=full` makes parts ten times as long, and has Slurm reach a time limit, which takes
//! minutes. Where an engine is absent its tests say so and pass.
#![cfg(target_os = "linux")]

mod hyperqueue;
mod processes;
mod slurm;
mod study;

use crate::common::faults::files;
use hyperqueue::HyperQueue;
use slurm::Slurm;
use std::fs;
use std::path::Path;
use study::{Launched, PARTS, Study};

/// An engine with three workers. What it has started ends with it.
trait Cluster {
    /// How `switchback launch` calls it.
    const OPTION: &'static str;
    /// Starts it; nothing where it is absent, which is reported.
    fn start(scratch: &Path) -> Option<Self>
    where
        Self: Sized;
    /// What its commands need in their environment.
    fn environment(&self) -> Vec<(&'static str, String)>;
    /// Ends a worker that runs a part, with all that it runs, as a power cut does; false while it runs none.
    fn kill_a_busy_worker(&mut self) -> bool;
    /// Ends what shares the work out, and starts it again, with workers where it has lost them.
    fn restart_coordinator(&mut self);
    /// Whether the script must be started again after that.
    const FORGETS: bool;
}

fn bytes_survive_a_killed_worker<C: Cluster>() {
    let Some((study, mut cluster)) = begin::<C>() else { return };
    let mut run = study.launch(&cluster, &["--submit"]);
    run.wait("three parts are finished", |run| run.finished().len() >= 3);
    run.wait("a worker is busy", |_| cluster.kill_a_busy_worker());
    run.wait("the report is there", Launched::has_report);
    let begun_twice = (1..=PARTS).filter(|&part| run.turns(part) > 1).count();
    assert_eq!(begun_twice, 1, "the part that was lost, and no other, is run again");
    assert_same(&study, &run);
}

fn bytes_survive_a_part_that_fails<C: Cluster>() {
    let Some((study, cluster)) = begin::<C>() else { return };
    let mut run = study.launch(&cluster, &[]);
    // A part has no folder to write to.
    let in_the_way = run.part(5);
    fs::create_dir_all(in_the_way.parent().expect("a folder")).expect("a folder");
    fs::write(&in_the_way, "in the way").expect("a file");
    run.start_script(&cluster);
    run.wait("merge has reported what is missing", |run| run.reported().contains("--array=5"));
    assert!(!run.has_report(), "a report without part 5");
    assert_eq!(run.finished().len(), PARTS - 1);
    run.wait_for_the_script();
    fs::remove_file(&in_the_way).expect("it was there");
    run.start_script(&cluster);
    run.wait("the report is there", Launched::has_report);
    assert!(
        (1..=PARTS).all(|part| run.turns(part) == if part == 5 { 2 } else { 1 }),
        "only part 5 is run again"
    );
    assert_same(&study, &run);
}

fn bytes_survive_another_coordinator<C: Cluster>() {
    let Some((study, mut cluster)) = begin::<C>() else { return };
    let mut run = study.launch(&cluster, &["--submit"]);
    run.wait("six parts are finished", |run| run.finished().len() >= 6);
    cluster.restart_coordinator();
    if C::FORGETS {
        run.wait_for_the_script();
        assert!(run.reported().contains("once it is there again: bash"), "{}", run.reported());
        run.start_script(&cluster);
    }
    run.wait("the report is there", Launched::has_report);
    assert!((1..=6).map(|part| run.turns(part)).max() <= Some(2), "finished parts are left alone");
    assert_same(&study, &run);
}

/// `time` is reached by parts, once the script is changed as a person may change it.
fn bytes_survive_a_time_limit<C: Cluster>(study: &Study, time: &str, change: impl Fn(&str) -> String) {
    let Some(cluster) = C::start(&study.folder.path("engine")) else { return };
    let mut run = study.launch(&cluster, &["--time", time]);
    run.edit_script(change);
    run.start_script(&cluster);
    run.wait("the report is there", Launched::has_report);
    let stopped = (1..=PARTS).filter(|&part| run.turns(part) > 1).count();
    assert!(stopped > 0, "no part has reached its time limit: {}", run.reported());
    assert_same(study, &run);
}

fn rounds_towards_a_precision_have_the_bytes_of_one_run<C: Cluster>() {
    let study = Study::with_precision();
    let Some(cluster) = C::start(&study.folder.path("engine")) else { return };
    let mut run = study.launch(&cluster, &["--submit"]);
    run.wait("the report is there", Launched::has_report);
    assert!(
        run.work.join("round-2/merged").exists() || run.work.join("round-2/part-1").exists(),
        "one round was enough"
    );
    assert_same(&study, &run);
}

/// Most of its parts hold no rig.
fn an_examination_has_the_bytes_of_one_run<C: Cluster>() {
    let study = Study::of_two_rigs();
    let Some(cluster) = C::start(&study.folder.path("engine")) else { return };
    let mut run = study.launch(&cluster, &["--submit"]);
    run.wait("the report is there", Launched::has_report);
    assert_same(&study, &run);
}

fn begin<C: Cluster>() -> Option<(Study, C)> {
    let study = Study::new(1);
    let cluster = C::start(&study.folder.path("engine"))?;
    Some((study, cluster))
}

#[track_caller]
fn assert_same(study: &Study, run: &Launched) {
    assert!(files(&run.out) == *study.whole(), "another report than that of one run");
}

macro_rules! on {
    ($engine:ident: $($name:ident = $test:expr;)*) => { $(#[test] fn $name() { $test } )* };
}

on! { HyperQueue:
    hyperqueue_loses_a_worker = bytes_survive_a_killed_worker::<HyperQueue>();
    hyperqueue_has_a_part_that_fails = bytes_survive_a_part_that_fails::<HyperQueue>();
    hyperqueue_is_started_again = bytes_survive_another_coordinator::<HyperQueue>();
    hyperqueue_reaches_a_time_limit = bytes_survive_a_time_limit::<HyperQueue>(&Study::new(4), "0:01", hyperqueue::in_the_first_turn);
    hyperqueue_examines = an_examination_has_the_bytes_of_one_run::<HyperQueue>();
    hyperqueue_runs_rounds = rounds_towards_a_precision_have_the_bytes_of_one_run::<HyperQueue>();
}

on! { Slurm:
    slurm_loses_a_node = bytes_survive_a_killed_worker::<Slurm>();
    slurm_has_a_part_that_fails = bytes_survive_a_part_that_fails::<Slurm>();
    slurm_is_started_again = bytes_survive_another_coordinator::<Slurm>();
    slurm_examines = an_examination_has_the_bytes_of_one_run::<Slurm>();
    slurm_runs_rounds = rounds_towards_a_precision_have_the_bytes_of_one_run::<Slurm>();
}
