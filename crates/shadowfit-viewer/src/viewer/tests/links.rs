//! Links: another viewer that follows a link shows the same state.

use glam::DVec3;

use super::*;
use crate::keep::link::Link;
use crate::keep::undo::State;
use crate::stage::ArtefactShow;

/// Returns a second viewer that has followed the link of the first one.
fn follower(first: &Viewer, arguments: &[&str]) -> Viewer {
    let fragment = first.link().to_fragment();
    let mut second = ready(arguments, None);
    second.follow(Link::parse(&fragment).expect(&fragment));
    until(&mut second, "the scene of the link", |viewer| viewer.loading.is_none());
    assert!(second.link.is_none(), "{fragment}");
    second
}

fn assert_same(first: &Viewer, second: &Viewer) {
    let fragment = first.link().to_fragment();
    // Only the settings that the artefact changed matter.
    let state = |viewer: &Viewer| State { artefact: ArtefactShow::default(), ..viewer.state() };
    assert_eq!(state(first), state(second), "{fragment}");
    let [a, b] = [&first.stage, &second.stage];
    assert_eq!((a.shown(), a.narration(), a.cure_changes()), (b.shown(), b.narration(), b.cure_changes()));
    assert_eq!((a.before_artefact(), a.ill_technique()), (b.before_artefact(), b.ill_technique()), "{fragment}");
    let place = |viewer: &Viewer| (viewer.stage.camera, viewer.stage.split, viewer.stage.seconds());
    assert_eq!(place(first), place(second), "{fragment}");
    assert_eq!(first.source, second.source);
    assert_eq!(second.link().to_fragment(), fragment);
}

fn set(viewer: &mut Viewer, id: &str, value: &str) {
    run(viewer, Command::Set(id.to_owned(), value.to_owned()));
    assert!(viewer.message.as_ref().is_some_and(|message| message.text.contains(" = ")), "{id}={value}");
}

#[test]
fn gpu_who_follows_a_link_sees_the_same() {
    let mut first = ready(&["forest"], None);
    run(&mut first, Command::Technique("stable-4".to_owned()));
    for (id, value) in [
        ("splits.count", "3"),
        ("splits.scheme", "practical"),
        ("splits.lambda", "0.37"),
        ("bias.slope", "1.3"),
        ("map.filter", "point"),
        ("light.hour", "8.25"),
        ("camera.fov_y", "63.7"),
        ("camera.near", "0.3"),
        ("view.marks", "outline"),
        ("view.inset", "all"),
        ("view.inset_map", "2"),
    ] {
        set(&mut first, id, value);
    }
    run(&mut first, Command::View(ViewMode::Error));
    run(&mut first, Command::Compare(Toggle::On));
    first.interface.edits_other = true;
    set(&mut first, "bias.constant", "0.123");
    first.interface.edits_other = false;
    run(&mut first, Command::Split(0.3));
    run(&mut first, Command::Scrub(1.7));
    let (eye, target) = ([3.1, 2.7, 1.0 / 3.0], [0.1, 0.2, -7.0]);
    run(&mut first, Command::LookAt { eye, target });
    let second = follower(&first, &["plain", "--technique", "xna-1"]);
    assert_same(&first, &second);
    assert!(second.message.is_none());
}

#[test]
fn gpu_a_link_of_the_scene_on_show_undoes_all_else() {
    let mut first = ready(&["plain"], None);
    set(&mut first, "bias.slope", "1.3");
    let mut second = ready(&["plain", "--technique", "xna-1"], None);
    set(&mut second, "view.shadows", "off");
    run(&mut second, Command::Compare(Toggle::On));
    second.follow(first.link());
    assert!(second.loading.is_none());
    assert_same(&first, &second);
}

#[test]
fn gpu_an_artefact_comes_back_with_its_card_shown_and_fixed() {
    let mut first = ready(&[], None);
    run(&mut first, Command::ShowArtefact(Artefact::Acne));
    until(&mut first, "acne", |viewer| viewer.stage.shown().is_some());
    run(&mut first, Command::NextMarks);
    assert_same(&first, &follower(&first, &["plain"]));
    run(&mut first, Command::FixArtefact);
    let mut second = follower(&first, &["plain"]);
    assert_same(&first, &second);
    assert!(!second.stage.cure_changes().is_empty() && second.stage.narration().contains("texel"));
    // The state before it is known, too.
    for viewer in [&mut first, &mut second] {
        run(viewer, Command::ShowArtefact(Artefact::Aliasing));
        until(viewer, "aliasing", |viewer| viewer.stage.shown().is_some_and(|shown| !shown.fixed));
    }
    assert_same(&first, &second);
}

