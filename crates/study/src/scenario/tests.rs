//! Every refusal names file, line, key, value and remedy; what is accepted keeps its values.

use super::*;
use std::path::Path;

const GOOD: &str = r#"
study = "consistency"
question = "Do the estimates converge?"
seed = 20090706
replicates = 500
[system]
a = [-1.2, 0.5]
b = [0.3, 0.2]
interval = [-20.0, 20.0]
input = "deflection [mm]"
[[border]]
name = "coarse"
kind = "table"
ascending = [{ v = -20.0, u = -1.0 }, { v = 20.0, u = 1.5 }]
descending = [{ v = -20.0, u = -1.5 }, { v = 20.0, u = 1.0 }]
[sweep]
noise = [0.02, 0.1]
samples = [1000, 3000]
points = [4, 8]
methods = ["joint", "memoryless"]
[expect]
consistent = ["joint"]
inconsistent = ["memoryless"]
within_error = ["sd_slope", "coverage"]
"#;

fn refusal(from: &str, to: &str) -> (String, String, usize) {
    let text = GOOD.replacen(from, to, 1);
    assert_ne!(text, GOOD, "the test changes nothing: {from}");
    match Scenario::parse("scenarios/bad.toml", &text) {
        Err(ScenarioError::Invalid(invalid)) => {
            let message = invalid.to_string();
            assert!(message.starts_with("scenarios/bad.toml:"), "{message}");
            let remedy = miette::Diagnostic::help(&invalid).map_or_else(String::new, |h| h.to_string());
            (message, remedy, invalid.line())
        }
        other => panic!("{to} must be refused, not {other:?}"),
    }
}

#[test]
fn a_good_scenario_keeps_its_values_and_gets_the_defaults() {
    let scenario = Scenario::parse("scenarios/good.toml", GOOD).expect("a valid scenario");
    assert_eq!(scenario.name(), "good");
    assert_eq!(scenario.seed(), 20090706);
    assert_eq!(scenario.replication(), Replication { replicates: 500, stopping: None });
    assert_eq!((scenario.coupling(), scenario.engine()), (Coupling::Shared, Engine::Superposed));
    assert_eq!(scenario.labels().input, "deflection [mm]");
    assert_eq!(scenario.labels().output, "output y");
    let [case] = scenario.cases() else { panic!("one case by default") };
    assert_eq!((case.order, case.spacing, case.disturbance.clone()), (2, 2, Disturbance::White));
    assert_eq!(case.borders[0].hysteresis.span(), 3.0);
    assert_eq!(scenario.sweep().methods, [Method::Joint, Method::Memoryless]);
    assert_eq!(case.expect.within_error, [Check::SdSlope, Check::Coverage]);
    assert_eq!(scenario.source()["sweep"]["noise"][1], 0.1);
}

#[test]
fn slopes_are_fitted_over_the_last_two_decades_or_what_the_file_says() {
    for (samples, slopes) in [
        ("[1000, 3000]", &[1000, 3000][..]),
        ("[300, 1000, 3000, 10000, 30000, 100000]", &[1000, 3000, 10000, 30000, 100000]),
        ("[100, 1000, 100000]", &[100, 1000, 100000]),
        ("[100, 200, 10000, 1000000]", &[200, 10000, 1000000]),
        ("[100, 300, 900]\nslope_from = 300", &[300, 900]),
    ] {
        let text = GOOD.replace("[1000, 3000]", samples);
        let scenario = Scenario::parse("slopes.toml", &text).expect("a valid scenario");
        assert_eq!(scenario.sweep().slope_samples(), slopes, "{samples}");
    }
}

#[test]
fn a_case_overrides_parts_and_keeps_the_rest() {
    let text = format!(
        r#"{GOOD}
[[case]]
name = "order too low"
order = 1
[[case]]
name = "adjacent pulses"
system = {{ a = [-0.5], b = [1.0] }}
spacing = 1
disturbance = {{ kind = "coloured", ar = [-0.8] }}
expect = {{ inconsistent = ["joint"] }}
"#
    );
    let scenario = Scenario::parse("cases.toml", &text).expect("a valid scenario");
    let [low, adjacent] = scenario.cases() else { panic!("two cases") };
    assert_eq!((low.order, low.spacing, low.system.order()), (1, 2, 2));
    assert_eq!(low.expect.consistent, [Method::Joint]);
    assert_eq!((adjacent.order, adjacent.spacing), (1, 1));
    assert_eq!(adjacent.disturbance, Disturbance::Coloured { ar: vec![-0.8], ma: vec![] });
    assert_eq!(adjacent.expect.inconsistent, [Method::Joint]);
    assert!(adjacent.expect.consistent.is_empty());
}

