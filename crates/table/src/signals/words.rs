//! Words of headers, and the parts of a record that they stand for: a line a language or two, as words are written without accents.

/// Lists of words, set apart by commas.
pub(super) type Words = &'static [&'static str];

/// Whether a word is one of a list.
pub(super) fn has(words: Words, word: &str) -> bool {
    const BETWEEN: &str = ", ";
    let is_whole = |line: &str, at: usize| {
        let (before, behind) = (&line[..at], &line[at + word.len()..]);
        (before.is_empty() || before.ends_with(BETWEEN)) && (behind.is_empty() || behind.starts_with(BETWEEN))
    };
    // Columns may be many, and each is looked up again and again: a line is searched for the word, not taken apart into its own.
    let is_in =
        |line: &&str| word.len() <= line.len() && line.match_indices(word).any(|(at, _)| is_whole(line, at));
    !word.contains(BETWEEN) && words.iter().any(is_in)
}

/// Time, whatever its unit.
pub(super) const TIME: Words = &[
    "t, time, timestamp, timestamps, datetime, date, elapsed, seconds, second, x value, stamp, clock, sec, secs, utc",
    "millis, micros, nanos, timecode, ms, us, msec, usec",
    "zeit, uhrzeit, temps, tiempo, tempo, tid, tijd, czas, cas, время",
    "時間, 時刻, 时间, 時間軸, 시간",
];
/// Beside a word for time: how long something takes, rather than when it is.
pub(super) const DURATION: Words = &[
    "turnaround, cycle, execution, exec, response, dead, lap, rise, fall, settling, delay, latency, duration, processing",
    "computation, calculation, loop, roundtrip, trip, overrun, idle, tot, zyklus, anstiegs, reaktions, antwort, ausfuhrungs",
    "mort, reponse, montee, ciclo, muerto, respuesta, morto, risposta",
];
/// The words for time that may stand beside them.
pub(super) const DURATION_OF: Words = &["time, times, zeit, temps, tiempo, tempo"];
/// The input of a machine, whatever is measured on it.
pub(super) const INPUT: Words = &[
    "v, u, input, in, drive, command, cmd, setpoint, excitation, eingang, consigne, consigna, sollwert",
    "指令, 目標, 目标, 设定, 设定值, 给定, 給定, 入力, 输入, 지령",
];
/// A command beside its response: `des_pos`, `target pos`, `action`.
pub(super) const COMMAND: Words = &[
    "cmd, cmds, cmded, command, commands, commanded, des, desired, target, targets, tgt, tar, goal, ref, reference",
    "setpoint, sp, set, demand, demanded, request, requested, reqd, req, planned, wanted, nominal, stimulus",
    "action, actions, ctrl, control, input, inp, in, u, drive, driven, excitation, duty, pwm, actuation",
    "soll, sollwert, eingang, vorgabe, stellwert, fuhrungsgrosse",
    "consigne, commande, consigna, comando, riferimento, referencia, задание",
    "指令, 目標, 目标, 设定, 設定, 设定值, 给定, 給定, 入力, 输入, 期望, 지령",
];
/// Of these, what says where a machine should be; the others may be what its controller gives out.
pub(super) const REFERENCE: Words = &[
    "des, desired, target, targets, tgt, tar, goal, ref, reference, setpoint, sp, set, demand, demanded, planned",
    "soll, sollwert, vorgabe, fuhrungsgrosse, consigne, consigna, riferimento, referencia, задание",
    "目標, 目标, 设定, 設定, 设定值, 给定, 給定, 期望",
];
/// What answers a command.
pub(super) const RESPONSE: Words = &[
    "actual, act, meas, measured, measurement, feedback, fb, fbk, state, states, obs, observation, observations",
    "response, resp, output, out, outp, y, encoder, enc, sensor, sensed, present, achieved, readback, rb, real, process",
    "pv, estimate, estimated, estimates, est",
    "ist, istwert, ausgang, mesure, reel, reelle, medida, medido, misura, misurato, effettivo, факт",
    "実, 実測, 実際, 応答, 測定, 现在, 現在, 实际, 反馈, 回授, 测量, 测量值, 실제",
];
/// Of these, what says by itself that the same name without it is the command.
pub(super) const ACTUAL: Words = &["actual, act, ist, istwert, feedback, fbk, fb, 実測, 実際, 实际, 反馈"];
/// Words beside those of a command or response that distinguish no signals.
pub(super) const NEUTRAL: Words =
    &["status, filtered, filt, hat, value, val, wert, signal, sig, data, valeur, valor, valore, 値, 值"];
