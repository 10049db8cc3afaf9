//! The neural patcher: a fully convolutional generator from an ONNX file, run by rten.
//!
//! The model (`app/lab/training/train.py`) takes `[1, 5, height, width]`: RGB from 0 to 1 with roughly filled holes, a mask
//! with 1 in holes and 0 elsewhere, and disparity from 0 (far plane) to 1 (the nearest pixel), with filled holes. It
//! returns `[1, 3, height, width]`, RGB. Rows run from the top. Columns are forward columns, in which a disocclusion's
//! background is on its left. Width and height are multiples of [`MULTIPLE`].

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::anyhow;
use image::{Rgb, RgbImage};
use rten::{Dimension, Model, ValueOrView};
use rten_tensor::prelude::*;
use rten_tensor::{NdTensor, Tensor};

use super::patcher::{PatchTime, Patched, Patcher, Reprojected, nearest_rows};
use yoro::eyes::Eye;
use yoro_files as files;

/// The built-in model, made by `app/lab/training/train.py`; the README beside it describes its data.
static MODEL: &[u8] = include_bytes!("../../../training/patcher.onnx");

/// The numbers of channels of the model's input and output.
const CHANNELS: [usize; 2] = [5, 3];

/// Sizes are multiples of this, because the generator halves its input four times.
const MULTIPLE: usize = 16;

pub(super) struct Neural {
    model: Model,
    /// The name for messages: the file, or "the built-in model".
    name: String,
}

impl Neural {
    /// Loads the model from a file, or the built-in one.
    pub(super) fn new(file: Option<&Path>) -> anyhow::Result<Neural> {
        let name = file.map_or("the built-in model".to_owned(), |file| file.display().to_string());
        let fault = |reason: String| unsuitable(&name, &reason);
        let loaded = match file {
            Some(file) => Model::load(files::read(file)?),
            None => Model::load_static_slice(MODEL),
        };
        let model = loaded.map_err(|error| fault(one_line(&error.to_string())))?;
        let counts = [model.input_ids().len(), model.output_ids().len()];
        if counts != [1, 1] {
            return Err(fault(format!(
                "it has {} inputs and {} outputs, not one of each",
                counts[0], counts[1]
            )));
        }
        let input = model.input_shape(0).unwrap_or_default();
        let fits = |dimension: &Dimension, size: usize| match dimension {
            Dimension::Fixed(n) => *n == size,
            Dimension::Symbolic(_) => true,
        };
        let free = |dimension: &Dimension| matches!(dimension, Dimension::Symbolic(_));
        let shape_fits = match input.as_slice() {
            [n, c, h, w] => fits(n, 1) && fits(c, CHANNELS[0]) && free(h) && free(w),
            _ => false,
        };
        if !shape_fits {
            return Err(fault(format!(
                "its input is {}, not [1, 5, height, width] with free height and width",
                shape_text(&input)
            )));
        }
        let neural = Neural { model, name };
        // The shape of the output is known only after a run.
        neural.run(NdTensor::zeros([1, CHANNELS[0], MULTIPLE, 2 * MULTIPLE]))?;
        Ok(neural)
    }

    fn run(&self, input: NdTensor<f32, 4>) -> anyhow::Result<Tensor<f32>> {
        let fault = |reason: String| unsuitable(&self.name, &reason);
        let [_, _, height, width] = input.shape();
        let output = self
            .model
            .run_one(ValueOrView::from(input.view()), None)
            .map_err(|error| fault(one_line(&error.to_string())))?;
        let output: Tensor<f32> =
            output.try_into().map_err(|_| fault("its output is not of 32-bit floats".into()))?;
        let expected = [1, CHANNELS[1], height, width];
        if output.shape() != expected {
            return Err(fault(format!(
                "for a picture of {width}x{height} its output is {:?}, not {expected:?}",
                output.shape()
            )));
        }
        Ok(output)
    }
}

