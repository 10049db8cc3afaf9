//! yoro in an engine on wgpu: the engine has one eye in its own textures, and yoro records the passes that draw the
//! other eye into the engine's command encoder.
//!
//! `cargo run -p yoro-wgpu --example offscreen` writes `out/wgpu.png`, which shows the left and the right eye side by
//! side, the left one synthesized. It prints how close that one is to a real render of the left eye. `WGPU_BACKEND=gl`
//! chooses another back end. `cargo xtask web --wgpu --serve` shows the same in a browser with WebGPU.

use anyhow::{Context as _, Result};
use image::{Rgb, RgbImage};
use yoro_wgpu::wgpu::{self, TextureFormat, TextureUsages};
use yoro_wgpu::yoro::eyes::{
    DepthConvention, DepthRange, Eye, EyePair, Frustum, GuardBand, MEAN_IPD, Pose, SynthesisViews, View,
};
use yoro_wgpu::{Gather, Options, Source, Target};

const SIZE: [u32; 2] = [768, 768];
const COLOR: TextureFormat = TextureFormat::Rgba8UnormSrgb;
const DEPTH: TextureFormat = TextureFormat::Depth32Float;

#[cfg(not(target_arch = "wasm32"))]
fn main() -> Result<()> {
    let stereo = pollster::block_on(Stereo::draw(&instance()))?;
    let path = std::path::Path::new("out/wgpu.png");
    std::fs::create_dir_all("out")?;
    let unfinished = path.with_extension("tmp");
    stereo.side_by_side().save_with_format(&unfinished, image::ImageFormat::Png)?;
    std::fs::rename(unfinished, path)?;
    println!("{}\n{}", path.display(), stereo.sentence());
    Ok(())
}

#[cfg(target_arch = "wasm32")]
fn main() {
    #[wasm_bindgen::prelude::wasm_bindgen]
    extern "C" {
        /// Shows a picture and a sentence on the page.
        fn show(width: u32, rgba: &[u8], sentence: &str);
    }
    wasm_bindgen_futures::spawn_local(async {
        match Stereo::draw(&instance()).await {
            Ok(stereo) => {
                let rgba = image::DynamicImage::from(stereo.side_by_side()).into_rgba8();
                show(rgba.width(), &rgba, &stereo.sentence());
            }
            Err(error) => show(0, &[], &format!("{error:#}")),
        }
    });
}

fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env())
}

/// The drawn images.
pub struct Stereo {
    /// The back end, and the name of the GPU if known.
    pub device: String,
    /// The synthesized eye.
    pub left: RgbImage,
    /// The rendered eye.
    pub right: RgbImage,
    /// A real render of the synthesized eye.
    pub truth: RgbImage,
}

impl Stereo {
    /// Draws both eyes.
    ///
    /// # Errors
    /// Fails if there is neither a GPU nor a software driver, and with the errors of wgpu and yoro.
    pub async fn draw(instance: &wgpu::Instance) -> Result<Stereo> {
        let adapter = instance.request_adapter(&Default::default()).await.context(
            "wgpu finds no GPU, and no driver that does without: install one, or take a browser with WebGPU",
        )?;
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                required_limits: wgpu::Limits::downlevel_defaults(),
                ..Default::default()
            })
            .await?;
        let engine = Engine::new(device, queue);

        // The poses and frusta of the eyes, and the meaning of the depth buffer. With OpenXR, poses and frusta come
        // from the two views.
        let depth = DepthRange { near: 0.1, far: f32::INFINITY, convention: DepthConvention::Reversed };
        let head = Pose { position: [0.0, 1.6, 2.0].into(), ..Pose::IDENTITY };
        let frustum = Frustum::symmetric(75f32.to_radians(), 1.0);
        let pair = EyePair::parallel(head, frustum, MEAN_IPD, depth, SIZE, Eye::Right);
        let views = pair.synthesis_views(GuardBand::Distance(0.7))?;

        // Once: pipelines for the format of the other eye's texture.
        let options = Options { color_format: COLOR, ..Options::default() };
        let mut gather = Gather::new(&engine.device, &options)?;

        // The engine's textures. The view to render is wider than the eye by the guard band.
        let used =
            TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        let color = engine.texture(COLOR, views.source.size, used);
        let depth = engine.texture(DEPTH, views.source.size, used);
        let left = engine.texture(COLOR, views.target.size, used);
        let [color_view, depth_view, left_view] =
            [&color, &depth, &left].map(|texture| texture.create_view(&Default::default()));

        // Each frame, in the engine's own command encoder.
        let mut encoder = engine.device.create_command_encoder(&Default::default());
        engine.render(&mut encoder, &views.source, &color_view, &depth_view);
        let (source, target) = (Source::new(&color_view, &depth_view), Target::new(&left_view));
        gather.record(&engine.device, &engine.queue, &mut encoder, &source, &views.warp, &target)?;
        engine.queue.submit([encoder.finish()]);

        // The rendered eye's own image is the part of the source that starts at this corner.
        let right = engine.picture(&color, views.dominant_crop_from_top()).await?;
        let left = engine.picture(&left, [0, 0]).await?;
        // Do this once in every integration: a wrong sign, a flipped row or a misread depth costs more than 10 dB.
        let truth = engine.rendered_target(&views).await?;
        let info = adapter.get_info();
        let device = format!("{:?} {}", info.backend, info.name).trim_end().to_owned();
        Ok(Stereo { device, left, right, truth })
    }

    /// Returns the left eye next to the right one.
    pub fn side_by_side(&self) -> RgbImage {
        let mut both = RgbImage::new(2 * SIZE[0], SIZE[1]);
        image::imageops::replace(&mut both, &self.left, 0, 0);
        image::imageops::replace(&mut both, &self.right, i64::from(SIZE[0]), 0);
        both
    }

    /// Returns a sentence that says how close the synthesized eye is to the real one.
    fn sentence(&self) -> String {
        format!(
            "left eye synthesized on {}, right eye rendered; against the left eye rendered: {:.2} dB; the right eye in \
             its place: {:.2} dB",
            self.device,
            psnr(&self.left, &self.truth),
            psnr(&self.right, &self.truth)
        )
    }
}

