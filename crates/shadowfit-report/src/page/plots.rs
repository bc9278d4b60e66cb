//! SVG plots along the camera path: one column per plot, frames on the x axis, one line per technique.
//!
//! They show where on the path a technique fails. A table of the whole path hides this.

use anyhow::{Result, anyhow};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::plotting::{
    COLOURS, FAMILY, GRID, INK, LEGEND_LINE, LEGEND_TOP, PAPER, RULE, TEXT, TITLE, register, text_style,
};
use crate::markdown::readable;
use crate::run::{Run, TechniqueRun, value};

/// Columns that are plotted if the run has values for them.
const COLUMNS: [&str; 8] =
    ["wrong %", "light error %", "flip", "false shadow %", "false light %", "hole %", "ppt p95", "crawl %"];
/// Width and minimum height, in pixels. Browsers scale the plots. A long legend makes a plot higher.
const SIZE: (u32, u32) = (780, 300);
/// Width of the legend beside the plot, in pixels, and the number of characters of a name that fit.
const LEGEND: u32 = 215;
const NAME_LENGTH: usize = 23;
/// Distance of group names below the axis, in pixels. The axis numbers are in between.
const BELOW_AXIS: i32 = 35;
/// Greatest ratio of values for a linear axis. Larger ratios get a logarithmic one.
const EVEN_RATIO: f64 = 100.0;

/// A plot of one column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Plot {
    pub(crate) column: String,
    pub(crate) svg: String,
}

/// A group of consecutive frames: its name, its first frame, and the frame after its last one.
#[derive(Clone, Debug, PartialEq)]
struct Group<'a> {
    name: &'a str,
    frames: [usize; 2],
}

/// Returns the colour (sRGB) of the technique with this index in the run. It is the same in all plots.
pub(crate) fn colour(place: usize) -> [u8; 3] {
    let RGBColor(r, g, b) = COLOURS[place % COLOURS.len()];
    [r, g, b]
}

/// Returns a plot for each column that has values in the run.
///
/// # Errors
///
/// If a plot cannot be drawn.
pub(crate) fn plots(run: &Run) -> Result<Vec<Plot>> {
    register();
    let has_values = |column: &&str| values(run, column).next().is_some();
    COLUMNS.into_iter().filter(has_values).map(|column| plot(run, column)).collect()
}

fn plot(run: &Run, column: &str) -> Result<Plot> {
    let mut svg = String::new();
    let legend_height = LEGEND_TOP as u32 + LEGEND_LINE as u32 * run.techniques.len() as u32;
    {
        let area = SVGBackend::with_string(&mut svg, (SIZE.0, SIZE.1.max(legend_height))).into_drawing_area();
        draw(run, column, &area).map_err(|error| anyhow!("the plot of {column} cannot be drawn: {error}"))?;
        area.present().map_err(|error| anyhow!("the plot of {column} cannot be drawn: {error}"))?;
    }
    Ok(Plot { column: column.to_owned(), svg })
}

/// Returns the finite values of a column, for all techniques and frames.
fn values<'a>(run: &'a Run, column: &'a str) -> impl Iterator<Item = f64> + 'a {
    let frames = run.techniques.iter().flat_map(|technique| &technique.frames);
    frames.filter_map(move |columns| value(columns, column)).filter(|value| value.is_finite())
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn<'a> = Result<(), DrawingAreaErrorKind<std::io::Error>>;

fn draw<'a>(run: &Run, column: &str, area: &Area<'a>) -> Drawn<'a> {
    area.fill(&PAPER)?;
    let (chart, side) = area.split_horizontally(SIZE.0 - LEGEND);
    legend(run, &side)?;
    let [low, high] = values(run, column).fold([f64::INFINITY, 0.0], |[low, high], v| [low.min(v), high.max(v)]);
    if low > 0.0 && high / low > EVEN_RATIO {
        draw_chart(run, column, &chart, (low * 0.8..high * 1.25).log_scale())
    } else {
        draw_chart(run, column, &chart, 0.0..if high > 0.0 { high * 1.08 } else { 1.0 })
    }
}

fn draw_chart<'a, Y>(run: &Run, column: &str, area: &Area<'a>, range: Y) -> Drawn<'a>
where
    Y: AsRangedCoord<Value = f64>,
    Y::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let groups = groups(run);
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .margin_top(40)
        .x_label_area_size(44)
        .y_label_area_size(58)
        .build_cartesian_2d(-0.5..run.frames.len() as f64 - 0.5, range)?;
    let place_in_group = |x: &f64| {
        let frame = x.round().max(0.0) as usize;
        let group = groups.iter().find(|group| (group.frames[0]..group.frames[1]).contains(&frame));
        group.map_or_else(String::new, |group| (frame - group.frames[0]).to_string())
    };
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .axis_style(RULE)
        .x_labels(run.frames.len().min(16))
        .y_labels(6)
        .x_label_formatter(&place_in_group)
        .y_label_formatter(&|value| readable(*value))
        .label_style((FAMILY, TEXT).into_font().color(&INK))
        .draw()?;
    area.draw(&Text::new(column.to_owned(), (10, 20), text_style(TITLE, HPos::Left)))?;
    let bottom_and_top = chart.y_range();
    for group in &groups {
        let middle = (group.frames[0] + group.frames[1]) as f64 * 0.5 - 0.5;
        let (x, y) = chart.plotting_area().map_coordinate(&(middle, bottom_and_top.start));
        area.draw(&Text::new(group.name.to_owned(), (x, y + BELOW_AXIS), text_style(TEXT, HPos::Center)))?;
    }
    for group in groups.iter().skip(1) {
        let x = group.frames[0] as f64 - 0.5;
        chart.draw_series(LineSeries::new([(x, bottom_and_top.start), (x, bottom_and_top.end)], RULE))?;
    }
    for (place, technique) in run.techniques.iter().enumerate() {
        let style = COLOURS[place % COLOURS.len()].stroke_width(2);
        for line in groups.iter().flat_map(|group| lines(technique, column, group)) {
            chart.draw_series(LineSeries::new(line.iter().copied(), style))?;
            chart.draw_series(line.into_iter().map(|point| Circle::new(point, 3, mark(place))))?;
        }
    }
    Ok(())
}

