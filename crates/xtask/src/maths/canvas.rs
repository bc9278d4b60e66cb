//! SVG drawing: a light panel with lines, areas and labels, written by the `svg` crate.
//!
//! Page coordinates are pixels at a width of 720, y down. A [`Frame`] converts plot coordinates (y up) to
//! them.

use shadowfit::glam::DVec2;
use svg::Document;
use svg::node::Node;
use svg::node::element::{Circle, Path, Polygon, Polyline, Rectangle, Text as TextElement, Title};

/// Width of every picture, in pixels: about the width of text on a GitHub page.
const WIDTH: f64 = 720.0;

/// Colours that colour-blind readers can also distinguish (M. Okabe and K. Ito's set).
pub(super) const INK: &str = "#2b2b2b";
pub(super) const GREY: &str = "#8a8a8a";
pub(super) const BLUE: &str = "#0072b2";
pub(super) const RED: &str = "#d55e00";
pub(super) const YELLOW: &str = "#e69f00";
pub(super) const GREEN: &str = "#009e73";
pub(super) const PURPLE: &str = "#a5488a";

/// Colours of the maps, the nearest first.
pub(super) const MAPS: [&str; 4] = [BLUE, GREEN, YELLOW, PURPLE];

/// Font sizes of labels and of smaller labels, in pixels.
const LABEL: f64 = 14.0;
const SMALL: f64 = 12.0;

/// Style of a shape: colour and opacity of its area, colour and width (in pixels) of its line.
#[derive(Clone, Copy)]
pub(super) struct Paint {
    fill: (&'static str, f64),
    stroke: (&'static str, f64),
    is_dashed: bool,
}

/// Returns the style of an area without an outline.
pub(super) const fn fill(colour: &'static str, opacity: f64) -> Paint {
    stroke("none", 0.0).filled(colour, opacity)
}

/// Returns the style of a line, with its width in pixels.
pub(super) const fn stroke(colour: &'static str, width: f64) -> Paint {
    Paint { fill: ("none", 1.0), stroke: (colour, width), is_dashed: false }
}

impl Paint {
    /// Returns the style with a filled area.
    pub(super) const fn filled(self, colour: &'static str, opacity: f64) -> Self {
        Self { fill: (colour, opacity), ..self }
    }

    /// Returns the style with a dashed line.
    pub(super) const fn dashed(self) -> Self {
        Self { is_dashed: true, ..self }
    }
}

/// Alignment of a label to its point, as SVG's `text-anchor`.
pub(super) type Side = &'static str;

/// The label ends at the point.
pub(super) const LEFT: Side = "end";
/// The label is centred on the point.
pub(super) const MIDDLE: Side = "middle";
/// The label begins at the point.
pub(super) const RIGHT: Side = "start";

/// A picture under construction.
pub(super) struct Canvas {
    document: Document,
}

impl Canvas {
    /// Creates a light panel of the usual width, with a title for screen readers. `height` is in pixels.
    pub(super) fn new(height: f64, title: &str) -> Self {
        let panel = Rectangle::new()
            .set("x", 0.5)
            .set("y", 0.5)
            .set("width", WIDTH - 1.0)
            .set("height", height - 1.0)
            .set("rx", 8)
            .set("fill", "#fbfaf7")
            .set("stroke", "#d9d6cf");
        let document = Document::new()
            .set("viewBox", (0, 0, WIDTH, height))
            .set("width", WIDTH)
            .set("height", height)
            .set("font-family", "Verdana, DejaVu Sans, Helvetica, Arial, sans-serif")
            .set("stroke-linejoin", "round")
            .set("stroke-linecap", "round")
            .add(Title::new(title))
            .add(panel);
        Self { document }
    }

    pub(super) fn finish(self) -> String {
        format!("{}\n", self.document)
    }

    /// Draws into a rectangle of the page, clipped to it, with an outline and a title above.
    pub(super) fn panel(&mut self, min: DVec2, size: DVec2, title: &str, draw: impl FnOnce(&mut Self)) {
        // A nested SVG element clips its content.
        let document = Document::new()
            .set("x", min.x)
            .set("y", min.y)
            .set("width", size.x)
            .set("height", size.y)
            .set("viewBox", (min.x, min.y, size.x, size.y));
        let mut inner = Self { document };
        draw(&mut inner);
        self.document.append(inner.document);
        self.rectangle(min, min + size, stroke(GREY, 1.0));
        self.bold(min - DVec2::new(0.0, 12.0), RIGHT, INK, title);
    }

    /// Draws a label with its baseline at the point.
    pub(super) fn text(&mut self, at: DVec2, side: Side, colour: &str, text: &str) {
        self.write(at, side, colour, (LABEL, "normal"), text);
    }

    /// Draws a bold label.
    pub(super) fn bold(&mut self, at: DVec2, side: Side, colour: &str, text: &str) {
        self.write(at, side, colour, (LABEL, "bold"), text);
    }

    /// Draws a smaller label, for axes.
    pub(super) fn small(&mut self, at: DVec2, side: Side, colour: &str, text: &str) {
        self.write(at, side, colour, (SMALL, "normal"), text);
    }

    fn write(&mut self, at: DVec2, side: Side, colour: &str, (size, weight): (f64, &str), text: &str) {
        let node = TextElement::new(text)
            .set("x", rounded(at.x))
            .set("y", rounded(at.y))
            .set("font-size", size)
            .set("font-weight", weight)
            .set("text-anchor", side)
            .set("fill", colour);
        self.document.append(node);
    }

    fn add(&mut self, mut node: impl Node + Into<Box<dyn Node>>, paint: Paint) {
        node.assign("fill", paint.fill.0);
        node.assign("fill-opacity", paint.fill.1);
        node.assign("stroke", paint.stroke.0);
        node.assign("stroke-width", paint.stroke.1);
        if paint.is_dashed {
            node.assign("stroke-dasharray", "5 4");
        }
        self.document.append(node);
    }

    pub(super) fn polygon(&mut self, points: impl IntoIterator<Item = DVec2>, paint: Paint) {
        self.add(Polygon::new().set("points", joined(points)), paint);
    }

    pub(super) fn path(&mut self, points: impl IntoIterator<Item = DVec2>, paint: Paint) {
        self.add(Polyline::new().set("points", joined(points)), paint);
    }

    /// Draws many dots of a diameter in pixels, as one element.
    pub(super) fn dots(&mut self, centres: impl IntoIterator<Item = DVec2>, diameter: f64, colour: &'static str) {
        let dots: Vec<String> = centres.into_iter().map(|p| format!("M{},{}h0", rounded(p.x), rounded(p.y))).collect();
        self.add(Path::new().set("d", dots.concat()), stroke(colour, diameter));
    }

    pub(super) fn circle(&mut self, centre: DVec2, radius: f64, paint: Paint) {
        self.add(Circle::new().set("cx", rounded(centre.x)).set("cy", rounded(centre.y)).set("r", radius), paint);
    }

    /// Draws a rectangle given by two opposite corners.
    pub(super) fn rectangle(&mut self, a: DVec2, b: DVec2, paint: Paint) {
        self.polygon([a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)], paint);
    }
}

/// Rounds to a tenth of a pixel, which is finer than visible. Adding +0 makes -0 positive.
fn rounded(v: f64) -> f64 {
    libm::round(v * 10.0) / 10.0 + 0.0
}

fn joined(points: impl IntoIterator<Item = DVec2>) -> String {
    let points: Vec<String> = points.into_iter().map(|p| format!("{},{}", rounded(p.x), rounded(p.y))).collect();
    points.join(" ")
}

/// A transform from plot coordinates (y up) to page coordinates.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    scale: DVec2,
    offset: DVec2,
}

