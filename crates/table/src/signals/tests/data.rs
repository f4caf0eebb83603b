//! What the data say where names do not, or say it wrongly.

use super::*;

#[test]
fn what_stands_still_is_no_other_choice() {
    let (machine, still) = (Machine::new(1), vec![0.0; SAMPLES]);
    let columns: [(&str, &[f64]); 4] = [
        ("joint 1 cmd", &machine.input),
        ("joint 1 pos", &machine.output),
        ("joint 2 cmd", &still),
        ("joint 2 pos", &still),
    ];
    let measured = inferred(&columns).expect("names say it");
    assert_eq!(measured.selection.rivals, Vec::<usize>::new());
}

#[test]
fn bystanders_do_not_hide_the_two_that_belong_together() {
    let machine = Machine::new(1);
    let (warm, fed, third) = (bystander(31.0, 5), bystander(24.0, 6), bystander(7.0, 7));
    let columns: [(&str, &[f64]); 5] =
        [("a", &warm), ("b", &machine.output), ("c", &fed), ("d", &machine.input), ("e", &third)];
    let measured = inferred(&columns).expect("two move");
    assert_taken(&measured, ["d", "b"], Some("`d` is taken for the input, since its past predicts `b`"));
    assert!(measured.doubts[0].contains("--input b --output d"), "{:?}", measured.doubts);
}

#[test]
fn an_output_without_a_name_is_what_follows_the_input() {
    let machine = Machine::new(1);
    let (warm, fed) = (bystander(31.0, 5), bystander(24.0, 6));
    let columns: [(&str, &[f64]); 4] =
        [("a", &warm), ("b", &machine.output), ("setpoint", &machine.input), ("c", &fed)];
    let measured = inferred(&columns).expect("one follows");
    let doubt = "no name says which column is the output: `b` is taken for the output";
    assert_taken(&measured, ["setpoint", "b"], Some(doubt));
}

#[test]
fn what_is_computed_from_others_is_not_taken() {
    let machine = Machine::new(1);
    let input = &machine.input;
    let mut y = 0.0;
    let output: Vec<f64> = input
        .iter()
        .zip(bystander(0.0, 3))
        .map(|(v, noise)| {
            y += 0.3 * (v - y) + noise;
            printed(y)
        })
        .collect();
    let output = &output;
    let error: Vec<f64> = input.iter().zip(output).map(|(v, y)| printed(v - y)).collect();
    let scaled: Vec<f64> = error.iter().map(|e| printed(0.4 * e)).collect();
    for name in ["c", "err"] {
        let columns: [(&str, &[f64]); 5] =
            [("a", &scaled), ("b", output), (name, &error), ("d", input), ("e", &bystander(3.0, 4))];
        let measured = inferred(&columns).expect("two are left");
        assert_taken(&measured, ["d", "b"], Some("no name says which column is the input"));
        assert!(measured.doubts[0].contains("move with them"), "{:?}", measured.doubts);
    }
}

#[test]
fn a_pair_that_names_say_and_data_refute_is_replaced_in_doubt() {
    let machine = Machine::new(1);
    let rpm = bystander(3000.0, 5);
    let columns: [(&str, &[f64]); 3] = [
        ("Engine rpm", &rpm),
        ("Throttle Pedal [%]", &machine.input),
        ("Throttle Servo [%]", &machine.output),
    ];
    let measured = inferred(&columns).expect("two belong together");
    let doubt =
        "neither says anything of the other here: `Throttle Pedal [%]` and `Throttle Servo [%]` are taken";
    assert_taken(&measured, ["Throttle Pedal", "Throttle Servo"], Some(doubt));
}

#[test]
fn a_command_that_its_response_does_not_follow_is_doubted() {
    let machine = Machine::new(1);
    let columns: [(&str, &[f64]); 4] = [
        ("pos_cmd", &bystander(1.0, 5)),
        ("pos", &bystander(1.0, 6)),
        ("a", &machine.input),
        ("b", &machine.output),
    ];
    let measured = inferred(&columns).expect("names say it");
    assert_taken(&measured, ["pos_cmd", "pos"], Some("neither says anything of the other here"));
}

#[test]
fn two_pairs_without_names_are_refused() {
    let (one, other) = (Machine::new(1), Machine::new(2));
    let reversed = |x: &[f64]| x.iter().rev().copied().collect::<Vec<f64>>();
    let late: Vec<f64> = (0..SAMPLES).map(|k| other.input[(3 * k) % SAMPLES]).collect();
    let mut y = 0.0;
    let lag = |x: &f64| {
        y += 0.4 * (x - y);
        printed(y)
    };
    let follows: Vec<f64> = reversed(&late).iter().map(lag).collect();
    let columns: [(&str, &[f64]); 4] =
        [("a", &one.input), ("b", &one.output), ("c", &reversed(&late)), ("d", &follows)];
    let refused = inferred(&columns).expect_err("either could be meant");
    assert!(refused.contains("the input and which the output"), "{refused}");
}

#[test]
fn signals_of_rows_of_their_own_are_compared_too() {
    let machine = Machine::new(1);
    let rows = |own: &[f64], is_even: bool| -> Vec<f64> {
        let value = |k: usize| if k.is_multiple_of(2) == is_even { own[k / 2] } else { f64::NAN };
        (0..2 * SAMPLES).map(value).collect()
    };
    let [input, output, warm] =
        [(&machine.input, true), (&machine.output, false), (&bystander(3.0, 4), true)]
            .map(|(own, is_even)| rows(own, is_even));
    let measured = inferred(&[("a", &warm), ("b", &output), ("c", &input)]).expect("two belong together");
    assert_taken(&measured, ["c", "b"], Some("no name says which column is the input"));
}

#[test]
fn of_a_chain_the_next_signal_is_the_output() {
    let machine = Machine::new(1);
    let mut y = 0.0;
    let further: Vec<f64> = machine
        .output
        .iter()
        .zip(bystander(0.0, 3))
        .map(|(x, noise)| {
            y += 0.3 * (x - y) + noise;
            printed(y)
        })
        .collect();
    let columns: [(&str, &[f64]); 3] = [("a", &further), ("b", &machine.output), ("c", &machine.input)];
    let measured = inferred(&columns).expect("a chain");
    assert_taken(&measured, ["c", "b"], Some("`a` moves with them"));
}