/// Returns the lines of a technique in a group. A frame without a value ends a line.
fn lines(technique: &TechniqueRun, column: &str, group: &Group) -> Vec<Vec<(f64, f64)>> {
    let mut lines = vec![Vec::new()];
    for frame in group.frames[0]..group.frames[1] {
        let value = technique.frames.get(frame).and_then(|columns| value(columns, column));
        match (value.filter(|value| value.is_finite()), lines.last_mut()) {
            (Some(value), Some(line)) => line.push((frame as f64, value)),
            _ => lines.push(Vec::new()),
        }
    }
    lines.retain(|line| !line.is_empty());
    lines
}

/// Returns the style of a technique's marks: filled, and hollow when the colours repeat.
fn mark(place: usize) -> ShapeStyle {
    let colour = COLOURS[place % COLOURS.len()];
    if place < COLOURS.len() { colour.filled() } else { colour.stroke_width(1) }
}

fn legend<'a>(run: &Run, area: &Area<'a>) -> Drawn<'a> {
    for ((place, technique), line) in run.techniques.iter().enumerate().zip(0..) {
        let y = LEGEND_TOP + LEGEND_LINE * line;
        area.draw(&PathElement::new([(4, y), (24, y)], COLOURS[place % COLOURS.len()].stroke_width(2)))?;
        area.draw(&Circle::new((14, y), 3, mark(place)))?;
        area.draw(&Text::new(short(&technique.name), (32, y), text_style(TEXT, HPos::Left)))?;
    }
    Ok(())
}

/// Returns a name shortened to fit in the legend.
fn short(name: &str) -> String {
    if name.chars().count() <= NAME_LENGTH {
        return name.to_owned();
    }
    name.chars().take(NAME_LENGTH - 1).chain(['…']).collect()
}

fn groups(run: &Run) -> Vec<Group<'_>> {
    let mut groups: Vec<Group> = Vec::new();
    for (index, frame) in run.frames.iter().enumerate() {
        match groups.last_mut().filter(|group| group.name == frame.group) {
            Some(group) => group.frames[1] = index + 1,
            None => groups.push(Group { name: &frame.group, frames: [index, index + 1] }),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::tests::run;

    #[test]
    fn there_is_a_plot_of_each_column_that_has_values() {
        let columns: Vec<_> = plots(&run()).expect("plots").into_iter().map(|plot| plot.column).collect();
        assert_eq!(columns, ["wrong %", "false light %"]);
        let empty = Run { techniques: Vec::new(), frames: Vec::new(), ..run() };
        assert!(plots(&empty).expect("none").is_empty());
    }

    #[test]
    fn a_plot_names_its_techniques_and_groups_and_marks_every_value() {
        let plot = plots(&run()).expect("plots").remove(0);
        for wanted in ["xna", "focused | best", "orbit", "fly-through", "wrong %"] {
            assert!(plot.svg.contains(wanted), "{wanted}");
        }
        let marks = plot.svg.matches("<circle").count();
        assert_eq!(marks, 2 * 5 + 2, "five values of two techniques, and the legend");
    }

    #[test]
    fn lines_break_where_the_camera_jumps_and_where_nothing_was_measured() {
        let mut run = run();
        run.techniques[0].frames[1][0].1 = f64::NAN;
        let groups = groups(&run);
        assert_eq!(groups.iter().map(|group| group.frames).collect::<Vec<_>>(), [[0, 3], [3, 5]]);
        let lengths =
            groups.iter().flat_map(|group| lines(&run.techniques[0], "wrong %", group)).map(|line| line.len());
        assert_eq!(lengths.collect::<Vec<_>>(), [1, 1, 2]);
    }

    #[test]
    fn values_of_very_different_sizes_get_an_axis_of_powers() {
        let mut run = run();
        run.techniques[0].frames[0][0].1 = 0.001;
        let svg = |run: &Run| plots(run).expect("plots").remove(0).svg;
        assert!(svg(&run).contains(">\n0.001\n</text>") || svg(&run).contains(">\n0.01\n</text>"), "{}", svg(&run));
        run.techniques[0].frames[0][0].1 = 0.0;
        assert!(svg(&run).contains(">\n0\n</text>"));
        run.techniques.iter_mut().flat_map(|t| &mut t.frames).for_each(|columns| columns[0].1 = 0.0);
        assert!(!svg(&run).contains("NaN"));
    }

    #[test]
    fn names_in_svg_are_escaped_and_short() {
        let mut run = run();
        run.techniques[0].name = "<script> & a name of many, many words".into();
        let svg = plots(&run).expect("plots").remove(0).svg;
        assert!(!svg.contains("<script>") && svg.contains("&lt;script&gt;") && svg.contains('…'), "{svg}");
    }
}
