//! One point: rendered, timed, judged and kept.

use std::{sync::Arc, time::Duration};

use serde_json::{Map, Value};

use super::{
    Bench, POINTS, Reference, Spec, SweepError,
    host::{GoOn, Host},
    line,
};
use crate::{
    lab::{
        self, Auto, LabError, Picture, Provenance,
        render_report::warnings,
        timing::{self, Rounds, Variant},
    },
    metrics::Measure,
    passes::light,
    renderer::{Frame, Planned, Renderer},
    store::Key,
};

/// Frames before the rounds; fewer where the median settles sooner.
const MOST_WARMUP: u32 = 30;

impl Bench<'_> {
    /// Does a point and keeps it; says why it failed, if it did. `patience`: how long to wait until this host is quiet.
    ///
    /// # Errors
    /// [`SweepError::Store`] where it cannot be kept; [`LabError::Interrupted`] when `go_on` breaks off.
    pub fn work(&self, at: usize, host: &Host, patience: Duration, go_on: GoOn) -> Result<Option<String>, SweepError> {
        let spec = &self.sweep.points[at];
        let busy = host.busy(go_on)?;
        let (key, planned) = self.plan(spec);
        let mut line = line::begun(self.sweep, spec, &key, self.gpu.info());
        let mut failed = None;
        let measured = planned.map_err(LabError::from).and_then(|planned| {
            drop(busy);
            self.measure(spec, planned, (host, patience), go_on)
        });
        match measured {
            Ok(measured) => line.extend(measured),
            Err(LabError::Interrupted) => return Err(LabError::Interrupted.into()),
            Err(reason) => {
                failed = Some(reason.to_string());
                line.insert("failed".to_owned(), reason.to_string().into());
            }
        }
        self.keep(&key, line)?;
        Ok(failed)
    }

    fn keep(&self, key: &Key, line: Map<String, Value>) -> Result<(), SweepError> {
        let kept = self.store.keep(POINTS, key, Value::Object(line).to_string().as_bytes());
        kept.map_err(|reason| SweepError::Store { path: self.store.file(POINTS, key).unwrap_or_default(), reason })
    }

    fn measure(
        &self,
        spec: &Spec,
        planned: Planned,
        (host, patience): (&Host, Duration),
        go_on: GoOn,
    ) -> Result<Map<String, Value>, LabError> {
        let job = &spec.job;
        let busy = host.busy(go_on)?;
        let photons = if planned.photon_bytes > 0 { u64::from(job.settings.whole(&light::SIDE)).pow(2) } else { 0 };
        let bytes = planned.plan.bytes();
        let mut renderer = Renderer::planned(self.gpu, job, planned, self.sources.clone())?;
        let stages = renderer.stages();
        drop(busy);

        let frame = Frame::default();
        let (quiet, alone) = host.quiet(patience, go_on)?;
        let render = || renderer.frame(&frame).map_err(LabError::from);
        let mut variants = [Variant { name: "frame".to_owned(), stages, frame: Box::new(render) }];
        let rounds = Rounds {
            rounds: self.sweep.rounds,
            most_warmup: MOST_WARMUP,
            least_warmup: timing::least_warmup(self.gpu.info()),
            seed: 0,
            until: None,
        };
        let timed = rounds.run(&mut variants, &mut |_| go_on())?;
        drop((variants, quiet));

        let _busy = host.busy(go_on)?;
        let tick_ms = f64::from(self.gpu.info().timestamp_period) * 1e-6;
        let mut said: Vec<String> = job.scene.warnings.clone();
        let account = renderer.account()?;
        said.extend(warnings(&account, job));
        said.extend(timed.warnings(tick_ms));
        let about = Provenance::new(job, &frame, self.gpu.info(), Vec::new()).attributes();
        let picture = Picture { file: job.scene.name.clone(), layers: renderer.layers()?, about };
        let mut line = Map::from_iter([("photons".to_owned(), photons.into()), ("alone".to_owned(), alone.into())]);
        line.extend(line::scale(&job.scene, bytes));
        line.extend(renderer.energy(&account)?.ratio.map(|kept| ("kept".to_owned(), kept.into())));
        line.extend(line::times(&timed.series[0]).map(|(name, value)| (name.to_owned(), value)));
        if let Some((mut error, more)) = self.judge(spec, picture, host, go_on)? {
            if let Some(flicker) = self.flicker(spec, &mut renderer, host, go_on)? {
                error["measures"]["flicker"] = line::measure(flicker);
            }
            line.insert("error".to_owned(), error);
            said.extend(more);
        }
        line.insert("warnings".to_owned(), said.into());
        Ok(line)
    }

    /// Of the frames that the sweep asks for, each against a truth of its own time.
    fn flicker(
        &self,
        spec: &Spec,
        renderer: &mut Renderer,
        host: &Host,
        go_on: GoOn,
    ) -> Result<Option<Measure>, LabError> {
        let Some(sequence) = self.sweep.flicker else { return Ok(None) };
        let (job, mut frames) = (&spec.job, Vec::new());
        for time in sequence.times() {
            let frame = Frame { time, ..Frame::default() };
            renderer.frame(&frame)?;
            let about = Provenance::new(job, &frame, self.gpu.info(), Vec::new()).attributes();
            frames.push(Picture { file: job.scene.name.clone(), layers: renderer.layers()?, about });
        }
        let truths = self.references(spec, &frames, host, go_on)?;
        Ok(lab::flicker(&frames, &truths, &self.sweep.layer)?)
    }

    /// The truths of pictures; one that two made at once would be made twice.
    fn references(
        &self,
        spec: &Spec,
        pictures: &[Picture],
        host: &Host,
        go_on: GoOn,
    ) -> Result<Vec<Arc<Picture>>, LabError> {
        let _making = host.making(&format!("truth-{}", spec.job.scene.source.hash), go_on)?;
        let auto = Auto { layer: &self.sweep.layer, seconds: self.sweep.seconds, store: &self.store };
        auto.references(pictures, &mut |_| go_on())
    }

    fn judge(
        &self,
        spec: &Spec,
        picture: Picture,
        host: &Host,
        go_on: GoOn,
    ) -> Result<Option<(Value, Vec<String>)>, LabError> {
        let layer = &self.sweep.layer;
        let pictures = [picture];
        let reference = match &spec.reference {
            Reference::None => return Ok(None),
            Reference::File { picture, .. } => picture.clone(),
            Reference::Auto => self.references(spec, &pictures, host, go_on)?.remove(0),
        };
        let comparison = lab::compare(&pictures[0], &reference, layer)?;
        Ok(Some((line::error(&comparison), comparison.warnings)))
    }
}
