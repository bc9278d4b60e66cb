//! Progress of loading a scene: the elapsed time as a share of the expected time.
//!
//! The expected time of each phase is computed from the scene's size, with weights from measured scenes. The
//! speed of this machine is estimated from the previous phases. Within a phase, the clock moves the bar, up
//! to the start of the next one.

use web_time::Instant;

use shadowfit_scene::SceneSize;

use crate::platform::BusyBar;

/// Number of phases: reading the file, parsing it, decoding its contents, preparing the scene.
pub(super) const PHASES: usize = 4;
/// The last phase. All others are steps of loading a file.
pub(super) const READY: usize = PHASES - 1;

/// Estimates for a file whose JSON has not been parsed yet: bytes of JSON per node in files of many nodes,
/// bytes of buffers per triangle, and least number of triangles per node.
const JSON_A_NODE: u64 = 68;
const BYTES_A_TRIANGLE: u64 = 18;
const TRIANGLES_A_NODE: u64 = 12;

/// Least number of drawn triangles for scenes whose meshes are not cut. Their fits get a box per node.
const UNCUT: u64 = 6_000_000;
/// Number of parts into which the meshes of a smaller scene are cut for fits.
const CUT_INTO: f64 = 1024.0;

/// Time that is too short to estimate the speed of a machine, in seconds.
const TOO_SHORT: f64 = 0.004;

/// Returns the time of each phase on two cores of 2.5 GHz, in seconds. Weights are in nanoseconds per byte,
/// node or triangle.
pub(super) fn weights(size: &SceneSize) -> [f64; PHASES] {
    let guessed = guessed(size);
    let [file, json, nodes, triangles, drawn, images] =
        [guessed.file, guessed.json, guessed.nodes, guessed.triangles, guessed.drawn, guessed.images]
            .map(|amount| amount as f64 * 1e-9);
    let halvings = (CUT_INTO / guessed.nodes.max(1) as f64).log2().max(0.0);
    let cut = if guessed.drawn > UNCUT { 150.0 } else { 50.0 * halvings };
    [
        0.6 * file + 1e-4,
        12.0 * json + 1e-4,
        250.0 * nodes + 140.0 * triangles + 40.0 * images + 1e-4,
        1200.0 * nodes + (170.0 + cut) * drawn + 40.0 * images + 5e-3,
    ]
}

/// Returns the size of a scene, with estimates for its unknown parts.
fn guessed(size: &SceneSize) -> SceneSize {
    if size.nodes > 0 {
        return *size;
    }
    let json = if size.json > 0 { size.json } else { size.file / 2 };
    let triangles = size.file.saturating_sub(json) / BYTES_A_TRIANGLE;
    let nodes = json / JSON_A_NODE;
    SceneSize { json, nodes, triangles, drawn: triangles.max(nodes * TRIANGLES_A_NODE), ..*size }
}

/// Progress of loading a scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    weights: [f64; PHASES],
    phase: usize,
    /// Start times of the first phase and of this one.
    start: Instant,
    since: Instant,
    /// Share at the start of this phase. The share never falls below it.
    least: f32,
}

impl Progress {
    pub(super) fn new(now: Instant) -> Self {
        Self { weights: weights(&SceneSize::default()), phase: 0, start: now, since: now, least: 0.0 }
    }

    /// Starts a phase, with the currently known size of the scene.
    pub(super) fn begin(&mut self, phase: usize, size: Option<&SceneSize>, now: Instant) {
        self.least = self.share(now);
        self.weights = size.map_or(self.weights, weights);
        (self.phase, self.since) = (phase.min(READY), now);
    }

    /// Returns the elapsed share of the time, 0..=1.
    pub(super) fn share(&self, now: Instant) -> f32 {
        let [before, after] = [self.end_of(self.phase.checked_sub(1)), self.end_of(Some(self.phase))];
        // Duration relative to the machine of the weights.
        let spent = (self.since - self.start).as_secs_f64();
        let slowness = (spent + TOO_SHORT) / (before * self.sum() + TOO_SHORT);
        let expected = self.weights[self.phase] * slowness;
        let passed = ((now - self.since).as_secs_f64() / expected).clamp(0.0, 1.0);
        ((before + (after - before) * passed) as f32).max(self.least)
    }

    /// Returns the bar for the rest of this phase.
    pub(super) fn ahead(&self, now: Instant) -> BusyBar {
        let (share, end) = (self.share(now), self.end_of(Some(self.phase)) as f32);
        let spent = (self.since - self.start).as_secs_f64();
        let before = self.end_of(self.phase.checked_sub(1));
        let slowness = (spent + TOO_SHORT) / (before * self.sum() + TOO_SHORT);
        BusyBar { from: share, to: end.max(share), seconds: (self.weights[self.phase] * slowness) as f32 }
    }

