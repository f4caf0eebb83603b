//! A working point between the borders, as weights of border values.
//!
//! What is left of the old border after a reversal is a weight on each of its knots. Weights below [`NEGLIGIBLE`] are dropped, as the
//! diagnosis does.

use super::borders::Written;
use super::builder::{Builder, Part, choose, note, when};
use super::by_border::by_border;
use super::input::Ends;
use super::motion::Motion;
use crate::step::model::{Direction, Effects, Model, Transition, TransitionLaw, Widening};
use crate::step::program::{Array, Procedure, Statement, Value, Variable};

/// Weight below which a border value no longer counts in a working point between the borders.
pub const NEGLIGIBLE: f64 = 1e-5;

/// What the weights are kept in.
struct Weights {
    /// Values of all weights' knots.
    values: Array,
    now: Array,
    sum: Array,
    add_hat: Procedure,
    /// Number of border values, and of all weights.
    borders: usize,
    size: usize,
    k: Variable,
}

impl Weights {
    fn clear(&self) -> Statement {
        Statement::Fill(self.sum, Value::from(0.0))
    }

    fn hat(&self, side: impl Into<Value>, at: impl Into<Value>, factor: impl Into<Value>) -> Statement {
        Statement::Run(self.add_hat, vec![side.into(), at.into(), factor.into()])
    }

    /// Each weight of the sum becomes a value of its place.
    fn each(&self, value: impl Fn(Value) -> Value) -> Statement {
        let body = vec![self.sum.put(self.k, value(self.k.get()))];
        Statement::Repeat(self.k, self.size, body)
    }

    /// Drops what no longer counts.
    fn drop_negligible(&self) -> Statement {
        let small = self.sum.at(self.k).abs().at_most(NEGLIGIBLE);
        Statement::Repeat(self.k, self.size, vec![when(small, vec![self.sum.put(self.k, 0.0)])])
    }

    /// The sum is the working point.
    fn take(&self) -> Statement {
        Statement::Copy(self.now, self.sum)
    }
}

/// A transition with its memory.
struct Passing {
    transition: Transition,
    fade: Variable,
    fading: Array,
    /// Not zero where anything fades.
    anything: Variable,
    /// The border of the last move, the share of the other one, and what that was just after the reversal.
    crossing: Option<[Variable; 3]>,
}

/// How the working point is followed by weights.
pub(super) fn part(
    b: &mut Builder,
    model: &Model,
    (ends, x, u): (&Ends, Variable, Variable),
    (borders, motion): (&Written, &Motion),
) -> Part {
    let effects = &model.effects;
    let middle = matches!(model.direction, Direction::Place { between_borders: true, .. });
    let w = lay_out(b, borders, effects.had_starts, model);
    let passing = effects.transition.map(|transition| Passing::new(b, transition, w.size));
    let mut start = vec![w.clear()];
    let halves = || vec![w.hat(1.0, x, 0.5), w.hat(-1.0, x, 0.5)];
    let nearer =
        || vec![choose(Value::from(0.5).at_most(x), vec![w.hat(1.0, x, 1.0)], vec![w.hat(-1.0, x, 1.0)])];
    let by_itself = if middle { halves() } else { nearer() };
    start.extend(by_border(ends, [vec![w.hat(-1.0, x, 1.0)], by_itself, vec![w.hat(1.0, x, 1.0)]]));
    if effects.had_starts {
        start.push(w.sum.put(Value::Whole(w.borders), 1.0));
    }
    start.push(w.take());
    let mut step = vec![note("the working point, as weights of border values")];
    if let Some(passing) = &passing {
        start.extend(passing.begin((ends, x), middle));
        let reversal = motion.reversal.expect("a transition asks for reversals");
        step.push(when(reversal.get().differs(0.0), passing.turn(&w, motion)));
    }
    let mut moving = move_on(b, (&w, passing.as_ref()), effects, (x, motion));
    let still = relax(b, &w, effects, x).map(|relaxing| {
        moving.extend(relaxing.moved);
        start.push(relaxing.start);
        relaxing.still
    });
    let moves = motion.moves().expect("effects have a motion");
    step.push(choose(moves, moving, still.unwrap_or_default()));
    let sum = || u.set(Value::Dot(w.values, w.now));
    start.push(sum());
    step.push(sum());
    Part { start, step }
}

