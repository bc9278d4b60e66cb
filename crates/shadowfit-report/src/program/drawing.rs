//! Options for drawing and judging pictures, shared by all kinds of reports.

use anyhow::{Context, Result, bail, ensure};
use shadowfit::Technique;
use shadowfit::settings::{BiasSettings, Edges, FilterKind, MapFormat, SoftRadius, Softness};
use shadowfit_adapter::AdapterOptions;
use shadowfit_params::{self as params, Inputs};
use shadowfit_render::Gpu;
use shadowfit_study::{Judging, NamedTechnique};

use crate::inputs::InputArgs;

#[derive(Clone, Debug, clap::Args)]
pub(crate) struct Drawing {
    /// Width and height of the judged pictures, in pixels
    #[arg(long, default_value = "1280x720", value_name = "WxH", value_parser = size)]
    size: [u32; 2],
    #[arg(
        long,
        value_name = "NAME",
        value_parser = filter,
        help = "Filter of the look-up, such as pcf_3x3 or vogel_16; the viewer's --parameters lists them under map.filter \
                [default: the technique's, or pcf_5x5]"
    )]
    filter: Option<FilterKind>,
    #[arg(
        long,
        value_name = "NAME=TEXELS,...",
        help = "Biases in texels, such as \"normal_offset=1.5,constant=0.1\": unnamed ones are 0 [default: just \
                enough for planes with this filter]"
    )]
    bias: Option<String>,
    /// Trace edges, with N rays for each pixel where the maps are unsure; 0 filters them [default: the
    /// technique's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=64))]
    rays: Option<u32>,
    /// Store depths in a colour texture of 32-bit floats and compare them in the shader
    #[arg(long)]
    color_format: bool,
    /// Scene units per metre: shadow rays start 1 mm above the surface [default: a thousandth of a unit, less
    /// in a scene below 2 units, more where coordinates exceed 1000]
    #[arg(long, value_name = "N", value_parser = positive)]
    units_per_metre: Option<f64>,
    /// Angular radius of the sun, in degrees (0.27 for the real sun): truth becomes the mean of many rays
    #[arg(long, default_value_t = 0.0, value_name = "DEG", value_parser = radius)]
    sun_radius: f64,
    /// Number of rays per pixel to a sun with a radius
    #[arg(long, default_value_t = 64, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    sun_rays: u32,
    /// Sets a parameter of the techniques, e.g. `splits.count=2`; the viewer's --parameters lists them
    #[arg(long = "set", value_name = "ID=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    inputs: InputArgs,
    /// Do not measure crawl, which draws each frame a second time
    #[arg(long)]
    no_crawl: bool,
    /// Do not measure ꟻLIP, which draws each frame twice more
    #[arg(long)]
    no_flip: bool,
    /// Compare factors with the light on each pixel's area, sampled at N x N points
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=16))]
    area: u32,
    #[command(flatten)]
    adapter: AdapterOptions,
}

impl Drawing {
    pub(crate) fn gpu(&self) -> Result<Gpu> {
        Ok(pollster::block_on(Gpu::headless(&self.adapter.choice()))?)
    }

    pub(crate) fn judging(&self) -> Judging {
        Judging {
            size: self.size,
            ray_offset: 1e-3 * self.units_per_metre.unwrap_or(1.0),
            sun_radius: self.sun_radius.to_radians(),
            sun_rays: self.sun_rays,
            crawl: !self.no_crawl,
            area: self.area,
            flip: !self.no_flip,
            subject_only: false,
        }
    }

    /// Returns whether the scene units, which set the start of shadow rays, are given.
    pub(crate) const fn sets_units(&self) -> bool {
        self.units_per_metre.is_some()
    }

    /// Returns the inputs of fits for techniques that do not define their own.
    pub(crate) fn inputs(&self) -> Inputs {
        self.inputs.changed(Inputs::default())
    }

    /// Returns whether the options change the techniques.
    pub(crate) fn changes_techniques(&self) -> bool {
        let has_look_up = self.filter.is_some() || self.bias.is_some() || self.color_format;
        has_look_up || self.rays.is_some() || !self.set.is_empty()
    }

