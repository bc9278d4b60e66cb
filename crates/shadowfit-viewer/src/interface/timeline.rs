//! The bar below the picture: the animation, the time of day, and where the camera is.

use egui::{Button, DragValue, RichText, Slider, Ui};
use shadowfit::tool::DAY;

use super::Asked;
use crate::command::Command;
use crate::stage::Stage;

/// Least change of the time that counts as one, in seconds.
const SCRUB_STEP: f32 = 0.006;

pub(super) fn show(ui: &mut Ui, stage: &mut Stage, frame_ms: Option<f32>, asked: &mut Asked) {
    egui::Panel::bottom("timeline").show(ui, |ui| {
        ui.add_space(2.0);
        ui.horizontal_wrapped(|ui| {
            animation(ui, stage, asked);
            ui.separator();
            day(ui, stage, asked);
            ui.separator();
            speed(ui, stage);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let frame = frame_ms.map_or_else(String::new, |ms| format!("{ms:.0} ms"));
                ui.label(RichText::new(frame).weak()).on_hover_text("Time of a whole frame");
            });
        });
        ui.add_space(2.0);
    });
}

/// Play, pause, and the time of the animation.
fn animation(ui: &mut Ui, stage: &mut Stage, asked: &mut Asked) {
    let Some(duration) = stage.duration() else {
        ui.add_enabled(false, Button::new("▶")).on_disabled_hover_text("This scene has no animation");
        return;
    };
    let (icon, help) = if stage.settings.view.play { ("⏸", "Pause (Space)") } else { ("▶", "Play (Space)") };
    if ui.add(Button::new(icon).min_size(egui::vec2(28.0, 0.0))).on_hover_text(help).clicked() {
        asked.commands.push(Command::TogglePlay);
    }
    let now = stage.seconds() % duration.max(1e-3);
    let mut seconds = now;
    let slider = Slider::new(&mut seconds, 0.0..=duration).fixed_decimals(2).suffix(" s").trailing_fill(true);
    let response = ui.add(slider).on_hover_text("Time of the animation; dragging it poses the scene");
    // A slider rounds what it shows, which is no wish.
    if response.changed() && (seconds - now).abs() > SCRUB_STEP {
        asked.commands.push(Command::Scrub(seconds));
    }
}

/// The sun over the day.
fn day(ui: &mut Ui, stage: &mut Stage, asked: &mut Asked) {
    let light = &mut stage.settings.light;
    let help = "Lets the sun move (L)";
    if ui.add(Button::selectable(light.animate, "Sun")).on_hover_text(help).clicked() {
        asked.commands.push(Command::ToggleSun);
    }
    let mut hour = light.hour.unwrap_or(12.0);
    let is_set = light.hour.is_some();
    let clock = |hour: f64, _: std::ops::RangeInclusive<usize>| {
        let minutes = (hour * 60.0).round() as u32;
        if is_set { format!("{}:{:02}", minutes / 60, minutes % 60) } else { "by angles".to_owned() }
    };
    let slider = Slider::new(&mut hour, DAY.0..=DAY.1).custom_formatter(clock).trailing_fill(true);
    let help = "Time of day: sunrise at 6, noon at 12, sunset at 18. Azimuth and elevation in the panel are used until it \
                is moved.";
    if ui.add(slider).on_hover_text(help).changed() {
        light.hour = Some(hour);
    }
    if light.hour.is_some() && ui.small_button("×").on_hover_text("Back to azimuth and elevation").clicked() {
        light.hour = None;
    }
}

/// How fast the camera flies.
fn speed(ui: &mut Ui, stage: &mut Stage) {
    let (least, most) = shadowfit::tool::FLYING_SPEEDS;
    let speed = DragValue::new(&mut stage.settings.camera.speed).range(least..=most).speed(0.05).suffix(" m/s");
    ui.add(speed.max_decimals(1)).on_hover_text("Flying speed (wheel over the picture)");
}
