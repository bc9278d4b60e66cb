//! The page of a run: one self-contained HTML file.
//!
//! It shows the table, then the plots, then the pictures side by side. The page is readable without its
//! script, which only hides the pictures that are not selected and shows large pictures one after another.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::imageops::{FilterType, resize};

use super::plots::{Plot, colour};
use super::png::png;
use crate::markdown::readable;
use crate::run::{FramePictures, Run, TechniqueRun, meaning, telling, value};
use crate::tables::{SCENE_NOTES, Table, facts, stopped, tables};

/// Greatest width of a picture in the page, in pixels. Wider pictures are scaled down to keep the file small.
const MAX_WIDTH: u32 = 1280;
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// Kinds of pictures, in display order, with their titles.
const KINDS: [(&str, &str); 3] = [
    ("overlay", "Errors: wrong pixels in colour, the rest dimmed"),
    ("heat", "Sampling: screen pixels per shadow texel"),
    ("picture", "Picture: as rendered"),
];

/// Returns the page of a run, with its plots and the pictures from `folder`.
///
/// # Errors
///
/// If a picture cannot be read.
pub(crate) fn page(run: &Run, plots: &[Plot], folder: &Path) -> Result<String> {
    let mut text = head(run);
    text.push_str(&table_section(run));
    text.push_str(&plot_section(plots));
    text.push_str(&picture_section(run, folder)?);
    text.push_str(&technique_section(run));
    let _ = write!(
        text,
        "<footer>Made by shadowfit's report. The figures are in <code>report.json</code>.</footer>\n</main>\n<script>{SCRIPT}</script>\n</body>\n</html>\n"
    );
    Ok(text)
}

fn head(run: &Run) -> String {
    let title = escape(&run.title);
    let mut text = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n\
         <body>\n<main>\n<header>\n<h1>{title}</h1>\n"
    );
    if !run.finished {
        let _ = writeln!(text, "<p class=\"banner\"><strong>Stopped early:</strong> {}</p>", escape(&stopped(run)));
    }
    text.push_str("<dl class=\"facts\">\n");
    for (name, value) in facts(run) {
        let _ = writeln!(text, "<div><dt>{name}</dt><dd>{}</dd></div>", escape(&value));
    }
    text.push_str("</dl>\n");
    for note in &run.notes {
        let _ = writeln!(text, "<p class=\"note\">{}</p>", escape(note));
    }
    if !run.scene_notes.is_empty() {
        let _ = write!(text, "<h2>{SCENE_NOTES}</h2>\n<ul class=\"note\">\n");
        for note in &run.scene_notes {
            let _ = writeln!(text, "<li>{}</li>", escape(note));
        }
        text.push_str("</ul>\n");
    }
    text.push_str("</header>\n");
    text
}

fn table_section(run: &Run) -> String {
    let tables = tables(run);
    let mut text =
        "<section>\n<h2>Figures</h2>\n<p class=\"lead\">Shares are of the pixels that face the light; the best \
                    value of a column is bold.</p>\n"
            .to_owned();
    let (overall, groups) = tables.split_first().map_or((None, &[][..]), |(first, rest)| (Some(first), rest));
    if let Some(table) = overall {
        text.push_str(&table_html(table));
    }
    for table in groups {
        let title = escape(&table.title);
        let _ = write!(text, "<details>\n<summary>{title}</summary>\n{}</details>\n", table_html(table));
    }
    let known = overall.map(|table| table.columns.as_slice()).unwrap_or_default();
    text.push_str("<details>\n<summary>What the columns mean</summary>\n<dl class=\"meanings\">\n");
    for (column, meaning) in known.iter().filter_map(|column| Some((column, meaning(column)?))) {
        let _ = writeln!(text, "<div><dt>{}</dt><dd>{}</dd></div>", escape(column), escape(meaning));
    }
    text.push_str("</dl>\n");
    text.push_str("</details>\n</section>\n");
    text
}

