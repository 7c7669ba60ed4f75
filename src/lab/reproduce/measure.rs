//! The runs: one renderer a variant and N, as many as time and memory allow, timed in rounds, then judged.

use std::{
    cell::Cell,
    collections::BTreeMap,
    ops::ControlFlow,
    sync::Arc,
    time::{Duration, Instant},
};

use super::{
    Extent, Watch,
    asked::{Asked, Place},
    columns::{self, Part, Variant},
    subject::Subject,
};
use crate::{
    gpu::{Gpu, GpuError, Sources},
    image::Layers,
    lab::{
        Auto, LabError, Picture, Provenance,
        compare::{fitted_figure, judged_figure},
        exposure,
        papers::Published,
        timing::{self, Beat, Rounds, Timed},
    },
    methods,
    metrics::{Fitted, Measure},
    renderer::{self, Frame, Job, Providers, RenderError, Renderer},
    scene::Scene,
    store::Store,
    truth::{
        backward::{self, Beam, Useful},
        trace::Space,
    },
};

/// The layer that is judged.
const LAYER: &str = "irradiance.caustic";
/// Frames before timing begins, at most.
const MOST_WARMUP: u32 = 8;
/// Of the device's memory that all renderers together may take.
const MEMORY: f64 = 0.5;
const SEED: u64 = 1;
/// Rays backward from the floor, of a quick run and of a whole one.
const RAYS: [u64; 2] = [1 << 17, 1 << 24];
/// s: no machine waits as long, and any clock can add it.
const LONGEST: f64 = 1e9;
/// Place of the photons that arrived in an account.
const VALID: usize = 1;

/// One variant at one N, timed and judged.
#[derive(Clone, Debug)]
pub struct Measured {
    pub variant: Variant,
    pub side: u32,
    pub stages: Vec<String>,
    /// Photons that arrived, of those emitted, and their share of the flux; of a method that shoots any.
    pub valid: Option<[f64; 2]>,
    /// Photons emitted.
    pub emitted: u64,
    /// Points that each stage of gathering draws, where it draws points: those of every step of a traversal among them.
    pub counts: Vec<(String, u64)>,
    /// Invocations of each stage that computes, fragments of each that draws.
    pub work: Vec<(String, u64)>,
    /// Of its scene.
    pub triangles: u64,
    /// Flux in the map over the flux that arrived in it.
    pub kept: Option<f64>,
    /// Of the picture; none before it was judged.
    pub relmse: Option<Measure>,
    /// The same with the scale that fits best, of a picture that is right only up to one.
    pub fitted: Option<Fitted>,
    pub layers: Layers,
    /// For its PNG, EV.
    pub exposure_ev: f64,
    pub provenance: Provenance,
}

/// Everything that was run.
pub struct Run {
    pub all: Vec<Measured>,
    /// In the order of `all`, whose last, that no figure asks a time of, are not in it.
    pub timed: Timed,
    /// N that were not run, and why.
    pub left_out: LeftOut,
    pub reference: String,
    /// Of rays backward, where the table asks for them.
    pub useful: Vec<(Beam, Useful)>,
    pub warnings: Vec<String>,
}

impl Run {
    /// Where a variant is among the measured.
    ///
    /// # Errors
    /// Why it is not.
    pub fn find(&self, Place { variant, side, .. }: Place) -> Result<usize, String> {
        self.all.iter().position(|m| m.variant == variant && m.side == side).ok_or_else(|| self.why(side))
    }

    /// Why an N was not run.
    pub fn why(&self, side: u32) -> String {
        let why = self.left_out.iter().find(|(n, _)| *n == side).map(|(_, why)| why.clone());
        why.unwrap_or_else(|| "was not run".to_owned())
    }
}

impl Measured {
    /// Points that gathering draws in all, where it draws points.
    pub fn points(&self) -> Option<u64> {
        self.counts.iter().map(|(_, points)| *points).reduce(|a, b| a + b)
    }
}

