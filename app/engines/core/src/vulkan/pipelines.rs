//! Graphics pipelines and their layouts.

use ash::vk;

use super::commands::UNIFORM_STAGES;
use super::objects::Objects;
use super::targets::{PassKind, Rendering};
use super::{Options, VulkanError, shaders};
use crate::synthesis::{HoleMark, Holes};

/// Bindings of the descriptor set, in the order of `TEXTURE` in the shaders: depth, colour, tile map, span map.
pub(super) const TEXTURES: usize = 4;
/// The binding of the source's colour, which is filtered. All others are fetched unfiltered.
pub(super) const FILTERED: &[usize] = &[1];

/// The layouts that all pipelines share.
#[derive(Clone, Copy)]
pub(super) struct Layouts {
    pub(super) textures: vk::DescriptorSetLayout,
    pub(super) pipeline: vk::PipelineLayout,
}

impl Layouts {
    /// Creates the layouts, for passes with this number of bytes of uniforms, whose textures of these bindings are
    /// filtered.
    pub(super) fn new(
        objects: &mut Objects,
        uniforms: usize,
        filtered: &[usize],
    ) -> Result<Layouts, VulkanError> {
        let textures = texture_layout(objects, filtered)?;
        let layouts = [textures];
        // Every device supports 128 bytes of push constants.
        let constants =
            [vk::PushConstantRange { stage_flags: UNIFORM_STAGES, offset: 0, size: uniforms as u32 }];
        let info =
            vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts).push_constant_ranges(&constants);
        Ok(Layouts { textures, pipeline: objects.create_pipeline_layout(&info)? })
    }
}

fn texture_layout(objects: &mut Objects, filtered: &[usize]) -> Result<vk::DescriptorSetLayout, VulkanError> {
    let nearest = [objects.create_sampler(&sampler(vk::Filter::NEAREST))?];
    let linear = [objects.create_sampler(&sampler(vk::Filter::LINEAR))?];
    let bindings: [_; TEXTURES] = std::array::from_fn(|place| {
        vk::DescriptorSetLayoutBinding::default()
            .binding(place as u32)
            .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::FRAGMENT)
            .immutable_samplers(if filtered.contains(&place) { &linear } else { &nearest })
    });
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
    objects.create_descriptor_set_layout(&info)
}

fn sampler(filter: vk::Filter) -> vk::SamplerCreateInfo<'static> {
    let edge = vk::SamplerAddressMode::CLAMP_TO_EDGE;
    vk::SamplerCreateInfo::default()
        .mag_filter(filter)
        .min_filter(filter)
        .address_mode_u(edge)
        .address_mode_v(edge)
        .address_mode_w(edge)
}

/// The pipelines of a pass.
#[derive(Clone, Copy)]
pub(super) struct Pipelines {
    /// For sources that fill their images and the intermediate buffers.
    whole: vk::Pipeline,
    /// For all others: `PART` in the shaders.
    part: vk::Pipeline,
}

impl Pipelines {
    pub(super) fn get(&self, part: bool) -> vk::Pipeline {
        if part { self.part } else { self.whole }
    }
}

/// Makes pipelines that differ in their fragment shaders and attachments.
pub(super) struct PipelineFactory<'a> {
    pub(super) objects: &'a mut Objects,
    /// The shader modules, which are only needed until the pipelines are created.
    pub(super) modules: Objects,
    pub(super) rendering: &'a Rendering,
    pub(super) layout: vk::PipelineLayout,
    pub(super) options: &'a Options,
    /// The vertex shader of the pass that draws the target.
    pub(super) march_vertex: &'static [u8],
}

impl PipelineFactory<'_> {
    pub(super) fn pipelines(&mut self, fragment: &[u8], kind: PassKind) -> Result<Pipelines, VulkanError> {
        Ok(Pipelines {
            whole: self.pipeline(fragment, kind, false)?,
            part: self.pipeline(fragment, kind, true)?,
        })
    }

    /// Returns a pipeline that runs a fragment shader over the whole viewport.
    pub(super) fn pipeline(
        &mut self,
        fragment: &[u8],
        kind: PassKind,
        part: bool,
    ) -> Result<vk::Pipeline, VulkanError> {
        let vertex = match kind {
            PassKind::Target => self.march_vertex,
            _ => shaders::SCREEN,
        };
        let vertex = self.modules.create_shader(vertex)?;
        let fragment = self.modules.create_shader(fragment)?;
        // `PART` in the shaders.
        let value = u32::from(part);
        let entries = [vk::SpecializationMapEntry { constant_id: 0, offset: 0, size: 4 }];
        let constants =
            vk::SpecializationInfo::default().map_entries(&entries).data(bytemuck::bytes_of(&value));
        let stage = |stage, module| {
            vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main")
        };
        let stages = [
            stage(vk::ShaderStageFlags::VERTEX, vertex),
            stage(vk::ShaderStageFlags::FRAGMENT, fragment).specialization_info(&constants),
        ];
        self.create(&stages, kind)
    }

    /// Returns a pipeline of these shaders with the state that all passes share.
    fn create(
        &mut self,
        stages: &[vk::PipelineShaderStageCreateInfo],
        kind: PassKind,
    ) -> Result<vk::Pipeline, VulkanError> {
        let (format, depth_format) = (kind.format(self.options), kind.depth_format(self.options));
        let vertices = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let multisample = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(depth_format.is_some())
            .depth_write_enable(depth_format.is_some())
            .depth_compare_op(vk::CompareOp::ALWAYS);
        let marks = kind == PassKind::Target && self.options.holes == Holes::Open(HoleMark::Stencil);
        let replace = vk::StencilOpState {
            pass_op: vk::StencilOp::REPLACE,
            compare_op: vk::CompareOp::ALWAYS,
            compare_mask: 0xff,
            write_mask: 0xff,
            reference: 1,
            ..vk::StencilOpState::default()
        };
        let depth = depth.stencil_test_enable(marks).front(replace).back(replace);
        let blend =
            [vk::PipelineColorBlendAttachmentState::default()
                .color_write_mask(vk::ColorComponentFlags::RGBA)];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blend);
        let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(stages)
            .vertex_input_state(&vertices)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(self.layout);
        let formats = [format];
        let mut attachments = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&formats)
            .depth_attachment_format(depth_format.unwrap_or_default())
            .stencil_attachment_format(if marks {
                depth_format.unwrap_or_default()
            } else {
                vk::Format::UNDEFINED
            });
        let info = match self.rendering {
            Rendering::Dynamic { .. } => info.push_next(&mut attachments),
            Rendering::Passes { .. } => info.render_pass(self.rendering.render_pass(kind)),
        };
        self.objects.create_graphics_pipeline(self.options.pipeline_cache, info)
    }
}