    /// Returns a technique with the requested changes.
    pub(crate) fn changed(&self, mut named: NamedTechnique) -> Result<NamedTechnique> {
        named.inputs = self.inputs.changed(named.inputs);
        let technique = &mut named.technique;
        if self.bias.is_some() || self.filter.is_some() {
            let filter = self.filter.unwrap_or(technique.filter);
            *technique = technique.with_look_up(filter, self.bias(filter)?);
        }
        if self.color_format {
            technique.format = MapFormat::R32Float;
        }
        technique.edges = self.edges().unwrap_or(technique.edges);
        for assignment in &self.set {
            let (id, value) = assignment
                .split_once('=')
                .with_context(|| format!("--set {assignment}: expected ID=VALUE, e.g. splits.count=2"))?;
            if let Err(error) = params::set_technique_from_str(technique, id.trim(), value.trim()) {
                bail!("--set {assignment}: {error}");
            }
        }
        Ok(named)
    }

    pub(crate) fn filter(&self) -> FilterKind {
        self.filter.unwrap_or(FilterKind::Pcf5x5)
    }

    /// Returns the requested kind of edges, if any.
    pub(crate) fn edges(&self) -> Option<Edges> {
        self.rays.map(|samples| if samples == 0 { Edges::Filtered } else { Edges::Traced { samples } })
    }

    /// Returns the softness for maps from fit files: penumbrae of the judging sun, without limit of their
    /// width.
    pub(crate) fn softness(&self) -> Softness {
        if self.sun_radius == 0.0 {
            return Softness::default();
        }
        let radius = SoftRadius::SunAngle(self.sun_radius.to_radians() as f32);
        Softness { radius, ceiling: Softness::MAX_RADIUS, ..Softness::default() }
    }

    pub(crate) fn format(&self) -> MapFormat {
        if self.color_format { MapFormat::R32Float } else { MapFormat::Depth32Float }
    }

    /// Returns the requested biases, or by default biases that are just large enough for planes with this
    /// filter.
    pub(crate) fn bias(&self, filter: FilterKind) -> Result<BiasSettings> {
        let Some(text) = &self.bias else { return Ok(BiasSettings::automatic(filter)) };
        let zero =
            BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 0.0 };
        let mut technique = Technique { bias: zero, ..Technique::default() };
        for part in text.split(',').filter(|part| !part.is_empty()) {
            let (name, value) =
                part.split_once('=').with_context(|| format!("--bias: \"{part}\" is not NAME=TEXELS"))?;
            let id = format!("bias.{}", name.trim());
            if let Err(error) = params::set_technique_from_str(&mut technique, &id, value) {
                bail!("--bias: {error}");
            }
        }
        Ok(technique.bias)
    }
}

/// Parses a number above 0.
pub(crate) fn positive(text: &str) -> Result<f64> {
    let value: f64 = text.parse().with_context(|| format!("\"{text}\" is not a number"))?;
    ensure!(value.is_finite() && value > 0.0, "{value} is not a number above 0");
    Ok(value)
}

/// Parses the angular radius of a sun, in degrees.
fn radius(text: &str) -> Result<f64> {
    let value: f64 = text.parse().with_context(|| format!("\"{text}\" is not a number"))?;
    ensure!((0.0..=45.0).contains(&value), "{value} degrees; give 0 to 45");
    Ok(value)
}

pub(crate) fn size(text: &str) -> Result<[u32; 2]> {
    let sides = text.split_once('x').with_context(|| format!("\"{text}\" is not WxH, such as 1280x720"))?;
    let side = |text: &str| -> Result<u32> {
        let side: u32 = text.parse().with_context(|| format!("\"{text}\" is not a number of pixels"))?;
        if !(1..=8192).contains(&side) {
            bail!("{side} pixels; give 1 to 8192");
        }
        Ok(side)
    };
    Ok([side(sides.0)?, side(sides.1)?])
}

fn filter(text: &str) -> Result<FilterKind> {
    let mut technique = Technique::default();
    params::set_technique_from_str(&mut technique, "map.filter", text)?;
    Ok(technique.filter)
}

/// Returns the filter of a name, and the name.
pub(crate) fn named_filter(text: &str) -> Result<(String, FilterKind)> {
    Ok((text.trim().to_owned(), filter(text.trim())?))
}
