//! The folders in which a run saves its pictures.

use std::path::{Path, PathBuf};

use super::record::Conditions;
use yoro_report::text::slug;

/// Returns the folder for all pictures of a run, beside its file of `results`.
pub fn pictures_beside(results: &Path) -> PathBuf {
    results.with_extension("pictures")
}

/// Returns the folder for the pictures of a setting, beside the file `results`: `RUN.pictures/SUITE/SCENE`, with
/// `.LABEL` or `.POINT` appended. It contains `dominant.png`, `truth.png` and `CONTENDER.png`.
pub fn picture_folder(results: &Path, conditions: &Conditions) -> PathBuf {
    let mut name = slug(&conditions.scene);
    if let Some(label) = &conditions.label {
        name += &format!(".{}", slug(label));
    }
    if let Some(point) = conditions.point {
        name += &format!(".{point}");
    }
    pictures_beside(results).join(slug(&conditions.suite)).join(name)
}
