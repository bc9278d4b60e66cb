//! A model of the maps: histories of a small world, drawn into simulated maps.
//!
//! A simulated map has a sample every 128 texels of its layer, which holds the set of casters that were drawn
//! there. Each frame's plan is executed on it: clears, restored parts, regions. A cached map must then hold
//! all current static casters, and the visible moving casters. A map that is drawn for one frame must hold
//! the visible casters. A waiting map must not hold static casters that are gone.

use std::sync::LazyLock;

use shadowfit::cache::{
    CacheFrame, CacheSettings, Casters, Culling, FramePlan, InView, Layer, MapCache, MapReuse, PassPlan, UpdateSchedule,
};
use shadowfit::culling::Reader;
use shadowfit::glam::{DVec3, IVec2, UVec2, Vec3, Vec4};
use shadowfit::scroll::TexelRect;
use shadowfit::settings::CasterPolicy;
use shadowfit::{Aabb, Boxes, CasterVolume, FittedMap, StaticBoxes};

use super::fixtures::{SIDE, fitted};

/// Number of maps: the finest windows.
const MAPS: usize = 3;

/// Samples along a side of a map.
pub(crate) const SAMPLES: u32 = 16;

/// Position of the world.
const PLACE: DVec3 = DVec3::new(3000.0, 10.0, -2000.0);

const LIGHTS: [Vec3; 3] = [Vec3::new(0.45, -0.8, 0.3), Vec3::new(0.4, -0.8, 0.35), Vec3::new(-0.6, -0.5, 0.1)];

/// The maps of each light, for two distances, at the world's position.
static FITTED: LazyLock<[[[FittedMap; MAPS]; 2]; 3]> = LazyLock::new(|| {
    let boxes = [Aabb::new(Vec3::new(-90.0, -1.0, -90.0), Vec3::new(90.0, 12.0, 90.0))];
    let maps = |light, far| {
        let maps = fitted(light, far, &boxes);
        core::array::from_fn(|index| placed(&maps[index]))
    };
    LIGHTS.map(|light| [40.0, 60.0].map(|far| maps(light, far)))
});

/// Moves a map from the world's origin to the world's position.
fn placed(map: &FittedMap) -> FittedMap {
    let mut map = panned(map, PLACE);
    let toward_light = map.projection.light_from_world.transpose().z_axis.truncate().as_dvec3();
    let along = PLACE.dot(toward_light);
    map.projection.origin += toward_light * along;
    let grid_position = map.grid_position.as_mut().expect("a map on a grid");
    grid_position.depth = grid_position.depth.map(|depth| depth + along);
    map
}

/// Moves a map on its grid, by metres.
fn panned(map: &FittedMap, by: DVec3) -> FittedMap {
    let mut map = *map;
    let grid_position = map.grid_position.as_mut().expect("a map on a grid");
    let rows = map.projection.light_from_world.transpose();
    for (axis, row) in [rows.x_axis, rows.y_axis].into_iter().enumerate() {
        let row = row.truncate().as_dvec3();
        let texels = (by.dot(row) / grid_position.texel[axis]).round();
        grid_position.first[axis] += texels as i64;
        map.projection.origin += row * (texels * grid_position.texel[axis]);
    }
    map
}

/// A caster.
#[derive(Clone, Copy, Debug)]
struct Object {
    centre: DVec3,
    half: DVec3,
    key: u64,
    moves: bool,
    /// Its number in the tree of static casters, or `None` if it is in the list.
    stands: Option<u32>,
    /// Number of the bit that represents its shape at its position.
    bit: u32,
}

/// A change before a frame. Numbers of objects wrap around.
#[derive(Clone, Debug)]
pub(crate) enum Event {
    Nothing,
    Insert(usize, [f64; 3]),
    /// Inserts a copy of another object.
    Copy(usize, usize),
    Remove(usize),
    SwapRemove(usize),
    RemoveFrom(usize),
    Reverse,
    Rotate(usize),
    SortByPlace,
    Place(usize, [f64; 3]),
    PlaceAll(f64),
    /// Gives an object another shape in the same box.
    Reshape(usize),
    /// Sets how many thirds of the casters have keys.
    Keys(usize),
    Moves(usize),
    /// Moves an object from the list into the tree, or back.
    Stand(usize),
    NewTree,
    Schedule(UpdateSchedule),
    Light(usize),
    Distance(usize),
    Pan([f64; 2]),
    /// Sets the visible volume: everything, or the half space that begins in a direction (radians) at a
    /// distance (metres).
    View(Option<[f32; 2]>),
    Invalidate(usize),
    InvalidateAll,
}

