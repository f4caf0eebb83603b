//! What the input does, sample by sample, as the operator sees it.

/// Direction of the working point.
pub(crate) type Sign = f64;

/// One sample of the input's motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    /// +1 on the ascending border, −1 on the descending one, 0 before the first move.
    pub(crate) branch: Sign,
    /// Whether the operator's input moves at this sample (inside the play it does not).
    pub(crate) moves: bool,
    /// Input at the last reversal.
    pub(crate) turn: f64,
    /// Travel since the last reversal.
    pub(crate) travel: f64,
    /// Whether a new branch starts at this sample.
    pub(crate) reversal: bool,
    /// Travel between the last two reversals: the size of the loop.
    pub(crate) loop_size: f64,
    /// Samples since the last move.
    pub(crate) rest: usize,
    /// `v(t) − v(t−1)`.
    pub(crate) step: f64,
    /// Travel since the record began.
    pub(crate) path: f64,
}

/// Follows an input through a play of full width `play`; moves below `threshold` against the branch are no reversal.
///
/// With play, the border coordinate stays the recorded `v`: each branch engages at `v ∓ play/2`, a shift that the
/// border tables absorb. What the play leaves is the rest after each reversal.
pub(crate) fn motions(v: &[f64], play: f64, threshold: f64) -> Vec<Motion> {
    let mut out = Vec::with_capacity(v.len());
    let Some(&first) = v.first() else { return out };
    let mut m = Motion {
        branch: 0.0,
        moves: false,
        turn: first,
        travel: 0.0,
        reversal: false,
        loop_size: 0.0,
        rest: 0,
        step: 0.0,
        path: 0.0,
    };
    // The furthest point reached on the present branch: the next reversal is measured from here.
    let mut extreme = first;
    // Whether the present branch has taken up the play; a record starts engaged.
    let mut engaged = true;
    out.push(m);
    for t in 1..v.len() {
        let step = v[t] - v[t - 1];
        m.step = step;
        m.path += step.abs();
        m.reversal = false;
        m.moves = false;
        if step != 0.0 {
            if m.branch == 0.0 {
                m.branch = step.signum();
                m.reversal = true;
                m.turn = v[t - 1];
                extreme = v[t];
            }
            let back = (extreme - v[t]) * m.branch;
            if back > threshold {
                m.branch = -m.branch;
                m.reversal = true;
                m.loop_size = (extreme - m.turn).abs();
                m.turn = extreme;
                extreme = v[t];
                engaged = play <= 0.0;
            } else if back <= 0.0 {
                extreme = v[t];
            }
            m.travel = (v[t] - m.turn).abs();
            if !engaged && m.travel > play {
                engaged = true;
            }
            m.moves = engaged;
        }
        m.rest = if step == 0.0 { m.rest + 1 } else { 0 };
        out.push(m);
    }
    out
}
