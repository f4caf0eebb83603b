//! A page of Markdown as its blocks of code.

use std::fs;
use std::path::{Path, PathBuf};

/// A page.
pub(crate) struct Page {
    /// Its path in the repository.
    pub(crate) path: PathBuf,
    pub(crate) blocks: Vec<Block>,
}

/// A block of code.
pub(crate) struct Block {
    /// What stands behind its opening fence.
    pub(crate) language: String,
    pub(crate) text: String,
    /// Line of its opening fence, from 1.
    pub(crate) line: usize,
    /// Who checks it, where it is not run here.
    pub(crate) mark: Option<Mark>,
    /// Whether nothing but blank lines stands between the block before and this one.
    pub(crate) follows: bool,
}

/// Why a block is not run here.
pub(crate) enum Mark {
    /// A file checks it, and holds a text that shows it.
    CheckedBy { file: String, text: String },
    /// Nothing checks it.
    NotRun,
}

impl Mark {
    /// A comment of one line.
    fn parse(line: &str) -> Option<Self> {
        let words = line.trim().strip_prefix("<!-- ")?.strip_suffix(" -->")?;
        if let Some(reason) = words.strip_prefix("not run: ") {
            return (!reason.is_empty()).then_some(Self::NotRun);
        }
        let (file, text) = words.strip_prefix("checked by ")?.split_once(": ")?;
        Some(Self::CheckedBy { file: file.to_owned(), text: text.to_owned() })
    }
}

/// What is run here, or is no program.
const SETTLED: [&str; 6] = ["sh", "text", "toml", "json", "csv", "mermaid"];

impl Page {
    /// Reads a page of a repository.
    pub(crate) fn read(root: &Path, path: &Path) -> Self {
        let text = fs::read_to_string(root.join(path)).expect("a readable page");
        Self { path: path.to_owned(), blocks: blocks(&text) }
    }

    /// Where a block stands.
    pub(crate) fn place(&self, block: &Block) -> String {
        format!("{}:{}", self.path.display(), block.line)
    }

    /// Marks that point at nothing, programs in other languages that nobody runs, and TOML that is none.
    pub(crate) fn unchecked(&self, root: &Path) -> Vec<String> {
        let complaint = |block: &Block| {
            let place = self.place(block);
            match &block.mark {
                Some(Mark::CheckedBy { file, text }) => {
                    let checks = fs::read_to_string(root.join(file)).is_ok_and(|check| check.contains(text));
                    (!checks).then(|| format!("{place}: {file} does not hold `{text}`"))
                }
                Some(Mark::NotRun) => None,
                None if block.language == "toml" => {
                    let wrong = block.text.parse::<toml::Table>().err()?;
                    Some(format!("{place}: no TOML: {wrong}"))
                }
                None => (!SETTLED.contains(&block.language.as_str()))
                    .then(|| format!("{place}: nobody runs this `{}`; say who does", block.language)),
            }
        };
        self.blocks.iter().filter_map(complaint).collect()
    }
}

fn blocks(text: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut lines = text.lines().enumerate();
    // The last line that was not blank.
    let mut last = "";
    while let Some((number, line)) = lines.next() {
        let Some(language) = line.strip_prefix("```") else {
            if !line.trim().is_empty() {
                last = line;
            }
            continue;
        };
        let body: Vec<&str> =
            lines.by_ref().map(|(_, line)| line).take_while(|line| !line.starts_with("```")).collect();
        blocks.push(Block {
            language: language.trim().to_owned(),
            text: body.join("\n") + "\n",
            line: number + 1,
            mark: Mark::parse(last),
            follows: last == "```",
        });
        last = "```";
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_know_their_place_and_who_checks_them() {
        let page = "# a\n```sh\nls\n```\n\n```text\nb\n```\n<!-- checked by .ci/run: ls -->\n```sh\nls\n```\n<!-- not run: no -->\n```julia\n```\n";
        let found = blocks(page);
        let reported: Vec<_> = found.iter().map(|b| (b.language.as_str(), b.line, b.follows)).collect();
        assert_eq!(reported, [("sh", 2, false), ("text", 6, true), ("sh", 10, false), ("julia", 14, false)]);
        assert!(found[0].mark.is_none() && matches!(found[3].mark, Some(Mark::NotRun)));
        assert!(
            matches!(&found[2].mark, Some(Mark::CheckedBy { file, text }) if file == ".ci/run" && text == "ls")
        );
    }

    #[test]
    fn what_nobody_checks_is_reported() {
        let page = Page {
            path: PathBuf::from("a.md"),
            blocks: blocks(
                "```python\n1\n```\n<!-- checked by none: x -->\n```sh\nls\n```\n\n```toml\n= 1\n```\n",
            ),
        };
        let reported = page.unchecked(Path::new("."));
        assert_eq!(reported.len(), 3, "{reported:?}");
        assert!(
            reported[0].contains("a.md:1: nobody runs this `python`")
                && reported[1].contains("does not hold `x`")
        );
    }
}
