//! The folder of a report, drawn as a page: files one after the other, each behind a line `=== NAME`.

use super::{Scratch, reported, text_of};
use switchback_report::pages::{Files, index};

/// Runs it on an input.
pub fn run(bytes: &[u8]) {
    let Some(text) = text_of(bytes) else { return };
    // A folder of its own: what an input lacks must not be there from the one before.
    let folder = Scratch::new();
    for part in text.split("=== ").skip(1) {
        let Some((name, contents)) = part.split_once('\n') else { continue };
        if !name.is_empty()
            && name.len() < 40
            && name.chars().all(|c| c.is_ascii_alphanumeric() || "._-".contains(c))
            && !name.starts_with('.')
        {
            folder.write(name, contents.as_bytes());
        }
    }
    match Files::read(folder.path()).and_then(|files| index(&files)) {
        Ok(page) => {
            assert_eq!(page.matches("<script").count(), 1, "only the page's own script");
            assert!(!page.contains("javascript:") || text.contains("javascript:"));
            assert!(
                page.chars().all(|c| !c.is_control() || "\n\t\r".contains(c))
                    || text.contains(char::is_control)
            );
        }
        Err(refusal) => reported(&refusal),
    }
}
