//! Counters that wrap, and signs in a bit or a column.

use super::*;

#[test]
fn an_angle_that_wraps_is_continued() {
    let text = table("time,command,angle [deg]", |_, t, v, y| {
        format!("{t},{v},{}", (8.0 * y + 300.0).rem_euclid(360.0))
    });
    let loaded = load(text, &[]);
    assert!(loaded.reported.to_string().contains("`angle [deg]` wraps at 360"), "{}", loaded.reported);
    let y = &signals(&loaded)[1];
    let off = y[0] - 8.0 * truth().1[0];
    assert_close(y, &truth().1.iter().map(|y| 8.0 * y + off).collect::<Vec<_>>(), 1e-6);
}

#[test]
fn signs_in_a_bit_are_signs() {
    let coded = [
        (
            Box::new(|y: f64| if y < 0.0 { 32_768.0 - y } else { y }) as Box<dyn Fn(f64) -> f64>,
            "has its sign in bit 15",
        ),
        (Box::new(|y: f64| y.rem_euclid(65_536.0)), "is a two's complement of 16 bits"),
    ];
    for (code, said) in coded {
        let text = table("time,command,speed", |_, t, v, y| format!("{t},{v},{}", code((100.0 * y).round())));
        let loaded = load(text, &[]);
        assert!(loaded.reported.to_string().contains(said), "{}", loaded.reported);
        assert_eq!(signals(&loaded)[1], truth().1.iter().map(|y| (100.0 * y).round()).collect::<Vec<_>>());
    }
}

#[test]
fn a_letter_gives_a_magnitude_its_sign() {
    let text = table("time,travel,force,state", |_, t, v, y| {
        format!("{t},{v},{},{}", y.abs(), if y < 0.0 { "D" } else { "C" })
    });
    is_the_record(text, &[], "`force` is a magnitude, and `state` its sign");
}
