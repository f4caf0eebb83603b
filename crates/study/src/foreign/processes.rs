//! All processes of a method of others.

use super::conversation::{Broken, Conversation};
use super::design::Design;
use super::estimator::{Estimates, ForeignError, ForeignEstimator, Records};
use crate::scenario::{ForeignMethod, Program};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use switchback_io::output::in_shell;

/// A command that is run in as many processes as are asked at once.
#[derive(Debug)]
pub struct Processes {
    name: String,
    command: Vec<String>,
    patience: Duration,
    /// Most processes at once.
    most: usize,
    pool: Mutex<Pool>,
    is_free: Condvar,
}

#[derive(Debug, Default)]
struct Pool {
    /// Those that nobody asks at the moment.
    idle: Vec<Conversation>,
    /// How many are being asked.
    busy: usize,
}

impl Processes {
    /// Of a method; nothing is begun yet. `None` where the method is no command.
    pub fn of(method: &ForeignMethod) -> Option<Self> {
        let Program::Command(command) = &method.program else { return None };
        Some(Self {
            name: method.name.as_str().to_owned(),
            command: command.clone(),
            patience: method.patience,
            most: method.workers.unwrap_or(usize::MAX),
            pool: Mutex::default(),
            is_free: Condvar::new(),
        })
    }

    fn pool(&self) -> MutexGuard<'_, Pool> {
        self.pool.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A process that nobody else asks, begun where there is none.
    fn take(&self) -> Result<Conversation, Broken> {
        let mut pool = self.pool();
        while pool.busy >= self.most {
            pool = self.is_free.wait(pool).unwrap_or_else(PoisonError::into_inner);
        }
        pool.busy += 1;
        let idle = pool.idle.pop();
        drop(pool);
        idle.map_or_else(|| Ok(Conversation::begin(&self.command, self.patience)?.0), Ok)
            .inspect_err(|_| self.give_back(None))
    }

    /// Gives one back; none where it has broken.
    fn give_back(&self, conversation: Option<Conversation>) {
        let mut pool = self.pool();
        pool.busy -= 1;
        pool.idle.extend(conversation);
        self.is_free.notify_one();
    }
}

impl ForeignEstimator for Processes {
    fn begin(&self) -> Result<String, ForeignError> {
        let refused = |Broken(why)| ForeignError {
            method: self.name.clone(),
            why,
            remedy: format!(
                "try the command by hand in this folder: {}; it must answer as docs/FORMAT.md says under \"Methods of others\"",
                self.command.iter().map(|word| in_shell(word)).collect::<Vec<_>>().join(" ")
            ),
        };
        let (conversation, version) = Conversation::begin(&self.command, self.patience).map_err(refused)?;
        self.pool().idle.push(conversation);
        Ok(version)
    }

    fn estimate(&self, design: &Design, records: &[Records<'_>]) -> Vec<Result<Estimates, String>> {
        let mut results: Vec<Option<Result<Estimates, String>>> = vec![None; records.len()];
        while let Some(first) = results.iter().position(Option::is_none) {
            match self.take() {
                Ok(conversation) => self.give_back(conversation.ask(design, records, &mut results)),
                Err(Broken(why)) => results[first] = Some(Err(why)),
            }
        }
        results.into_iter().flatten().collect()
    }

    fn end(&self) {
        let idle = std::mem::take(&mut self.pool().idle);
        idle.into_iter().for_each(Conversation::end);
    }
}

impl Drop for Processes {
    fn drop(&mut self) {
        self.end();
    }
}
