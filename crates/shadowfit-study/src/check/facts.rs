//! Facts about the program and the device in a report.

use shadowfit_render::Gpu;

/// Returns names and values, in display order.
pub(super) fn facts(gpu: &Gpu) -> Vec<(&'static str, String)> {
    let info = gpu.adapter.get_info();
    let or_unknown = |text: String| if text.trim().is_empty() { "unknown".to_owned() } else { text };
    let driver = [info.driver, info.driver_info].join(" ");
    vec![
        ("program", format!("shadowfit {}, {}", env!("CARGO_PKG_VERSION"), system())),
        ("adapter", or_unknown(info.name)),
        ("driver", or_unknown(driver.trim().to_owned())),
        ("backend", format!("{:?}", info.backend)),
        ("device type", format!("{:?}, vendor {:#06x}, device {:#06x}", info.device_type, info.vendor, info.device)),
        ("limits", limits(&gpu.device.limits())),
        ("features", features(gpu)),
    ]
}

fn system() -> String {
    format!("{} {}", std::env::consts::OS, std::env::consts::ARCH)
}

/// Returns the limits that decide how maps are drawn and whether edges are traced.
fn limits(limits: &wgpu::Limits) -> String {
    let mib = |bytes: u64| bytes >> 20;
    format!(
        "textures of {}² texels and {} layers, buffers of {} MiB, storage bindings of {} MiB, {} storage buffers a stage, \
         {} invocations a workgroup",
        limits.max_texture_dimension_2d,
        limits.max_texture_array_layers,
        mib(limits.max_buffer_size),
        mib(limits.max_storage_buffer_binding_size),
        limits.max_storage_buffers_per_shader_stage,
        limits.max_compute_invocations_per_workgroup,
    )
}

/// Returns the features that the program would use, and the ones that the device lacks.
fn features(gpu: &Gpu) -> String {
    let wanted = shadowfit_render::Wanted::default().features;
    let has = gpu.device.features() & wanted;
    let names = |features: wgpu::Features| {
        let names: Vec<String> = features.iter_names().map(|(name, _)| name.to_lowercase()).collect();
        if names.is_empty() { "none".to_owned() } else { names.join(", ") }
    };
    format!("{}; missing: {}", names(has), names(wanted - has))
}
