//! Devices without a window, and pictures in their textures.
//!
//! Arrays have their rows from the bottom, as everywhere in yoro; textures have them from the top, as in wgpu.

use std::sync::OnceLock;

use crate::against_opengl::flipped;

use yoro_wgpu::wgpu::{
    self, Backends, BindGroupDescriptor, BindGroupEntry, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingResource, BindingType, BufferDescriptor, BufferUsages, ColorTargetState, CommandEncoder,
    CompareFunction, DepthStencilState, Device, DeviceType, Extent3d, Features, FragmentState, Instance,
    InstanceDescriptor, Limits, LoadOp, MapMode, MultisampleState, Operations, Origin3d,
    PipelineLayoutDescriptor, PollType, Queue, RenderPassColorAttachment, RenderPassDepthStencilAttachment,
    RenderPassDescriptor, RenderPipelineDescriptor, ShaderStages, StoreOp, TexelCopyBufferInfo,
    TexelCopyBufferLayout, TexelCopyTextureInfo, Texture, TextureAspect, TextureDescriptor, TextureDimension,
    TextureFormat, TextureSampleType, TextureUsages, TextureView, TextureViewDescriptor,
    TextureViewDimension, VertexState,
};

/// A device on one of wgpu's native back ends. It lives as long as the tests, because dropping wgpu's OpenGL would also
/// terminate the EGL display that the OpenGL pictures are drawn with.
pub struct Gpu {
    pub name: String,
    pub device: Device,
    pub queue: Queue,
    _instance: Instance,
}

/// Runs a test body on wgpu's Vulkan and on its OpenGL, unless the tests are told to skip Vulkan. The body must have
/// drawn what it compares with before this call, because the thread's current context changes.
pub fn with_gpus(mut body: impl FnMut(&Gpu)) {
    static GPUS: [OnceLock<Result<Gpu, String>>; 2] = [OnceLock::new(), OnceLock::new()];
    for (backend, gpu) in [Backends::VULKAN, Backends::GL].into_iter().zip(&GPUS) {
        if backend == Backends::VULKAN && std::env::var_os("YORO_TEST_WITHOUT_VULKAN").is_some() {
            println!("LEFT OUT: wgpu on Vulkan");
            continue;
        }
        match gpu.get_or_init(|| Gpu::open(backend)) {
            Ok(gpu) => body(gpu),
            Err(reason) => {
                panic!("{backend:?}: {reason}: `cargo xtask setup`, or set YORO_TEST_WITHOUT_VULKAN=1")
            }
        }
    }
}

