//! What synthesis finds hard, case by case: the part of the image that shows it.

use glam::Vec3;
use image::{RgbImage, imageops};

use super::super::Experiment;
use super::super::contender::Contender;
use super::super::frames::{Field, picture_name};
use super::super::job::{Choices, Job};
use super::super::record::metric;
use super::super::results::SuiteData;
use super::super::runner::{Runner, eye_image};
use super::super::scenes::LazyObject;
use super::super::tables::{PSNR_SSIM_FLIP, cell, psnr_ssim_flip, push_refusals, table_of};
use super::super::views::Views;
use yoro::eyes::View;
use yoro_files::interrupt;
use yoro_metrics::Comparison;
use yoro_render::PreparedScene;
use yoro_report::{Cell, Section};
use yoro_scenes::hard_cases::{CASES, Case};

/// The scene with the cases.
const SCENE: &str = "hard-cases";
/// The part of the image's height that the edges of the compared square take.
const PART: f32 = 0.3;

/// What synthesis finds hard, case by case.
pub struct HardCases;

impl Experiment for HardCases {
    fn name(&self) -> &'static str {
        "hard-cases"
    }

    fn about(&self) -> &'static str {
        "Quality of the part of the image that shows it, for each thing that synthesis finds hard"
    }

    fn jobs(&'static self, choices: &Choices, _: &LazyObject) -> anyhow::Result<Vec<Job>> {
        let own = vec![Contender::Synthesized(Default::default()), Contender::RenderedHoles];
        let contenders = choices.contenders(self.name(), own, &Contender::BASELINES)?;
        Ok(choices.sweep(self, vec![SCENE.to_owned()], CASES, |job, case| {
            job.conditions.label = Some(case.name.to_owned());
            job.contenders.clone_from(&contenders);
            job.frames = 1;
        }))
    }

    fn measure(&self, runner: &mut Runner, job: &Job, scene: &mut PreparedScene) -> anyhow::Result<()> {
        let head = (CASES[job.point].name.to_owned(), Case::viewpoint(job.point).pose());
        let views = Views::new(job, vec![head])?;
        let pair = &views.pairs[0];
        let other = pair.dominant.other();
        let mut field = Field::new(runner, job, scene, &views, false)?;
        let mut round = field.start_round(job, 0);
        let mut truth: Option<RgbImage> = None;
        runner.announce(job, 0);
        for entry in &mut field.entries {
            interrupt::check()?;
            entry.subject.render_settled(scene, pair, &mut field.frame)?;
            let part = part(&eye_image(&field.frame, other), &pair.view(other), Case::center(job.point));
            runner.save_picture(job, &picture_name(entry.contender), &part)?;
            match &truth {
                Some(truth) => {
                    round.of(&entry.name).push_comparison(&Comparison::of(&part, truth, None)?);
                }
                // The conventional method comes first.
                None => truth = Some(part),
            }
            runner.bar.inc(1);
        }
        runner.finish(round)
    }

    fn sections(&self, suite: &SuiteData) -> Vec<Section> {
        let mut section = Section::new(
            "Hard cases",
            format!(
                "What synthesis finds hard: a square of {:.0} % of the image's height around each case, at one viewpoint of \
                 the scene {SCENE}. The pictures below show these squares.",
                100.0 * PART
            ),
        );
        let contenders = suite.compared(metric::SSIM);
        let columns = [&contenders[..], &["<filled holes, looked at"]].concat();
        let mut table = table_of(PSNR_SSIM_FLIP, &["<case"], &columns);
        for setting in &suite.settings {
            let name = setting.conditions.label.as_deref().unwrap_or_default();
            let mut cells = vec![Cell::plain(name)];
            for contender in &contenders {
                let measured = setting.find(contender);
                cells.push(cell(contender, psnr_ssim_flip(|metric| measured?.mean(metric))));
            }
            let seen = CASES.iter().find(|case| case.name == name).map_or("", |case| case.seen);
            cells.push(Cell::long(seen));
            table.push(cells);
        }
        push_refusals(&mut table, suite);
        section.table(table);
        vec![section]
    }
}

/// Returns the square of a view's image around a point of the scene, moved so that it lies within the image.
fn part(image: &RgbImage, view: &View, center: Vec3) -> RgbImage {
    let edge = (PART * view.size[1] as f32).min(view.size[0] as f32) as u32;
    let seen = view.view_projection().project_point3(center);
    let corner = |from_left_or_top: f32, size: u32| {
        let pixels = (0.5 + 0.5 * from_left_or_top) * size as f32 - 0.5 * edge as f32;
        (pixels.max(0.0) as u32).min(size - edge)
    };
    let (x, y) = (corner(seen.x, view.size[0]), corner(-seen.y, view.size[1]));
    imageops::crop_imm(image, x, y, edge, edge).to_image()
}

#[cfg(test)]
mod tests {
    use super::*;
    use yoro::eyes::{EyeOptions, Pose};

    #[test]
    fn the_part_is_around_the_point_and_within_the_image() {
        let eyes = EyeOptions { size: [200, 100], fov_y: 90f32.to_radians(), ..EyeOptions::default() };
        let view = eyes.pair(Pose::IDENTITY).view(yoro::eyes::Eye::Left);
        let image = RgbImage::from_fn(200, 100, |x, y| image::Rgb([x as u8, y as u8, 0]));
        let first = |center: Vec3| part(&image, &view, center + view.pose.position).get_pixel(0, 0).0;
        assert_eq!(part(&image, &view, Vec3::NEG_Z).dimensions(), (30, 30));
        assert_eq!(first(Vec3::NEG_Z), [85, 35, 0]);
        assert_eq!(first(Vec3::new(0.4, 0.4, -1.0)), [105, 15, 0]);
        assert_eq!(first(Vec3::new(-5.0, -5.0, -1.0)), [0, 70, 0]);
    }
}
