//! What names and units say.

use super::*;

/// Reads columns of which the first is the input and the second the output, in this order and the other.
#[track_caller]
fn both_orders(names: [&str; 2], others: &[&str], doubt: Option<&str>) {
    let machine = Machine::new(1);
    let others: Vec<(&str, Vec<f64>)> =
        others.iter().zip(3..).map(|(name, seed)| (*name, bystander(30.0, seed))).collect();
    let wanted = names.map(|name| name.split(" [").next().unwrap_or(name));
    for is_first in [true, false] {
        let mut columns = vec![(names[0], &machine.input[..]), (names[1], &machine.output[..])];
        if !is_first {
            columns.reverse();
        }
        columns.extend(others.iter().map(|(name, values)| (*name, &values[..])));
        let measured = inferred(&columns).unwrap_or_else(|refused| panic!("{names:?}: {refused}"));
        assert_taken(&measured, wanted, doubt);
    }
}

#[test]
fn a_command_is_known_by_what_its_path_shares_with_the_response() {
    for names in [
        ["/arm_controller/desired/positions[0]", "/arm_controller/actual/positions[0]"],
        ["axis0.controller.pos_setpoint", "axis0.pos_estimate"],
        ["EPS_Cmd::TargetAngle", "EPS_Status::ActualAngle"],
        ["field.set_point", "field.process_value"],
        ["Valve_rDes\\XETKC:1", "Valve_rAct\\XETKC:1"],
        ["Tar", "Act"],
        ["q_d[3]", "q[3]"],
        ["SetPos", "ActPos"],
        ["axis.Position", "axis.ActualPosition"],
        ["targetposition", "actualposition"],
        ["controller/ref_speed", "controller/speed"],
    ] {
        both_orders(names, &["motor temperature"], None);
    }
}

#[test]
fn a_derivative_is_no_command() {
    let machine = Machine::new(1);
    let x = &machine.output;
    let slope: Vec<f64> = (0..SAMPLES).map(|k| printed(100.0 * (x[k] - x[k.saturating_sub(1)]))).collect();
    let measured = inferred(&[("v", &machine.input), ("x", x), ("x_d", &slope)]).expect("an input is named");
    assert_taken(&measured, ["v", "x"], Some("no name says which column is the output"));
}

#[test]
fn of_several_commands_that_of_a_position_is_taken_in_doubt() {
    let (place, force) = (Machine::new(1), Machine::new(2));
    let columns: [(&str, &[f64]); 4] = [
        ("iq_ref", &force.input),
        ("iq", &force.output),
        ("arm/pos_ref", &place.input),
        ("arm/pos", &place.output),
    ];
    let measured = inferred(&columns).expect("names say it");
    assert_taken(&measured, ["arm/pos_ref", "arm/pos"], Some("but there is also `iq_ref` with `iq`"));
}

#[test]
fn a_reference_comes_before_what_a_controller_gives_out() {
    let machine = Machine::new(1);
    let given: Vec<f64> =
        machine.input.iter().zip(&machine.output).map(|(v, y)| printed(3.0 * (2.0 * v - y))).collect();
    let columns: [(&str, &[f64]); 3] = [("u", &given), ("ref", &machine.input), ("pos", &machine.output)];
    let measured = inferred(&columns).expect("names say it");
    assert_taken(&measured, ["ref", "pos"], Some("`ref` is taken for the input, but `u` is called one too"));
}

#[test]
fn a_place_that_follows_a_command_beside_a_force_is_told() {
    let machine = Machine::new(1);
    let force: Vec<f64> = Machine::new(2).output.iter().map(|y| printed(3.0 * y)).collect();
    let columns: [(&str, &[f64]); 3] =
        [("valve_command [mA]", &machine.input), ("lvdt [mm]", &machine.output), ("load [kN]", &force)];
    let measured = inferred(&columns).expect("names say it");
    assert_taken(
        &measured,
        ["valve_command", "load"],
        Some("but `lvdt [mm]` follows `valve_command [mA]` too"),
    );
}

