//! What answers in the field are counted into.

use crate::examination::calibration::{Claims, Stratum};
use crate::examination::rating::{Asked, Rating};
use crate::examination::share::Share;
use crate::examination::table::{Cell, Table, grouped};

/// The right class, or better.
pub(super) const RIGHT: [Rating; 2] = [Rating::Exact, Rating::Class];

/// The share of judged answers with one of some ratings.
pub(super) fn share<'a, 'c: 'a>(asked: impl Iterator<Item = &'a Asked<'c>>, wanted: &[Rating]) -> Share {
    let ratings: Vec<Rating> = asked.filter_map(Asked::rating).collect();
    Share::over(ratings.iter(), |rating| wanted.contains(rating))
}

/// Answers by what `key` says of them and by whether the base's model was given; no key leaves one out.
pub(super) fn answers<'c>(asked: &[Asked<'c>], key: impl Fn(&Asked<'c>) -> Option<String>) -> Table {
    type Group<'a, 'c> = ((String, bool), Vec<&'a Asked<'c>>);
    fn rated((_, asked): &Group<'_, '_>, wanted: &[Rating]) -> Cell {
        Cell::Share(share(asked.iter().copied(), wanted))
    }
    Table::of(
        grouped(asked, |a| Some((key(a)?, a.answer.with_model))),
        &[
            ("of", |((of, _), _)| Cell::word(of)),
            ("with_model", |((_, with_model), _)| Cell::Flag(*with_model)),
            ("answers", |(_, asked)| Cell::Count(asked.len())),
            ("exact", |group| rated(group, &[Rating::Exact])),
            ("class", |group| rated(group, &RIGHT)),
            ("silent", |group| rated(group, &[Rating::Silent])),
            ("wrong", |group| rated(group, &[Rating::Wrong])),
        ],
    )
}

/// The claims by stratum, the one whose calibration is worst first.
pub(super) fn strata(asked: &[Asked<'_>]) -> Vec<Stratum> {
    let groups = grouped(asked, |a| Some((a.stratum(), a.answer.with_model)));
    let stratum = |((of, with_model), asked): ((String, bool), Vec<&Asked<'_>>)| {
        let claims = Claims::of(asked.into_iter().filter_map(Asked::claim));
        Stratum { of, with_model, claims }
    };
    let mut strata: Vec<Stratum> = groups.into_iter().map(stratum).filter(|s| s.claims.count > 0).collect();
    let excess = |s: &Stratum| s.claims.excess.unwrap_or(f64::NEG_INFINITY);
    strata.sort_by(|x, y| excess(y).total_cmp(&excess(x)));
    strata
}

/// Bins of the claims, all together and a stratum at a time.
pub(crate) fn bins(claims: &Claims, strata: &[Stratum]) -> Table {
    let all = std::iter::once(("all", "", claims));
    let each = strata.iter().map(|s| (s.of.as_str(), if s.with_model { "true" } else { "false" }, &s.claims));
    let rows =
        all.chain(each).flat_map(|(of, model, claims)| claims.bins.iter().map(move |b| (of, model, b)));
    Table::of(
        rows,
        &[
            ("stratum", |(of, ..)| Cell::word(*of)),
            ("with_model", |(_, model, _)| Cell::word(*model)),
            ("claimed", |(.., bin)| Cell::Figure(bin.claimed)),
            ("held", |(.., bin)| Cell::Share(bin.held)),
            ("answers", |(.., bin)| Cell::Count(bin.held.of)),
        ],
    )
}