#[test]
fn gpu_a_sample_comes_back_in_its_variant_with_its_options() {
    let mut first = ready(&["--sample", "xna-shadow-mapping"], None);
    set(&mut first, "view.inset_map", "3");
    run(&mut first, Command::ShowSampleVariant(Some(0)));
    set(&mut first, "sample.format", "r16f");
    let second = follower(&first, &[]);
    assert_same(&first, &second);
    set(&mut first, "sample.shadows", "ours");
    set(&mut first, "bias.slope", "1.3");
    assert_same(&first, &follower(&first, &["--sample", "xna-shadow-mapping/acne"]));
}

/// Writes a scene of one triangle as a file.
fn write_scene(path: &Path) {
    let gltf = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,0,1]}]}"#;
    std::fs::write(path, gltf).expect("written");
}

#[test]
fn gpu_a_link_of_a_file_asks_for_it_and_waits() {
    let folder = tempfile::tempdir().expect("a folder");
    let [here, there] = ["here", "there"].map(|name| folder.path().join(name));
    for folder in [&here, &there] {
        std::fs::create_dir(folder).expect("a folder");
        write_scene(&folder.join("my town.gltf"));
    }
    let mut first = ready(&[&here.join("my town.gltf").display().to_string()], None);
    set(&mut first, "bias.slope", "1.3");
    run(&mut first, Command::LookAt { eye: [1.0, 2.0, 3.0], target: [0.0; 3] });
    let fragment = first.link().to_fragment();
    assert!(fragment.contains("file=my%20town.gltf&") && !fragment.contains("here"), "{fragment}");
    let mut second = ready(&["--link", &format!("https://example.org/{fragment}")], None);
    let request = |viewer: &Viewer| viewer.link.as_ref().and_then(|link| link.scene.request());
    assert_eq!(request(&second).as_deref(), Some("This link needs my town.gltf: drop that file here"));
    run(&mut second, Command::Open("plain".to_owned()));
    until(&mut second, "another scene", |viewer| viewer.loading.is_none());
    assert!(request(&second).is_some(), "it still waits");
    run(&mut second, Command::OpenFile(there.join("my town.gltf")));
    until(&mut second, "the file", |viewer| viewer.loading.is_none());
    assert_eq!((request(&second), &second.stage.settings), (None, &first.stage.settings));
    assert_eq!(second.stage.camera.position, DVec3::new(1.0, 2.0, 3.0));
}

#[test]
fn gpu_a_link_that_makes_little_sense_is_followed_as_far_as_it_goes() {
    let mut viewer = ready(&["plain"], None);
    for text in [
        "#scene=courtyard&animation=99&time=1e30&split=-7&camera=1e12,-1e12,0,1e9,900",
        "#scene=courtyard&view.play=true&splits.lambda=0.5&was.map.filter=point&ill.bias.slope=1&b.light.hour=7",
        "#scene=plain&artefact=hole,fixed&camera=0,1e9,0,0,90&sample.bias=1",
    ] {
        viewer.follow(Link::parse(text).expect(text));
        until(&mut viewer, "the scene", |viewer| viewer.loading.is_none());
        (0..5).for_each(|_| frame(&mut viewer));
        assert!(viewer.failure.is_none() && !viewer.window_requests.quit, "{text}");
    }
}

#[test]
fn gpu_the_link_of_the_start_wins_and_a_bad_one_ends_it() {
    let link = "#scene=plain&bias.slope=1.5&new.thing=1";
    let viewer = ready(&["arcade", "--set", "bias.slope=2", "--link", link], None);
    assert_eq!((&viewer.source, viewer.stage.settings.technique.bias.slope), (&SceneSource::from_text("plain"), 1.5));
    assert!(viewer.message.is_some_and(|message| message.text.contains("new.thing")));
    let bad = Arguments::parse_from(["viewer", "--link", "#bias.slope=x"]);
    let error = format!("{:#}", Start::new(&bad).expect_err("no number"));
    assert!(error.contains("--link") && error.contains("bias.slope=x"), "{error}");
}