/// Returns whether an object is at a position, where an equal box represents an equal shape.
fn is_there(object: &Object, centre: DVec3) -> bool {
    (object.centre - centre).length() < 0.01
}

/// The casters that a sample holds: a bit for each of the last 128 static casters, and for each position in
/// the last frames of moving casters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Sample {
    fixed: u128,
    moving: u128,
}

type Samples = Vec<Sample>;

/// A world, its maps, and their contents.
pub(crate) struct World {
    objects: Vec<Object>,
    tree: StaticBoxes,
    bits: u32,
    keys: u64,
    /// Number of thirds of the casters that have keys.
    keyed: usize,
    were_keyed: usize,
    light: usize,
    distance: usize,
    place: DVec3,
    view: Option<[f32; 2]>,
    frame: u32,
    cache: MapCache,
    shown: [Samples; MAPS],
    fixed: [Samples; MAPS],
    /// Position of each sample in its square of texels.
    jitter: UVec2,
}

impl World {
    pub(crate) fn new(settings: CacheSettings, jitter: UVec2) -> Self {
        let samples = || vec![Sample::default(); (SAMPLES * SAMPLES) as usize];
        let mut world = Self {
            objects: Vec::new(),
            tree: StaticBoxes::new(PLACE),
            bits: 0,
            keys: 0,
            keyed: 0,
            were_keyed: 0,
            light: 0,
            distance: 0,
            place: PLACE,
            view: None,
            frame: 0,
            cache: MapCache::new(settings),
            shown: core::array::from_fn(|_| samples()),
            fixed: core::array::from_fn(|_| samples()),
            jitter,
        };
        world.insert(0, DVec3::new(0.0, -0.5, 0.0), DVec3::new(80.0, 0.5, 80.0));
        for i in 0..12 {
            let i = f64::from(i);
            world.insert(0, DVec3::new(7.0 * i - 40.0, 1.0, -4.0 * i), DVec3::new(1.0, 1.0 + 0.1 * i, 1.5));
        }
        world
    }

    fn insert(&mut self, at: usize, centre: DVec3, half: DVec3) {
        self.keys += 1;
        let bit = self.next_bit();
        self.objects
            .insert(at, Object { centre: PLACE + centre, half, key: self.keys, moves: false, stands: None, bit });
    }

    fn next_bit(&mut self) -> u32 {
        self.bits += 1;
        self.bits % 128
    }

    /// Returns the index of an object. The ground is never removed.
    fn number(&self, number: usize) -> usize {
        number % self.objects.len()
    }