impl Frame {
    /// Returns the transform that maps the range `low..high` to the rectangle of the page with the corners
    /// `min` and `max`, scaling each axis separately.
    pub(super) fn stretched(low: DVec2, high: DVec2, min: DVec2, max: DVec2) -> Self {
        let scale = DVec2::new(max.x - min.x, min.y - max.y) / (high - low);
        Self { scale, offset: DVec2::new(min.x, max.y) - low * scale }
    }

    /// Returns the transform that maps `centre` to `middle` on the page, at a scale in pixels per unit.
    pub(super) fn scaled(centre: DVec2, middle: DVec2, scale: f64) -> Self {
        let scale = DVec2::new(scale, -scale);
        Self { scale, offset: middle - centre * scale }
    }

    /// Returns the transform that fits points into a rectangle of the page, with the same scale for both
    /// axes.
    pub(super) fn around(points: impl IntoIterator<Item = DVec2>, min: DVec2, max: DVec2) -> Self {
        let (low, high) = bounds(points);
        let scale = ((max - min) / (high - low)).min_element();
        Self::scaled((low + high) * 0.5, (min + max) * 0.5, scale)
    }

    pub(super) fn at(&self, p: DVec2) -> DVec2 {
        p * self.scale + self.offset
    }
}

/// Returns the least and greatest coordinates.
pub(super) fn bounds(points: impl IntoIterator<Item = DVec2>) -> (DVec2, DVec2) {
    points.into_iter().fold((DVec2::MAX, DVec2::MIN), |(low, high), p| (low.min(p), high.max(p)))
}