#[test]
fn knots_and_promises_of_intervals_are_read_and_checked() {
    let case =
        |rest: &str| Scenario::parse("knots.toml", &format!("{GOOD}\n[[case]]\nname = \"fine\"\n{rest}\n"));
    let expect = "expect = { coverage = { mean = [0.9, 0.98], least = 0.85 }, width = { of = \"fine\", at_most = 2.0 } }";
    let scenario =
        case(&format!("knots = \"refined\"\nfit = \"prewhitened\"\n{expect}")).expect("a valid scenario");
    let [fine] = scenario.cases() else { panic!("one case") };
    assert_eq!((fine.knots, fine.fit), (Knots::Refined, Fit::Prewhitened));
    assert_eq!(fine.expect.coverage, Some(Coverage { mean: (0.9, 0.98), least: 0.85 }));
    assert_eq!(fine.expect.width, Some(Width { of: "fine".to_owned(), at_most: 2.0 }));
    for (rest, reported) in [
        ("knots = \"refind\"".to_owned(), "refined"),
        ("fit = \"free-run\"".to_owned(), "free run"),
        ("fit = \"free run\"\nknots = \"known\"".to_owned(), "equation error alone"),
        (expect.replace("0.98", "98"), "coverage lies between 0 and 1"),
        (expect.replace("0.98", "0.1"), "begins above its end"),
        (expect.replace("\"fine\"", "\"fin\""), "no such case"),
        (expect.replace("2.0", "-2.0"), "at_most must be positive"),
    ] {
        let error = case(&rest).expect_err("a refusal");
        assert!(format!("{error:?}").contains(reported), "{error:?}");
    }
}

#[test]
fn an_unknown_key_is_named_with_its_line_and_the_nearest_key() {
    let (message, remedy, line) = refusal("points = [4, 8]", "pionts = [4, 8]");
    assert!(message.contains("`sweep.pionts`") && message.contains("unknown key"), "{message}");
    assert!(remedy.contains("`points`"), "{remedy}");
    assert_eq!(line, 19);
}

#[test]
fn an_unknown_key_of_a_border_is_named_too() {
    let (message, remedy, line) = refusal("ascending =", "ascendng =");
    assert!(message.contains("border[0].ascendng"), "{message}");
    assert!(remedy.contains("`ascending`"), "{remedy}");
    assert_eq!(line, 14);
}

#[test]
fn a_wrong_type_is_named_with_key_and_value() {
    let (message, _, line) = refusal("0.02, 0.1", "0.02, \"loud\"");
    assert!(
        message.contains("sweep.noise[1] = \"loud\"") && message.contains("expected a number"),
        "{message}"
    );
    assert_eq!(line, 17);
    let (message, ..) = refusal("replicates = 500", "replicates = -5");
    assert!(message.contains("replicates = -5") && message.contains("whole number"), "{message}");
    let (message, ..) = refusal("[-20.0, 20.0]", "[-20.0]");
    assert!(message.contains("system.interval = [-20.0]"), "{message}");
}

#[test]
fn a_missing_key_is_named() {
    let (message, ..) = refusal("seed = 20090706\n", "");
    assert!(message.contains("missing key `seed`"), "{message}");
    let (message, ..) = refusal("kind = \"table\"\n", "");
    assert!(message.contains("no `kind`"), "{message}");
}

#[test]
fn impossible_values_are_refused_where_they_stand() {
    for (from, to, key) in [
        ("[-1.2, 0.5]", "[-2.1, 1.1]", "system.a = [-2.1, 1.1]"),
        ("b = [0.3, 0.2]", "b = [0.3, -0.3]", "system"),
        ("[-20.0, 20.0]", "[20.0, -20.0]", "system.interval = [20.0, -20.0]"),
        ("u = 1.5", "u = -2.5", "`border[0]`: Assumption 1"),
        ("u = 1.5", "u = inf", "border[0].ascending"),
        ("v = 20.0", "v = -30.0", "-30 follows -20"),
        ("replicates = 500", "replicates = 1", "replicates = 1"),
        ("replicates = 500", "replicates = 500\nmax_replicates = 900", "max_replicates = 900"),
        ("replicates = 500", "replicates = 500\nprecision = { bias_mcse = 0.1 }", "precision"),
        ("replicates = 500", "replicates = 500\nengine = \"direkt\"", "engine = \"direkt\""),
        ("[0.02, 0.1]", "[0.02, 0.0]", "sweep.noise[1] = 0.0"),
        ("[0.02, 0.1]", "[0.02, nan]", "sweep.noise[1] = nan"),
        ("[0.02, 0.1]", "[]", "sweep.noise = []"),
        ("[1000, 3000]", "[3000, 1000]", "sweep.samples[1] = 1000"),
        ("[1000, 3000]", "[21, 3000]", "sweep.samples[0] = 21"),
        ("points = [4, 8]", "points = [4, 8]\nslope_from = 2000", "sweep.slope_from = 2000"),
        ("points = [4, 8]", "points = [0, 8]", "sweep.points[0] = 0"),
        ("[\"joint\", \"memoryless\"]", "[\"joint\", \"joint\"]", "sweep.methods[1] = \"joint\""),
    ] {
        let (message, remedy, _) = refusal(from, to);
        assert!(message.contains(key), "{to}: {message}");
        assert!(!remedy.is_empty(), "{to} has no remedy: {message}");
    }
}