/// N that are not run, and why.
type LeftOut = Vec<(u32, String)>;

struct Ready {
    variant: Variant,
    side: u32,
    job: Job,
    renderer: Renderer,
}

pub fn run(gpu: &Gpu, store: &Store, published: &Published, extent: &Extent, watch: Watch) -> Result<Run, LabError> {
    let started = Instant::now();
    let late = |seconds: f64| started + Duration::from_secs_f64(seconds.min(LONGEST));
    let wanted = Wanted::of(published);
    let (mut ready, left_out) = prepare(gpu, &wanted, extent, watch)?;
    ready.sort_by_key(|ready| !wanted.is_timed(ready.variant, ready.side));
    let count = ready.iter().filter(|ready| wanted.is_timed(ready.variant, ready.side)).count();
    let frames = count as u32 * extent.rounds;
    let say = format!("timing {count} variants, {frames} frames, on {}", gpu.info().label());
    let rounds = Rounds {
        rounds: extent.rounds,
        most_warmup: MOST_WARMUP,
        least_warmup: timing::least_warmup(gpu.info()),
        seed: SEED,
        until: Some(late(extent.seconds)),
    };
    let timed = time(&mut ready[..count], rounds, &mut |first| watch(if first { &say } else { "" }))?;
    let mut warnings = timed.warnings(f64::from(gpu.info().timestamp_period) * 1e-6);
    warnings.extend(cut_short(&timed, extent));
    let all = ready.into_iter().map(|ready| read(gpu, ready)).collect::<Result<Vec<_>, _>>()?;
    let (pictures, mut all): (Vec<Picture>, Vec<Measured>) = all.into_iter().unzip();
    let mut begun = false;
    let left = late(extent.seconds + extent.truth_seconds).saturating_duration_since(Instant::now()).as_secs_f64();
    let seconds = extent.truth_seconds.min(left);
    let judged: Vec<usize> = (0..all.len()).filter(|at| all[*at].variant.is_judged()).collect();
    let pictures: Vec<Picture> =
        pictures.into_iter().zip(&all).filter(|(_, m)| m.variant.is_judged()).map(|(p, _)| p).collect();
    let references = Auto { layer: LAYER, seconds, store }.references(&pictures, &mut |_| {
        let first = !std::mem::replace(&mut begun, true);
        watch(if first { "making the truth that the pictures are judged by" } else { "" })
    })?;
    for ((at, picture), truth) in judged.into_iter().zip(&pictures).zip(&references) {
        all[at].relmse = Some(judged_figure(picture, truth, LAYER)?);
        all[at].fitted = fitted_figure(picture, truth, LAYER)?;
    }
    let reference = references.first().map(|truth| truth.file.clone()).unwrap_or_default();
    let useful = useful(published, extent)?;
    Ok(Run { all, timed, left_out, reference, useful, warnings })
}

/// The rays backward that a table asks for, of the paper's water.
fn useful(published: &Published, extent: &Extent) -> Result<Vec<(Beam, Useful)>, LabError> {
    let asked = published.figures.iter().filter_map(|figure| columns::asked(published, figure).ok());
    let beams = asked.filter_map(|asked| if let Asked::Claim(claim) = asked { claim.beam() } else { None });
    let mut beams: Vec<Beam> = beams.collect();
    beams.dedup();
    if beams.is_empty() {
        return Ok(Vec::new());
    }
    let scene = Subject::Water.load()?;
    let (space, rays) = (Space::new(&scene), RAYS[usize::from(!extent.quick)]);
    Ok(beams.into_iter().map(|beam| (beam, backward::useful(&space, beam, rays, SEED))).collect())
}

/// Fewer rounds than were asked for.
fn cut_short(timed: &Timed, extent: &Extent) -> Option<String> {
    let (done, asked) = (timed.rounds(), extent.rounds);
    let remedy = if extent.quick { "leave --quick out" } else { "raise --max-seconds" };
    (done < asked).then(|| {
        format!("the time was up after {done} of {asked} rounds: figures are of those, their intervals wide; {remedy}")
    })
}

