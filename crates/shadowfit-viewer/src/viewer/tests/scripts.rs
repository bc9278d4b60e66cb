//! Effects of a script's lines, including lines that fail.

use super::*;

/// Plays a script in a folder.
fn play(folder: &Path, text: &str) -> Viewer {
    let path = folder.join("script.txt");
    std::fs::write(&path, text).expect("written");
    let mut viewer = viewer(&["--script", &path.display().to_string()], None);
    viewer.start = viewer.start.clone().saving_into(folder);
    settle(&mut viewer, Viewer::has_played);
    viewer
}

#[test]
fn gpu_a_line_that_cannot_be_done_fails_the_script_and_the_rest_is_played() {
    let folder = tempfile::tempdir().expect("a folder");
    for bad in [
        "set bias.constant 1e9",
        "set splits.lambda 0.5",
        "open no/such/scene.glb",
        "drop no/such/technique.toml",
        "picture no/such/folder/picture.png",
        "goto 7",
    ] {
        let viewer = play(folder.path(), &format!("await loaded\n{bad}\nset splits.count 2\n"));
        assert!(viewer.player.failed, "{bad}");
        assert_eq!(viewer.stage.settings.technique.maps.count(), 2, "{bad}");
    }
    assert!(play(folder.path(), "set splits.count 2\nawait loaded\n").player.failed, "there is no scene yet");
    let good = play(folder.path(), "await loaded\nset bias.constant 1\nbookmark 7\ngoto 7\npicture a.png\n");
    assert!(!good.player.failed);
    assert!(folder.path().join("a.png").is_file());
}

#[test]
fn gpu_files_without_a_name_go_to_the_folder_of_the_script() {
    let folder = tempfile::tempdir().expect("a folder");
    let viewer = play(folder.path(), "await loaded\npress p\nframes 2\npress p\n");
    assert!(!viewer.player.failed);
    for name in ["shadowfit-001.png", "shadowfit-002.png"] {
        assert!(folder.path().join(name).is_file(), "{name}");
    }
}

#[test]
fn gpu_what_random_actions_save_is_gone_at_the_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("script.txt");
    std::fs::write(&path, "await loaded\nmonkey 60 1\n").expect("written");
    let mut viewer = viewer(&["--script", &path.display().to_string()], None);
    until(&mut viewer, "the monkey", |viewer| viewer.player.is_random());
    run(&mut viewer, Command::Screenshot(None));
    let litter = viewer.litter.as_ref().expect("a folder of its own").path().to_owned();
    assert!(litter.join("shadowfit-001.png").is_file());
    drop(viewer);
    assert!(!litter.exists());
}

#[test]
fn gpu_bookmarks_and_times_of_the_animation_come_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = "await loaded\nlook 1 2 3 to 4 2 3\nbookmark 3\nlook 0 9 0 to 1 0 1\ngoto 3\nscrub 1.5\n";
    let viewer = play(folder.path(), script);
    assert!((viewer.stage.camera.position - glam::DVec3::new(1.0, 2.0, 3.0)).length() < 1e-9);
    assert!(!viewer.stage.settings.view.play && viewer.stage.seconds() == 1.5, "it stands at that time");
}
