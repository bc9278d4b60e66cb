//! The bar below the picture: the animation, the time of day, the flying speed and the frame time.

use egui::{Button, DragValue, RichText, Slider, Ui};
use shadowfit_egui::{Command, Icon, icon_button, rename, with_keys};
use shadowfit_params::tool::DAY;

use super::{InterfaceOutput, narrow};
use crate::stage::Stage;

/// Least change of the time by a user, in seconds.
const SCRUB_STEP: f32 = 0.006;

pub(super) fn show(ui: &mut Ui, stage: &mut Stage, frame_ms: Option<f32>, output: &mut InterfaceOutput) {
    let is_narrow = narrow::is_narrow(ui.max_rect().size());
    egui::Panel::bottom("timeline").show(ui, |ui| {
        ui.add_space(2.0);
        if is_narrow {
            return rows(ui, stage, frame_ms, output);
        }
        ui.horizontal_wrapped(|ui| {
            animation(ui, stage, output);
            ui.separator();
            if !stage.draws_sample() {
                // A sample has the light of its source.
                day(ui, stage, output);
                ui.separator();
            }
            speed(ui, stage);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| frame_time(ui, frame_ms));
        });
        ui.add_space(2.0);
    });
}

/// Shows the same in two rows, with sliders that fill the remaining width.
fn rows(ui: &mut Ui, stage: &mut Stage, frame_ms: Option<f32>, output: &mut InterfaceOutput) {
    /// Width of each row without its slider, in points.
    const REST: [f32; 2] = [204.0, 208.0];
    let sliders = REST.map(|rest| (ui.available_width() - rest).max(0.0));
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = sliders[0];
        animation(ui, stage, output);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| speed(ui, stage));
    });
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = sliders[1];
        if !stage.draws_sample() {
            day(ui, stage, output);
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| frame_time(ui, frame_ms));
    });
    ui.add_space(2.0);
}

fn frame_time(ui: &mut Ui, frame_ms: Option<f32>) {
    let frame = frame_ms.map_or_else(String::new, |ms| format!("{ms:.0} ms"));
    ui.label(RichText::new(frame).weak()).on_hover_text("Time of a whole frame");
}

/// Shows play, pause, and the time of the animation.
fn animation(ui: &mut Ui, stage: &mut Stage, output: &mut InterfaceOutput) {
    let Some(duration) = stage.duration() else {
        ui.add_enabled_ui(false, |ui| icon_button(ui, Icon::Play, "Play", "This scene has no animation"));
        return;
    };
    let plays = stage.settings.view.play;
    let (icon, name) = if plays { (Icon::Pause, "Pause") } else { (Icon::Play, "Play") };
    let help = with_keys(name, &Command::TogglePlay);
    if icon_button(ui, icon, name, &help).clicked() {
        output.commands.push(Command::TogglePlay);
    }
    let now = stage.seconds() % duration.max(1e-3);
    let mut seconds = now;
    let slider = Slider::new(&mut seconds, 0.0..=duration).fixed_decimals(2).suffix(" s").trailing_fill(true);
    let response = ui.add(slider).on_hover_text("Time of the animation; dragging it poses the scene");
    rename(ui, &response, "Time of the animation".to_owned());
    // A slider rounds its value, which is not a change by the user.
    if response.changed() && (seconds - now).abs() > SCRUB_STEP {
        output.commands.push(Command::Scrub(seconds));
    }
}

/// Shows the time of day.
fn day(ui: &mut Ui, stage: &mut Stage, output: &mut InterfaceOutput) {
    let light = &mut stage.settings.light;
    let help = with_keys("Lets the sun move", &Command::ToggleSun);
    if ui.add(Button::selectable(light.animate, "Sun")).on_hover_text(help).clicked() {
        output.commands.push(Command::ToggleSun);
    }
    let mut hour = light.hour.unwrap_or(12.0);
    let is_set = light.hour.is_some();
    let otherwise = if light.file.is_some() { "of the file" } else { "by angles" };
    let clock = |hour: f64, _: std::ops::RangeInclusive<usize>| {
        let minutes = (hour * 60.0).round() as u32;
        if is_set { format!("{}:{:02}", minutes / 60, minutes % 60) } else { otherwise.to_owned() }
    };
    let slider = Slider::new(&mut hour, DAY.0..=DAY.1).custom_formatter(clock).trailing_fill(true);
    let help = "Time of day: sunrise at 6, noon at 12, sunset at 18. Until you move it, the sun of the file is used, \
                or azimuth and elevation in the panel.";
    let response = ui.add(slider).on_hover_text(help);
    rename(ui, &response, "Time of day".to_owned());
    if response.changed() {
        light.hour = Some(hour);
    }
    let help = "Back to the sun of the file, or to azimuth and elevation";
    if light.hour.is_some() && icon_button(ui, Icon::X, "Sun by angles", help).clicked() {
        light.hour = None;
    }
}

/// Shows the flying speed.
fn speed(ui: &mut Ui, stage: &mut Stage) {
    let (least, most) = shadowfit_params::tool::FLYING_SPEEDS;
    let now = stage.settings.camera.speed;
    // Three digits. A drag by a point changes one hundredth.
    let decimals = (1.0 - now.max(least).log10().floor()).clamp(1.0, 6.0) as usize;
    let speed = DragValue::new(&mut stage.settings.camera.speed).range(least..=most).speed(f64::from(now) * 0.01);
    let response =
        ui.add(speed.suffix(" m/s").max_decimals(decimals)).on_hover_text("Flying speed (wheel over the picture)");
    rename(ui, &response, "Flying speed".to_owned());
}