/// Motion drives a machine that answers with a force; but a piezo stage answers a voltage with it, so alone these words leave a doubt.
pub(super) const MOTION: Words = &[
    "displacement, disp, travel, stroke, position, positions, pos, posn, deflection, elongation, angle, strain, crosshead",
    "traverse, extension, indentation, rotation, qpos, lvdt, extensometer",
    "weg, hub, auslenkung, winkel, lage, verschiebung, dehnung, verformung, traversenweg, wegaufnehmer, kolbenweg",
    "deplacement, course, allongement, angle, desplazamiento, carrera, posicion, angulo, spostamento, corsa, posizione",
    "angolo, deslocamento, posicao, verplaatsing, hoek, positie, przemieszczenie, перемещение, положение, ход, угол",
    "変位, 位置, 角度, ストローク, 伸び, 位移, 行程, 转角, 변위, 위치, 각도",
];
/// What drives a machine that answers with motion.
pub(super) const DRIVE: Words = &[
    "voltage, volt, current, pressure, valve, throttle",
    "spannung, strom, druck, pression, courant, presion, corriente, pressione, corrente, tensione, давление, ток",
    "電圧, 電流, 圧力, 电压, 电流, 压力, 전압, 전류, 압력",
];
/// Motion as an answer to a drive.
pub(super) const ANSWER: Words = &[
    "velocity, velocities, vel, qvel, speed, rpm, acceleration, acc",
    "drehzahl, geschwindigkeit, beschleunigung, vitesse, velocidad, velocita, snelheid, скорость",
    "速度, 回転数, 加速度, 转速, 속도",
];
/// Forces, and the plain words for an output.
pub(super) const OUTPUT: Words = &[
    "y, output, out, response, force, load, loadcell, torque, moment, stress, effort, ausgang",
    "kraft, drehmoment, spannkraft, effort, couple, fuerza, carga, forza, carico, coppia, forca, kracht, koppel, sila",
    "сила, усилие, нагрузка, момент",
    "荷重, 力, トルク, 応力, 出力, 载荷, 負荷, 负荷, 负载, 扭矩, 转矩, 应力, 하중, 힘",
];
/// Of the words for motion, those of machines that load specimens.
pub(super) const TEST_TRAVEL: Words = &[
    "displacement, disp, stroke, deflection, elongation, strain, crosshead, traverse, extension, indentation, travel",
    "weg, hub, traversenweg, kolbenweg, dehnung, verformung, deplacement, allongement, desplazamiento, spostamento",
    "変位, ストローク, 伸び, 位移, 변위",
];
/// Forces and torques.
pub(super) const FORCE: Words = &[
    "force, load, loadcell, torque, stress, kraft, drehmoment, effort, couple, fuerza, carga, forza, carico, coppia",
    "荷重, 力, トルク, 応力, 载荷, 負荷, 负荷, 负载, 扭矩, 转矩, 应力, 하중, 힘",
];
/// What commands a machine: its output is no response.
pub(super) const CONTROLLER: Words = &["controller, pid, regler, plc, sps"];
/// Before the name of a signal, in one word with it: `Sollposition`.
pub(super) const PREFIXES: Words =
    &["soll, ist, set, act, actual, target, desired, demand, cmd, ref, meas, des"];
