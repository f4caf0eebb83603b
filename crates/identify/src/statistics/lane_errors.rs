//! Adding eight replicates at a time to the running sums.

use super::error_sums::{ErrorSums, TERMS};
use super::quantile::normal_quantile_975;
use switchback_noise::lanes::{LANES, Lane, Work, keep_apart, widest};

/// What eight replicates report every parameter of a cell: [`ReplicateError`](super::ReplicateError) in lanes.
#[derive(Debug, Clone, Copy)]
pub struct LaneErrors<'a> {
    /// The replicates themselves.
    pub own: LaneEstimates<'a>,
    /// Their antithetic partners, the same noise with its sign changed, where these were estimated (see [`ErrorSums::push_pair`]).
    pub mirrored: Option<LaneEstimates<'a>>,
    /// Exact variances of the first-order parts, where they are known.
    pub first_variances: Option<&'a [f64]>,
}

/// The estimates of every parameter from eight records, with the leading terms of their errors.
#[derive(Debug, Clone, Copy)]
pub struct LaneEstimates<'a> {
    /// The estimates `θ̂`.
    pub values: &'a [Lane],
    /// Variances that the method reports.
    pub variances: &'a [Lane],
    /// First-order part of the errors.
    pub first_order: &'a [Lane],
    /// What is known of the second.
    pub second_order: &'a [Lane],
}

/// Sums over the replicates of eight sections, a lane each, of every parameter of a cell.
///
/// Each lane's replicates are added one after the other: sums that are kept and taken up later have the bits of sums in one go.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LaneSums {
    /// Replicates so far.
    count: Lane,
    /// … of which the first-order part is known.
    controlled: Lane,
    terms: Vec<[Lane; TERMS]>,
}

impl LaneSums {
    /// Nothing yet, of so many parameters.
    pub fn new(parameters: usize) -> Self {
        Self { terms: vec![[Lane::ZERO; TERMS]; parameters], ..Self::default() }
    }

    /// How many parameters there are.
    pub fn parameters(&self) -> usize {
        self.terms.len()
    }

    /// Adds the replicates in the chosen lanes, given the true values.
    pub fn add(&mut self, truth: &[f64], errors: LaneErrors<'_>, chosen: &[bool; LANES]) {
        self.count_chosen(chosen);
        widest(Add { truth, errors: &[errors], sums: &mut self.terms, chosen: Some(chosen) });
    }

    /// Adds the replicates in all lanes, one [`LaneErrors`] after the other: the same to the bit as [`Self::add`] for each, in less time.
    pub fn add_all(&mut self, truth: &[f64], errors: &[LaneErrors<'_>]) {
        errors.iter().for_each(|_| self.count_chosen(&[true; LANES]));
        widest(Add { truth, errors, sums: &mut self.terms, chosen: None });
    }

    fn count_chosen(&mut self, chosen: &[bool; LANES]) {
        let more = Lane(chosen.map(f64::from));
        self.count += more;
        self.controlled += more;
    }

    /// The sums in a lane, one a parameter.
    pub fn lane(&self, lane: usize) -> Vec<ErrorSums> {
        let (count, controlled) = (self.count.0[lane], self.controlled.0[lane]);
        let of = |terms: &[Lane; TERMS]| ErrorSums { count, controlled, terms: terms.map(|t| t.0[lane]) };
        self.terms.iter().map(of).collect()
    }

    /// Puts other sums into a lane: what [`lane`](Self::lane) gave, with more replicates added to every parameter.
    pub fn set_lane(&mut self, lane: usize, sums: &[ErrorSums]) {
        for (terms, sums) in self.terms.iter_mut().zip(sums) {
            (self.count.0[lane], self.controlled.0[lane]) = (sums.count, sums.controlled);
            terms.iter_mut().zip(sums.terms).for_each(|(term, total)| term.0[lane] = total);
        }
    }

    /// Adds the sums of other replicates, lane by lane.
    pub fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.controlled += other.controlled;
        for (into, from) in self.terms.iter_mut().zip(&other.terms) {
            into.iter_mut().zip(from).for_each(|(into, from)| *into += *from);
        }
    }

    /// Appends all that is in it, as little-endian numbers of 64 bits: [`read`](Self::read) takes them.
    pub fn write(&self, bytes: &mut Vec<u8>) {
        let lanes = [&self.count, &self.controlled].into_iter().chain(self.terms.iter().flatten());
        bytes.reserve(LANE_BYTES * (2 + TERMS * self.terms.len()));
        for lane in lanes {
            let mut written = [0; LANE_BYTES];
            written.chunks_exact_mut(8).zip(lane.0).for_each(|(to, x)| to.copy_from_slice(&x.to_le_bytes()));
            bytes.extend_from_slice(&written);
        }
    }