/// Returns the peak signal-to-noise ratio over red, green and blue in decibels.
fn psnr(image: &RgbImage, truth: &RgbImage) -> f64 {
    let squares = image.iter().zip(truth.iter()).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
    10.0 * (255f64.powi(2) * truth.len() as f64 / squares.sum::<f64>()).log10()
}

/// A minimal engine.
struct Engine {
    device: wgpu::Device,
    queue: wgpu::Queue,
    room: wgpu::RenderPipeline,
}

impl Engine {
    fn new(device: wgpu::Device, queue: wgpu::Queue) -> Engine {
        let module = device.create_shader_module(wgpu::include_wgsl!("room.wgsl"));
        let room = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("room"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("see"),
                compilation_options: Default::default(),
                targets: &[Some(COLOR.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Engine { device, queue, room }
    }

    fn texture(
        &self,
        format: TextureFormat,
        [width, height]: [u32; 2],
        usage: TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// Renders a view.
    fn render(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &View,
        color: &wgpu::TextureView,
        depth: &wgpu::TextureView,
    ) {
        let [width, height] = view.size.map(|n| n as f32);
        let (eye, frustum) = (view.pose.position, &view.frustum);
        let values = [
            [eye.x, eye.y, eye.z, view.depth.near],
            // On the plane at distance 1: the upper left corner of the image, and a pixel's size. Rows run from the
            // top.
            [frustum.left, frustum.top, frustum.width() / width, -frustum.height() / height],
        ];
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: size_of_val(&values) as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&values));
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.room.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("room"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.room);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Returns a real render of the synthesized eye.
    async fn rendered_target(&self, views: &SynthesisViews) -> Result<RgbImage> {
        let used = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
        let color = self.texture(COLOR, views.target.size, used);
        let depth = self.texture(DEPTH, views.target.size, TextureUsages::RENDER_ATTACHMENT);
        let [into, depth] = [&color, &depth].map(|texture| texture.create_view(&Default::default()));
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.render(&mut encoder, &views.target, &into, &depth);
        self.queue.submit([encoder.finish()]);
        self.picture(&color, [0, 0]).await
    }

    /// Returns the part of a texture that starts at a corner, of the size of an eye.
    async fn picture(&self, texture: &wgpu::Texture, [left, top]: [u32; 2]) -> Result<RgbImage> {
        let pitch = (4 * texture.width()).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(pitch * texture.height()),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(pitch), rows_per_image: None };
        let into = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), into, texture.size());
        self.queue.submit([encoder.finish()]);
        let (sender, mapped) = futures_channel::oneshot::channel();
        buffer.slice(..).map_async(wgpu::MapMode::Read, |result| drop(sender.send(result)));
        // Browsers do not need to be polled.
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        mapped.await??;
        let bytes = buffer.slice(..).get_mapped_range();
        Ok(RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
            let i = ((y + top) * pitch + (x + left) * 4) as usize;
            Rgb([bytes[i], bytes[i + 1], bytes[i + 2]])
        }))
    }
}
