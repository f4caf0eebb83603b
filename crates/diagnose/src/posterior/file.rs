//! The file of a posterior.

use super::bytes::{Reader, Writer};
use super::decision::Thresholds;
use super::error::PosteriorError;
use super::network::Network;
use super::novelty::Novelty;
use super::prior::Prior;
use super::ranker::Ranker;
use super::second_stage::SecondStage;
use super::trees::Trees;
use super::weights::{Posterior, Shares};

/// What every file begins with.
const MAGIC: &[u8; 4] = b"SWBP";
/// Version of the format.
pub const VERSION: u32 = 2;

impl Posterior {
    /// The bytes of its file.
    pub fn write(&self) -> Vec<u8> {
        let mut out = Writer(MAGIC.to_vec());
        out.0.extend(VERSION.to_le_bytes());
        out.text(&self.provenance);
        out.count(self.rows);
        let Prior { effect, none, none_of_these } = self.prior;
        let Thresholds { named, class, .. } = self.thresholds;
        [effect, none, none_of_these, named, class].iter().for_each(|x| out.number(*x as f32));
        for names in [&self.columns, &self.classes] {
            out.count(names.len());
            names.iter().for_each(|name| out.text(name));
        }
        self.trees.write(&mut out);
        out.byte(u8::from(self.network.is_some()));
        self.network.iter().for_each(|network| network.write(&mut out));
        out.byte(u8::from(self.ranker.is_some()));
        self.ranker.iter().for_each(|ranker| ranker.write(&mut out));
        let Shares { trees, network, ranker } = self.shares;
        [trees, network, ranker].iter().for_each(|share| out.number(*share));
        out.byte(u8::from(self.second.is_some()));
        self.second.iter().for_each(|second| second.write(&mut out));
        out.count(self.temperatures.len());
        for (name, temperature) in &self.temperatures {
            out.text(name);
            out.number(*temperature);
        }
        self.novelty.write(&mut out);
        out.0
    }

    /// Reads a file's bytes.
    ///
    /// # Errors
    /// [`PosteriorError`] where they are none of this version, or damaged.
    pub fn read(bytes: &[u8]) -> Result<Self, PosteriorError> {
        let rest = bytes.strip_prefix(MAGIC).ok_or(PosteriorError::NoPosterior)?;
        let mut from = Reader::new(rest);
        let found = from.version()?;
        if found != VERSION {
            return Err(PosteriorError::Version { found, known: VERSION });
        }
        let provenance = from.text()?;
        let rows = from.any_count()?;
        let mut shares = [0.0; 5];
        for share in &mut shares {
            *share = f64::from(from.number()?);
        }
        if shares.iter().any(|share| !(0.0..=1.0).contains(share)) {
            return Err(from.damaged("a probability that is none"));
        }
        let [effect, none, none_of_these, named, class] = shares;
        let prior = Prior { effect, none, none_of_these };
        let thresholds = Thresholds { named, class, ..Thresholds::default() };
        let mut names = || -> Result<Vec<String>, PosteriorError> {
            let count = from.count_of(4)?;
            (0..count).map(|_| from.text()).collect()
        };
        let (columns, classes) = (names()?, names()?);
        let trees = Trees::read(&mut from, columns.len())?;
        if trees.start.len() != classes.len() || classes.is_empty() {
            return Err(from.damaged("trees of another number of classes"));
        }
        let network = match from.byte()? {
            0 => None,
            _ => Some(Network::read(&mut from, columns.len(), classes.len())?),
        };
        let ranker = match from.byte()? {
            0 => None,
            _ => Some(Ranker::read(&mut from, columns.len(), classes.len())?),
        };
        let shares = Shares { trees: from.number()?, network: from.number()?, ranker: from.number()? };
        let second = match from.byte()? {
            0 => None,
            _ => Some(SecondStage::read(&mut from, columns.len(), classes.len())?),
        };
        let populations = from.count_of(8)?;
        let mut temperatures = Vec::new();
        for _ in 0..populations {
            let (name, temperature) = (from.text()?, from.number()?);
            if temperature <= 0.0 {
                return Err(from.damaged("a temperature that is not positive"));
            }
            temperatures.push((name, temperature));
        }
        let novelty = Novelty::read(&mut from, columns.len())?;
        if !from.is_at_end() {
            return Err(from.damaged("the file goes on behind its end"));
        }
        Ok(Self {
            provenance,
            rows,
            prior,
            thresholds,
            columns,
            classes,
            trees,
            network,
            ranker,
            shares,
            second,
            temperatures,
            novelty,
        })
    }
}
