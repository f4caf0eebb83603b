//! Units above a table, one a line: with numbers, as names have them, or in a section of their own.

use super::keyed::{Named, is_unit_key, keyed_value};
use super::unit;

/// Positions of columns, and their units.
type Units = Vec<(usize, Option<String>)>;

/// Given to the columns that have none yet.
pub(super) fn add_units(names: &mut [Named], lines: &[(u64, &str)]) {
    for (k, unit) in counted(lines, names).or_else(|| section(lines, names.len())).into_iter().flatten() {
        let (_, own) = &mut names[k];
        *own = own.take().or(unit);
    }
}

/// Units with the numbers of names: `DISP_UNIT0 = mm`. They count on from where the lines of names do, else from the first column on.
fn counted(lines: &[(u64, &str)], names: &[Named]) -> Option<Units> {
    let entries: Vec<(&str, usize, &str)> = lines.iter().filter_map(|(_, line)| keyed_value(line)).collect();
    let named =
        |(_, _, value): &&(&str, usize, &str)| names.iter().any(|(name, _)| unit::split(value).0 == *name);
    let keys = entries.iter().map(|(key, ..)| *key).filter(|key| is_unit_key(key));
    keys.into_iter().find_map(|key| {
        let own: Vec<_> = entries.iter().filter(|(other, ..)| *other == key).collect();
        let is_known = own.iter().any(|(.., cell)| unit::bare(cell).is_some());
        let first = own.first().map(|(_, number, _)| *number)?;
        let base = entries.iter().find(named).map(|(_, number, _)| *number);
        let base = base.or_else(|| (own.len() == names.len()).then_some(first))?;
        let positions =
            own.iter().map(|(_, number, _)| number.checked_sub(base).filter(|k| *k < names.len()));
        let positions: Vec<usize> = positions.collect::<Option<_>>()?;
        let units = own.iter().map(|(.., cell)| unit::meant(cell));
        (is_known && own.len() > 1).then(|| positions.into_iter().zip(units).collect())
    })
}

/// Units one a line in a section called so, of the last columns where they are fewer: instruments list those of added channels only. A blank line
/// between two of them stands for a channel without one.
fn section(lines: &[(u64, &str)], width: usize) -> Option<Units> {
    let framed = |line: &str| line.trim().strip_prefix('[')?.strip_suffix(']').map(str::to_lowercase);
    let is_head = |(_, line): &(u64, &str)| {
        framed(line)
            .is_some_and(|name| name == "units" || name.ends_with(" units") || name.ends_with("_units"))
    };
    let at = lines.iter().position(is_head)?;
    let within = lines[at + 1..].iter().take_while(|(_, line)| framed(line).is_none());
    let units: Vec<(u64, &str)> = within.map(|(number, line)| (*number, line.trim())).collect();
    let (first, last) = (units.first()?.0, units.last()?.0);
    let is_known = |(_, cell): &(u64, &str)| unit::bare(cell).is_some();
    let is_single =
        |(_, cell): &(u64, &str)| !cell.contains([' ', ',', ';', '\t']) || unit::bare(cell).is_some();
    let from = width.checked_sub(usize::try_from(last - first).ok()? + 1)?;
    let is_list = units.iter().any(is_known) && units.iter().all(is_single);
    is_list.then(|| {
        let position = |number: u64| from + usize::try_from(number - first).unwrap_or(0);
        units.into_iter().map(|(number, cell)| (position(number), unit::meant(cell))).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered(text: &str) -> Vec<(u64, &str)> {
        (1..).zip(text.lines()).filter(|(_, line)| !line.is_empty()).collect()
    }

    fn names(all: &[&str]) -> Vec<Named> {
        all.iter().map(|name| ((*name).to_owned(), None)).collect()
    }

    fn some(unit: &str) -> Option<String> {
        Some(unit.to_owned())
    }

    #[test]
    fn units_have_the_numbers_of_their_names() {
        let names = names(&["Target of axis:1", "Force"]);
        for text in [
            "# NAME0 = Target of axis:1\n# NAME1 = Force\n#\n# DISP_UNIT0 = µm\n# DISP_UNIT1 = N",
            "# UNIT0 = µm\n# RANGE0 = 5\n# UNIT1 = N\n# RANGE1 = 2",
            "Unit 1: µm\nUnit 2: N",
        ] {
            assert_eq!(
                counted(&numbered(text), &names),
                Some(vec![(0, some("µm")), (1, some("N"))]),
                "{text}"
            );
        }
        let last = "# NAME0 = Target of axis:1\n# NAME1 = Force\n# UNIT1 = N";
        assert_eq!(counted(&numbered(last), &names), None, "one unit is a setting");
        assert_eq!(counted(&numbered("# UNIT0 = 5\n# UNIT1 = 6"), &names), None);
        assert_eq!(counted(&numbered("# UNIT0 = mm\n# UNIT1 = N\n# UNIT2 = V"), &names), None);
    }

    #[test]
    fn units_of_a_section_belong_to_the_last_columns() {
        let text = "[header]\ntime\nstroke\nload\n\n[channel units]\nmm\nN\n\n[data]";
        assert_eq!(section(&numbered(text), 3), Some(vec![(1, some("mm")), (2, some("N"))]));
        let gap = "[units]\nmm\n\nN\n";
        assert_eq!(section(&numbered(gap), 4), Some(vec![(1, some("mm")), (3, some("N"))]));
        assert_eq!(section(&numbered(text), 1), None);
        assert_eq!(section(&numbered("[units]\ns mm N"), 3), None, "a row of units");
    }
}
