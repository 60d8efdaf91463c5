//! All runs of a scene on a number of cores: estampe in every language, and the peer, in turn.

use super::limits::Limits;
use super::peer::{Effort, Session};
use super::results::{Measured, RunResults, fastest};
use super::table::{Line, Ours};
use crate::BenchError;
use crate::frame::FrameSize;
use crate::picture::{Difference, Picture};
use crate::scene::{SceneEntry, ShaderLanguage};

/// The runs of a scene.
#[derive(Debug)]
pub struct Runs {
    scene: &'static SceneEntry,
    /// The runs of estampe in each language that the scene has.
    ours: Vec<(ShaderLanguage, Vec<RunResults>)>,
    /// The runs of the peer.
    pub theirs: Vec<RunResults>,
}

impl Runs {
    /// No runs yet.
    #[must_use]
    pub fn new(scene: &'static SceneEntry) -> Self {
        let languages = ShaderLanguage::ALL.into_iter();
        // A scene without shaders is the same in every language.
        let has = |language: &ShaderLanguage| match language {
            ShaderLanguage::Rust => !scene.is_wgsl_only,
            ShaderLanguage::Wgsl | ShaderLanguage::WgslContracted => scene.name != "clear",
        };
        Self {
            scene,
            ours: languages
                .filter(has)
                .map(|language| (language, Vec::new()))
                .collect(),
            theirs: Vec::new(),
        }
    }

    /// Adds a round.
    ///
    /// # Errors
    /// If a run fails.
    pub fn draw(
        &mut self,
        session: &Session,
        sizes: &[FrameSize],
        cores: usize,
        effort: Effort,
    ) -> Result<(), BenchError> {
        let name = self.scene.name;
        for (language, runs) in &mut self.ours {
            runs.push(session.run_ours((name, *language), sizes, cores, effort)?);
        }
        self.theirs
            .push(session.run_peer(name, sizes, cores, effort)?);
        Ok(())
    }

    /// The line of a table.
    ///
    /// # Errors
    /// If a run did not measure the scene at this size, or pictures cannot be compared.
    pub fn line(
        &self,
        session: &Session,
        size: FrameSize,
        cores: usize,
        limits: &Limits,
    ) -> Result<Line, BenchError> {
        let name = self.scene.name;
        let found = |runs: &[RunResults], who: &str| -> Result<Measured, BenchError> {
            fastest(runs, name, size).ok_or_else(|| BenchError::Command {
                command: who.to_owned(),
                reason: format!("measured no {name} at {size}"),
            })
        };
        let theirs = found(&self.theirs, "peerbench")?;
        let path = session.peer_picture(name, size);
        let reference = Picture::read_png(&path)?;
        let (mut ours, mut worst) = (Vec::new(), Difference::default());
        for (language, runs) in &self.ours {
            let picture = Picture::read_png(&session.our_picture(name, *language, size))?;
            let difference =
                Difference::between(&picture, &reference).ok_or_else(|| BenchError::Picture {
                    path: path.clone(),
                    reason: format!("is not of {size} pixels"),
                })?;
            if difference.share_beyond() >= worst.share_beyond() {
                worst = difference;
            }
            ours.push(Ours {
                language: *language,
                measured: found(runs, "estampe-bench")?,
            });
        }
        let fragments = ours.first().map_or(0, |ours| ours.measured.fragments);
        Ok(Line {
            scene: name,
            group: self.scene.group,
            limit: limits.of_scene(name, size, cores, fragments),
            ours,
            theirs,
            difference: worst,
        })
    }
}
