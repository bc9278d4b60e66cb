//! The plan as data: random histories of the world of the [model](super::model).

use proptest::prelude::*;
use proptest::sample::select;

use shadowfit::cache::{CacheSettings, Culling, UpdateSchedule};
use shadowfit::glam::UVec2;

use super::fixtures::{SIDE, settings};
use super::model::{Event, SAMPLES, World};

fn place() -> impl Strategy<Value = [f64; 3]> {
    [-40.0..40.0, 0.2..4.0, -60.0..20.0]
}

fn event() -> impl Strategy<Value = Event> {
    let number = any::<usize>;
    let schedules =
        [UpdateSchedule::EveryFrame, UpdateSchedule::Every([1, 2, 5, 1, 1, 1, 1, 1]), UpdateSchedule::Texels(9000)];
    prop_oneof![
        3 => Just(Event::Nothing),
        3 => (number(), place()).prop_map(|(at, place)| Event::Insert(at, place)),
        1 => (number(), number()).prop_map(|(of, at)| Event::Copy(of, at)),
        2 => number().prop_map(Event::Remove),
        2 => number().prop_map(Event::SwapRemove),
        1 => number().prop_map(Event::RemoveFrom),
        1 => Just(Event::Reverse),
        1 => number().prop_map(Event::Rotate),
        1 => Just(Event::SortByPlace),
        2 => (number(), place()).prop_map(|(number, place)| Event::Place(number, place)),
        1 => (0.2..2.0).prop_map(Event::PlaceAll),
        2 => number().prop_map(Event::Reshape),
        1 => (0..4_usize).prop_map(Event::Keys),
        2 => number().prop_map(Event::Moves),
        3 => number().prop_map(Event::Stand),
        1 => Just(Event::NewTree),
        1 => select(schedules.to_vec()).prop_map(Event::Schedule),
        1 => (0..3_usize).prop_map(Event::Light),
        1 => (0..2_usize).prop_map(Event::Distance),
        3 => [-6.0..6.0, -6.0..6.0].prop_map(Event::Pan),
        2 => proptest::option::weighted(0.8, [0.0..7.0_f32, -30.0..20.0_f32]).prop_map(Event::View),
        1 => number().prop_map(Event::Invalidate),
        1 => Just(Event::InvalidateAll),
    ]
}

fn any_settings() -> impl Strategy<Value = CacheSettings> {
    let culling = select(vec![Culling::Swept, Culling::WholeMap, Culling::Off]);
    (culling, 0..10_u32).prop_map(|(culling, caching)| settings(caching > 0, culling))
}

proptest! {
    // At least 500 cases. PROPTEST_CASES raises the number in nightly runs.
    #![proptest_config(ProptestConfig::with_cases(ProptestConfig::default().cases.max(500)))]

    #[test]
    fn maps_hold_what_maps_drawn_anew_hold_whatever_happened_before(
        settings in any_settings(),
        jitter in [0..SIDE / SAMPLES, 0..SIDE / SAMPLES],
        events in proptest::collection::vec(event(), 100),
    ) {
        let mut world = World::new(settings, UVec2::from(jitter));
        for (frame, event) in events.iter().enumerate() {
            world.change(event);
            let drawn = world.draw();
            prop_assert!(drawn.is_ok(), "{drawn:?} after {event:?}, the last of {:?}", &events[..=frame]);
        }
    }
}
