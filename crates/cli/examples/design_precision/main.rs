//! Does a plan reach the precision that it promises?
//!
//! For machines of known truth: a pilot of a hundred periods is measured and identified, `design --from … --precision P` plans from it,
//! and 2,000 replicates of the plan's pulse experiments are simulated and identified. Printed is the achieved error (about the truth,
//! root mean square) over the predicted standard error, root mean square over all parameters, least and largest: on replicates of the
//! system that the plan was made for, and on the machine itself, which the pilot knows only nearly. Then the same for ever shorter
//! experiments, where the asymptotic theory must end.
//!
//! ```text
//! cargo run -p switchback --example design_precision [REPLICATES]
//! ```

mod replicates;

use replicates::{Machine, Planned, machines, rms};
use switchback_study::design::{Forecast, Length, Plan, PlanMethod, Truth};

fn main() {
    let replicates = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(2000);
    for method in [PlanMethod::Efficient, PlanMethod::Joint] {
        println!("{} replicates, method {}", replicates, method.name());
        for machine in machines() {
            let planned = Planned::after_a_pilot(&machine, method, 7);
            println!(
                "{:32} P = {:.3}: {} periods, N = {}",
                machine.name,
                machine.precision,
                planned.plan.dataset().periods(),
                planned.plan.dataset().samples()
            );
            describe("  own plan", &planned.ratios(&planned.believed, method, replicates));
            describe("  the machine", &planned.ratios(&machine, method, replicates));
        }
    }
    println!("short experiments, method efficient, the machine known exactly");
    for machine in machines() {
        let truth = known(&machine);
        for periods in [3, 5, 10, 20, 50] {
            let plan = Plan::new(machine.request(), Length::Periods(periods)).expect("a plan");
            let forecast =
                Forecast::new(&truth, plan.dataset().pulses(), PlanMethod::Efficient).expect("a forecast");
            let achieved = machine.errors(plan.dataset(), PlanMethod::Efficient, replicates);
            let ratios: Vec<f64> =
                achieved.iter().zip(forecast.at(periods).errors.all()).map(|(a, p)| a / p).collect();
            describe(&format!("  {:30} {periods:3} periods", machine.name), &ratios);
        }
    }
}

fn describe(what: &str, ratios: &[f64]) {
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = ratios.iter().copied().fold(0.0, f64::max);
    println!(
        "{what}: rms {:.3}, from {least:.3} to {largest:.3} over {} parameters",
        rms(ratios),
        ratios.len()
    );
}

fn known(machine: &Machine) -> Truth {
    Truth {
        rig: machine.name.to_owned(),
        method: switchback_io::identification::Method::Efficient,
        system: machine.system.clone(),
        hysteresis: machine.hysteresis.clone(),
        noise_sd: machine.noise_sd,
        points: machine.points,
        notes: Vec::new(),
    }
}
