//! Libraries that may panic where a file contradicts itself: those of Parquet and MCAP.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    static IS_SILENT: Cell<bool> = const { Cell::new(false) };
}

/// Runs something; none, and nothing printed, where it panics.
pub(crate) fn contained<T>(work: impl FnOnce() -> T) -> Option<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_SILENT.get() {
                before(panic);
            }
        }));
    });
    IS_SILENT.set(true);
    let done = catch_unwind(AssertUnwindSafe(work));
    IS_SILENT.set(false);
    done.ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_none() {
        assert_eq!((contained(|| 7), contained(|| -> u8 { panic!("as some do") })), (Some(7), None));
    }
}