#[test]
fn gpu_a_page_copies_links_and_cannot_be_quit() {
    let mut viewer = ready(&["plain"], None);
    viewer.page = Some("https://example.org/view/".to_owned());
    for command in [Command::Quit, Command::Escape] {
        run(&mut viewer, command);
        assert!(!viewer.window_requests.quit);
    }
    viewer.ask(Command::CopyLink);
    frame(&mut viewer);
    let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(640.0, 360.0)));
    let (_, output) = viewer.frame(RawInput { screen_rect, ..Default::default() }, FRAME);
    let expected = format!("https://example.org/view/{}", viewer.link().to_fragment());
    assert_eq!(output.commands, [egui::OutputCommand::CopyText(expected)]);
}

/// Writes a scene of one triangle with two cameras, the second one rolled, and two suns, as a file.
fn write_views(path: &Path) {
    let gltf = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2,3,4]}],
        "nodes":[{"mesh":0},{"camera":0,"translation":[0.5,0.3,3]},
        {"camera":1,"translation":[0,2,3],"rotation":[-0.28,0.0,0.38,0.88]},
        {"rotation":[-0.5,0,0,0.866],"extensions":{"KHR_lights_punctual":{"light":0}}},
        {"rotation":[-0.6,0.1,0,0.79],"extensions":{"KHR_lights_punctual":{"light":1}}}],
        "extensionsUsed":["KHR_lights_punctual"],
        "extensions":{"KHR_lights_punctual":{"lights":[{"type":"directional","intensity":0},{"type":"directional"}]}},
        "cameras":[{"type":"perspective","perspective":{"yfov":2.9,"znear":0.01}},
        {"type":"orthographic","orthographic":{"xmag":2,"ymag":1.5,"znear":0.1,"zfar":20}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,0,1]}]}"#;
    std::fs::write(path, gltf).expect("written");
}

#[test]
fn gpu_cameras_and_suns_of_a_file_come_back_by_link_while_followed_and_after() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("views.gltf");
    write_views(&path);
    let file = path.to_str().expect("text");
    let mut first = ready(&[file], None);
    let settings = |viewer: &Viewer| viewer.stage.settings;
    assert_eq!((settings(&first).camera.file, settings(&first).light.file), (Some(1), Some(2)));
    assert!((settings(&first).camera.fov_y - 2.9).abs() < 1e-6);
    assert!(!first.link().to_fragment().contains("camera="), "{}", first.link().to_fragment());
    let follow = |first: &Viewer| {
        let mut second = ready(&[file], None);
        second.follow(Link::parse(&first.link().to_fragment()).expect("a link"));
        until(&mut second, "a frame", |_| true);
        second
    };
    for (id, value) in [("camera.file", "2"), ("light.file", "1")] {
        set(&mut first, id, value);
    }
    until(&mut first, "a frame", |viewer| viewer.stage.settings.camera.height.is_some());
    let second = follow(&first);
    assert_eq!(settings(&second).camera.height, Some(3.0));
    assert_eq!((settings(&first), first.stage.camera), (settings(&second), second.stage.camera));
    // Flown and turned by hand, with the roll of the camera.
    first.stage.update(&shadowfit_render::FlyInput { movement: glam::Vec3::X, ..Default::default() }, 0.1);
    set(&mut first, "light.azimuth", "30");
    let second = follow(&first);
    assert!(first.stage.camera.roll != 0.0);
    assert_eq!((settings(&first), first.stage.camera), (settings(&second), second.stage.camera));
    assert_eq!((settings(&second).camera.file, settings(&second).light.file), (None, None));
    run(&mut first, Command::LevelCamera);
    assert_eq!(first.stage.camera.roll, 0.0);
    run(&mut first, Command::Reset);
    until(&mut first, "the first view", |viewer| viewer.stage.settings.camera.file == Some(1));
    assert_eq!(settings(&first).light.file, Some(2));
}