/// The account and the picture of the frame that was timed.
fn read(gpu: &Gpu, ready: Ready) -> Result<(Picture, Measured), LabError> {
    let Ready { variant, side, job, mut renderer } = ready;
    let frame = Frame { time: variant.subject.judged(), ..Frame::default() };
    renderer.frame(&frame)?;
    let account = renderer.account()?;
    let kept = renderer.energy(&account)?.ratio;
    let layers = renderer.layers()?;
    let provenance = Provenance::new(&job, &frame, gpu.info(), Vec::new());
    let counters = renderer.counters(&frame)?;
    let work = counters.iter().filter_map(|(stage, c)| Some((stage.clone(), c.fragments.or(c.invocations)?))).collect();
    let counts = counters.iter().filter(|(stage, _)| Part::Gather.holds(stage));
    let counts = counts.filter_map(|(stage, c)| Some((stage.clone(), c.points?))).collect();
    let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    let emitted = account.emitted();
    let photons = share(account.counts[VALID] as f64, emitted as f64);
    let valid = job.providers.shoot().then(|| [photons, share(account.valid_w(), account.emitted_w())]);
    let exposure_ev = exposure(&job.settings, &job.scene);
    let picture = Picture { file: variant.name(), layers: layers.clone(), about: provenance.attributes() };
    Ok((
        picture,
        Measured {
            variant,
            side,
            stages: renderer.stages(),
            valid,
            emitted,
            counts,
            work,
            triangles: job.scene.triangles(),
            kept,
            relmse: None,
            fitted: None,
            layers,
            exposure_ev,
            provenance,
        },
    ))
}

/// What a table wants.
struct Wanted {
    /// Its N, rising, and the variants at each.
    sides: BTreeMap<u32, Vec<Variant>>,
    timed: Vec<Place>,
}

impl Wanted {
    fn of(published: &Published) -> Self {
        let (mut sides, mut timed): (BTreeMap<u32, Vec<Variant>>, _) = Default::default();
        for asked in published.figures.iter().filter_map(|figure| columns::asked(published, figure).ok()) {
            for Place { variant, side, .. } in asked.places() {
                let variants = sides.entry(side).or_default();
                if !variants.contains(&variant) {
                    variants.push(variant);
                }
            }
            Vec::extend(&mut timed, asked.timed());
        }
        Self { sides, timed }
    }

    fn is_timed(&self, variant: Variant, side: u32) -> bool {
        self.timed.iter().any(|place| place.variant == variant && place.side == side)
    }

    /// Frames of a variant at most, without its first.
    fn frames(&self, variant: Variant, side: u32, extent: &Extent) -> f64 {
        if self.is_timed(variant, side) { f64::from(extent.rounds + MOST_WARMUP) } else { 2.0 }
    }
}

/// Scenes read so far.
type Scenes = Vec<(Subject, Arc<Scene>)>;

fn scene(scenes: &mut Scenes, subject: Subject) -> Result<Arc<Scene>, LabError> {
    if let Some((_, scene)) = scenes.iter().find(|(known, _)| *known == subject) {
        return Ok(scene.clone());
    }
    let scene = Arc::new(subject.load()?);
    scenes.push((subject, scene.clone()));
    Ok(scene)
}

