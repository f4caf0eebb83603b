//! The posterior that is compiled in.

use super::weights::Posterior;
use std::sync::LazyLock;

impl Posterior {
    /// The one that is compiled in; its provenance says how it was trained.
    pub fn built_in() -> &'static Self {
        static BUILT_IN: LazyLock<Posterior> = LazyLock::new(|| {
            let bytes = include_bytes!("../../weights/posterior.bin");
            Posterior::read(bytes).expect("the file in the repository is whole")
        });
        &BUILT_IN
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_whole_and_says_where_it_comes_from() {
        let posterior = Posterior::built_in();
        assert!(posterior.rows > 1000 && posterior.provenance.starts_with("switchback train"));
        let prior = posterior.prior;
        assert!((prior.effect + prior.none + prior.none_of_these - 1.0).abs() < 1e-5);
        assert!(posterior.temperatures.iter().any(|(name, _)| name == Posterior::ALL));
    }
}
