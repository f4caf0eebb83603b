//! Files of tests.

use crate::signals::{ColumnNames, InputForm, Measured, Request, Sampling};
use crate::table::TableError;
use std::path::PathBuf;

/// A file of its own, removed at the end.
pub(crate) struct File(pub(crate) PathBuf);

impl File {
    /// With this name, which no other test has, and this content.
    pub(crate) fn of(name: &str, bytes: &[u8]) -> Self {
        let path = std::env::temp_dir().join(format!("switchback-{}-{name}", std::process::id()));
        std::fs::write(&path, bytes).expect("a writable temporary folder");
        Self(path)
    }

    /// Its signals, input and output by name where one is given.
    pub(crate) fn measured(&self, [input, output]: [Option<&str>; 2]) -> Result<Measured, Vec<TableError>> {
        let named = |name: Option<&str>| name.map(str::to_owned);
        let names = ColumnNames { time: None, input: named(input), output: named(output) };
        let input_form = InputForm::CommandLine(format!("switchback init {}", self.0.display()));
        let request = Request {
            names: &names,
            sampling: Sampling::default(),
            input_form: &input_form,
            needs_output: true,
        };
        Measured::read(&self.0, request)
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}