#[test]
fn a_misspelt_method_border_or_check_is_answered_with_the_valid_names() {
    let (message, remedy, _) = refusal("[\"joint\", \"mem", "[\"jiont\", \"mem");
    assert!(message.contains("no such method"), "{message}");
    assert!(remedy.contains("\"joint\"") && remedy.contains("efficient"), "{remedy}");
    let (_, remedy, _) = refusal("points = [4, 8]", "points = [4, 8]\nborders = [\"corse\"]");
    assert!(remedy.contains("coarse"), "{remedy}");
    let (_, remedy, _) = refusal("\"coverage\"]", "\"covrage\"]");
    assert!(remedy.contains("coverage"), "{remedy}");
    let (message, remedy, _) = refusal("seed = 20090706", "seed = 1\nengine = \"dirct\"");
    assert!(message.contains("no such engine"), "{message}");
    assert!(remedy.contains("did you mean \"direct\"? valid: superposed, direct"), "{remedy}");
    let (_, remedy, _) = refusal("kind = \"table\"", "kind = \"tabel\"");
    assert!(remedy.contains("\"table\""), "{remedy}");
}

#[test]
fn every_kind_of_border_is_read_with_its_own_keys() {
    for (kind, parameters, at_high) in [
        (
            "straight_lines",
            "ascending = { slope = 1.0, offset = 0.5 }\ndescending = { slope = 2.0, offset = 0.0 }",
            20.5,
        ),
        ("leaf_spring", "stiffness = 0.2\nfriction = 0.8", 4.8),
        ("leaf_spring", "stiffness = 0.2\nhardening = 0.001\nfriction = 0.8", 12.8),
        ("relay", "low = -1.0\nhigh = 2.0\nascending_threshold = 3.0\ndescending_threshold = -3.0", 2.0),
        (
            "discontinuous",
            "ascending = [{ from = -20.0, value = 0.0 }, { from = 0.0, value = 1.0, slope = 0.1 }]\n\
             descending = [{ from = -20.0, value = -1.0 }]",
            3.0,
        ),
        (
            "non_monotone",
            "ascending = { offset = 0.5, slope = 0.1, amplitude = 1.0, wavelength = 20.0 }\n\
             descending = { offset = -0.5, slope = 0.1, amplitude = 1.0, wavelength = 20.0 }",
            2.5,
        ),
        (
            "general",
            "ascending = { offset = 1.0, amplitude = 1.0, centre = 20.0, width = 4.0 }\n\
             descending = { offset = -1.0, amplitude = 1.0, centre = -2.0, width = 4.0, slope = 0.1 }",
            1.0,
        ),
    ] {
        let start = GOOD.find("kind = ").expect("the border's kind");
        let end = GOOD.find("[sweep]").expect("the sweep");
        let text = format!("{}kind = \"{kind}\"\n{parameters}\n{}", &GOOD[..start], &GOOD[end..]);
        let scenario = Scenario::parse("kinds.toml", &text).unwrap_or_else(|e| panic!("{kind}: {e}"));
        let u_high = scenario.cases()[0].borders[0].hysteresis.u_high();
        assert!((u_high - at_high).abs() < 1e-12, "{kind}: {u_high}");
    }
}

#[test]
fn a_file_that_is_no_toml_or_absent_is_refused() {
    let (_, _, line) = refusal("seed = 20090706", "seed = ");
    assert_eq!(line, 4);
    let error = Scenario::read(Path::new("no/such/file.toml")).expect_err("there is no such file");
    assert!(error.to_string().contains("no/such/file.toml"));
}
