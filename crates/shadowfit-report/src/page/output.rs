//! The output folder of a report.
//!
//! ```text
//! index.html  report.md  report.json  path.toml  pictures/*.png  plots/*.svg
//! ```

use std::path::{Path, PathBuf};

use anyhow::Result;
use image::RgbaImage;

use super::html::page;
use super::plots::plots;
use super::png::png;
use crate::run::Run;
use crate::tables::{to_json, to_markdown};

const PICTURES: &str = "pictures";
const PLOTS: &str = "plots";
/// File name of the camera path.
pub const PATH: &str = "path.toml";
/// File name of the HTML page, the entry point for readers.
pub const PAGE: &str = "index.html";

/// Functions that write files. Readers never see partial files if both functions are atomic.
#[derive(Clone, Copy, Debug)]
pub struct FileWriter {
    /// Creates a folder and checks that it is writable.
    pub make_folder: fn(&Path) -> Result<()>,
    /// Writes a file, replacing an existing one.
    pub write: fn(&Path, &[u8]) -> Result<()>,
}

/// An output folder.
#[derive(Clone, Debug)]
pub struct Output {
    folder: PathBuf,
    writer: FileWriter,
}

impl Output {
    /// Creates the folder and its subfolders if they are missing.
    ///
    /// # Errors
    ///
    /// If a folder cannot be created or written to.
    pub fn create(folder: &Path, writer: FileWriter) -> Result<Self> {
        for folder in [folder.to_owned(), folder.join(PICTURES), folder.join(PLOTS)] {
            (writer.make_folder)(&folder)?;
        }
        Ok(Self { folder: folder.to_owned(), writer })
    }

    /// Writes a picture and returns its path relative to the folder.
    ///
    /// # Errors
    ///
    /// If the picture cannot be written.
    pub fn write_picture(&self, name: &PictureName<'_>, picture: &RgbaImage) -> Result<PathBuf> {
        let PictureName { place, technique, frame, kind } = name;
        let file = Path::new(PICTURES).join(format!("{place}-{}-{}-{kind}.png", slug(technique), slug(frame)));
        self.write(&file, &png(picture)?)?;
        Ok(file)
    }

    /// Writes the tables, plots, path and page of a run. Its pictures must be written already. `path` is the
    /// text of the camera path.
    ///
    /// # Errors
    ///
    /// If a file cannot be written, or a picture cannot be read back for the page.
    pub fn write_report(&self, run: &Run, path: Option<&str>) -> Result<()> {
        if let Some(path) = path {
            self.write(Path::new(PATH), path.as_bytes())?;
        }
        self.write(Path::new("report.json"), to_json(run)?.as_bytes())?;
        self.write(Path::new("report.md"), to_markdown(run).as_bytes())?;
        let plots = plots(run)?;
        for plot in &plots {
            self.write(&Path::new(PLOTS).join(format!("{}.svg", slug(&plot.column))), plot.svg.as_bytes())?;
        }
        // The page is written last: if it exists, all other files do.
        self.write(Path::new(PAGE), page(run, &plots, &self.folder)?.as_bytes())
    }

    fn write(&self, file: &Path, bytes: &[u8]) -> Result<()> {
        (self.writer.write)(&self.folder.join(file), bytes)
    }
}

/// The parts of the file name of a picture. Technique and frame may hold any characters.
#[derive(Clone, Copy, Debug)]
pub struct PictureName<'a> {
    /// Index of the technique in the run, so that techniques with equal names get different files.
    pub place: usize,
    /// Name of the technique.
    pub technique: &'a str,
    /// Name of the frame.
    pub frame: &'a str,
    /// Kind of picture, such as `overlay`.
    pub kind: &'a str,
}

/// Returns a file name that is valid on all file systems: letters, digits and dashes.
fn slug(name: &str) -> String {
    let letters = name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { ' ' });
    letters.collect::<String>().split_whitespace().collect::<Vec<_>>().join("-")
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::run::FramePictures;
    use crate::run::tests::run;
    use image::Rgba;

    const WRITER: FileWriter = FileWriter {
        make_folder: |folder| Ok(fs::create_dir_all(folder)?),
        write: |file, bytes| Ok(fs::write(file, bytes)?),
    };

    #[test]
    fn a_report_has_all_its_files() {
        let folder = std::env::temp_dir().join(format!("shadowfit-report-{}", std::process::id()));
        let output = Output::create(&folder, WRITER).expect("a folder");
        let mut run = run();
        let picture = RgbaImage::from_pixel(8, 8, Rgba([1, 2, 3, 255]));
        for (place, technique) in run.techniques.iter_mut().enumerate() {
            let [overlay, heat, picture] = ["overlay", "heat", "picture"].map(|kind| {
                let name = PictureName { place, technique: &technique.name, frame: "orbit/1", kind };
                output.write_picture(&name, &picture).expect("written")
            });
            technique.pictures.push(FramePictures { frame: 1, overlay, heat, picture });
        }
        output.write_report(&run, Some("near = 0.1\n")).expect("written");
        let mut files: Vec<String> = ["", "pictures", "plots"]
            .iter()
            .flat_map(|sub| fs::read_dir(folder.join(sub)).expect("a folder"))
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        files.sort();
        let path = fs::read_to_string(folder.join(PATH));
        fs::remove_dir_all(&folder).expect("removed");
        assert_eq!(path.expect("a path"), "near = 0.1\n");
        for wanted in ["index.html", "report.md", "report.json", "wrong.svg", "1-focused-best-orbit-1-heat.png"] {
            assert!(files.iter().any(|file| file == wanted), "{wanted}: {files:?}");
        }
    }

    #[test]
    fn names_of_files_have_letters_digits_and_dashes_only() {
        assert_eq!(["../a b", "ppt p95", "wrong %", "Ä|x/3"].map(slug), ["a-b", "ppt-p95", "wrong", "x-3"]);
    }
}