    #[expect(clippy::too_many_lines, reason = "a line or two for each event")]
    pub(crate) fn change(&mut self, event: &Event) {
        let at = |place: &[f64; 3]| (DVec3::from_array(*place), DVec3::new(0.4 + place[1], place[1], 1.2));
        self.were_keyed = self.keyed;
        match event {
            Event::Nothing => {}
            // The last object is never removed.
            Event::Remove(_) | Event::SwapRemove(_) if self.objects.len() == 1 => {}
            Event::Insert(number, place) => {
                let (centre, half) = at(place);
                self.insert(self.number(*number), centre, half);
            }
            Event::Copy(of, number) => {
                let mut copy = Object { stands: None, ..self.objects[self.number(*of)] };
                if self.frame.is_multiple_of(2) {
                    self.keys += 1;
                    copy.key = self.keys;
                }
                self.objects.insert(self.number(*number), copy);
            }
            Event::Remove(number) => drop(self.objects.remove(self.number(*number))),
            Event::SwapRemove(number) => drop(self.objects.swap_remove(self.number(*number))),
            Event::RemoveFrom(number) => self.objects.truncate(self.number(*number).max(4)),
            Event::Reverse => self.objects.reverse(),
            Event::Rotate(number) => {
                let by = self.number(*number);
                self.objects.rotate_left(by);
            }
            Event::SortByPlace => self.objects.sort_by(|a, b| a.centre.x.total_cmp(&b.centre.x)),
            Event::Place(number, place) => {
                let (bit, number) = (self.next_bit(), self.number(*number));
                let (centre, half) = at(place);
                let object = &mut self.objects[number];
                if !is_there(object, PLACE + centre) {
                    (object.centre, object.half, object.bit) = (PLACE + centre, half, bit);
                }
            }
            Event::PlaceAll(by) => {
                let before = self.objects.clone();
                for number in 0..self.objects.len() {
                    let object = &mut self.objects[number];
                    object.centre.x += by;
                    let Object { centre, half, .. } = *object;
                    let former = before.iter().find(|former| former.half == half && is_there(former, centre));
                    self.objects[number].bit = former.map_or_else(|| self.next_bit(), |former| former.bit);
                }
            }
            Event::Reshape(number) => {
                let (bit, number) = (self.next_bit(), self.number(*number));
                self.keys += 1;
                let object = &mut self.objects[number];
                (object.bit, object.key) = (bit, self.keys);
                // Without a key in this frame and the previous one, the cache cannot detect the change.
                if self.keyed < 3 || self.were_keyed < 3 || object.stands.is_some() {
                    self.invalidate(number);
                }
            }
            Event::Keys(thirds) => self.keyed = *thirds,
            Event::Moves(number) => {
                let (bit, number) = (self.next_bit(), self.number(*number));
                let object = &mut self.objects[number];
                if object.stands.is_none() {
                    (object.moves, object.bit) = (!object.moves, bit);
                }
            }
            Event::Stand(number) => {
                let number = self.number(*number);
                let object = &mut self.objects[number];
                object.stands = match object.stands.take().and_then(|number| self.tree.remove(number)) {
                    Some(_) => None,
                    None => Some(self.tree.insert(Aabb::EMPTY).expect("a box")),
                };
                object.moves = false;
            }
            Event::NewTree => {
                self.tree = StaticBoxes::new(self.place);
                for object in self.objects.iter_mut().rev().filter(|object| object.stands.is_some()) {
                    object.stands = Some(self.tree.insert(Aabb::EMPTY).expect("a box"));
                }
            }
            Event::Schedule(schedule) => self.cache.settings.schedule = *schedule,
            Event::Light(light) => self.light = *light,
            Event::Distance(distance) => self.distance = *distance,
            Event::Pan([x, z]) => self.place += DVec3::new(*x, 0.01 * x, *z),
            Event::View(view) => self.view = *view,
            Event::Invalidate(number) => self.invalidate(self.number(*number)),
            Event::InvalidateAll => self.cache.invalidate_all(),
        }
        for object in self.objects.iter_mut().filter(|object| object.moves) {
            object.centre.y += if self.frame.is_multiple_of(2) { 0.3 } else { -0.3 };
        }
        self.tell_tree();
        self.frame += 1;
    }

    /// Updates the tree with moved and removed boxes.
    fn tell_tree(&mut self) {
        let mut numbers = Vec::new();
        self.tree.for_each(|number, _| numbers.push(number));
        for number in
            numbers.into_iter().filter(|number| self.objects.iter().all(|object| object.stands != Some(*number)))
        {
            self.tree.remove(number);
        }
        for object in &self.objects {
            if let Some(number) = object.stands {
                self.tree.set(number, object.aabb(self.tree.origin())).expect("a good box");
            }
        }
    }

    fn invalidate(&mut self, number: usize) {
        self.cache.invalidate(&self.objects[number].aabb(self.place), self.place);
    }

    /// Returns the volume of casters that can shadow visible points.
    fn in_view(&self) -> CasterVolume {
        let mut volume = CasterVolume::everywhere(self.place);
        if let Some([angle, from]) = self.view.filter(|_| self.cache.settings.culling == Culling::Swept) {
            (volume.planes[0], volume.count) = (Vec4::new(angle.cos(), 0.0, angle.sin(), -from), 1);
        }
        volume
    }