fn table_html(table: &Table) -> String {
    let mut text = "<div class=\"scroll\"><table>\n<thead><tr><th scope=\"col\">Technique</th>".to_owned();
    for column in &table.columns {
        let title = meaning(column).map(|text| format!(" title=\"{}\"", escape(text))).unwrap_or_default();
        let _ = write!(text, "<th scope=\"col\"{title}>{}</th>", escape(column));
    }
    text.push_str("</tr></thead>\n<tbody>\n");
    for (place, (name, cells)) in table.rows.iter().enumerate() {
        let _ = write!(text, "<tr><th scope=\"row\">{}{}</th>", swatch(place), escape(name));
        for (cell, is_best) in cells {
            let cell = escape(cell);
            let cell = if *is_best { format!("<strong>{cell}</strong>") } else { cell };
            let _ = write!(text, "<td>{cell}</td>");
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</tbody>\n</table></div>\n");
    text
}

/// Returns a dot in the technique's plot colour.
fn swatch(place: usize) -> String {
    let [r, g, b] = colour(place);
    format!("<i class=\"swatch\" style=\"background:rgb({r},{g},{b})\"></i>")
}

fn plot_section(plots: &[Plot]) -> String {
    if plots.is_empty() {
        return String::new();
    }
    let mut text = "<section>\n<h2>Over the camera path</h2>\n<div class=\"plots\">\n".to_owned();
    for plot in plots {
        let label = escape(&format!("{} over the camera path", plot.column));
        let svg = scalable(&plot.svg);
        let _ = writeln!(text, "<figure class=\"plot\" role=\"img\" aria-label=\"{label}\">{svg}</figure>");
    }
    text + "</div>\n</section>\n"
}

/// Returns SVG that scales to the width of its container.
fn scalable(svg: &str) -> String {
    let start = svg.find("<svg").unwrap_or(0);
    svg[start..].replacen("<svg ", "<svg class=\"chart\" ", 1)
}

fn picture_section(run: &Run, folder: &Path) -> Result<String> {
    let mut text = String::new();
    for (frame, why) in chosen_frames(run) {
        let name = escape(&run.frames[frame].name);
        let _ = write!(text, "<article class=\"frame\" data-frame=\"{name}\">\n<h3>{why} <span>{name}</span></h3>\n");
        for (kind, title) in KINDS {
            let figures = run.techniques.iter().enumerate().filter_map(|(place, technique)| {
                let pictures = technique.pictures.iter().find(|pictures| pictures.frame == frame)?;
                Some(figure(technique, place, pictures, kind, folder))
            });
            let figures = figures.collect::<Result<String>>()?;
            let _ = write!(
                text,
                "<section class=\"kind\" data-kind=\"{kind}\">\n<h4>{title}</h4>\n<div class=\"row\">\n{figures}</div>\n\
                 </section>\n"
            );
        }
        text.push_str("</article>\n");
    }
    if text.is_empty() {
        return Ok(text);
    }
    let lead = "Frames are picked by the mean of wrong % over the techniques.";
    Ok(format!("<section id=\"pictures\">\n<h2>Pictures</h2>\n<p class=\"lead\">{lead}</p>\n{text}</section>\n"))
}

/// Returns the worst, the median and the best of the frames that have pictures.
fn chosen_frames(run: &Run) -> Vec<(usize, &'static str)> {
    let has_pictures = |frame: &usize| {
        run.techniques.iter().flat_map(|technique| &technique.pictures).any(|shown| shown.frame == *frame)
    };
    telling(run, (0..run.frames.len()).filter(has_pictures))
}

fn figure(
    technique: &TechniqueRun,
    place: usize,
    pictures: &FramePictures,
    kind: &str,
    folder: &Path,
) -> Result<String> {
    let file = match kind {
        "overlay" => &pictures.overlay,
        "heat" => &pictures.heat,
        _ => &pictures.picture,
    };
    let name = escape(&technique.name);
    let wrong = technique.frames.get(pictures.frame).and_then(|columns| value(columns, crate::run::WRONG));
    let wrong = wrong.map(|wrong| format!(" <span>{} % wrong</span>", readable(wrong))).unwrap_or_default();
    let source = data_uri(&folder.join(file))?;
    Ok(format!(
        "<figure><img src=\"{source}\" alt=\"{name}, {kind}\" loading=\"lazy\">\
         <figcaption>{}{name}{wrong}</figcaption></figure>\n",
        swatch(place)
    ))
}

/// Returns a PNG file as a data URI. Wide pictures are scaled down.
fn data_uri(file: &Path) -> Result<String> {
    let read = || -> Result<Vec<u8>> {
        let bytes = fs::read(file)?;
        let picture = image::load_from_memory(&bytes)?;
        if picture.width() <= MAX_WIDTH {
            return Ok(bytes);
        }
        let height = (u64::from(picture.height()) * u64::from(MAX_WIDTH) / u64::from(picture.width())).max(1) as u32;
        png(&resize(&picture.to_rgba8(), MAX_WIDTH, height, FilterType::CatmullRom))
    };
    let bytes = read().with_context(|| format!("{}: the picture cannot be read for the page", file.display()))?;
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(bytes)))
}

