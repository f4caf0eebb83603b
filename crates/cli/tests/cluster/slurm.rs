//! Slurm with three nodes on this host (`three-nodes.sh`).

use super::Cluster;
use super::processes::{Process, all, has_variable, kill, number_in, parent};
use super::study::{Study, is_asked, is_full};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Ports are taken by one cluster at a time.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

pub(crate) struct Slurm {
    folder: PathBuf,
    _turn: MutexGuard<'static, ()>,
}

/// The node that dies.
const NODE: &str = "n2";

impl Slurm {
    fn configuration(&self) -> String {
        self.folder.join("slurm.conf").display().to_string()
    }

    fn answers(&self) -> bool {
        let idle =
            Command::new("sinfo").args(["--noheader", "--format=%T %D"]).envs(self.environment()).output();
        idle.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).trim() == "idle 3")
    }

    fn end_all(&self) {
        for file in fs::read_dir(&self.folder).into_iter().flatten().flatten() {
            if let Some(id) =
                number_in(&file.path()).filter(|_| file.path().extension().is_some_and(|e| e == "pid"))
            {
                kill(id);
            }
        }
        let configuration = self.configuration();
        let ours: Vec<_> =
            all().into_iter().filter(|p| has_variable(p.id, "SLURM_CONF", &configuration)).collect();
        steps_of(&ours).into_iter().chain(ours).for_each(|process| kill(process.id));
    }
}

/// The daemons that watch over jobs, of which these are processes.
fn steps_of(processes: &[Process]) -> Vec<Process> {
    let parents: Vec<u32> = processes.iter().filter_map(|process| parent(process.id)).collect();
    all().into_iter().filter(|p| parents.contains(&p.id) && p.name.starts_with("slurmstepd")).collect()
}

impl Cluster for Slurm {
    const OPTION: &'static str = "--slurm";
    const FORGETS: bool = false;

    fn start(scratch: &Path) -> Option<Self> {
        if !is_asked() {
            return None;
        }
        let has = |program: &str| Command::new(program).arg("-V").output().is_ok();
        let is_root =
            fs::metadata("/proc/self").is_ok_and(|own| std::os::unix::fs::MetadataExt::uid(&own) == 0);
        if !["slurmctld", "slurmd", "sbatch", "munged"].into_iter().all(has) || !is_root {
            eprintln!(
                "SKIPPED: Slurm and munge are not installed, or this is not root, as whom three nodes are started on one host"
            );
            return None;
        }
        let turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
        let cluster = Self { folder: scratch.to_owned(), _turn: turn };
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cluster/three-nodes.sh");
        let started = Command::new("bash").arg(script).arg(scratch).status().expect("bash");
        assert!(started.success(), "{script}");
        let begun = Instant::now();
        while !cluster.answers() {
            assert!(begun.elapsed() < Duration::from_secs(60), "Slurm does not come up");
            sleep(Duration::from_millis(100));
        }
        Some(cluster)
    }

    fn environment(&self) -> Vec<(&'static str, String)> {
        vec![("SLURM_CONF", self.configuration())]
    }

    fn kill_a_busy_worker(&mut self) -> bool {
        let configuration = self.configuration();
        let of_node =
            |id| has_variable(id, "SLURMD_NODENAME", NODE) && has_variable(id, "SLURM_CONF", &configuration);
        let running: Vec<_> = all().into_iter().filter(|process| of_node(process.id)).collect();
        if !running.iter().any(|process| process.name == "switchback") {
            return false;
        }
        let node = number_in(&self.folder.join(format!("slurmd-{NODE}.pid"))).expect("it runs");
        // The daemon first, then the steps and what they run, so that nobody reports their end.
        kill(node);
        steps_of(&running).into_iter().chain(running).for_each(|process| kill(process.id));
        true
    }

    fn restart_coordinator(&mut self) {
        // As a system's services are ended. Killed outright, slurmctld forgets what it has begun in the seconds before, gives the same numbers to
        // other jobs, and then drains the nodes that know them.
        let file = self.folder.join("slurmctld.pid");
        let controller = number_in(&file).expect("it runs");
        let reported = Command::new("kill").args(["-TERM", &controller.to_string()]).status().expect("kill");
        assert!(reported.success());
        let begun = Instant::now();
        while parent(controller).is_some() {
            assert!(begun.elapsed() < Duration::from_secs(60), "slurmctld does not end");
            sleep(Duration::from_millis(50));
        }
        // Away long enough for parts to end meanwhile.
        sleep(Duration::from_secs(3));
        let started =
            Command::new("slurmctld").args(["-f", &self.configuration()]).status().expect("slurmctld");
        assert!(started.success());
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        self.end_all();
    }
}

/// Slurm counts time limits in minutes; reported three minutes before their end, parts are stopped as soon as Slurm looks, every half minute.
#[test]
fn slurm_reaches_a_time_limit() {
    if is_full() {
        let notice = |script: &str| script.replace("notice=60", "notice=170");
        super::bytes_survive_a_time_limit::<Slurm>(&Study::new(3), "3", notice);
    } else {
        eprintln!("SKIPPED: a time limit of Slurm's takes minutes; SWITCHBACK_CLUSTER=full reaches one");
    }
}