impl Gpu {
    pub fn open(backends: Backends) -> Result<Gpu, String> {
        let descriptor = InstanceDescriptor { backends, ..InstanceDescriptor::new_without_display_handle() };
        let instance = Instance::new(descriptor);
        let adapters = pollster::block_on(instance.enumerate_adapters(backends));
        // The pictures of a CPU rasterizer are the same everywhere.
        let is_cpu = |adapter: &&wgpu::Adapter| adapter.get_info().device_type == DeviceType::Cpu;
        let adapter = adapters.iter().find(is_cpu).or(adapters.first()).ok_or("no device is here")?;
        // Features that not every device has. Tests of formats check for them.
        let wanted = Features::TEXTURE_FORMAT_16BIT_NORM | Features::DEPTH32FLOAT_STENCIL8;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            required_features: wanted & adapter.features(),
            required_limits: Limits::downlevel_defaults(),
            ..Default::default()
        }))
        .map_err(|error| error.to_string())?;
        let info = adapter.get_info();
        let name = format!("{:?}, {}", info.backend, info.name);
        Ok(Gpu { name, device, queue, _instance: instance })
    }

    /// True if textures of this format can be created.
    pub fn has(&self, format: TextureFormat) -> bool {
        self.device.features().contains(format.required_features())
    }

    /// True for wgpu's OpenGL, which cannot sample layers of arrays or multisampled textures.
    pub fn is_opengl(&self) -> bool {
        self.device.adapter_info().backend == wgpu::Backend::Gl
    }

    /// Records, submits and waits.
    pub fn run<R>(&self, record: impl FnOnce(&mut CommandEncoder) -> R) -> R {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let result = record(&mut encoder);
        self.queue.submit([encoder.finish()]);
        self.device.poll(PollType::wait_indefinitely()).unwrap();
        result
    }

    /// Creates an array of textures that can be sampled, copied and, if the format allows it, rendered to.
    pub fn texture(&self, format: TextureFormat, size: [u32; 2], layers: u32) -> Texture {
        let copied = TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
        self.texture_of(format, size, layers, 1, copied)
    }

    /// Creates a texture of four samples that can be rendered to and sampled.
    pub fn multisampled(&self, format: TextureFormat, size: [u32; 2]) -> Texture {
        self.texture_of(format, size, 1, 4, TextureUsages::empty())
    }

    /// Returns a view of a single-sampled texture with this usage only.
    pub fn with_usage(&self, format: TextureFormat, size: [u32; 2], usage: TextureUsages) -> TextureView {
        one_layer(&self.texture_with(format, size, 1, 1, usage), 0, TextureAspect::All)
    }

    fn texture_of(
        &self,
        format: TextureFormat,
        size: [u32; 2],
        layers: u32,
        samples: u32,
        copied: TextureUsages,
    ) -> Texture {
        let drawn = match format {
            TextureFormat::R16Unorm | TextureFormat::R32Float => TextureUsages::empty(),
            _ => TextureUsages::RENDER_ATTACHMENT,
        };
        self.texture_with(format, size, layers, samples, TextureUsages::TEXTURE_BINDING | drawn | copied)
    }

    fn texture_with(
        &self,
        format: TextureFormat,
        [width, height]: [u32; 2],
        depth_or_array_layers: u32,
        sample_count: u32,
        usage: TextureUsages,
    ) -> Texture {
        self.device.create_texture(&TextureDescriptor {
            label: None,
            size: Extent3d { width, height, depth_or_array_layers },
            mip_level_count: 1,
            sample_count,
            dimension: TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// Writes a whole layer of colour, in the format's own encoding.
    fn upload(&self, texture: &Texture, layer: u32, bytes: &[u8]) {
        let bytes_per_row = Some(bytes.len() as u32 / texture.height());
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: None };
        let size = Extent3d { depth_or_array_layers: 1, ..texture.size() };
        self.queue.write_texture(place(texture, layer), &flipped(bytes, texture.height()), layout, size);
    }

    /// Reads a layer of colour in the format's own encoding, 4 bytes per pixel.
    fn read(&self, texture: &Texture, layer: u32) -> Vec<u8> {
        let pitch = (4 * texture.width()).next_multiple_of(256);
        let buffer = self.device.create_buffer(&BufferDescriptor {
            label: None,
            size: u64::from(pitch * texture.height()),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        self.run(|encoder| {
            let layout =
                TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(pitch), rows_per_image: None };
            let size = Extent3d { depth_or_array_layers: 1, ..texture.size() };
            let into = TexelCopyBufferInfo { buffer: &buffer, layout };
            encoder.copy_texture_to_buffer(place(texture, layer), into, size);
        });
        buffer.slice(..).map_async(MapMode::Read, Result::unwrap);
        self.device.poll(PollType::wait_indefinitely()).unwrap();
        let mapped = buffer.slice(..).get_mapped_range();
        let rows = mapped.chunks_exact(pitch as usize).rev();
        rows.flat_map(|row| &row[..4 * texture.width() as usize]).copied().collect()
    }

    /// Copies one texture to a layer of another pixel by pixel: colour, depth, or the bits of depth. If the target is
    /// multisampled, copies to each sample.
    pub fn draw(&self, from: &TextureView, into: &Texture, layer: u32) {
        let (device, format) = (&self.device, into.format());
        let module = device.create_shader_module(wgpu::include_wgsl!("copies.wgsl"));
        let entry = BindGroupLayoutEntry {
            binding: 0,
            visibility: ShaderStages::FRAGMENT,
            ty: BindingType::Texture {
                sample_type: TextureSampleType::Float { filterable: false },
                view_dimension: TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        let layout =
            device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: None, entries: &[entry] });
        let pipeline_layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let is_depth = format.has_depth_aspect();
        let color_target = [Some(ColorTargetState::from(format))];
        let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
            label: None,
            layout: Some(&pipeline_layout),
            vertex: VertexState {
                module: &module,
                entry_point: Some("screen"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: is_depth.then(|| DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: MultisampleState { count: into.sample_count(), ..Default::default() },
            fragment: Some(FragmentState {
                module: &module,
                entry_point: Some(match format {
                    TextureFormat::R32Uint => "bits",
                    _ if into.sample_count() > 1 => "sample_depth",
                    _ if is_depth => "depth",
                    _ => "color",
                }),
                compilation_options: Default::default(),
                targets: if is_depth { &[] } else { &color_target },
            }),
            multiview_mask: None,
            cache: None,
        });
        let resource = BindingResource::TextureView(from);
        let entries = [BindGroupEntry { binding: 0, resource }];
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &entries,
        });
        let view = one_layer(into, layer, TextureAspect::All);
        let colors = [Some(RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: Operations { load: LoadOp::Load, store: StoreOp::Store },
        })];
        let depth = RenderPassDepthStencilAttachment {
            view: &view,
            depth_ops: Some(Operations { load: LoadOp::Load, store: StoreOp::Store }),
            stencil_ops: format
                .has_stencil_aspect()
                .then_some(Operations { load: LoadOp::Load, store: StoreOp::Store }),
        };
        self.run(|encoder| {
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                color_attachments: if is_depth { &[] } else { &colors },
                depth_stencil_attachment: is_depth.then_some(depth),
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        });
    }

    /// Fills a layer of colour with RGBA bytes. sRGB formats take them unchanged.
    pub fn upload_rgba8(&self, texture: &Texture, layer: u32, rgba: &[u8]) {
        if is_rgba8(texture.format()) {
            return self.upload(texture, layer, rgba);
        }
        let plain = self.texture(TextureFormat::Rgba8Unorm, size(texture), 1);
        self.upload(&plain, 0, rgba);
        self.draw(&plain.create_view(&Default::default()), texture, layer);
    }

    /// Reads a layer of colour as RGBA bytes.
    pub fn read_rgba8(&self, texture: &Texture, layer: u32) -> Vec<u8> {
        if is_rgba8(texture.format()) {
            return self.read(texture, layer);
        }
        let plain = self.texture(TextureFormat::Rgba8Unorm, size(texture), 1);
        self.draw(&one_layer(texture, layer, TextureAspect::All), &plain, 0);
        self.read(&plain, 0)
    }

    /// Fills a layer of depth.
    pub fn upload_depth(&self, texture: &Texture, layer: u32, depth: &[f32]) {
        let floats: Vec<u8> = depth.iter().flat_map(|depth| depth.to_ne_bytes()).collect();
        match texture.format() {
            TextureFormat::R32Float => self.upload(texture, layer, &floats),
            TextureFormat::R16Unorm => {
                let steps = depth.iter().map(|depth| (depth * 65535.0).round() as u16);
                let bytes: Vec<u8> = steps.flat_map(u16::to_ne_bytes).collect();
                self.upload(texture, layer, &bytes);
            }
            _ => {
                let plain = self.texture(TextureFormat::R32Float, size(texture), 1);
                self.upload(&plain, 0, &floats);
                self.draw(&plain.create_view(&Default::default()), texture, layer);
            }
        }
    }

    /// Reads a layer of depth.
    pub fn read_depth(&self, texture: &Texture, layer: u32) -> Vec<f32> {
        // Not every device can render to 32-bit floats.
        let plain = self.texture(TextureFormat::R32Uint, size(texture), 1);
        self.draw(&depth_of(texture, layer), &plain, 0);
        self.read_bits(&plain)
    }

    /// Reads the bits of floats.
    pub fn read_bits(&self, bits: &Texture) -> Vec<f32> {
        let bytes = self.read(bits, 0);
        bytes.chunks_exact(4).map(|value| f32::from_ne_bytes(value.try_into().unwrap())).collect()
    }
}

fn is_rgba8(format: TextureFormat) -> bool {
    matches!(format, TextureFormat::Rgba8Unorm | TextureFormat::Rgba8UnormSrgb)
}

fn size(texture: &Texture) -> [u32; 2] {
    [texture.width(), texture.height()]
}

fn place(texture: &Texture, layer: u32) -> TexelCopyTextureInfo<'_> {
    TexelCopyTextureInfo { origin: Origin3d { z: layer, ..Origin3d::ZERO }, ..texture.as_image_copy() }
}

/// Returns a view of one layer.
pub fn one_layer(texture: &Texture, layer: u32, aspect: TextureAspect) -> TextureView {
    texture.create_view(&TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2),
        aspect,
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

/// Returns a view to read depth or a float from.
pub fn depth_of(texture: &Texture, layer: u32) -> TextureView {
    let aspect =
        if texture.format().has_depth_aspect() { TextureAspect::DepthOnly } else { TextureAspect::All };
    one_layer(texture, layer, aspect)
}