fn technique_section(run: &Run) -> String {
    let mut text = "<section>\n<h2>Techniques</h2>\n".to_owned();
    for (place, technique) in run.techniques.iter().enumerate() {
        let [name, what, settings] = [&technique.name, &technique.what, &technique.settings].map(|text| escape(text));
        let _ = write!(
            text,
            "<details>\n<summary>{}{name} <span>{what}</span></summary>\n<pre><code>{settings}</code></pre>\n</details>\n",
            swatch(place)
        );
    }
    text.push_str("</section>\n");
    text
}

/// Escapes text for HTML elements and quoted attributes.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            _ => escaped.push(character),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::tests::run;

    fn with_pictures(folder: &Path) -> Run {
        let mut run = run();
        std::fs::create_dir_all(folder).expect("a folder");
        let wide = image::RgbaImage::from_pixel(MAX_WIDTH + 700, 4, image::Rgba([9, 9, 9, 255]));
        std::fs::write(folder.join("a.png"), png(&wide).expect("a PNG")).expect("written");
        for technique in &mut run.techniques {
            let shown = |frame: usize| {
                let [overlay, heat, picture] = ["a.png"; 3].map(Into::into);
                FramePictures { frame, overlay, heat, picture }
            };
            technique.pictures = [0, 1, 3, 4].map(shown).into();
        }
        run
    }

    #[test]
    fn the_page_asks_for_nothing_else_and_escapes_what_it_is_given() {
        let folder = std::env::temp_dir().join(format!("shadowfit-page-{}", std::process::id()));
        let mut run = with_pictures(&folder);
        run.techniques[0].what = "\"a\" <b onload='x'>".into();
        let plots = crate::page::plots::plots(&run).expect("plots");
        let page = page(&run, &plots, &folder);
        std::fs::remove_dir_all(&folder).expect("removed");
        let page = page.expect("a page");
        assert!(!page.contains("<1>") && page.contains("Courtyard &lt;1&gt;") && !page.contains("<b onload"));
        let outside = page.replace("http://www.w3.org/2000/svg", "");
        for request in ["http:", "https:", "@import", "url(", "<link"] {
            assert!(!outside.contains(request), "{request}");
        }
        assert_eq!(page.matches("data:image/png;base64,").count(), 3 * 2 * KINDS.len());
        assert!(page.contains("A note &amp; more.") && !page.contains("Stopped early"));
    }

    #[test]
    fn the_worst_median_and_best_of_the_frames_with_pictures_are_shown_once() {
        let folder = std::env::temp_dir().join(format!("shadowfit-page-frames-{}", std::process::id()));
        let mut run = with_pictures(&folder);
        std::fs::remove_dir_all(&folder).expect("removed");
        assert_eq!(chosen_frames(&run), [(4, "Worst frame"), (1, "Median frame"), (0, "Best frame")]);
        for technique in &mut run.techniques {
            technique.pictures.truncate(1);
        }
        assert_eq!(chosen_frames(&run), [(0, "Worst frame")]);
        run.techniques.clear();
        assert!(chosen_frames(&run).is_empty());
    }

    #[test]
    fn a_missing_picture_is_named() {
        let error = data_uri(Path::new("nowhere/a.png")).expect_err("refused");
        assert!(format!("{error:#}").starts_with("nowhere/a.png: the picture cannot be read"), "{error:#}");
    }

    #[test]
    fn the_page_lists_the_notes_on_the_scene_and_has_no_heading_for_none() {
        let text = page(&run(), &[], Path::new(".")).expect("a page");
        let list = "<h2>Notes on the scene</h2>\n<ul class=\"note\">\n<li>images[0]: replaced by a placeholder</li>\n\
                    <li>points &lt;skipped&gt;</li>\n</ul>";
        assert!(text.contains(list), "{text}");
        let text = page(&Run { scene_notes: Vec::new(), ..run() }, &[], Path::new(".")).expect("a page");
        assert!(!text.contains("Notes on the scene"), "{text}");
    }

    #[test]
    fn a_run_that_was_stopped_says_so_above_its_table() {
        let page = page(&Run { finished: false, ..run() }, &[], Path::new(".")).expect("a page");
        let [banner, table] = ["Stopped early:", "<table>"].map(|part| page.find(part).expect(part));
        assert!(banner < table);
    }
}
