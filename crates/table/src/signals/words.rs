//! Words of headers, and the parts of a record that they stand for.

/// Time, whatever its unit.
pub(super) const TIME: &[&str] = &[
    "t",
    "time",
    "zeit",
    "timestamp",
    "timestamps",
    "datetime",
    "date",
    "elapsed",
    "seconds",
    "uhrzeit",
    "temps",
    "tiempo",
    "tempo",
    "tid",
    "x value",
    "stamp",
    "clock",
    "sec",
    "secs",
    "millis",
    "micros",
    "timecode",
    "ms",
    "us",
    "msec",
    "usec",
    "nanos",
    "second",
];
/// The input of a machine, whatever is measured on it.
pub(super) const INPUT: &[&str] =
    &["v", "u", "input", "in", "drive", "command", "cmd", "setpoint", "excitation", "eingang"];
/// A command beside its response: `des_pos`, `target pos`, `action`.
pub(super) const COMMAND: &[&str] = &[
    "cmd",
    "cmds",
    "cmded",
    "command",
    "commands",
    "commanded",
    "des",
    "desired",
    "target",
    "targets",
    "tgt",
    "goal",
    "ref",
    "reference",
    "setpoint",
    "sp",
    "set",
    "soll",
    "sollwert",
    "demand",
    "demanded",
    "request",
    "requested",
    "action",
    "actions",
    "ctrl",
    "control",
    "input",
    "inp",
    "in",
    "u",
    "drive",
    "driven",
    "excitation",
    "stimulus",
    "eingang",
    "vorgabe",
    "consigne",
    "duty",
    "pwm",
    "actuation",
    "stellwert",
    "reqd",
    "req",
    "planned",
    "wanted",
    "nominal",
];
/// What answers a command.
pub(super) const RESPONSE: &[&str] = &[
    "actual",
    "meas",
    "measured",
    "measurement",
    "feedback",
    "fb",
    "fbk",
    "state",
    "states",
    "obs",
    "observation",
    "observations",
    "response",
    "resp",
    "ist",
    "istwert",
    "output",
    "out",
    "y",
    "ausgang",
    "encoder",
    "enc",
    "sensor",
    "sensed",
    "present",
    "achieved",
    "mesure",
    "readback",
    "rb",
    "real",
    "process",
    "pv",
    "outp",
];
/// Motion drives a machine that answers with a force; but a piezo stage answers a voltage with it, so alone these words leave a doubt.
pub(super) const MOTION: &[&str] = &[
    "displacement",
    "disp",
    "travel",
    "stroke",
    "position",
    "pos",
    "deflection",
    "elongation",
    "angle",
    "strain",
    "weg",
    "hub",
    "auslenkung",
    "winkel",
    "crosshead",
    "traverse",
    "extension",
    "indentation",
    "rotation",
    "qpos",
    "lage",
];
/// What drives a machine that answers with motion.
pub(super) const DRIVE: &[&str] =
    &["voltage", "volt", "spannung", "current", "strom", "pressure", "druck", "valve", "throttle"];
/// Motion as an answer to a drive.
pub(super) const ANSWER: &[&str] =
    &["velocity", "vel", "qvel", "speed", "rpm", "drehzahl", "geschwindigkeit", "acceleration", "acc"];
/// Forces, and the plain words for an output.
pub(super) const OUTPUT: &[&str] = &[
    "y",
    "output",
    "out",
    "response",
    "ausgang",
    "force",
    "load",
    "torque",
    "moment",
    "stress",
    "kraft",
    "drehmoment",
    "spannkraft",
];
/// What commands a machine: its output is no response.
pub(super) const CONTROLLER: &[&str] = &["controller", "pid", "regler", "plc", "sps"];
/// Before the name of a signal, in one word with it: `Sollposition`.
pub(super) const PREFIXES: &[&str] = &["soll", "ist"];
/// Columns that count the samples.
pub(super) const INDEX: &[&str] =
    &["", "index", "idx", "i", "k", "n", "no", "nr", "sample", "samples", "row", "count", "id", "point", "x"];
/// Words of the names of such columns.
pub(super) const COUNTER: &[&str] = &[
    "index",
    "idx",
    "sample",
    "samples",
    "row",
    "count",
    "counter",
    "cnt",
    "frame",
    "seq",
    "sequence",
    "packet",
    "pkt",
    "tick",
    "ticks",
    "scan",
    "msg",
    "iteration",
    "iter",
    "cycle",
    "loop",
    "number",
    "nr",
];
/// Columns that number the parts of a record.
pub(super) const PART: &[&str] =
    &["episode", "run", "trial", "segment", "lap", "batch", "test", "rep", "repetition"];
/// A signal before it was converted to its unit.
pub(super) const RAW: &[&str] =
    &["raw", "adc", "counts", "count", "volt", "volts", "bits", "lsb", "mv", "digits"];
/// Units of such signals.
pub(super) const RAW_UNITS: &[&str] =
    &["V", "mV", "µV", "counts", "count", "bits", "bit", "LSB", "raw", "digits", "mV/V", "mA"];
