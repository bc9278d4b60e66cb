use crate::host::{builder, *};
use crate::states::*;
use egui::{Theme, Vec2};
use shadowfit_egui::PANEL_WIDTH;

fn save(
    host: Host,
    theme: Theme,
    scale: f32,
    height: f32,
    name: &str,
    prepare: impl FnOnce(&mut egui_kittest::Harness<'_, Host>),
) {
    let mut harness = builder(Vec2::new(PANEL_WIDTH, height), theme, scale)
        .wgpu()
        .with_render_cursor(false)
        .build_ui_state(|ui, host: &mut Host| host.show(ui), host);
    harness.run();
    prepare(&mut harness);
    harness.run();
    let folder = "/tmp/w/panel-pictures";
    std::fs::create_dir_all(folder).unwrap();
    harness.render().unwrap().save(format!("{folder}/{name}.png")).unwrap();
}

#[test]
fn pictures() {
    for (theme, t) in [(Theme::Dark, "dark"), (Theme::Light, "light")] {
        save(session(), theme, 1.0, 720.0, &format!("{t}-720-1x"), |_| {});
        save(busy(), theme, 1.0, 1600.0, &format!("{t}-busy-1600-1x"), |_| {});
        save(session(), theme, 1.0, 1600.0, &format!("{t}-open-1600-1x"), |h| open_sections(h));
        save(session(), theme, 2.0, 720.0, &format!("{t}-720-2x"), |_| {});
        save(busy(), theme, 2.0, 1600.0, &format!("{t}-busy-1600-2x"), |_| {});
        save(session(), theme, 1.0, 1600.0, &format!("{t}-plots-1600-1x"), |h| play(h));
    }
}
