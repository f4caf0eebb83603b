//! A design before it is planned: what is asked for, completed from the rig to plan from.

use super::forecast::Forecast;
use super::plan::{Length, Plan, Request};
use super::truth::Truth;
use super::{DesignError, Options, Outlook, Report};
use std::path::{Path, PathBuf};
use switchback_identify::excitation::Dataset;
use switchback_io::rig;
use switchback_model::rig::Rig;

/// Levels on each border where neither the user nor a rig says how many.
const POINTS: usize = 8;

/// What is asked for, and what the rig to plan from says of the system.
#[derive(Debug)]
pub struct Draft {
    options: Options,
    request: Request,
    source: Option<Source>,
    folder: Option<String>,
}

impl Draft {
    /// Reads the rig to plan from, where one is named, and completes what is asked for. `out` is the folder that the plan is meant for.
    ///
    /// # Errors
    /// [`DesignError`] if something is missing, or the rig cannot be read or identified.
    pub fn new(options: Options, out: Option<&Path>) -> Result<Self, DesignError> {
        options.check()?;
        let source = options.from.as_deref().map(|file| Source::read(file, options.order)).transpose()?;
        let request = request((&options, out), source.as_ref())?;
        Ok(Self { options, request, source, folder: out.map(|folder| folder.display().to_string()) })
    }

    /// Every file that was read.
    pub fn inputs(&self) -> Vec<&Path> {
        let records = self.source.iter().flat_map(|source| &source.files);
        records.chain(&self.options.from).map(PathBuf::as_path).collect()
    }

    /// The plan, as long as the precision wanted needs, and what is predicted of it.
    ///
    /// # Errors
    /// [`DesignError`] if the experiments are impossible.
    pub fn plan(self) -> Result<Report, DesignError> {
        let Self { options, request, source, folder } = self;
        let Some(Source { truth, .. }) = source else {
            return Ok(Report { plan: Plan::new(request, options.length())?, outlook: None, folder });
        };
        let Request { interval, order, points, .. } = request;
        let sketch = Dataset::new(interval, order, points, Dataset::FEWEST_PERIODS)?;
        let forecast = Forecast::new(&truth, sketch.pulses(), options.method)?;
        let wanted = options.precision;
        let length = wanted.map_or_else(|| options.length(), |p| Length::Periods(forecast.periods_for(p)));
        let plan = Plan::new(request, length)?;
        Ok(Report { plan, outlook: Some(Outlook { truth, forecast, wanted }), folder })
    }
}

/// The rig to plan from, and what it says of the system.
#[derive(Debug)]
struct Source {
    rig: Rig,
    truth: Truth,
    /// The rig's records.
    files: Vec<PathBuf>,
}

impl Source {
    fn read(file: &Path, order: Option<u8>) -> Result<Self, DesignError> {
        let rig::Loaded { mut rig, plan, .. } = rig::load(file)?;
        let files = plan.records.into_iter().map(|record| record.path).collect();
        rig.order = order.map(usize::from).or(rig.order);
        let truth = Truth::of(&rig, file)?;
        Ok(Self { rig, truth, files })
    }
}

/// What is asked for, completed from the rig.
fn request(
    (options, out): (&Options, Option<&Path>),
    source: Option<&Source>,
) -> Result<Request, DesignError> {
    let known = source.map(|s| (s.truth.hysteresis.interval(), s.rig.sample_time, s.truth.system.order()));
    let given = options.interval.zip(options.rate).zip(options.order);
    let (interval, sample_time, order) = known
        .or(given.map(|((interval, rate), order)| (interval, 1.0 / rate, usize::from(order))))
        .ok_or(DesignError::Incomplete)?;
    let label = |given: &Option<String>, of_rig: fn(&Rig) -> &str, default: &str| {
        given.clone().unwrap_or_else(|| source.map_or(default, |s| of_rig(&s.rig)).to_owned())
    };
    let folder = out.and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
    Ok(Request {
        name: options.name.clone().or(folder).unwrap_or_else(|| "planned".to_owned()),
        order,
        points: options.points.map(usize::from).or(source.map(|s| s.truth.points)).unwrap_or(POINTS),
        interval,
        sample_time,
        labels: [
            label(&options.input, |rig| &rig.input_label, "input v"),
            label(&options.output, |rig| &rig.output_label, "output y"),
        ],
        amplitude: options.amplitude,
        max_speed: options.max_speed,
        free_only: options.free_only,
        seed: options.seed,
    })
}
