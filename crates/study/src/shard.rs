//! `--shard`

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Which of equal parts of a study runs: every `of`-th piece of work, from the `number`-th on, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub struct Shard {
    /// Which part, from 1 to `of`.
    #[schemars(range(min = 1))]
    pub number: usize,
    /// How many parts there are.
    #[schemars(range(min = 1))]
    pub of: usize,
}

impl Shard {
    /// Whether the piece of work at a position, counted from 0, belongs to this part.
    ///
    /// ```
    /// # use switchback_study::Shard;
    /// let second: Shard = "2/3".parse()?;
    /// assert_eq!((0..6).filter(|k| second.holds(*k)).collect::<Vec<_>>(), [1, 4]);
    /// # Ok::<(), String>(())
    /// ```
    pub fn holds(self, position: usize) -> bool {
        position % self.of == self.number - 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts =
            text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match parts {
            Some((number, of)) if (1..=of).contains(&number) => Ok(Self { number, of }),
            _ => Err("give the number of a part and how many there are, as in 1/4".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_one_of_some() {
        assert_eq!("3/3".parse(), Ok(Shard { number: 3, of: 3 }));
        for bad in ["0/3", "4/3", "1", "1/0", "a/b", "1/2/3", "-1/2"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }

    #[test]
    fn parts_share_everything_out() {
        for of in 1..6 {
            for position in 0..40 {
                let holders = (1..=of).filter(|number| Shard { number: *number, of }.holds(position));
                assert_eq!(holders.count(), 1);
            }
        }
    }
}