    /// Executes the plan of a frame, and checks the contents of the maps.
    ///
    /// # Errors
    ///
    /// Describes a wrong content of a map.
    pub(crate) fn draw(&mut self) -> Result<(), String> {
        let maps: Vec<FittedMap> =
            FITTED[self.light][self.distance].iter().map(|map| panned(map, self.place - PLACE)).collect();
        // Boxes relative to a moving origin: their rounding differs in each frame.
        let listed: Vec<Object> = self.objects.iter().filter(|object| object.stands.is_none()).copied().collect();
        let boxes: Vec<Aabb> = listed.iter().map(|object| object.aabb(self.place)).collect();
        let moves: Vec<bool> = listed.iter().map(|object| object.moves).collect();
        let keyed = listed.iter().take(listed.len() * self.keyed / 3);
        let keys: Vec<u64> = keyed.map(|object| object.key).collect();
        let boxes = Boxes { origin: self.place, boxes: &boxes };
        let casters = Casters { boxes, moves: &moves, keys: &keys };
        let in_view = [self.in_view(); MAPS];
        let frame = CacheFrame {
            maps: &maps,
            casters,
            static_boxes: (listed.len() < self.objects.len()).then_some(&self.tree),
            direction: LIGHTS[self.light],
            reader: Reader::from_eye(self.place, Vec3::NEG_Z),
            in_view: InView::Volumes(&in_view),
        };
        let plan = self.cache.update(&frame).map_err(|error| error.to_string())?.clone();
        for pass in &plan.passes {
            self.carry_out(&plan, pass, &listed);
        }
        (0..MAPS).try_for_each(|index| self.compare(index))
    }

    /// Draws a pass into the samples of its layer.
    fn carry_out(&mut self, plan: &FramePlan, pass: &PassPlan, listed: &[Object]) {
        let map = &plan.maps[pass.map];
        let samples = |part: TexelRect| samples_in(part, self.jitter);
        let [shown, fixed] = [&mut self.shown[pass.map], &mut self.fixed[pass.map]];
        if pass.layer == Layer::Shown {
            for index in plan.rects[pass.mended.clone()].iter().flat_map(|rect| samples(*rect)) {
                shown[index] = fixed[index];
            }
        }
        for aabb in &plan.boxes[pass.mended_boxes.clone()] {
            let rect = covered(map, aabb, self.place);
            for part in rect
                .stored(map.texel_offset, pass.size)
                .filter(|part| plan.viewports[pass.viewports.clone()].contains(&part.viewport()))
            {
                samples(part.stored).for_each(|index| shown[index] = fixed[index]);
            }
        }
        let layer = if pass.layer == Layer::Shown { shown } else { fixed };
        if pass.clears {
            layer.fill(Sample::default());
        }
        for rect in &plan.rects[pass.cleared.clone()] {
            samples(*rect).for_each(|index| layer[index] = Sample::default());
        }
        let volume = CasterVolume::of_map(&map.projection, CasterPolicy::DepthClamp).relative_to(self.place);
        for region in plan.regions_of(pass) {
            let static_boxes = |number: &u32| self.objects.iter().find(|object| object.stands == Some(*number));
            let casters = plan.casters_of(region).iter().map(|number| &listed[*number as usize]);
            let static_boxes =
                plan.static_boxes_of(region).iter().map(|number| static_boxes(number).expect("it stands"));
            for object in casters.chain(static_boxes) {
                let aabb = object.aabb(self.place);
                // The GPU clips casters outside the map, such as beyond its far plane.
                if self.cache.settings.culling != Culling::Off && !volume.intersects_aabb(aabb.min, aabb.max) {
                    continue;
                }
                let (rect, viewport) = (covered(map, &aabb, self.place), region.part.viewport());
                let min = rect.min.as_ivec2() + viewport;
                let [min, end] = [min, min + rect.size.as_ivec2()].map(|corner| corner.max(IVec2::ZERO).as_uvec2());
                let drawn = TexelRect { min, size: end - min }.intersection(region.part.stored);
                samples(drawn).for_each(|index| layer[index] = layer[index].with(object.sample(self.frame)));
            }
        }
    }

