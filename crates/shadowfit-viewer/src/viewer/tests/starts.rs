//! Starts with invalid saved state or arguments.

use super::*;

/// Returns the current message.
fn message(viewer: &Viewer) -> &str {
    viewer.message.as_ref().map_or("", |message| &message.text)
}

/// Writes saved state with a scene and practical splits.
fn saved(folder: &Path, scene: &str) -> std::path::PathBuf {
    let path = folder.join("viewer.toml");
    let scene = toml::Value::from(scene);
    let text = format!(
        "version = 1\nscene = {scene}\n[settings.fit]\nkind = \"focused\"\n[settings.splits]\nscheme = \"practical\"\nlambda = 0.5\n"
    );
    std::fs::write(&path, text).expect("written");
    path
}

#[test]
fn gpu_a_first_start_has_the_colours_that_the_system_prefers_until_a_person_chooses() {
    let mut viewer = ready(&[], None);
    let prefer = |viewer: &mut Viewer, theme| {
        let input = RawInput { system_theme: Some(theme), ..Default::default() };
        let _ = viewer.frame(input, FRAME);
        viewer.interface.context.theme()
    };
    for theme in [egui::Theme::Light, egui::Theme::Dark, egui::Theme::Light] {
        assert_eq!(prefer(&mut viewer, theme), theme);
    }
    run(&mut viewer, Command::SetTheme(egui::ThemePreference::Dark));
    assert_eq!(prefer(&mut viewer, egui::Theme::Light), egui::Theme::Dark);
}

#[test]
fn gpu_a_damaged_file_is_told_in_the_panel_once_the_scene_is_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("viewer.toml");
    std::fs::write(&path, "version = 99").expect("written");
    let mut viewer = ready(&[], Some(&path));
    assert!(message(&viewer).contains("damaged-1"), "{:?}", message(&viewer));
    pass(&mut viewer, 13.4);
    assert_eq!(message(&viewer), "", "it was there to be read for some seconds");
}

#[test]
fn gpu_a_scene_of_the_last_time_that_went_bad_gives_way_to_the_built_in_one() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("bad.glb"), "no scene").expect("written");
    for name in ["bad.glb", "gone.glb"] {
        let path = saved(folder.path(), &folder.path().join(name).display().to_string());
        let viewer = ready(&[], Some(&path));
        assert_eq!(viewer.source, SceneSource::default());
        assert!(message(&viewer).contains(name), "{:?}", message(&viewer));
    }
}

#[test]
fn gpu_a_refused_argument_leaves_the_saved_settings_as_they_were() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = saved(folder.path(), "courtyard");
    let before = std::fs::read(&path).expect("it is there");
    let all = ["--technique", "windows-4", "--set", "splits.lambda=0.7"];
    let mut viewer = viewer(&all, Some(&path));
    settle(&mut viewer, |viewer| viewer.window_requests.quit);
    let error = format!("{:#}", viewer.failure.as_ref().expect("windows have no practical splits"));
    assert!(error.contains("splits.lambda"), "{error}");
    viewer.save();
    assert_eq!(std::fs::read(&path).expect("it is there"), before);
}

#[test]
fn gpu_an_argument_may_need_what_was_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = saved(folder.path(), "courtyard");
    let viewer = ready(&["--set", "splits.lambda=0.7"], Some(&path));
    assert_eq!(
        viewer.stage.settings.technique.maps.as_cascades().splits,
        shadowfit::settings::SplitScheme::Practical(0.7)
    );
}

#[test]
fn gpu_the_copied_command_line_starts_with_these_settings() {
    let mut viewer = ready(&["plain", "--technique", "stable-4", "--set", "bias.slope=1.25"], None);
    run(&mut viewer, Command::Set("map.filter".to_owned(), "point".to_owned()));
    let line = viewer.text_of_settings();
    let line: toml::Table = toml::from_str(&line).expect("a table");
    let line = line["command"].as_str().expect("a line").to_owned();
    let arguments: Vec<&str> = line.split(' ').skip(1).collect();
    let second = ready(&arguments, None);
    assert!(second.start.arguments.no_state, "nothing that was saved may change it");
    assert_eq!((&second.source, &second.stage.settings), (&viewer.source, &viewer.stage.settings));
}
