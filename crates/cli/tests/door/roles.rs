//! Which column is the command, and which the response.

use super::*;

#[test]
fn commands_and_responses_are_known_by_their_names() {
    for (header, input) in [
        ("time,pos_cmd,pos", 1),
        ("time,dof_pos,des_dof_pos", 2),
        ("time,actual,command", 2),
        ("time,q_ref,q", 1),
        ("time,Position Feedback,Position Command", 2),
        ("time,state,action", 2),
        ("time,goal_current,present_velocity", 1),
        ("time,Istwert,Sollwert", 2),
        ("time,measured force,demanded force", 2),
        ("time,pos (5),target pos (5)", 2),
        ("time,joint[2].effort,joint[2].reference", 2),
        ("time,ctrl/travel,ctrl/force", 1),
        ("time,rpm,voltage", 2),
        ("time,Istposition,Sollposition", 2),
        ("time,Measured Value,Controller Output", 2),
    ] {
        let loaded = load(
            table(
                header,
                |_, t, v, y| if input == 1 { format!("{t},{v},{y}") } else { format!("{t},{y},{v}") },
            ),
            &[],
        );
        assert_eq!(signals(&loaded)[0], truth().0, "{header}: {}", loaded.reported);
        assert!(!loaded.reported.to_string().contains("no name says"), "{header}: {}", loaded.reported);
    }
}

#[test]
fn of_three_signals_the_two_that_belong_together_are_taken() {
    for (header, labels) in [
        ("time,throttle_cmd,throttle_pos,rpm", ["throttle_cmd", "throttle_pos"]),
        ("time,ctrl_0,qpos_0,qvel_0", ["ctrl_0", "qpos_0"]),
        ("time,Sollposition,Istposition,Schleppfehler", ["Sollposition", "Istposition"]),
        ("time,Reference,Measured Value,Controller Output", ["Reference", "Measured Value"]),
        ("time,Crosshead [mm],Load Cell [N],Strain 1 [%]", ["Crosshead [mm]", "Load Cell [N]"]),
        ("time,cmd,pos,vel", ["cmd", "pos"]),
    ] {
        let loaded = load(table(header, |k, t, v, y| format!("{t},{v},{y},{}", (k % 17) as f64 - 8.0)), &[]);
        assert_eq!(
            [&loaded.rig.input_label, &loaded.rig.output_label],
            labels,
            "{header}: {}",
            loaded.reported
        );
    }
}

#[test]
fn without_names_the_input_is_the_one_that_the_other_follows() {
    for header in ["", "time,a,b\n", "time,Volt,Volt\n", "x-axis,1,2\nsecond,Volt,Volt\n"] {
        for is_first in [true, false] {
            let row = |(t, v, y): (f64, f64, f64)| match is_first {
                true => format!("{t},{v},{y}\n"),
                false => format!("{t},{y},{v}\n"),
            };
            let text: String = std::iter::once(header.to_owned()).chain(rows().map(row)).collect();
            let loaded = is_the_record(text, &[], "no name says which column is the input");
            assert_eq!(loaded.plan.columns.input, loaded.plan.columns.input, "{header}");
        }
    }
}

#[test]
fn a_signal_in_volts_and_in_its_unit_is_taken_in_its_unit() {
    let text = table("time,Force (V),Force (N),Travel (V),Travel (mm),force_raw", |_, t, v, y| {
        format!("{t},{},{y},{},{v},{}", y / 20.0, v / 10.0, 100.0 * y)
    });
    let loaded = is_the_record(text, &[], "`Travel [V]`");
    assert_eq!([&loaded.rig.input_label, &loaded.rig.output_label], ["Travel [mm]", "Force [N]"]);
}

#[test]
fn of_several_channels_the_one_that_moves_is_taken() {
    let text = table("time,target pos (3),pos (3),target pos (5),pos (5),load (5)", |_, t, v, y| {
        format!("{t},1747,1748,{v},{y},40")
    });
    let loaded = is_the_record(text, &[], "pos (5)");
    assert_eq!(loaded.rig.output_label, "pos (5)");
}

#[test]
fn a_dead_log_is_refused_as_one() {
    let refused = refusal(table("time,frame,iq_mA,vq_mV,theta", |k, t, _, _| format!("{t},{k},0,0,0")));
    assert!(refused.contains("none of the columns ever moves: `iq [mA]`, `vq [mV]`, `theta`"), "{refused}");
}
