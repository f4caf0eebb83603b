//! What every law says of itself.

/// The identity card of a law: the five methods that hold constants.
macro_rules! card {
    ($effect:literal, $name:literal, $stage:ident, $unit:expr, $limit:literal) => {
        fn effect(&self) -> &'static str {
            $effect
        }
        fn name(&self) -> &'static str {
            $name
        }
        fn stage(&self) -> crate::generate::law::Stage {
            crate::generate::law::Stage::$stage
        }
        fn unit(&self) -> &'static str {
            $unit
        }
        fn limit(&self) -> f64 {
            $limit
        }
    };
}
pub(crate) use card;