    /// Takes what [`write`](Self::write) appended, of so many parameters, from the beginning of `bytes`; `None` where there is too little.
    pub fn read(parameters: usize, bytes: &mut &[u8]) -> Option<Self> {
        let length = TERMS.checked_mul(parameters)?.checked_add(2)?.checked_mul(LANE_BYTES)?;
        let (own, rest) = bytes.split_at_checked(length)?;
        *bytes = rest;
        let mut lanes = own.chunks_exact(LANE_BYTES).map(|lane| {
            let number = |l: usize| lane[8 * l..8 * (l + 1)].try_into().expect("eight bytes");
            Lane(std::array::from_fn(|l| f64::from_le_bytes(number(l))))
        });
        let (count, controlled) = (lanes.next()?, lanes.next()?);
        let mut terms = vec![[Lane::ZERO; TERMS]; parameters];
        terms.iter_mut().flatten().zip(lanes).for_each(|(term, lane)| *term = lane);
        Some(Self { count, controlled, terms })
    }
}

/// Bytes of a lane, written.
const LANE_BYTES: usize = 8 * LANES;

/// [`LaneSums::add`] on its way.
struct Add<'a> {
    truth: &'a [f64],
    errors: &'a [LaneErrors<'a>],
    sums: &'a mut [[Lane; TERMS]],
    /// The lanes that are added; all of them if it is not said.
    chosen: Option<&'a [bool; LANES]>,
}

impl Work for Add<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { truth, errors, sums, chosen } = self;
        let quantile = normal_quantile_975();
        let covered = quantile * quantile;
        for (k, (truth, sums)) in truth.iter().zip(sums).enumerate() {
            keep_apart();
            let mut running = *sums;
            for errors in errors {
                keep_apart();
                let terms = errors.terms(k, *truth, covered);
                match chosen {
                    None => {
                        for k in 0..TERMS {
                            running[k] += terms[k];
                        }
                    }
                    // A lane that is left out may hold anything, so it is not multiplied by zero.
                    Some(chosen) => {
                        for k in 0..TERMS {
                            running[k] += terms[k].where_or(chosen, Lane::ZERO);
                        }
                    }
                }
            }
            *sums = running;
        }
    }
}

impl LaneErrors<'_> {
    /// The terms of parameter `k`; `covered` is the largest squared error over variance that an interval covers.
    #[inline(always)]
    fn terms(&self, k: usize, truth: f64, covered: f64) -> [Lane; TERMS] {
        let within = self.first_variances.map(|variances| variances[k] * covered);
        let variance = self.own.variances[k];
        let error = self.own.values[k] - Lane::splat(truth);
        let square = error * error;
        let is_covered = square.at_most(variance * covered);
        let mut remainders = self.own.remainders(k, truth, (covered, within));
        if let Some(mirrored) = self.mirrored {
            let partner = mirrored.remainders(k, truth, (covered, within));
            for (own, partner) in remainders.iter_mut().zip(partner) {
                *own = (*own + partner) * 0.5;
            }
        }
        let [remainder, square_remainder, coverage_remainder] = remainders;
        [
            error,
            square,
            square * error,
            square * square,
            variance,
            variance * variance,
            is_covered,
            remainder,
            remainder * remainder,
            square_remainder,
            square_remainder * square_remainder,
            coverage_remainder,
            coverage_remainder * coverage_remainder,
        ]
    }
}

