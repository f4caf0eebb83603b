//! The other end of the protocol: an estimator that answers lines.

use std::io;
use std::path::Path;
use switchback_host::{numbers, serve};
use switchback_identify::excitation::Direction;
use switchback_study::foreign::{
    Answer, Design, DesignExperiment, Estimates, ForeignEstimator, Greeting, PROTOCOL, Records, Request,
    Stored,
};

/// Answers requests on standard input until there are no more.
///
/// # Errors
/// If the greeting is of another protocol, a line is no request, or the system refuses.
pub fn answer_requests(estimator: &dyn ForeignEstimator) -> io::Result<()> {
    let mut is_greeted = false;
    serve(|line| {
        if !is_greeted {
            let greeting: Greeting = serde_json::from_str(line)?;
            if greeting.schema != PROTOCOL {
                return Err(io::Error::other(format!(
                    "the program speaks {}, and not {PROTOCOL}",
                    greeting.schema
                )));
            }
            is_greeted = true;
            let version = estimator.begin().map_err(io::Error::other)?;
            return Ok(serde_json::to_string(&Greeting { schema: PROTOCOL.to_owned(), version })?);
        }
        let request: Request = serde_json::from_str(line)?;
        Ok(serde_json::to_string(&answer(estimator, &request)?)?)
    })
}

fn answer(estimator: &dyn ForeignEstimator, request: &Request) -> io::Result<Answer> {
    let stored = |of: Stored| numbers(Path::new(&request.block), of.at, of.count);
    let experiment = |k: usize| -> io::Result<DesignExperiment> {
        let of = &request.experiments[k];
        Ok(DesignExperiment {
            direction: [Direction::Descendant, Direction::Ascendant][k],
            levels: of.levels.clone(),
            satellite: of.satellite,
            lead: of.lead,
            v: stored(of.v)?,
        })
    };
    let design = Design {
        cell: request.cell,
        order: request.order,
        points: request.points,
        samples: request.samples,
        interval: request.interval,
        parameters: request.parameters.clone(),
        experiments: [experiment(0)?, experiment(1)?],
    };
    let y = [stored(request.y[0])?, stored(request.y[1])?];
    let records = Records { replicate: request.replicate, antithetic: request.antithetic, y: [&y[0], &y[1]] };
    let nothing = Answer { id: request.id, estimate: None, se: None, failed: None };
    Ok(match estimator.estimate(&design, &[records]).pop() {
        Some(Ok(found)) => with(nothing, &found),
        Some(Err(why)) => Answer { failed: Some(why), ..nothing },
        None => Answer { failed: Some("there was no estimate".to_owned()), ..nothing },
    })
}

fn with(answer: Answer, found: &Estimates) -> Answer {
    let (estimate, se) =
        found.iter().map(|(x, se)| (Some(*x), Some(*se).filter(|se| se.is_finite()))).unzip();
    Answer { estimate: Some(estimate), se: Some(se), ..answer }
}
