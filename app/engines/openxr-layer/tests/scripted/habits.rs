//! The rendering habits of a test's application.

use std::ffi::CStr;

use openxr_sys::ViewConfigurationType as ViewsOf;
use yoro::eyes::Eye;
use yoro::vulkan::ash::vk;
use yoro_openxr_stub::script::Script;

use crate::client::{Chain, Client, DEPTH, Frame, Outcome, Part, Planes, Submitted, View};
use crate::drawing::Drawing;
use crate::world::{Seen, script, uncounted, watched};

pub const SRGB: vk::Format = vk::Format::R8G8B8A8_SRGB;
pub const D32: vk::Format = vk::Format::D32_SFLOAT;

/// The rendering habits of an application.
#[derive(Clone, Copy, Debug)]
pub struct Habits {
    /// The name that the application states.
    pub name: &'static str,
    /// The size of its images, as a multiple of the recommended size.
    pub scale: f32,
    /// Extra pixels of the swapchains on each side of the rendered rectangle.
    pub margin: [u32; 2],
    /// The number of layers of the swapchains, and the index of the rendered layer.
    pub layers: [u32; 2],
    pub formats: [vk::Format; 2],
    pub planes: Planes,
    /// The number of samples along one side of a pixel.
    pub samples: u32,
    pub submits_depth: bool,
    /// True if the field of view is flipped sideways, and upside down.
    pub flips: [bool; 2],
    /// True if the images are upside down, and the layers say so.
    pub upside_down: bool,
    pub frames: u32,
}

impl Habits {
    pub const PLAIN: Habits = Habits {
        name: "right",
        scale: 1.0,
        margin: [0; 2],
        layers: [1, 0],
        formats: [SRGB, D32],
        planes: Planes::PLAIN,
        samples: 1,
        submits_depth: true,
        flips: [false; 2],
        upside_down: false,
        frames: 3,
    };

    pub fn dominant(&self) -> Eye {
        if self.name == "left" { Eye::Left } else { Eye::Right }
    }
}

/// The swapchains of an application with one view.
pub struct Chains {
    pub color: Chain,
    pub depth: Chain,
    pub part: Part,
}

impl Chains {
    pub fn new(client: &Client, habits: &Habits) -> Outcome<Chains> {
        let size = client.sizes()?[0].map(|n| (n as f32 * habits.scale) as u32);
        let whole = [0, 1].map(|i| size[i] + 2 * habits.margin[i]);
        let [layers, layer] = habits.layers;
        let [color, depth] = habits.formats;
        let (color, depth) = (client.chain(color, whole, layers)?, client.chain(depth, whole, layers)?);
        let part = Part { chain: color.handle, origin: habits.margin, size, layer };
        Ok(Chains { color, depth, part })
    }

    /// Creates plain swapchains of a size.
    pub fn of_size(client: &Client, size: [u32; 2]) -> Outcome<Chains> {
        let (color, depth) = (client.chain(SRGB, size, 1)?, client.chain(D32, size, 1)?);
        let part = Part { chain: color.handle, origin: [0; 2], size, layer: 0 };
        Ok(Chains { color, depth, part })
    }

    pub fn depth_part(&self) -> Part {
        Part { chain: self.depth.handle, ..self.part }
    }
}

/// Renders a view to the swapchains. Returns what to submit.
pub fn render(client: &mut Client, chains: &Chains, habits: &Habits, view: View) -> Outcome<Submitted> {
    client.paint(view, chains.part.size, habits.samples, habits.formats, habits.planes);
    let image = client.acquire(&chains.color)?;
    uncounted(|| client.copy_color(image, chains.part));
    let mut depth = None;
    if habits.submits_depth {
        let image = client.acquire(&chains.depth)?;
        uncounted(|| client.copy_depth(image, chains.depth_part()));
        client.release(&chains.depth)?;
        depth = Some((chains.depth_part(), habits.planes));
    }
    client.release(&chains.color)?;
    Ok(Submitted { view, color: chains.part, depth })
}

/// Begins a session, and creates its swapchains.
pub fn begin_session(client: &mut Client, habits: &Habits) -> Outcome<Chains> {
    client.start_session()?;
    Chains::new(client, habits)
}

/// Begins a frame and renders its view. Returns what to submit.
pub fn begin_rendered(client: &mut Client, chains: &Chains, habits: &Habits) -> Outcome<(Frame, Submitted)> {
    let frame = client.begin_frame()?;
    let view = client.locate(frame)?[0].unwrap().flipped(habits.flips);
    Ok((frame, render(client, chains, habits, view)?))
}