/// Renderers for every N that fits, smallest first, and why others do not.
fn prepare(gpu: &Gpu, wanted: &Wanted, extent: &Extent, watch: Watch) -> Result<(Vec<Ready>, LeftOut), LabError> {
    let (mut ready, mut left_out, mut scenes) = (Vec::new(), Vec::new(), Vec::new());
    let started = Instant::now();
    let (mut frames_s, mut last, mut bytes) = (0.0, 0.0, 0);
    for (&side, variants) in &wanted.sides {
        let frames = |variant: &Variant| wanted.frames(*variant, side, extent);
        let growth: f64 = variants.iter().map(|variant| frames(variant) * variant.growth()).sum();
        let ahead = started.elapsed().as_secs_f64() + frames_s + growth * last;
        let too_large = format!("--quick takes N up to {}", extent.most_side);
        let why = if side > extent.most_side {
            Some(too_large)
        } else if ahead > extent.seconds {
            let seconds = extent.seconds;
            Some(format!("frames would take some {ahead:.0} s in all, and there are {seconds:.0} s (--max-seconds)"))
        } else {
            let names: Vec<_> = variants.iter().map(|variant| variant.at(side)).collect();
            if watch(&format!("preparing {}", names.join("; "))).is_break() {
                return Err(LabError::Interrupted);
            }
            match of_side(gpu, &mut scenes, (side, variants), extent, bytes)? {
                Ok((made, taken, each_s)) => {
                    ready.extend(made);
                    (bytes, last) = (taken, each_s.iter().sum::<f64>() / variants.len() as f64);
                    frames_s += variants.iter().zip(each_s).map(|(variant, s)| frames(variant) * s).sum::<f64>();
                    None
                }
                Err(why) => Some(why),
            }
        };
        left_out.extend(why.map(|why| (side, why)));
    }
    Ok((ready, left_out))
}

/// Renderers of one N, the bytes that all take then, and what a frame of each takes, s; or why it does not fit.
type OfSide = Result<(Vec<Ready>, u64, Vec<f64>), String>;

fn of_side(
    gpu: &Gpu,
    scenes: &mut Scenes,
    (side, variants): (u32, &[Variant]),
    extent: &Extent,
    mut bytes: u64,
) -> Result<OfSide, LabError> {
    let (mut made, mut seconds) = (Vec::new(), Vec::new());
    for &variant in variants {
        let settings = variant.settings(side).expect("the settings of a variant are shipped ones: a test runs them");
        let job = Job {
            scene: scene(scenes, variant.subject)?,
            providers: Providers::of(methods::find(variant.method()).map_err(RenderError::from)?),
            settings,
            camera: "region".to_owned(),
            size: variant.size(extent.size),
        };
        let planned = renderer::plan(&job)?;
        bytes += planned.plan.bytes();
        let memory = (MEMORY * gpu.info().memory_bytes as f64) as u64;
        if bytes > memory {
            return Ok(Err(format!(
                "takes {bytes} bytes with the smaller N, and {memory} are at most taken of the device"
            )));
        }
        let mut renderer = match Renderer::planned(gpu, &job, planned, Sources::default()) {
            Err(RenderError::Gpu(GpuError::TooLarge { name, text })) => return Ok(Err(format!("{name}: {text}"))),
            other => other?,
        };
        renderer.frame(&Frame::default())?; // the first one compiles, where drivers put that off
        let start = Instant::now();
        renderer.frame(&Frame::default())?;
        seconds.push(start.elapsed().as_secs_f64());
        made.push(Ready { variant, side, job, renderer });
    }
    Ok(Ok((made, bytes, seconds)))
}

fn time(
    ready: &mut [Ready],
    rounds: Rounds,
    watch: &mut dyn FnMut(bool) -> ControlFlow<()>,
) -> Result<Timed, LabError> {
    let now = Cell::new(0); // every variant renders the same moment in a round
    let mut list = Vec::new();
    for ready in ready {
        let (now, subject) = (&now, ready.variant.subject);
        let name = ready.variant.at(ready.side);
        let stages = ready.renderer.stages();
        let frame = move || {
            let frame = Frame { time: subject.time(now.get(), rounds.rounds), ..Frame::default() };
            Ok(ready.renderer.frame(&frame)?)
        };
        list.push(timing::Variant { name, stages, frame: Box::new(frame) });
    }
    let mut begun = false;
    rounds.run(&mut list, &mut |beat| {
        if let Beat::Timed { round, .. } = beat {
            now.set(round);
        }
        watch(!std::mem::replace(&mut begun, true))
    })
}