/// Behind other words, in one word with them: `Standardkraft`, `axialforce`.
pub(super) const SUFFIXES: Words = &[
    "kraft, weg, hub, winkel, drehmoment, moment, spannung, strom, druck, drehzahl, geschwindigkeit, beschleunigung",
    "position, auslenkung, verschiebung, dehnung, verformung, zeit, sollwert, istwert",
    "force, torque, displacement, angle, velocity, speed, pressure, travel, stroke, current, voltage, setpoint, command",
    "feedback, loadcell",
];
/// Where a machine is, how fast it moves, and what moves it, beside the words above.
pub(super) const PLACE: Words = &["q, x, z, theta, phi, alpha, beta, roll, pitch, yaw, axis, height, level"];
pub(super) const SPEED: Words = &["dq, qd, omega, rate, rates, w, n, nist, xd, twist"];
pub(super) const EFFORT: Words =
    &["tau, trq, iq, id, amps, uq, vq, power, volt, pwm, duty, temperature, temp"];
/// What a controller computes from a command and its response.
pub(super) const DEVIATION: Words = &[
    "err, error, errors, deviation, difference, diff, residual",
    "schleppfehler, regelabweichung, abweichung, fehler, ecart, erreur, desviacion, errore, 偏差, 誤差, 误差",
];
/// Terms of a controller.
pub(super) const TERM: Words = &["p, i, d, ff, dff, pterm, iterm, dterm, p term, i term, d term"];
/// What feeds a sensor or a machine and says nothing of its motion.
pub(super) const FEED: Words = &[
    "excitation, supply, bridge, exc, vexc, vbus, vcc, vdd, vbat, battery, bus, speisung, versorgung, brucke",
    "alimentation, alimentacion, alimentazione",
];
/// Columns that count the samples.
pub(super) const INDEX: Words = &["index, idx, i, k, n, no, nr, sample, samples, row, count, id, point, x"];
/// Words of the names of such columns.
pub(super) const COUNTER: Words = &[
    "index, idx, sample, samples, row, count, counter, cnt, frame, seq, sequence, packet, pkt, tick, ticks, scan",
    "msg, iteration, iter, cycle, loop, number, nr",
];
/// Columns that number the parts of a record.
pub(super) const PART: Words = &[
    "episode, run, trial, segment, segments, lap, laps, batch, test, rep, repetition, cycle, cycles, block, step, stage",
    "zyklus, zyklen, segmente, cyc, ciclo, ciclos, cicli, cykl, cyklus, cyclus, цикл",
    "サイクル, 回数, 循环, 周期, 循环数, 사이클",
];
/// A signal before it was converted to its unit.
pub(super) const RAW: Words = &["raw, adc, counts, count, volt, volts, bits, lsb, mv, digits"];
/// Units of such signals.
pub(super) const RAW_UNITS: Words = &["V, mV, µV, counts, count, bits, bit, LSB, raw, digits, mV/V, mA"];
/// Units of lengths and angles.
pub(super) const UNITS_OF_MOTION: Words =
    &["m, mm, um, µm, μm, nm, cm, km, in, inch, ft, mil, deg, °, rad, mrad, degrees, radians"];
/// Units of speeds.
pub(super) const UNITS_OF_SPEED: Words =
    &["m/s, mm/s, in/s, in/sec, km/h, rad/s, deg/s, °/s, rpm, rev/min, 1/min, min-1, m/s², m/s^2, g"];
/// Units of forces and torques.
pub(super) const UNITS_OF_FORCE: Words = &[
    "N, kN, MN, mN, daN, cN, lbf, lbs, lb, kgf, gf, kip, Nm, kNm, mNm, N·m, N*m, N.m, Nmm, Ncm, lbf·ft, lb-ft, ft-lb, in-lb",
];
/// Units of what feeds sensors and machines.
pub(super) const UNITS_OF_FEED: Words = &["V, mV, A, mA, Volt, Volts"];

/// Words that stand for something by themselves.
pub(super) const KNOWN: [Words; 10] =
    [TIME, INPUT, COMMAND, RESPONSE, MOTION, DRIVE, ANSWER, OUTPUT, DEVIATION, PART];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_in_a_list_whole() {
        const LIST: Words = &["set point, x value, aa, a", "力, トルク"];
        for (word, is_in) in [
            ("set point", true),
            ("aa", true),
            ("a", true),
            ("トルク", true),
            ("point", false),
            ("value, aa", false),
            ("x value, aa", false),
            ("", false),
            (",", false),
            ("ク", false),
        ] {
            assert_eq!(has(LIST, word), is_in, "{word}");
        }
    }
}