/// Runs one frame. Returns true if it should be rendered.
pub fn frame(client: &mut Client, chains: &Chains, habits: &Habits) -> Outcome<bool> {
    client.poll()?;
    let frame = client.begin_frame()?;
    if !frame.should_render {
        client.end_frame(frame, &[])?;
        return Ok(false);
    }
    let view = client.locate(frame)?[0].unwrap().flipped(habits.flips);
    let submitted = render(client, chains, habits, view)?;
    client.show(frame, submitted)?;
    Ok(true)
}

/// Runs frames until `count` have been rendered.
pub fn frames(client: &mut Client, chains: &Chains, habits: &Habits, count: u32) -> Outcome<()> {
    let mut rendered = 0;
    while rendered < count {
        rendered += u32::from(frame(client, chains, habits)?);
    }
    Ok(())
}

/// Runs an application that renders one view.
pub fn run<'a>(drawing: impl Into<Drawing<'a>>, habits: &Habits) -> Outcome<Client<'a>> {
    let layout: &[&CStr] = if habits.upside_down { &[c"XR_FB_composition_layer_image_layout"] } else { &[] };
    let mut client = Client::new(drawing, habits.name, &[&[DEPTH], layout].concat())?;
    client.upside_down = habits.upside_down;
    let chains = begin_session(&mut client, habits)?;
    frames(&mut client, &chains, habits, habits.frames)?;
    client.destroy_session()?;
    Ok(client)
}

/// Runs an application of this name once, so that the layer knows the exact size of what it offers. In the first start it
/// offers an estimate, whose views are a little wider.
pub fn learn_size<'a>(drawing: impl Into<Drawing<'a>>, name: &'static str) {
    watched(script(), || drop(run(drawing, &Habits { name, frames: 1, ..Habits::PLAIN }).unwrap()));
}

/// Runs an application with a session and swapchains, which `work` uses, on a runtime that follows a script.
pub fn watched_session<'a>(
    drawing: impl Into<Drawing<'a>>,
    script: Script,
    habits: &Habits,
    work: impl FnOnce(&mut Client, &Chains) -> Outcome<()>,
) -> Seen {
    watched(script, || {
        let mut client = Client::new(drawing, habits.name, &[DEPTH]).unwrap();
        let chains = begin_session(&mut client, habits).unwrap();
        frame(&mut client, &chains, habits).unwrap();
        work(&mut client, &chains).unwrap();
        client.destroy_session().unwrap();
    })
}

/// Runs an application with the setting `shrink`, which renders a tiny view beside its own. `show` ends each frame with
/// both.
pub fn run_shrunk<'a>(
    drawing: impl Into<Drawing<'a>>,
    habits: &Habits,
    count: u32,
    show: impl Fn(&mut Client, Frame, [Submitted; 2]) -> Outcome<()>,
) -> Outcome<()> {
    let mut client = Client::new(drawing, habits.name, &[DEPTH])?;
    client.views = ViewsOf::PRIMARY_STEREO;
    client.start_session()?;
    let sizes = client.sizes()?;
    assert!(sizes[0] == [16; 2] && sizes[1][0] > 128 && sizes[1][1] == 128, "{sizes:?}");
    let own = Chains::of_size(&client, sizes[1])?;
    let tiny = client.chain(SRGB, sizes[0], 1)?;
    let part = Part { chain: tiny.handle, size: sizes[0], ..own.part };
    for _ in 0..count {
        client.poll()?;
        let frame = client.begin_frame()?;
        let views = client.locate(frame)?;
        let rendered = render(&mut client, &own, habits, views[1].unwrap())?;
        client.acquire(&tiny)?;
        client.release(&tiny)?;
        let unused = Submitted { view: views[0].unwrap(), color: part, depth: None };
        show(&mut client, frame, [unused, rendered])?;
    }
    client.destroy_session()
}

/// Runs at most `limit` frames, until the session is over or lost.
pub fn until_over(client: &mut Client, chains: &Chains, habits: &Habits, limit: u32) -> Outcome<()> {
    for _ in 0..limit {
        client.poll()?;
        if client.over {
            break;
        }
        if client.is_running() {
            frame(client, chains, habits)?;
        }
    }
    Ok(())
}
