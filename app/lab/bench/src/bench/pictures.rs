//! The folders in which a run saves its pictures.

use std::path::{Path, PathBuf};

use super::record::Setting;
use yoro_report::text::slug;

/// Returns the folder for all pictures of a run, beside its file of `results`.
pub fn pictures_beside(results: &Path) -> PathBuf {
    results.with_extension("pictures")
}

/// Returns the folder for the pictures of a setting, beside the file `results`: `RUN.pictures/SUITE/SCENE`, with
/// `.LABEL` or `.POINT` appended. It contains `dominant.png`, `truth.png` and `CONTENDER.png`.
pub fn picture_folder(results: &Path, setting: &Setting) -> PathBuf {
    let mut name = slug(&setting.scene);
    if let Some(label) = &setting.label {
        name += &format!(".{}", slug(label));
    }
    if let Some(point) = setting.point {
        name += &format!(".{point}");
    }
    pictures_beside(results).join(slug(&setting.suite)).join(name)
}