fn lay_out(b: &mut Builder, borders: &Written, had_starts: bool, model: &Model) -> Weights {
    let size = borders.len() + usize::from(had_starts);
    let mut values = model.borders.values();
    // What a fitted record began with is unknown in another one.
    values.resize(size, 0.0);
    let values = b.constants("border_u", &values, "values that carry the weights");
    let now = b.line("weights", size, "weights of the working point");
    let sum = b.line("sum", size, "room for a sum of weights");
    let add_hat = borders.add_hat(b, sum);
    Weights { values, now, sum, add_hat, borders: borders.len(), size, k: b.index("k") }
}

impl Passing {
    fn new(b: &mut Builder, transition: Transition, size: usize) -> Self {
        let fading = b.line("fading", size, "weights of what fades after the last reversal");
        let crossing = (transition.law == TransitionLaw::Crossing).then(|| {
            [
                b.state("on", "the border of the last move: +1 or -1"),
                b.state("other_share", "the share of the other border in the working point"),
                b.state("other_share_turned", "what that was just after the last reversal"),
            ]
        });
        let fade = b.local("fade");
        Self { transition, fade, fading, anything: b.state("fades", "1 if anything fades, else 0"), crossing }
    }

    fn begin(&self, (ends, x): (&Ends, Variable), middle: bool) -> Vec<Statement> {
        let mut start = vec![Statement::Fill(self.fading, Value::from(0.0)), self.anything.set(0.0)];
        if let Some([on, share, turned]) = self.crossing {
            let nearer = vec![choose(Value::from(0.5).at_most(x), vec![on.set(1.0)], vec![on.set(-1.0)])];
            start.extend(by_border(ends, [vec![on.set(-1.0)], nearer, vec![on.set(1.0)]]));
            let half = if middle { 0.5 } else { 0.0 };
            start.push(share.set(0.0));
            if middle {
                start.push(when(ends.branch.get().equals(0.0), vec![share.set(half)]));
            }
            start.push(turned.set(share));
        }
        start
    }

    /// A reversal: notes what will fade.
    fn turn(&self, w: &Weights, motion: &Motion) -> Vec<Statement> {
        let branch = motion.side();
        let copy_sum = Statement::Copy(self.fading, w.sum);
        match (self.transition.law, self.crossing) {
            (TransitionLaw::Held, _) => {
                vec![Statement::Copy(self.fading, w.now), self.anything.set(1.0)]
            }
            (TransitionLaw::Offset, _) | (TransitionLaw::Crossing, None) => {
                let turn = motion.turn.expect("a transition asks for the turning place");
                let there = self.fading.at(w.k).differs(0.0);
                vec![
                    Statement::Copy(w.sum, w.now),
                    w.hat(branch, turn, -1.0),
                    w.drop_negligible(),
                    copy_sum,
                    self.anything.set(0.0),
                    Statement::Repeat(w.k, w.size, vec![when(there, vec![self.anything.set(1.0)])]),
                ]
            }
            (TransitionLaw::Crossing, Some([on, share, turned])) => {
                let mut body = vec![
                    choose(
                        on.get().differs(branch.clone()),
                        vec![turned.set(Value::from(1.0) - share)],
                        vec![turned.set(share)],
                    ),
                    on.set(branch),
                ];
                // Beyond the borders' values, what the record began with: it fades once.
                for k in w.borders..w.size {
                    let weight = w.now.at(Value::Whole(k));
                    body.push(self.fading.put(Value::Whole(k), weight.clone()));
                    let there = weight.differs(0.0);
                    body.push(choose(there, vec![self.anything.set(1.0)], vec![self.anything.set(0.0)]));
                }
                body
            }
        }
    }

    /// Sets what is left of the transition.
    fn set_fade(&self, motion: &Motion) -> Vec<Statement> {
        let Transition { length, shape, reach, .. } = self.transition;
        let travel = motion.travel.expect("a transition asks for the travel");
        let envelope = (-((travel / length).power(shape))).exp();
        vec![
            self.fade.set(0.0),
            when(
                travel.get().at_most(reach),
                vec![
                    self.fade.set(envelope),
                    when(self.fade.get().at_most(NEGLIGIBLE), vec![self.fade.set(0.0)]),
                ],
            ),
        ]
    }
}

