//! Drawing: a light panel with lines, areas and labels, written by the `svg` crate.
//!
//! Page coordinates are pixels at a width of 720, y down. A [`Frame`] takes plot coordinates (y up) to them.

use shadowfit::glam::DVec2;
use svg::Document;
use svg::node::Node;
use svg::node::element::{Circle, Path, Polygon, Polyline, Rectangle, Text as TextElement, Title};

/// Width of every picture, in pixels: that of a page's text on GitHub, nearly.
const WIDTH: f64 = 720.0;

/// The colours, chosen to be told apart by colour-blind readers as well (M. Okabe and K. Ito's set).
pub(super) const INK: &str = "#2b2b2b";
pub(super) const GREY: &str = "#8a8a8a";
pub(super) const BLUE: &str = "#0072b2";
pub(super) const RED: &str = "#d55e00";
pub(super) const YELLOW: &str = "#e69f00";
pub(super) const GREEN: &str = "#009e73";
pub(super) const PURPLE: &str = "#a5488a";

/// Colours of the maps, the nearest first.
pub(super) const MAPS: [&str; 4] = [BLUE, GREEN, YELLOW, PURPLE];

/// Size of labels and of smaller ones, in pixels.
const LABEL: f64 = 14.0;
const SMALL: f64 = 12.0;

/// How a shape is painted: its area's colour and opacity, and its line's colour and width in pixels.
#[derive(Clone, Copy)]
pub(super) struct Paint {
    fill: (&'static str, f64),
    stroke: (&'static str, f64),
    is_dashed: bool,
}

/// An area without an outline.
pub(super) const fn fill(colour: &'static str, opacity: f64) -> Paint {
    stroke("none", 0.0).filled(colour, opacity)
}

/// A line of a width in pixels.
pub(super) const fn stroke(colour: &'static str, width: f64) -> Paint {
    Paint { fill: ("none", 1.0), stroke: (colour, width), is_dashed: false }
}

impl Paint {
    /// The same with its area filled.
    pub(super) const fn filled(self, colour: &'static str, opacity: f64) -> Self {
        Self { fill: (colour, opacity), ..self }
    }

    /// The same with a dashed line.
    pub(super) const fn dashed(self) -> Self {
        Self { is_dashed: true, ..self }
    }
}

/// Where a label stands beside its point, as SVG says it.
pub(super) type Side = &'static str;

/// Ends at the point.
pub(super) const LEFT: Side = "end";
/// Is centred on the point.
pub(super) const MIDDLE: Side = "middle";
/// Begins at the point.
pub(super) const RIGHT: Side = "start";

/// A picture in the making.
pub(super) struct Canvas {
    document: Document,
}

impl Canvas {
    /// A light panel of the usual width, in pixels, with a title that screen readers say.
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

    /// Draws what shows only inside a rectangle of the page, with an outline and a title above.
    pub(super) fn panel(&mut self, min: DVec2, size: DVec2, title: &str, draw: impl FnOnce(&mut Self)) {
        // An SVG element inside another one hides what is outside of it.
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

    /// A label in a colour. Its baseline lies at the point.
    pub(super) fn text(&mut self, at: DVec2, side: Side, colour: &str, text: &str) {
        self.write(at, side, colour, (LABEL, "normal"), text);
    }

    /// A label in bold.
    pub(super) fn bold(&mut self, at: DVec2, side: Side, colour: &str, text: &str) {
        self.write(at, side, colour, (LABEL, "bold"), text);
    }

    /// A smaller label, for axes.
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

    /// Many dots of a diameter in pixels, as one element.
    pub(super) fn dots(&mut self, centres: impl IntoIterator<Item = DVec2>, diameter: f64, colour: &'static str) {
        let dots: Vec<String> = centres.into_iter().map(|p| format!("M{},{}h0", rounded(p.x), rounded(p.y))).collect();
        self.add(Path::new().set("d", dots.concat()), stroke(colour, diameter));
    }

    pub(super) fn circle(&mut self, centre: DVec2, radius: f64, paint: Paint) {
        self.add(Circle::new().set("cx", rounded(centre.x)).set("cy", rounded(centre.y)).set("r", radius), paint);
    }

    /// A rectangle from two opposite corners.
    pub(super) fn rectangle(&mut self, a: DVec2, b: DVec2, paint: Paint) {
        self.polygon([a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)], paint);
    }
}

/// A tenth of a pixel is finer than anyone sees. Adding +0 makes -0 positive.
fn rounded(v: f64) -> f64 {
    libm::round(v * 10.0) / 10.0 + 0.0
}

fn joined(points: impl IntoIterator<Item = DVec2>) -> String {
    let points: Vec<String> = points.into_iter().map(|p| format!("{},{}", rounded(p.x), rounded(p.y))).collect();
    points.join(" ")
}

/// Takes plot coordinates, y up, to the page.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    scale: DVec2,
    offset: DVec2,
}

impl Frame {
    /// Takes the range `low..high` to the rectangle of the page with the corners `min` and `max`; both axes on their
    /// own.
    pub(super) fn stretched(low: DVec2, high: DVec2, min: DVec2, max: DVec2) -> Self {
        let scale = DVec2::new(max.x - min.x, min.y - max.y) / (high - low);
        Self { scale, offset: DVec2::new(min.x, max.y) - low * scale }
    }

    /// Puts a point in the middle of a place on the page, at a scale in pixels per unit.
    pub(super) fn scaled(centre: DVec2, middle: DVec2, scale: f64) -> Self {
        let scale = DVec2::new(scale, -scale);
        Self { scale, offset: middle - centre * scale }
    }

    /// Puts points into a rectangle of the page at one scale for both axes, as large as they fit.
    pub(super) fn around(points: impl IntoIterator<Item = DVec2>, min: DVec2, max: DVec2) -> Self {
        let (low, high) = bounds(points);
        let scale = ((max - min) / (high - low)).min_element();
        Self::scaled((low + high) * 0.5, (min + max) * 0.5, scale)
    }

    pub(super) fn at(&self, p: DVec2) -> DVec2 {
        p * self.scale + self.offset
    }
}

/// Least and greatest coordinates.
pub(super) fn bounds(points: impl IntoIterator<Item = DVec2>) -> (DVec2, DVec2) {
    points.into_iter().fold((DVec2::MAX, DVec2::MIN), |(low, high), p| (low.min(p), high.max(p)))
}
