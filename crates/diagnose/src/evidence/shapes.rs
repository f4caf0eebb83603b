//! Further shapes in which effects appear: signals added to the working point or to the output, to first order.

use super::candidate::Candidates;
use super::context::{Context, Signal};
use super::setting::{Setting, quantile};

/// Places at which such signals are added.
pub(super) struct Shapes<'a> {
    pub(super) context: &'a Context<'a>,
    pub(super) setting: &'a Setting,
}

impl Shapes<'_> {
    fn signal(&self, of: impl Fn(usize) -> f64) -> Signal {
        self.setting.starts.windows(2).map(|w| (w[0]..w[1]).map(&of).collect()).collect()
    }

    /// The response of the linear part to a signal that is added to the working point.
    fn responded(&self, of: impl Fn(usize) -> f64) -> Signal {
        self.signal(of).iter().map(|x| self.context.base.linear.run(x)).collect()
    }

    /// Friction by speed and rest, wear by travel and side, slack.
    pub(super) fn operator(&self, out: &mut Candidates) {
        let s = self.setting;
        let mean = s.half.iter().map(|h| h.abs()).sum::<f64>() / s.half.len().max(1) as f64;
        let ln = libm::log1p;
        let mut one = |effect, of: &dyn Fn(usize) -> f64| {
            let column = out.add(self.responded(of));
            out.group(effect, vec![column]);
        };
        one("rate_dependence", &|t| s.branch[t] * s.half[t] * ln(s.speed[t]));
        one("rate_dependence", &|t| s.branch[t] * mean * libm::tanh(s.speed[t]));
        one("rate_dependence", &|t| s.branch[t] * mean * s.speed[t].powi(2));
        for width in [0.2, 0.6, 1.5] {
            one("stribeck", &|t| s.branch[t] * mean * libm::exp(-(s.speed[t] / width).powi(2)));
        }
        one("stribeck", &|t| s.branch[t] * s.half[t] / (1.0 + s.speed[t]));
        one("creep", &|t| s.branch[t] * mean * ln(s.rest[t] / 3.0));
        one("creep", &|t| s.branch[t] * s.half[t] * (1.0 - libm::exp(-s.rest[t] / 20.0)));
        one("border_wear", &|t| s.branch[t] * s.half[t] * (s.travelled[t] - 0.5));
        one("border_wear", &|t| s.branch[t].max(0.0) * mean * (s.travelled[t] - 0.5));
        one("border_wear", &|t| s.branch[t].min(0.0) * mean * (s.travelled[t] - 0.5));
        one("border_wear", &|t| s.branch[t] * s.half[t] * libm::exp(-5.0 * s.clock[t]));
        let spread = quantile(&s.u.iter().map(|u| u.abs()).collect::<Vec<_>>(), 0.5).max(f64::MIN_POSITIVE);
        for width in [0.05, 0.3] {
            one("slack", &|t| s.slope[t] * libm::tanh(s.u[t] / (width * spread)));
        }
        for reach in [0.02, 0.06] {
            one("slack", &|t| {
                s.slope[t] * s.branch[t] * libm::exp(-(s.u[t] / (reach * 5.0 * spread)).powi(2))
            });
        }
    }

    /// Gains that change over time.
    pub(super) fn slow(&self, out: &mut Candidates) {
        const HATS: usize = 7;
        let s = self.setting;
        let hats: Vec<usize> = (0..HATS)
            .map(|k| out.add(self.responded(|t| s.u[t] * hat(s.clock[t] * (HATS - 1) as f64 - k as f64))))
            .collect();
        out.group("gain_drift", hats);
        let square = out.add(self.responded(|t| s.u[t] * (s.clock[t] - 0.5).powi(2)));
        let straight = out.add(self.responded(|t| s.u[t] * (s.clock[t] - 0.5)));
        out.group("gain_drift", vec![straight, square]);
        let late = out.add(self.responded(|t| s.u[t] * libm::exp(-5.0 * s.clock[t])));
        out.group("gain_drift", vec![late]);
        let zero: Vec<usize> =
            (0..9).map(|k| out.add(self.signal(|t| hat(s.clock[t] * 8.0 - f64::from(k))))).collect();
        out.group("sensor_drift", zero);
        let records = s.starts.len() - 1;
        if records > 1 {
            let mut longest: Vec<usize> = (0..records).collect();
            longest.sort_by_key(|k| std::cmp::Reverse(s.starts[k + 1] - s.starts[*k]));
            let offsets: Vec<usize> = longest
                .into_iter()
                .take(8)
                .skip(1)
                .map(|k| out.add(self.signal(|t| f64::from(u8::from(s.record[t] == k)))))
                .collect();
            out.group("record_offset", offsets);
        }
    }

    /// A curved or clipped characteristic.
    pub(super) fn sensor(&self, out: &mut Candidates) {
        let level = &self.setting.level;
        let above = |from: f64| move |t: usize| (level[t] - from).max(0.0);
        let high = [0.88, 0.97].map(|from| out.add(self.signal(above(from))));
        let low = [0.12, 0.03].map(|to| out.add(self.signal(|t| (to - level[t]).max(0.0))));
        for group in [vec![high[0]], vec![high[1]], vec![low[0]], vec![low[1]], vec![high[0], low[0]]] {
            out.group("sensor_saturation", group);
        }
        let curved = [2, 3].map(|power| out.add(self.signal(|t| (level[t] - 0.5).powi(power))));
        out.group("sensor_nonlinearity", curved.to_vec());
        let bumps: Vec<usize> = (0..5)
            .map(|k| {
                let centre = 0.1 + 0.2 * f64::from(k);
                out.add(self.signal(|t| libm::exp(-((level[t] - centre) / 0.12).powi(2))))
            })
            .collect();
        out.group("sensor_nonlinearity", bumps);
    }
}

fn hat(x: f64) -> f64 {
    (1.0 - x.abs()).max(0.0)
}