/// A move on a border, or between them.
fn move_on(
    b: &mut Builder,
    (w, passing): (&Weights, Option<&Passing>),
    effects: &Effects,
    (x, motion): (Variable, &Motion),
) -> Vec<Statement> {
    let branch = motion.side();
    let (narrowing, other) = (b.local("narrowing"), b.local("other"));
    let mut body = vec![narrowing.set(narrower(effects, motion))];
    body.extend(passing.map(|passing| passing.set_fade(motion)).unwrap_or_default());
    let mut on_border = vec![w.clear(), w.hat(branch.clone(), x, 1.0)];
    let mut between = Vec::new();
    let half = Value::from(0.5) * narrowing;
    match passing.and_then(|passing| passing.crossing.map(|crossing| (passing, crossing))) {
        Some((passing, [_, share, turned])) => {
            on_border.push(share.set(0.0));
            between.push(share.set(passing.fade * turned));
            between.push(other.set(half + share * (Value::from(1.0) - narrowing)));
        }
        None => between.push(other.set(half)),
    }
    let merges = other.get().differs(0.0);
    between.extend([
        w.clear(),
        w.hat(branch.clone(), x, Value::from(1.0) - other),
        when(other.get().differs(0.0), vec![w.hat(-branch, x, other)]),
    ]);
    let is_on_border = narrowing.get().equals(0.0);
    match passing {
        Some(passing) => {
            let fade = passing.fade;
            let held = passing.transition.law == TransitionLaw::Held;
            let keep = if held { Value::from(1.0) - fade } else { Value::from(1.0) };
            let faded = w.each(|k| w.sum.at(k.clone()) * keep.clone() + passing.fading.at(k) * fade);
            between.push(when(fade.get().more(0.0), vec![faded]));
            let fades = fade.get().more(0.0).and(passing.anything.get().differs(0.0));
            between.push(when(merges.or(fades), vec![w.drop_negligible()]));
            body.push(choose(is_on_border.and(fade.get().equals(0.0)), on_border, between));
        }
        None => {
            between.push(when(merges, vec![w.drop_negligible()]));
            body.push(choose(is_on_border, on_border, between));
        }
    }
    body.push(w.take());
    body
}

/// Share by which the loop is narrower at the present speed.
fn narrower(effects: &Effects, motion: &Motion) -> Value {
    let narrowing = Value::from(effects.narrowing);
    let Some(Widening { share, power, scale, at_high_speeds }) = effects.widening else { return narrowing };
    let speed = motion.change.expect("effects have a motion").get().abs();
    let relative = (speed / scale).power(power);
    let wider = if at_high_speeds { relative } else { (-relative).exp() };
    narrowing - wider * share
}

struct Relaxing {
    start: Statement,
    moved: Vec<Statement>,
    still: Vec<Statement>,
}

/// At rest it goes by a share of the distance from where it stopped to the middle between the borders.
fn relax(b: &mut Builder, w: &Weights, effects: &Effects, x: Variable) -> Option<Relaxing> {
    let relaxation = effects.relaxation?;
    let stopped = b.state("stopped", "samples since the operator stopped; -1 before its first move");
    let place = b.state("x_stopped", "where that was");
    let at_stop = b.line("at_stop", w.size, "weights of the working point there");
    let share = b.local("relaxed");
    let towards = Value::from(1.0) - (-(stopped / relaxation.tau)).exp();
    let relaxing = vec![
        when(stopped.get().equals(0.0), vec![Statement::Copy(at_stop, w.now)]),
        stopped.set(stopped + 1.0),
        share.set(towards * relaxation.share),
        w.each(|k| at_stop.at(k) * (Value::from(1.0) - share)),
        w.hat(-1.0, place, share * 0.5),
        w.hat(1.0, place, share * 0.5),
        w.drop_negligible(),
        w.take(),
    ];
    Some(Relaxing {
        start: stopped.set(-1.0),
        moved: vec![stopped.set(0.0), place.set(x)],
        still: vec![when(Value::from(0.0).at_most(stopped), relaxing)],
    })
}