    /// Returns the share at the end of a phase; 0 before the first.
    pub(super) fn end_of(&self, phase: Option<usize>) -> f64 {
        let done: f64 = phase.map_or(0.0, |phase| self.weights[..=phase].iter().sum());
        done / self.sum()
    }

    fn sum(&self) -> f64 {
        self.weights.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::time::Duration;

    use shadowfit_scene::load_gltf_with_progress;

    use super::*;

    /// Returns the reported steps and sizes while a generated file of `nodes` nodes is loaded, a triangle
    /// each.
    fn told(nodes: usize) -> Vec<(usize, SceneSize)> {
        let triangle: Vec<u8> =
            [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0].iter().flat_map(|x| x.to_le_bytes()).collect();
        let list = |item: &dyn Fn(usize) -> String| (0..nodes).map(item).collect::<Vec<_>>().join(",");
        let text = format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],"meshes":[{{"primitives":
            [{{"attributes":{{"POSITION":0}}}}]}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":
            "VEC3"}}],"bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"byteLength":36,"uri":"triangle.bin"}}]}}"#,
            list(&|node| node.to_string()),
            list(&|node| format!(r#"{{"mesh":0,"translation":[{node},0,0]}}"#)),
        );
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("nodes.gltf");
        std::fs::write(folder.path().join("triangle.bin"), triangle).expect("the buffer");
        std::fs::write(&file, text).expect("the scene");
        let told = RefCell::new(Vec::new());
        let tell = |step, size: &SceneSize| told.borrow_mut().push((step as usize, *size));
        load_gltf_with_progress(&file, None, &tell).expect("a scene");
        told.into_inner()
    }

    /// Returns the displayed shares at a thousand times, each with the share of the time. Each phase takes
    /// `slowness` times its weight.
    fn shown(told: &[(usize, SceneSize)], slowness: f64) -> Vec<(f64, f64)> {
        let [.., (_, size)] = told else { return Vec::new() };
        let took = weights(size).map(|seconds| seconds * slowness);
        let sum: f64 = took.iter().sum();
        let start = Instant::now();
        let at = |seconds: f64| start + Duration::from_secs_f64(seconds);
        let mut progress = Progress::new(start);
        let mut begun = 0;
        let times = (0..=1000).map(|step| f64::from(step) / 1000.0);
        let shares = times.map(|time| {
            while begun < PHASES && took[..begun].iter().sum::<f64>() <= time * sum {
                let (phase, size) = told.get(begun).map_or((READY, None), |(phase, size)| (*phase, Some(size)));
                progress.begin(phase, size, at(took[..begun].iter().sum()));
                begun += 1;
            }
            (f64::from(progress.share(at(time * sum))), time)
        });
        shares.collect()
    }

    #[test]
    fn the_phases_of_a_scene_have_the_stated_weights_and_the_bar_never_falls() {
        let told = told(2000);
        let (_, size) = told[2];
        assert_eq!((told.len(), size.nodes, size.triangles, size.drawn), (3, 2000, 1, 2000));
        let weights = weights(&size);
        let now = Instant::now();
        let mut progress = Progress::new(now);
        for (phase, size) in &told {
            progress.begin(*phase, Some(size), now);
        }
        for phase in 0..PHASES {
            let expected = weights[..=phase].iter().sum::<f64>() / weights.iter().sum::<f64>();
            assert!((progress.end_of(Some(phase)) - expected).abs() < 1e-12, "{phase}");
        }
        for slowness in [0.2, 1.0, 10.0] {
            let shares = shown(&told, slowness);
            assert!(shares.windows(2).all(|pair| pair[0].0 <= pair[1].0), "{slowness} times as long");
            let (last, _) = shares[1000];
            assert!(last <= 1.0 && (slowness < 1.0 || last > 0.999), "{last} at {slowness} times as long");
        }
    }

    #[test]
    fn the_bar_is_within_ten_points_of_the_time_on_machines_of_any_speed() {
        let bytes = |nodes: u64, triangles: u64| SceneSize {
            file: nodes * JSON_A_NODE + triangles * BYTES_A_TRIANGLE,
            json: nodes * JSON_A_NODE,
            ..SceneSize::default()
        };
        for (nodes, triangles, drawn) in
            [(100_000, 12, 1_200_000), (1, 1_000_000, 1_000_000), (1, 10_000_000, 10_000_000)]
        {
            let read = bytes(nodes, triangles);
            let unread = SceneSize { json: 0, ..read };
            let known = SceneSize { nodes, triangles, drawn, ..read };
            for slowness in [0.5, 1.0, 4.0] {
                let shares = shown(&[(0, unread), (1, read), (2, known)], slowness);
                let worst = shares.iter().map(|(shown, time)| (shown - time).abs()).fold(0.0, f64::max);
                assert!(worst < 0.1, "{worst} off with {nodes} nodes, {triangles} triangles, {slowness} times as long");
            }
        }
    }
}
