//! Which levels a pulse experiment may visit.

use super::{Direction, ExcitationError};
use switchback_model::hysteresis::Interval;

/// Checks that levels keep the memory masked and fix the normalisation.
///
/// They must lie inside the interval, begin at the end opposite the satellite, go strictly towards the satellite and
/// stop short of it.
pub(super) fn check_levels(
    interval: Interval,
    direction: Direction,
    levels: &[f64],
) -> Result<(), ExcitationError> {
    let satellite = direction.satellite(interval);
    let expected = direction.opposite(interval);
    for (index, &value) in levels.iter().enumerate() {
        let number = index + 1;
        if !interval.contains(value) {
            let (low, high) = (interval.low(), interval.high());
            return Err(ExcitationError::OutsideInterval { number, value, low, high });
        }
        if value == satellite {
            return Err(ExcitationError::AtSatellite { number, value, direction });
        }
    }
    let first = *levels.first().ok_or(ExcitationError::NoLevels)?;
    if first != expected {
        return Err(ExcitationError::FirstLevel { value: first, expected, direction });
    }
    for (index, pair) in levels.windows(2).enumerate() {
        let (previous, value) = (pair[0], pair[1]);
        let towards_satellite = match direction {
            Direction::Descendant => value > previous,
            Direction::Ascendant => value < previous,
        };
        if !towards_satellite {
            return Err(ExcitationError::NotOrdered { number: index + 2, value, previous, direction });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use Direction::{Ascendant, Descendant};

    fn refusal(direction: Direction, levels: &[f64]) -> String {
        check_levels(Interval::new(-1.0, 1.0).unwrap(), direction, levels).unwrap_err().to_string()
    }

    #[test]
    fn levels_outside_the_interval_are_refused_by_number() {
        assert!(
            refusal(Descendant, &[-1.0, -1.5])
                .contains("level 2 is -1.5, outside the working interval [-1, 1]")
        );
        assert!(refusal(Ascendant, &[1.0, f64::NAN]).contains("level 2 is NaN"));
    }

    #[test]
    fn a_visit_to_the_satellite_is_refused() {
        assert!(
            refusal(Descendant, &[-1.0, 1.0])
                .contains("level 2 is the satellite 1 of the descendant experiment")
        );
        assert!(
            refusal(Ascendant, &[1.0, -1.0])
                .contains("level 2 is the satellite -1 of the ascendant experiment")
        );
    }

    #[test]
    fn the_first_level_must_be_the_end_opposite_the_satellite() {
        assert!(
            refusal(Descendant, &[-0.9, 0.0])
                .contains("level 1 is -0.9, but a descendant experiment visits -1")
        );
        assert!(refusal(Ascendant, &[0.5]).contains("visits 1 first"));
    }

    #[test]
    fn levels_out_of_order_or_repeated_are_refused() {
        assert!(refusal(Descendant, &[-1.0, 0.5, 0.2]).contains("level 3 is 0.2 after 0.5"));
        assert!(refusal(Descendant, &[-1.0, 0.5, 0.5]).contains("must strictly increase"));
        assert!(refusal(Ascendant, &[1.0, 0.2, 0.5]).contains("must strictly decrease"));
    }
}