    /// Compares the contents of a map with the current casters.
    fn compare(&self, index: usize) -> Result<(), String> {
        let (map, waits) = (&self.cache.plan().maps[index], self.cache.plan().reuse[index] == MapReuse::Waits);
        let (size, wrap) = (map.projection.resolution, map.texel_offset);
        let volume = CasterVolume::of_map(&map.projection, CasterPolicy::DepthClamp).relative_to(self.place);
        let (in_view, is_kept) = (self.in_view(), self.cache.is_kept(index));
        let mut expected = vec![Sample::default(); self.shown[index].len()];
        for object in &self.objects {
            let aabb = object.aabb(self.place);
            if self.cache.settings.culling != Culling::Off && !volume.intersects_aabb(aabb.min, aabb.max) {
                continue;
            }
            let is_needed = (is_kept && !object.moves) || in_view.intersects_aabb(aabb.min, aabb.max);
            if !is_needed && !waits {
                continue;
            }
            let parts = covered(map, &aabb, self.place).stored(wrap, size);
            for at in parts.flat_map(|part| samples_in(part.stored, self.jitter)) {
                expected[at] = expected[at].with(object.sample(self.frame));
            }
        }
        for (at, (held, expected)) in self.shown[index].iter().zip(&expected).enumerate() {
            let is_right = if waits { held.fixed & !expected.fixed == 0 } else { held == expected };
            if !is_right {
                let frame = self.frame;
                return Err(format!(
                    "frame {frame}, map {index}, sample {at}: {held:x?}, not {expected:x?}; waits: {waits}"
                ));
            }
        }
        Ok(())
    }
}

impl Object {
    fn aabb(&self, origin: DVec3) -> Aabb {
        let (centre, half) = ((self.centre - origin).as_vec3(), self.half.as_vec3());
        Aabb::new(centre - half, centre + half)
    }

    /// Returns the bit of the object in a sample.
    fn sample(&self, frame: u32) -> Sample {
        if self.moves {
            // A moving caster is elsewhere in the next frame.
            Sample { fixed: 0, moving: 1 << ((self.bit + frame * 41) % 128) }
        } else {
            Sample { fixed: 1 << self.bit, moving: 0 }
        }
    }
}

impl Sample {
    fn with(self, other: Self) -> Self {
        Self { fixed: self.fixed | other.fixed, moving: self.moving | other.moving }
    }
}

/// Returns the samples in a rectangle of a layer.
fn samples_in(rect: TexelRect, jitter: UVec2) -> impl Iterator<Item = usize> {
    let step = SIDE / SAMPLES;
    let index = |texel: u32, jitter: u32| (texel + step - 1).saturating_sub(jitter) / step;
    let end = rect.min + rect.size;
    let columns = index(rect.min.x, jitter.x)..index(end.x, jitter.x).min(SAMPLES);
    let rows = index(rect.min.y, jitter.y)..index(end.y, jitter.y).min(SAMPLES);
    rows.flat_map(move |row| columns.clone().map(move |column| (row * SAMPLES + column) as usize))
}

/// Returns the texels whose centres a box covers.
fn covered(map: &FittedMap, aabb: &Aabb, origin: DVec3) -> TexelRect {
    let projection = &map.projection;
    let (scale, size) = (projection.resolution.as_dvec2(), projection.resolution);
    let rows = projection.uv_from_world.transpose();
    let [low, high] = [rows.x_axis, rows.y_axis].map(|row| {
        let (normal, centre) = (row.truncate().as_dvec3(), (aabb.min + aabb.max).as_dvec3() * 0.5);
        let half = (aabb.max - aabb.min).as_dvec3() * 0.5;
        let [at, reach] = [normal.dot(centre + origin - projection.origin) + f64::from(row.w), normal.abs().dot(half)];
        [at - reach, at + reach]
    });
    let texel = |at: f64, scale: f64, size: u32| (at * scale + 0.5).floor().clamp(0.0, f64::from(size)) as u32;
    let min = UVec2::new(texel(low[0], scale.x, size.x), texel(high[0], scale.y, size.y));
    let end = UVec2::new(texel(low[1], scale.x, size.x), texel(high[1], scale.y, size.y));
    TexelRect { min, size: end.saturating_sub(min) }
}
