//! A share in a table.

use crate::pages::table::Cell;
use switchback_lab::examination::ShareFile;

/// `96.0 % (145 of 151)`.
pub(super) fn share(share: ShareFile) -> Cell {
    match share.share {
        Some(value) => {
            Cell::number(format!("{:.1} % ({} of {})", 100.0 * value, share.count, share.of), Some(value))
        }
        None => Cell::number("–", None),
    }
}
