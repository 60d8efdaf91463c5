//! One model of a sheet: read, and drawn in each view.

use super::arguments::SheetArgs;
use super::paint::Sheet;
use super::views::Views;
use crate::batch::deadline::{self, Claim};
use crate::failure::Failure;
use crate::input::{Model, Reading};
use crate::render;
use crate::values::Source;
use estampe::Device;
use estampe_assets::Limits;
use std::sync::{Arc, Mutex, PoisonError};

/// What became of a cell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Status {
    Drawn,
    Failed(String),
    /// A limit of the options was exceeded.
    Limit(String),
}

impl From<Failure> for Status {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Limit(problem) => Self::Limit(problem),
            other => Self::Failed(other.to_string()),
        }
    }
}

impl Status {
    /// The sentence of a cell that was not drawn.
    pub(super) fn problem(&self) -> Option<&str> {
        match self {
            Self::Drawn => None,
            Self::Failed(problem) | Self::Limit(problem) => Some(problem),
        }
    }
}

/// What became of a model: a status for each view, and the reader's warnings.
#[derive(Debug, Clone)]
pub(super) struct Done {
    pub(super) statuses: Vec<Status>,
    pub(super) warnings: Vec<String>,
}

/// What all models share.
#[derive(Clone)]
pub(super) struct Shared {
    pub(super) args: Arc<SheetArgs>,
    pub(super) limits: Limits,
    pub(super) views: Arc<Views>,
    pub(super) sheet: Arc<Mutex<Sheet>>,
    /// The reason why the sheet must not be written.
    pub(super) refused: Arc<Mutex<Option<Failure>>>,
}

impl Shared {
    /// Draws the views of a model into the sheet: the cells from `first` on.
    pub(super) fn draw(&self, model: &Source, first: usize, device: &Arc<Device>) -> Done {
        let done = match self.args.limits.timeout {
            None => self.caught(model, first, device, &Claim::default()),
            Some(timeout) => {
                let (shared, theirs, device) = (self.clone(), model.clone(), device.clone());
                let work = move |claim: &Claim| shared.caught(&theirs, first, &device, claim);
                let done = deadline::run(&model.name(), timeout, work);
                done.unwrap_or_else(|problem| self.all(&Status::Limit(problem)))
            }
        };
        let mut sheet = self.sheet.lock().unwrap_or_else(PoisonError::into_inner);
        let name = format!("{}: ", model.name());
        for (cell, status) in (first..).zip(&done.statuses) {
            if let Some(problem) = status.problem() {
                // The label names the model.
                sheet.write_problem(cell, problem.strip_prefix(&name).unwrap_or(problem));
            }
        }
        done
    }

    fn all(&self, status: &Status) -> Done {
        Done {
            statuses: vec![status.clone(); self.views.count()],
            warnings: Vec::new(),
        }
    }

    /// A model whose drawing panics has failed.
    fn caught(&self, model: &Source, first: usize, device: &Device, claim: &Claim) -> Done {
        let work = || self.drawn(model, first, device, claim);
        let done = std::panic::catch_unwind(std::panic::AssertUnwindSafe(work));
        let done = done.unwrap_or_else(|_| {
            Err(Failure::Input(format!(
                "{}: an internal error; please report it with the model, the others are drawn",
                model.name()
            )))
        });
        done.unwrap_or_else(|failure| self.all(&Status::from(failure)))
    }

    fn drawn(
        &self,
        source: &Source,
        first: usize,
        device: &Device,
        claim: &Claim,
    ) -> Result<Done, Failure> {
        let args = &self.args;
        let chosen = args.choice.at(args.picture.shader.time);
        let folder = args.choice.folder_of(source)?;
        let model = Model::read(
            (source, &folder),
            args.format,
            Reading {
                options: &chosen,
                limits: &self.limits,
                detail: &self.views.detail(&args.picture),
            },
            |_| {},
        )?;
        args.limits.check_memory(&model, &args.picture, false)?;
        if let Err(failure) = render::check_output(&args.output, &model, &args.picture) {
            let mut refused = self.refused.lock().unwrap_or_else(PoisonError::into_inner);
            refused.get_or_insert(failure.clone());
            return Err(failure);
        }
        let mut statuses = Vec::new();
        self.views.draw(&model, args, device, |view, image| {
            if !claim.begin_writing() {
                return false;
            }
            statuses.push(match image {
                Ok(image) => {
                    let mut sheet = self.sheet.lock().unwrap_or_else(PoisonError::into_inner);
                    sheet.paste(first + view, &image);
                    Status::Drawn
                }
                Err(failure) => Status::from(failure),
            });
            claim.end_writing();
            true
        })?;
        let given_up = Status::Limit("given up".to_owned());
        statuses.resize(self.views.count(), given_up);
        let warnings = model.warnings.iter().map(ToString::to_string).collect();
        Ok(Done { statuses, warnings })
    }
}
