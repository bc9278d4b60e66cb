//! Curves over logarithmic axes, as SVG.

use std::path::Path;

use anyhow::{Result, anyhow};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use shadowfit_report::page::plotting::{
    COLOURS, FAMILY, GRID, INK, LEGEND_LINE, LEGEND_TOP, PAPER, RULE, TEXT, TITLE, register, text_style,
};
use shadowfit_report::readable;
use shadowfit_study::write_whole;

/// Size, in pixels, and width of the legend.
const SIZE: (u32, u32) = (860, 400);
const LEGEND: u32 = 270;
/// Margin around the curves, as a factor.
const ROOM: f64 = 1.3;

/// A line through measured points.
#[derive(Clone)]
pub(crate) struct Curve {
    name: String,
    /// Index of its colour, and whether it is drawn thin, with hollow marks, for comparison.
    colour: usize,
    is_thin: bool,
    points: Vec<(f64, f64)>,
}

/// Curves in one picture.
pub(crate) struct Picture {
    /// Name of the file, without its extension.
    pub(crate) file: &'static str,
    pub(crate) title: &'static str,
    /// Labels of the axes.
    pub(crate) axes: [&'static str; 2],
    pub(crate) curves: Vec<Curve>,
}

impl Curve {
    /// Creates a line in the colour of an index.
    pub(crate) fn new(name: impl Into<String>, colour: usize) -> Self {
        Self { name: name.into(), colour, is_thin: false, points: Vec::new() }
    }

    /// Creates a thin line with hollow marks in the colour of an index, for comparison with others.
    pub(crate) fn thin(name: impl Into<String>, colour: usize) -> Self {
        Self { is_thin: true, ..Self::new(name, colour) }
    }

    /// Adds a value.
    pub(crate) fn add(&mut self, count: usize, value: f64) {
        self.points.push((count as f64, value));
    }

    /// Returns styles of the line and of its marks.
    fn styles(&self) -> [ShapeStyle; 2] {
        let colour = COLOURS[self.colour % COLOURS.len()];
        if self.is_thin {
            [colour.stroke_width(1), colour.stroke_width(1)]
        } else {
            [colour.stroke_width(2), colour.filled()]
        }
    }
}

impl Picture {
    /// Writes it into a folder.
    pub(crate) fn write(&self, folder: &Path) -> Result<()> {
        register();
        let file = folder.join(self.file).with_extension("svg");
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
            self.draw(&area)
                .and_then(|()| area.present())
                .map_err(|error| anyhow!("{}: cannot be drawn: {error}", file.display()))?;
        }
        write_whole(&file, svg.as_bytes())
    }

    fn draw(&self, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Drawn {
        area.fill(&PAPER)?;
        let (left, right) = area.split_horizontally(SIZE.0 - LEGEND);
        self.draw_legend(&right)?;
        let mut chart = ChartBuilder::on(&left)
            .margin(8)
            .margin_top(44)
            .margin_right(24)
            .x_label_area_size(52)
            .y_label_area_size(62)
            .build_cartesian_2d(self.range(|point| point.0).log_scale(), self.range(|point| point.1).log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .axis_style(RULE)
            .x_desc(self.axes[0])
            .y_desc(self.axes[1])
            .x_label_formatter(&|value| grouped(value.round() as usize))
            .y_label_formatter(&|value| readable(*value))
            .label_style((FAMILY, TEXT).into_font().color(&INK))
            .draw()?;
        area.draw(&Text::new(self.title, (10, 20), text_style(TITLE, HPos::Left)))?;
        for curve in &self.curves {
            let [line, mark] = curve.styles();
            chart.draw_series(LineSeries::new(curve.points.iter().copied(), line))?;
            chart.draw_series(curve.points.iter().map(|point| Circle::new(*point, 3, mark)))?;
        }
        Ok(())
    }

    fn draw_legend(&self, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Drawn {
        for (curve, number) in self.curves.iter().zip(0..) {
            let ([line, mark], y) = (curve.styles(), LEGEND_TOP + LEGEND_LINE * number);
            area.draw(&PathElement::new([(4, y), (24, y)], line))?;
            area.draw(&Circle::new((14, y), 3, mark))?;
            area.draw(&Text::new(curve.name.clone(), (32, y), text_style(TEXT, HPos::Left)))?;
        }
        Ok(())
    }

    /// Returns the range of the points' values, with a margin.
    fn range(&self, value: impl Fn(&(f64, f64)) -> f64) -> core::ops::Range<f64> {
        let values = self.curves.iter().flat_map(|curve| &curve.points).map(value);
        let [low, high] = values.fold([f64::INFINITY, 0.0], |[low, high], v| [low.min(v), high.max(v)]);
        low / ROOM..high * ROOM
    }
}

type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// Returns a number with separated thousands.
pub(crate) fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let (first, rest) = digits.split_at((digits.len() - 1) % 3 + 1);
    rest.as_bytes().chunks(3).fold(first.to_owned(), |text, group| text + "," + &String::from_utf8_lossy(group))
}
