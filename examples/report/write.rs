//! The output folder of a report, and writing into it so that a reader never sees half a file.
//!
//! ```text
//! index.html  report.md  report.json  path.toml  pictures/*.png  plots/*.svg
//! ```

use std::path::{Path, PathBuf};

use anyhow::Result;
use image::RgbaImage;
use shadowfit_study::{make_folder, write_whole};

use crate::data::Run;
use crate::page::page;
use crate::path::CameraPath;
use crate::plots::plots;
use crate::png::png;
use crate::tables::{to_json, to_markdown};

const PICTURES: &str = "pictures";
const PLOTS: &str = "plots";
/// The camera path.
pub(crate) const PATH: &str = "path.toml";
/// The page, which a reader opens first.
pub(crate) const PAGE: &str = "index.html";

/// An output folder.
#[derive(Clone, Debug)]
pub(crate) struct Output {
    folder: PathBuf,
}

impl Output {
    /// Makes the folder and those in it, where they are not there yet.
    ///
    /// # Errors
    ///
    /// When they cannot be made or written to.
    pub(crate) fn create(folder: &Path) -> Result<Self> {
        for folder in [folder.to_owned(), folder.join(PICTURES), folder.join(PLOTS)] {
            make_folder(&folder)?;
        }
        Ok(Self { folder: folder.to_owned() })
    }

    /// Writes a picture of a frame, such as `overlay`, and returns its place relative to the folder. Names may hold any
    /// characters; `technique` is the place of the technique in the run, so that equal names do not collide.
    ///
    /// # Errors
    ///
    /// When it cannot be written.
    pub(crate) fn write_picture(
        &self,
        technique: (usize, &str),
        frame: &str,
        kind: &str,
        picture: &RgbaImage,
    ) -> Result<PathBuf> {
        let (place, name) = technique;
        let file = Path::new(PICTURES).join(format!("{place}-{}-{}-{kind}.png", slug(name), slug(frame)));
        self.write(&file, &png(picture)?)?;
        Ok(file)
    }

    /// Writes the tables, plots, path and page of a run whose pictures are written already.
    ///
    /// # Errors
    ///
    /// When a file cannot be written, or a picture cannot be read back for the page.
    pub(crate) fn write_report(&self, run: &Run, path: &CameraPath) -> Result<()> {
        let file = Path::new(PATH);
        self.write(file, path.to_text(file)?.as_bytes())?;
        self.write(Path::new("report.json"), to_json(run)?.as_bytes())?;
        self.write(Path::new("report.md"), to_markdown(run).as_bytes())?;
        let plots = plots(run)?;
        for plot in &plots {
            self.write(&Path::new(PLOTS).join(format!("{}.svg", slug(&plot.column))), plot.svg.as_bytes())?;
        }
        // The page comes last: where it is, the rest is.
        self.write(Path::new(PAGE), page(run, &plots, &self.folder)?.as_bytes())
    }

    fn write(&self, file: &Path, bytes: &[u8]) -> Result<()> {
        write_whole(&self.folder.join(file), bytes)
    }
}

/// A name that every file system takes: letters, digits and dashes.
fn slug(name: &str) -> String {
    let letters = name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { ' ' });
    letters.collect::<String>().split_whitespace().collect::<Vec<_>>().join("-")
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::data::FramePictures;
    use crate::data::tests::run;
    use image::Rgba;
    use shadowfit::PerspectiveCamera;

    fn path() -> CameraPath {
        let (eye, forward, up) = (glam::DVec3::ZERO, glam::Vec3::NEG_Z, glam::Vec3::Y);
        let camera = PerspectiveCamera { eye, forward, up, fov_y: 1.0, aspect: 1.5, near: 0.1, far: 10.0 };
        CameraPath {
            frames: vec![crate::path::PathFrame { camera: camera.into(), group: "orbit".into() }],
            light: None,
        }
    }

    #[test]
    fn a_report_has_all_its_files_and_no_unfinished_ones() {
        let folder = std::env::temp_dir().join(format!("shadowfit-report-{}", std::process::id()));
        let output = Output::create(&folder).expect("a folder");
        let mut run = run();
        let picture = RgbaImage::from_pixel(8, 8, Rgba([1, 2, 3, 255]));
        for (place, technique) in run.techniques.iter_mut().enumerate() {
            let [overlay, heat, picture] = ["overlay", "heat", "picture"].map(|kind| {
                output.write_picture((place, &technique.name), "orbit/1", kind, &picture).expect("written")
            });
            technique.pictures.push(FramePictures { frame: 1, overlay, heat, picture });
        }
        output.write_report(&run, &path()).expect("written");
        let mut files: Vec<String> = ["", "pictures", "plots"]
            .iter()
            .flat_map(|sub| fs::read_dir(folder.join(sub)).expect("a folder"))
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        files.sort();
        let read = CameraPath::read(&folder.join("path.toml"), 1.5);
        fs::remove_dir_all(&folder).expect("removed");
        assert_eq!(read.expect("a path"), path());
        for wanted in ["index.html", "report.md", "report.json", "wrong.svg", "1-focused-best-orbit-1-heat.png"] {
            assert!(files.iter().any(|file| file == wanted), "{wanted}: {files:?}");
        }
        assert!(files.iter().all(|file| !file.contains(".part")), "{files:?}");
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let error = Output::create(Path::new("/dev/null/report")).expect_err("refused");
        assert!(format!("{error:#}").contains("/dev/null/report"), "{error:#}");
    }

    #[test]
    fn names_of_files_have_letters_digits_and_dashes_only() {
        assert_eq!(["../a b", "ppt p95", "wrong %", "Ä|x/3"].map(slug), ["a-b", "ppt-p95", "wrong", "x-3"]);
    }
}