impl LaneEstimates<'_> {
    /// What the control variates leave of the error of parameter `k`, of its square and of its coverage; `within` is the largest squared
    /// first-order part that an interval of the exact variance covers.
    #[inline(always)]
    fn remainders(&self, k: usize, truth: f64, (covered, within): (f64, Option<f64>)) -> [Lane; 3] {
        let (error, first) = (self.values[k] - Lane::splat(truth), self.first_order[k]);
        let beyond_first = error - first;
        let of_coverage = match within {
            Some(within) => {
                (error * error).at_most(self.variances[k] * covered)
                    - (first * first).at_most(Lane::splat(within))
            }
            None => Lane::ZERO,
        };
        [beyond_first - self.second_order[k], beyond_first * (error + first), of_coverage]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{KnownControl, ReplicateError};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn lanes_add_what_their_replicates_add_one_by_one(
            values in prop::array::uniform8(-1.0..1.0_f64), variances in prop::array::uniform8(0.0..0.5_f64), first in prop::array::uniform8(-1.0..1.0_f64),
            second in prop::array::uniform8(-0.1..0.1_f64), is_paired in any::<bool>(),
            chosen in prop::array::uniform8(any::<bool>()),
        ) {
            let left_out = |x: [f64; LANES]| Lane(std::array::from_fn(|l| if chosen[l] { x[l] } else { f64::NAN }));
            let [values_in_lanes, variances_in_lanes, first_in_lanes, second_in_lanes] = [values, variances, first, second].map(|x| [left_out(x)]);
            let own = LaneEstimates {
                values: &values_in_lanes,
                variances: &variances_in_lanes,
                first_order: &first_in_lanes,
                second_order: &second_in_lanes,
            };
            // Anything else that could be a partner.
            let partner = LaneEstimates { values: &second_in_lanes, second_order: &first_in_lanes, ..own };
            let errors = LaneErrors { own, mirrored: is_paired.then_some(partner), first_variances: Some(&[0.04]) };
            let mut fast = LaneSums::new(1);
            fast.add(&[0.3], errors, &chosen);
            fast.add(&[0.3], errors, &chosen);
            let known = KnownControl { mean: 0.0, first_order_variance: Some(0.1), first_order_coverage: Some(0.9) };
            let all = |sums: &ErrorSums| sums.performance(known).map(|p| {
                let controlled = [p.bias_controlled, p.sd_controlled, p.coverage_controlled];
                let [bias, sd, coverage] = controlled.map(|x| x.map_or(0.0, |x| x.value + x.mcse));
                [p.bias.value, p.bias.mcse, p.mse.value, p.mse.mcse, p.coverage.value, p.model_sd.value, p.model_sd.mcse, bias, sd, coverage]
            });
            for l in 0..LANES {
                let mut slow = ErrorSums::default();
                for _ in 0..if chosen[l] { 2 } else { 0 } {
                    let own = ReplicateError {
                        error: values[l] - 0.3,
                        se: variances[l].sqrt(),
                        first_order: Some(first[l]),
                        second_order: second[l],
                        first_order_variance: Some(0.04),
                    };
                    let partner = ReplicateError { error: second[l] - 0.3, second_order: first[l], ..own };
                    slow.push_pair(own, is_paired.then_some(partner));
                }
                let fast = fast.lane(l);
                prop_assert_eq!(fast[0].count(), slow.count());
                for (fast, slow) in all(&fast[0]).iter().flatten().zip(all(&slow).iter().flatten()) {
                    prop_assert!((fast - slow).abs() < 1e-7, "{} against {}", fast, slow);
                }
            }
        }

        #[test]
        fn all_at_once_adds_the_bits_of_one_after_the_other(
            numbers in prop::collection::vec(prop::array::uniform8(0.01..1.0_f64), 2 * 3 * 4), truth in prop::array::uniform2(-1.0..1.0_f64),
        ) {
            let lanes: Vec<Lane> = numbers.into_iter().map(Lane).collect();
            let errors: Vec<LaneErrors<'_>> = lanes
                .chunks_exact(8)
                .map(|x| {
                    let (values, variances) = x[..4].split_at(2);
                    let first_variances = Some(&[0.1, 0.2][..]);
                    let own = LaneEstimates { values, variances, first_order: &x[4..6], second_order: &x[6..] };
                    LaneErrors { own, mirrored: None, first_variances }
                })
                .collect();
            let (mut together, mut apart) = (LaneSums::new(2), LaneSums::new(2));
            together.add_all(&truth, &errors);
            errors.iter().for_each(|errors| apart.add(&truth, *errors, &[true; LANES]));
            prop_assert_eq!(&together, &apart);
            let mut written = Vec::new();
            together.write(&mut written);
            prop_assert!(LaneSums::read(2, &mut &written[1..]).is_none());
            written.push(7);
            let mut rest = written.as_slice();
            let read = LaneSums::read(2, &mut rest);
            prop_assert_eq!(read.as_ref(), Some(&together));
            prop_assert_eq!(rest, [7]);
            let mut moved = LaneSums::new(2);
            (0..LANES).for_each(|l| moved.set_lane(l, &together.lane(l)));
            prop_assert_eq!(&moved, &together);
            // Empty sums change nothing, on either side.
            moved.merge(&LaneSums::new(2));
            prop_assert_eq!(&moved, &together);
            let mut empty = LaneSums::new(2);
            empty.merge(&together);
            prop_assert_eq!(&empty, &together);
        }
    }
}