impl Patcher for Neural {
    fn patch(&mut self, image: &Reprojected) -> anyhow::Result<Patched> {
        let start = Instant::now();
        let [width, height] = image.size();
        let output = self.run(model_input(image))?;
        let output = output.nd_view::<4>();
        let mut patched = image.color.clone();
        for (x, y, pixel) in patched.enumerate_pixels_mut().filter(|&(x, y, _)| image.is_hole(x, y)) {
            let column = forward(image, x, width);
            let level = |c: usize| (output[[0, c, y as usize, column as usize]] * 255.0).round() as u8;
            *pixel = Rgb([level(0), level(1), level(2)]);
        }
        debug_assert_eq!(patched.dimensions(), (width, height));
        let time = PatchTime { patching: start.elapsed(), transfer: Duration::ZERO };
        Ok(Patched { image: patched, time })
    }
}

fn unsuitable(model: &str, reason: &str) -> anyhow::Error {
    anyhow!(
        "{model} is not a model for this patcher ({reason}): give an ONNX file made by app/lab/training/train.py"
    )
}

/// Converts an image's column into a forward column, or back.
fn forward(image: &Reprojected, x: u32, width: u32) -> u32 {
    match image.eye {
        Eye::Left => x,
        Eye::Right => width - 1 - x,
    }
}

/// Returns the model's input, padded by repetition on the right and at the bottom.
fn model_input(image: &Reprojected) -> NdTensor<f32, 4> {
    let [width, height] = image.size();
    let (color, disparity) = rough_fill(image);
    let nearest = disparity.iter().copied().fold(1e-6, f32::max);
    let padded = |n: u32| (n as usize).next_multiple_of(MULTIPLE);
    NdTensor::from_fn([1, CHANNELS[0], padded(height), padded(width)], |[_, channel, y, x]| {
        let (column, y) = ((x as u32).min(width - 1), (y as u32).min(height - 1));
        let x = forward(image, column, width);
        match channel {
            0..3 => f32::from(color.get_pixel(x, y).0[channel]) / 255.0,
            3 => f32::from(u8::from(image.is_hole(x, y))),
            _ => disparity[(y * width + x) as usize] / nearest,
        }
    })
}

/// Fills each hole with colour and disparity of the farther of its two ends in the row, or of the one behind it in
/// forward columns if both are equally far. Rows without a valid pixel repeat the nearest row that has one.
fn rough_fill(image: &Reprojected) -> (RgbImage, Vec<f32>) {
    let [width, height] = image.size();
    let mut color = image.color.clone();
    let mut disparity: Vec<f32> = image.disparity.pixels().map(|d| d.0[0]).collect();
    for y in 0..height {
        let at = |column: u32| forward(image, column, width);
        let mut column = 0;
        while column < width {
            if !image.is_hole(at(column), y) {
                column += 1;
                continue;
            }
            let end = (column..width).find(|&c| !image.is_hole(at(c), y)).unwrap_or(width);
            let depth = |c: u32| image.disparity.get_pixel(at(c), y).0[0];
            let source = match (column.checked_sub(1), (end < width).then_some(end)) {
                (Some(left), Some(right)) if depth(right) < depth(left) => right,
                (Some(left), _) => left,
                (None, Some(right)) => right,
                (None, None) => break,
            };
            let filling = (*image.color.get_pixel(at(source), y), depth(source));
            for c in column..end {
                color.put_pixel(at(c), y, filling.0);
                disparity[(y * width + at(c)) as usize] = filling.1;
            }
            column = end;
        }
    }
    let rows = nearest_rows(height, |y| (0..width).any(|x| !image.is_hole(x, y)));
    for (y, source) in (0..height).zip(rows).filter(|(y, source)| y != source) {
        for x in 0..width {
            color.put_pixel(x, y, *color.get_pixel(x, source));
            disparity[(y * width + x) as usize] = disparity[(source * width + x) as usize];
        }
    }
    (color, disparity)
}

fn shape_text(shape: &[Dimension]) -> String {
    let sizes = shape.iter().map(|dimension| match dimension {
        Dimension::Fixed(n) => n.to_string(),
        Dimension::Symbolic(name) => name.clone(),
    });
    format!("[{}]", sizes.collect::<Vec<_>>().join(", "))
}

/// Returns a library's message in one line, for use in a sentence.
fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}
