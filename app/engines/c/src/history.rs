//! Histories: the views of their strips, and the relation of these to the synthesized image.

use yoro::synthesis::Strips;

use crate::result::{Failure, YORO_ERROR_NULL, YoroMessages, YoroResult, catch_errors};
use crate::types::{YoroDepth, YoroRows, rows_down};
use crate::versioned::{self, versioned};
use crate::views::{YoroView, depth_range};

/// The largest number of strips in a history.
pub const YORO_MOST_STRIPS: usize = 8;

/// A history: a rendered image of the synthesized eye, divided into strips of rows, each rendered in a frame of its
/// own. All strips but the last have the same number of rows: the rows of the image divided by the number of strips,
/// rounded up.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroHistory {
    /// sizeof(YoroHistory).
    pub struct_size: u32,
    /// Number of strips, 1 to YORO_MOST_STRIPS.
    pub count: u32,
    /// For each strip, beginning with the one at row 0, the view of the whole image that it was rendered from:
    /// YoroViews' `synthesized` of that frame, with the size of the history. All views have the same size. NULL for an
    /// empty strip.
    pub strips: [*const YoroView; YORO_MOST_STRIPS],
    /// Distance of the near plane in metres, as for the eyes; more than 0.
    pub near_z: f32,
    /// Distance of the far plane in metres; may be INFINITY.
    pub far_z: f32,
    /// The meaning of the depth buffers' values.
    pub depth: YoroDepth,
    /// Order of rows in the images.
    pub rows: YoroRows,
    /// Receives error messages.
    pub messages: YoroMessages,
}

versioned!(YoroHistory);

/// The relation of a synthesized image to the strips of a history, for yoro_gl_synthesize and yoro_vk_record.
/// yoro_strips fills it. It can be copied and kept. It has the std140 layout of the shader kit's block `History`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct YoroStrips {
    /// Matrices that map a pixel of the synthesized image and its depth to a pixel of each strip's image and its depth,
    /// column-major. Zeros for empty strips.
    pub to_history: [[f32; 16]; YORO_MOST_STRIPS],
    /// Number of strips.
    pub count: u32,
    /// Must be 0.
    pub reserved: [u32; 3],
}

/// Computes where the strips of a history show the surfaces of a synthesized image.
///
/// Call it from any thread, without a context. It allocates and keeps nothing.
///
/// @param history     The strips.
/// @param synthesized The image to synthesize: YoroViews' `synthesized` of this frame.
/// @param strips      Receives the relation.
/// @pre The pointers point to structures, `history` to one of the size that it states.
/// @return YORO_ERROR_VALUE, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_strips(
    history: *const YoroHistory,
    synthesized: *const YoroView,
    strips: *mut YoroStrips,
) -> YoroResult {
    catch_errors(|told| {
        // SAFETY: the header requires a pointer to a structure of the size that it states.
        let history = unsafe { versioned::read(history, "history") }?;
        *told = history.messages;
        if synthesized.is_null() || strips.is_null() {
            return Err(Failure::new(YORO_ERROR_NULL, "synthesized or strips is NULL: give both"));
        }
        // SAFETY: the header requires pointers to views; the reads need no alignment.
        let read = |view: *const YoroView| unsafe { view.read_unaligned() };
        let former = history.strips.map(|view| (!view.is_null()).then(|| read(view)));
        let result = history.relation(&read(synthesized), &former)?;
        // SAFETY: the header requires a pointer to a structure.
        unsafe { strips.write_unaligned(result) };
        Ok(())
    })
}

impl YoroHistory {
    fn relation(&self, synthesized: &YoroView, strips: &[Option<YoroView>]) -> Result<YoroStrips, Failure> {
        let count = self.count as usize;
        if !(1..=YORO_MOST_STRIPS).contains(&count) {
            return Err(Failure::value(format!("{count} strips: give 1 to {YORO_MOST_STRIPS}")));
        }
        let range = depth_range(self.near_z, self.far_z, self.depth)?;
        let target = synthesized.core(range)?;
        let strips = strips[..count].iter().map(|view| view.map(|view| view.core(range)).transpose());
        let strips = strips.collect::<Result<Vec<_>, _>>()?;
        let mut sizes = strips.iter().flatten().map(|view| view.size);
        let size = sizes.next().unwrap_or(target.size);
        if sizes.any(|other| other != size) {
            return Err(Failure::value(
                "the strips' views are of different sizes: give the history's, for all of them",
            ));
        }
        let relation = Strips::new(&target, &strips);
        // The core counts rows from the bottom.
        let down = rows_down(self.rows)?;
        let relation = if down { relation.rows_turned(target.size[1], size[1]) } else { relation };
        Ok(YoroStrips {
            to_history: relation.to_history.map(|matrix| matrix.to_cols_array()),
            count: count as u32,
            reserved: [0; 3],
        })
    }
}

impl YoroStrips {
    /// Returns the core's relation, with rows ordered as in the images. Checks the count, since programs may have made
    /// it up.
    pub(crate) fn checked(&self) -> Result<Strips, Failure> {
        if !(1..=YORO_MOST_STRIPS).contains(&(self.count as usize)) || self.reserved != [0; 3] {
            return Err(Failure::value("strips are not those of yoro_strips: fill them in with that"));
        }
        let mut strips = Strips::NONE;
        strips.to_history = self.to_history.map(|matrix| glam::Mat4::from_cols_array(&matrix));
        strips.history_strips = self.count as i32;
        Ok(strips)
    }
}

/// Reads strips. Returns `None` for NULL.
///
/// # Safety
/// `strips` is null or points to strips.
pub(crate) unsafe fn read_strips(strips: *const YoroStrips) -> Result<Option<Strips>, Failure> {
    if strips.is_null() {
        return Ok(None);
    }
    // SAFETY: the pointer is not null; the read needs no alignment.
    unsafe { strips.read_unaligned() }.checked().map(Some)
}