#[test]
fn gpu_arguments_and_links_choose_a_camera_with_its_lens_and_may_change_that() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("views.gltf");
    write_views(&path);
    let file = path.to_str().expect("text");
    let camera = |viewer: &Viewer| viewer.stage.settings.camera;
    let mut first = ready(&[file, "--set", "camera.near=0.3", "--set", "camera.file=2"], None);
    for _ in 0..2 {
        assert_eq!((camera(&first).file, camera(&first).height, camera(&first).near), (Some(2), Some(3.0), 0.3));
        run(&mut first, Command::Reset);
        frame(&mut first);
    }
    // As a perspective camera, the second camera has the field of view of the first one.
    for height in ["5", "perspective"] {
        set(&mut first, "camera.height", height);
        let link = first.link();
        let text = first.command_line();
        let arguments: Vec<&str> = text.split(' ').skip(1).collect();
        let mut second = ready(&[file], None);
        second.follow(Link::parse(&link.to_fragment()).expect("a link"));
        frame(&mut second);
        let assert_same = |other: &Viewer| {
            assert_eq!((camera(other), other.stage.camera), (camera(&first), first.stage.camera), "{text}");
        };
        assert_same(&second);
        assert_same(&ready(&arguments, None));
    }
    let mut third = ready(&[file], None);
    third.follow(Link::parse("#v=1&file=views.gltf&camera.file=2").expect("a link"));
    frame(&mut third);
    assert_eq!((camera(&third).file, camera(&third).height), (Some(2), Some(3.0)));
    // A camera in the arguments replaces the flown one.
    let store = folder.path().join("viewer.toml");
    let mut flown = ready(&[file], Some(&store));
    run(&mut flown, Command::LookAt { eye: [1.0, 2.0, 3.0], target: [0.0; 3] });
    flown.save();
    let back = ready(&["--set", "camera.file=2"], Some(&store));
    assert_eq!((camera(&back).file, camera(&back).height), (Some(2), Some(3.0)));
}

#[test]
fn gpu_undo_goes_back_to_the_camera_of_the_file_before() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("views.gltf");
    write_views(&path);
    let mut viewer = ready(&[path.to_str().expect("text")], None);
    let view = |viewer: &Viewer| (viewer.stage.settings.camera, viewer.stage.camera);
    pass(&mut viewer, 2.0);
    let one = view(&viewer);
    set(&mut viewer, "camera.file", "2");
    pass(&mut viewer, 2.0);
    let two = view(&viewer);
    set(&mut viewer, "camera.height", "perspective");
    pass(&mut viewer, 2.0);
    for (command, expected) in [(Command::Undo, two), (Command::Undo, one), (Command::Redo, two)] {
        run(&mut viewer, command);
        frame(&mut viewer);
        assert_eq!(view(&viewer), expected);
    }
}

#[test]
fn gpu_redo_goes_back_to_where_the_camera_was_flown() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("views.gltf");
    write_views(&path);
    let mut viewer = ready(&[path.to_str().expect("text")], None);
    pass(&mut viewer, 2.0);
    let view = |viewer: &Viewer| (viewer.stage.settings.camera.file, viewer.stage.camera);
    let first = view(&viewer);
    let mut place = viewer.stage.camera;
    place.position.x += 3.0;
    viewer.stage.set_camera(place);
    pass(&mut viewer, 2.0);
    for (command, expected) in [(Command::Undo, first), (Command::Redo, (None, place))] {
        run(&mut viewer, command);
        frame(&mut viewer);
        assert_eq!(view(&viewer), expected);
    }
}

#[test]
fn gpu_a_picture_leaves_the_camera_and_gives_the_sun_to_its_own_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let [path, picture] = ["views.gltf", "picture.png"].map(|name| folder.path().join(name));
    write_views(&path);
    let mut viewer = ready(&[path.to_str().expect("text")], None);
    for (id, value) in [("camera.file", "2"), ("camera.near", "0.4"), ("light.file", "1"), ("bias.slope", "1.25")] {
        set(&mut viewer, id, value);
    }
    run(&mut viewer, Command::Screenshot(Some(picture.clone())));
    let light = viewer.stage.settings.light;
    run(&mut viewer, Command::Reset);
    frame(&mut viewer);
    let (before, place) = (viewer.stage.settings, viewer.stage.camera);
    run(&mut viewer, Command::OpenFile(picture.clone()));
    frame(&mut viewer);
    let settings = viewer.stage.settings;
    assert_eq!((settings.camera, viewer.stage.camera), (before.camera, place));
    assert_eq!((settings.light, settings.technique.bias.slope), (light, 1.25));
    run(&mut viewer, Command::Open("plain".to_owned()));
    until(&mut viewer, "the plain", |viewer| viewer.loading.is_none());
    let camera = viewer.stage.settings.camera;
    run(&mut viewer, Command::OpenFile(picture));
    let settings = viewer.stage.settings;
    assert_eq!((settings.camera, settings.light.file), (camera, None));
    assert!((settings.light.elevation - light.elevation).abs() < 1e-5, "the sun stands where it stood");
}
