//! Experiments that vary one quantity, or one setting.

use super::super::contender::Contender;
use super::super::job::Source;
use super::super::tables::{Sweep, show_labels};
use super::{FrameSuite, QUALITY};
use yoro_assets::ShadingStyle;
use yoro_report::paper::{DISTANCE as PAPERS_DISTANCE, PAPER};
use yoro_report::{Axis, Section};

pub(super) const STYLES: FrameSuite = FrameSuite {
    name: "styles",
    about: "Quality in each shading style",
    measures: QUALITY,
    contenders: Contender::synthesis,
    jobs: |suite, choices, _| {
        choices.sweep(suite, choices.varied_scenes(), ShadingStyle::ALL, |job, style| {
            job.style = Some(style);
            job.conditions.label = Some(style.name().to_owned());
        })
    },
    sections: |suite| {
        let mut section = Section::new(
            "Shading styles",
            "The same synthesis under five styles of shading. In the paper, each style is a separate scene.",
        );
        show_labels(&mut section, suite, "style");
        vec![section]
    },
};

pub(super) const IPD: FrameSuite = FrameSuite {
    name: "ipd",
    about: "Quality as the distance between the eyes grows from 50 to 75 mm",
    measures: QUALITY,
    contenders: Contender::synthesis,
    jobs: |suite, choices, _| {
        let millimetres: &[u32] = choices.long_or_quick(&[50, 55, 60, 65, 70, 75], &[50, 63, 75]);
        choices.sweep(suite, choices.varied_scenes(), millimetres.iter().copied(), |job, mm| {
            job.eyes.ipd = mm as f32 * 1e-3;
            job.conditions.point = Some(f64::from(mm));
        })
    },
    sections: |suite| {
        let mut section = Section::new(
            "Distance between the eyes",
            "Quality of the synthesized eye against the interpupillary distance.",
        );
        let sweep = Sweep { axis: Axis::new("IPD, mm"), text: |point| format!("{point}") };
        sweep.show_quality(&mut section, suite, &PAPER.sweeps["ipd"]);
        vec![section]
    },
};

pub(super) const DISTANCE: FrameSuite = FrameSuite {
    name: "distance",
    about: "Quality as an object, equally large on the screen, moves from 0.5 to 3 m",
    measures: QUALITY,
    contenders: Contender::synthesis,
    jobs: |suite, choices, object| {
        let metres: &[f32] = choices.long_or_quick(&[0.5, 1.0, 1.5, 2.0, 2.5, 3.0], &[0.5, 1.0, 3.0]);
        choices.sweep(suite, vec![object.name.clone()], metres.iter().copied(), |job, metres| {
            job.source = Source::Object(metres);
            job.conditions.point = Some(f64::from(metres));
        })
    },
    sections: |suite| {
        let [ssim, psnr] = PAPERS_DISTANCE;
        let mut section = Section::new(
            "Distance of the object",
            format!(
                "Quality against the distance of one irregular object, scaled so that it keeps its size on the screen. \
                 The paper shows its curve as a picture only; its text says SSIM {ssim} and {psnr} dB for 0.5 to 3 m."
            ),
        );
        let sweep = Sweep { axis: Axis::new("distance, m"), text: |point| format!("{point}") };
        sweep.show_quality(&mut section, suite, &[]);
        vec![section]
    },
};
