//! Every method at every order that a scenario may have, and the bytes of the small study.

use crate::common::Silent;
use crate::common::faults::files;
use sha2::{Digest, Sha256};
use std::path::Path;
use switchback_identify::Method;
use switchback_study::consistency::run;
use switchback_study::results::Results;
use switchback_study::scenario::{Engine, Scenario};

/// All methods on a system of an order, whose poles lie between −0.3 and 0.3.
fn study(order: usize, engine: Engine) -> Results {
    let mut a = vec![1.0];
    for k in 1..=order {
        let pole = 0.3 * k as f64 / order as f64 * if k % 2 == 0 { -1.0 } else { 1.0 };
        let shifted: Vec<f64> = [0.0].into_iter().chain(a.iter().copied()).collect();
        a.push(0.0);
        a.iter_mut().zip(shifted).for_each(|(x, before)| *x -= pole * before);
    }
    let b: Vec<f64> = (1..=order).map(|i| 0.3 / i as f64).collect();
    let methods = Method::ALL.map(Method::name);
    let text = format!(
        "study = \"consistency\"\nquestion = \"?\"\nseed = 3\nreplicates = 16\n\
         [system]\na = {:?}\nb = {b:?}\ninterval = [-1.0, 1.0]\n\
         [[border]]\nname = \"spring\"\nkind = \"leaf_spring\"\nstiffness = 1.0\nfriction = 0.3\n\
         [sweep]\nnoise = [0.01]\nsamples = [900]\npoints = [3]\nmethods = {methods:?}\n",
        &a[1..]
    );
    let scenario = Scenario::parse("orders.toml", &text).expect("a scenario").on(engine);
    run(&scenario, String::new(), &Silent).expect("a study")
}

#[test]
fn every_order_up_to_twenty_is_estimated_by_every_method() {
    for order in 1..=20 {
        let results = study(order, Engine::Superposed);
        assert_eq!(results.cells.len(), Method::ALL.len());
        for cell in &results.cells {
            assert_eq!(cell.failures.count, 0, "order {order}, {}: {:?}", cell.series, cell.failures);
            assert!(cell.parameters.len() >= 2 * order && cell.parameters.iter().all(|p| p.sd.is_some()));
        }
    }
}

/// SHA-256 of `results.json` of scenarios/quick.toml. It depends on the order of every sum, and on the exponentials and logarithms of the platform's
/// mathematical library in theory and verdicts: this is that of x86-64 Linux with glibc.
const QUICK: &str = "fac7055f478402335aafae6a12bb079d69efc9f05275658d7dda4e83aa5870a6";

#[test]
#[cfg(all(target_os = "linux", target_arch = "x86_64", target_env = "gnu"))]
fn the_small_study_has_its_bytes() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/quick.toml");
    let scenario = Scenario::read(&file).expect("the shipped scenario");
    let results = run(&scenario, "switchback quick.toml".to_owned(), &Silent).expect("a study");
    let hash =
        |bytes: &[u8]| -> String { Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect() };
    assert_eq!(hash(switchback_study::results::to_json(&results).as_bytes()), QUICK);
    let committed = files(&file.with_file_name("../reports/quick"));
    assert_eq!(hash(&committed["results.json"]), QUICK, "reports/quick is that of this version");
}