#[test]
fn a_position_answers_a_position_though_a_current_is_called_measured() {
    let machine = Machine::new(1);
    let mut noise = noise(7);
    let current: Vec<f64> = machine
        .input
        .iter()
        .zip(&machine.output)
        .map(|(v, y)| printed(0.5 * (2.0 * v - y) + 0.2 * noise()))
        .collect();
    let columns: [(&str, &[f64]); 3] = [
        ("drive0.controller.input_pos", &machine.input),
        ("drive0.mapper.pos_rel", &machine.output),
        ("drive0.motor.Iq_measured", &current),
    ];
    let measured = inferred(&columns).expect("names say it");
    assert_taken(
        &measured,
        ["drive0.controller.input_pos", "drive0.mapper.pos_rel"],
        Some("but `drive0.motor.Iq_measured` is called a response and follows too"),
    );
}

#[test]
fn a_force_beside_the_travel_of_a_testing_machine_is_told() {
    let machine = Machine::new(1);
    let mut noise = noise(7);
    let force: Vec<f64> = machine.output.iter().map(|y| printed(0.2 * y + 0.05 * noise())).collect();
    let columns = |names: [&'static str; 3]| -> [(&str, &[f64]); 3] {
        [(names[0], &machine.input), (names[1], &machine.output), (names[2], &force)]
    };
    let names = ["Axial Displacement Command [mm]", "Axial Displacement [mm]", "Axial Force [kN]"];
    let measured = inferred(&columns(names)).expect("names say it");
    let line = "but `Axial Force [kN]` follows too; if the specimen is meant, rather than the drive, name them, for instance: `switchback init a.csv --input 'Axial Displacement' --output 'Axial Force'`";
    assert_taken(&measured, ["Axial Displacement Command", "Axial Displacement"], Some(line));
    let measured = inferred(&columns(["target position", "position", "torque"])).expect("names say it");
    assert_taken(&measured, ["target position", "position"], None);
}

#[test]
fn words_of_other_languages_and_compounds_are_known() {
    for names in [
        ["Traversenweg absolut", "Standardkraft"],
        ["Kolbenweg", "Zylinderkraft"],
        ["Déplacement", "Effort"],
        ["Course vérin", "Couple moteur"],
        ["Desplazamiento", "Fuerza"],
        ["Spostamento", "Forza"],
        ["変位", "荷重"],
        ["位移1", "力"],
        ["目标位置", "实际位置"],
        ["指令値", "応答"],
        ["指令位置", "実位置"],
        ["consigne position", "mesure position"],
        ["rodtravel", "axialforce"],
    ] {
        both_orders(names, &["Öltemperatur"], None);
    }
}

#[test]
fn units_say_what_names_do_not() {
    both_orders(["přetvoření [mm]", "channel 2 [kN]"], &["channel 3 [degC]"], None);
    both_orders(["A [deg]", "B [Nm]"], &["C"], None);
}

#[test]
fn counters_of_cycles_and_feeds_of_sensors_are_no_signals() {
    let machine = Machine::new(1);
    let cycle: Vec<f64> = (0..SAMPLES).map(|k| (k / 100) as f64).collect();
    let part: Vec<f64> = (0..SAMPLES).map(|k| printed(0.005 * k as f64)).collect();
    let feed = bystander(10.0, 5);
    for (counter, values) in [
        ("Cycle", &cycle),
        ("Zyklus", &cycle),
        ("N° cycle", &cycle),
        ("segments", &cycle),
        ("Elapsed Cycles", &part),
        ("Excitation [V]", &feed),
        ("Bridge supply [V]", &feed),
    ] {
        let columns: [(&str, &[f64]); 3] =
            [(counter, values), ("Load Cell [N]", &machine.output), ("LVDT [mm]", &machine.input)];
        assert_taken(&inferred(&columns).expect(counter), ["LVDT", "Load Cell"], None);
        let unnamed: [(&str, &[f64]); 3] = [(counter, values), ("a", &machine.output), ("b", &machine.input)];
        let measured = inferred(&unnamed).expect(counter);
        assert_taken(&measured, ["b", "a"], Some("no name says which column is the input"));
    }
    let columns: [(&str, &[f64]); 2] = [("excitation [V]", &machine.input), ("a", &machine.output)];
    assert_taken(&inferred(&columns).expect("it moves"), ["excitation", "a"], None);
}
