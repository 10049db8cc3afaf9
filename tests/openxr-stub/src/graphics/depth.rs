//! Reads depth in OpenGL ES, which has no call for it: a pass copies it to colour.

use glow::HasContext as _;

use super::Texture;
use super::gles::{name, read_pixels};

const VERTEX: &str = "#version 300 es
void main() {
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}";

/// Returns a rectangle of a layer's depth as four floats for each pixel, the first of which it is. Restores the state that
/// applications of tests rely on from one pass to the next.
pub fn read(gl: &glow::Context, texture: Texture, layer: u32, rect: [i32; 4]) -> Option<Vec<u8>> {
    let [x, y, width, height] = rect;
    let (kind, target, place) = match texture.layers {
        1 => ("sampler2D", glow::TEXTURE_2D, "place".to_owned()),
        _ => ("sampler2DArray", glow::TEXTURE_2D_ARRAY, format!("ivec3(place, {layer})")),
    };
    let fragment = format!(
        "#version 300 es
precision highp float;
uniform highp {kind} depths;
layout(location = 0) out highp vec4 color;
void main() {{
    ivec2 place = ivec2(gl_FragCoord.xy) + ivec2({x}, {y});
    color = vec4(texelFetch(depths, {place}, 0).r, 0.0, 0.0, 0.0);
}}"
    );
    // SAFETY: plain GL calls in the context that the texture belongs to; what is made is deleted, what is bound is
    // bound again, and what is switched off is switched on.
    unsafe {
        let program = gl.create_program().ok()?;
        for (stage, source) in [(glow::VERTEX_SHADER, VERTEX), (glow::FRAGMENT_SHADER, &fragment)] {
            let shader = gl.create_shader(stage).ok()?;
            gl.shader_source(shader, source);
            gl.compile_shader(shader);
            gl.attach_shader(program, shader);
            gl.delete_shader(shader);
        }
        gl.link_program(program);
        assert!(gl.get_program_link_status(program), "{}", gl.get_program_info_log(program));

        let read = gl.get_parameter_framebuffer(glow::READ_FRAMEBUFFER_BINDING);
        let draw = gl.get_parameter_framebuffer(glow::DRAW_FRAMEBUFFER_BINDING);
        let vertices = gl.get_parameter_vertex_array(glow::VERTEX_ARRAY_BINDING);
        let used = gl.get_parameter_program(glow::CURRENT_PROGRAM);
        let unit = gl.get_parameter_i32(glow::ACTIVE_TEXTURE) as u32;
        let mut viewport = [0; 4];
        gl.get_parameter_i32_slice(glow::VIEWPORT, &mut viewport);
        let mask = gl.get_parameter_bool_array::<4>(glow::COLOR_WRITEMASK);
        let switches =
            [glow::SCISSOR_TEST, glow::DEPTH_TEST, glow::STENCIL_TEST, glow::CULL_FACE, glow::BLEND];
        let on = switches.map(|switch| gl.is_enabled(switch));
        switches.iter().for_each(|switch| gl.disable(*switch));
        gl.active_texture(glow::TEXTURE0);
        let bound = gl.get_parameter_texture(match texture.layers {
            1 => glow::TEXTURE_BINDING_2D,
            _ => glow::TEXTURE_BINDING_2D_ARRAY,
        });
        let before = gl.get_parameter_sampler(glow::SAMPLER_BINDING);

        let sampler = gl.create_sampler().ok()?;
        for filter in [glow::TEXTURE_MIN_FILTER, glow::TEXTURE_MAG_FILTER] {
            gl.sampler_parameter_i32(sampler, filter, glow::NEAREST as i32);
        }
        let array = gl.create_vertex_array().ok()?;
        let color = gl.create_renderbuffer().ok()?;
        let renderbuffer = gl.get_parameter_renderbuffer(glow::RENDERBUFFER_BINDING);
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(color));
        gl.renderbuffer_storage(glow::RENDERBUFFER, glow::RGBA32F, width, height);
        gl.bind_renderbuffer(glow::RENDERBUFFER, renderbuffer);
        let framebuffer = gl.create_framebuffer().ok()?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        let attachment = glow::COLOR_ATTACHMENT0;
        gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, attachment, glow::RENDERBUFFER, Some(color));
        let complete = gl.check_framebuffer_status(glow::FRAMEBUFFER) == glow::FRAMEBUFFER_COMPLETE;
        let pixels = complete.then(|| {
            gl.viewport(0, 0, width, height);
            gl.color_mask(true, true, true, true);
            gl.use_program(Some(program));
            gl.bind_vertex_array(Some(array));
            gl.bind_texture(target, name(texture));
            gl.bind_sampler(0, Some(sampler));
            gl.draw_arrays(glow::TRIANGLES, 0, 3);
            read_pixels(gl, [0, 0, width, height], glow::FLOAT, 16)
        });

        gl.bind_sampler(0, before);
        gl.bind_texture(target, bound);
        gl.active_texture(unit);
        gl.bind_vertex_array(vertices);
        gl.use_program(used);
        gl.bind_framebuffer(glow::READ_FRAMEBUFFER, read);
        gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, draw);
        gl.viewport(viewport[0], viewport[1], viewport[2], viewport[3]);
        gl.color_mask(mask[0], mask[1], mask[2], mask[3]);
        switches.iter().zip(on).filter(|(_, on)| *on).for_each(|(switch, _)| gl.enable(*switch));
        gl.delete_framebuffer(framebuffer);
        gl.delete_renderbuffer(color);
        gl.delete_vertex_array(array);
        gl.delete_sampler(sampler);
        gl.delete_program(program);
        pixels
    }
}
