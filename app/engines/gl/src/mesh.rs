//! Indexed triangles on the GPU.

use std::cell::Cell;
use std::ops::Range;
use std::rc::Rc;

use glow::HasContext;

use crate::{Context, GlError, Shape};

/// The number of copies of vertices that are rewritten: the GPU may still be reading those of earlier frames.
const COPIES: usize = 4;

/// One or more vertex arrays, each with an interleaved vertex buffer of floats, and 32-bit indices.
pub struct Mesh {
    gl: Rc<Context>,
    /// One copy, or [`COPIES`] if the vertices are rewritten.
    copies: Vec<(glow::VertexArray, glow::Buffer)>,
    /// The indices of the copies: of the current one, the previous one, and those that are rewritten next, last first.
    order: Cell<[usize; COPIES]>,
    indices: glow::Buffer,
    index_count: usize,
    vertex_count: usize,
    vertex_bytes: u32,
    /// The first location that no attribute has.
    free_location: u32,
}

impl Mesh {
    /// Uploads vertices and indices. `attributes` lists the number of floats of each of a vertex's attributes in order,
    /// for the shader's locations from 0 on.
    ///
    /// # Errors
    /// [`GlError::Object`] if the driver has no memory.
    ///
    /// # Panics
    /// If the sizes of the attributes do not add up to that of a vertex.
    pub fn new<V: bytemuck::Pod>(
        gl: &Rc<Context>,
        attributes: &[i32],
        vertices: &[V],
        indices: &[u32],
    ) -> Result<Mesh, GlError> {
        Mesh::with_copies(gl, attributes, vertices, indices, 1)
    }

    /// Uploads vertices that [`Mesh::rewrite`] can replace, as [`Mesh::new`] does.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    ///
    /// # Panics
    /// Those of [`Mesh::new`].
    pub fn rewritable<V: bytemuck::Pod>(
        gl: &Rc<Context>,
        attributes: &[i32],
        vertices: &[V],
        indices: &[u32],
    ) -> Result<Mesh, GlError> {
        Mesh::with_copies(gl, attributes, vertices, indices, COPIES)
    }

    fn with_copies<V: bytemuck::Pod>(
        gl: &Rc<Context>,
        attributes: &[i32],
        vertices: &[V],
        indices: &[u32],
        copies: usize,
    ) -> Result<Mesh, GlError> {
        let stride = attributes.iter().sum::<i32>() * size_of::<f32>() as i32;
        assert_eq!(stride as usize, size_of::<V>(), "attributes and vertex differ in size");
        let object = |what: &str, reason| GlError::Object { what: what.into(), reason };
        let raw = gl.raw();
        let usage = if copies > 1 { glow::DYNAMIC_DRAW } else { glow::STATIC_DRAW };
        // SAFETY: the attributes lie inside a vertex, as asserted above.
        unsafe {
            let index_buffer = raw.create_buffer().map_err(|e| object("an index buffer", e))?;
            gl.count(1);
            let mut mesh = Mesh {
                gl: gl.clone(),
                copies: Vec::with_capacity(copies),
                order: Cell::new(std::array::from_fn(|place| place % copies)),
                indices: index_buffer,
                index_count: indices.len(),
                vertex_count: vertices.len(),
                vertex_bytes: stride as u32,
                free_location: attributes.len() as u32,
            };
            for copy in 0..copies {
                let array = raw.create_vertex_array().map_err(|e| object("a vertex array", e))?;
                let vertex_buffer = raw.create_buffer().map_err(|e| object("a vertex buffer", e))?;
                gl.count(2);
                mesh.copies.push((array, vertex_buffer));
                raw.bind_vertex_array(Some(array));
                raw.bind_buffer(glow::ARRAY_BUFFER, Some(vertex_buffer));
                raw.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytemuck::cast_slice(vertices), usage);
                raw.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(index_buffer));
                if copy == 0 {
                    raw.buffer_data_u8_slice(
                        glow::ELEMENT_ARRAY_BUFFER,
                        bytemuck::cast_slice(indices),
                        glow::STATIC_DRAW,
                    );
                }
                let mut offset = 0;
                for (location, &floats) in (0..).zip(attributes) {
                    raw.enable_vertex_attrib_array(location);
                    raw.vertex_attrib_pointer_f32(location, floats, glow::FLOAT, false, stride, offset);
                    offset += floats * size_of::<f32>() as i32;
                }
                raw.bind_vertex_array(None);
            }
            if raw.get_error() == glow::OUT_OF_MEMORY {
                return Err(object("a mesh", format!("out of memory for {} vertices", vertices.len())));
            }
            Ok(mesh)
        }
    }

    /// Replaces the vertices of a mesh from [`Mesh::rewritable`], for draw calls after the next [`Mesh::bind`].
    ///
    /// # Panics
    /// If the number of vertices differs.
    pub fn rewrite<V: bytemuck::Pod>(&mut self, vertices: &[V]) {
        let bytes: &[u8] = bytemuck::cast_slice(vertices);
        assert_eq!(bytes.len(), self.vertex_count * self.vertex_bytes as usize, "other vertices than before");
        self.order.get_mut().rotate_right(1);
        self.write(0, 0, bytes);
    }

    /// Replaces all vertices that [`Mesh::bind_with_previous`] gives as the previous ones, in a copy that no earlier frame reads.
    ///
    /// # Panics
    /// If the number of vertices differs.
    pub fn renew_previous<V: bytemuck::Pod>(&self, vertices: &[V]) {
        let bytes: &[u8] = bytemuck::cast_slice(vertices);
        assert_eq!(bytes.len(), self.vertex_count * self.vertex_bytes as usize, "other vertices than before");
        let mut order = self.order.get();
        order.swap(1, COPIES - 1);
        self.order.set(order);
        self.write(1, 0, bytes);
    }

    /// Replaces vertices from `first` on after [`Mesh::renew_previous`].
    ///
    /// # Panics
    /// If there are not as many.
    pub fn rewrite_previous<V: bytemuck::Pod>(&self, first: usize, vertices: &[V]) {
        let bytes: &[u8] = bytemuck::cast_slice(vertices);
        let offset = first * self.vertex_bytes as usize;
        assert!(offset + bytes.len() <= self.vertex_count * self.vertex_bytes as usize, "too many vertices");
        self.write(1, offset, bytes);
    }

    /// Writes bytes that fit into a copy, which is given by its place in the order.
    fn write(&self, place: usize, offset: usize, bytes: &[u8]) {
        let gl = self.gl.raw();
        // SAFETY: the buffer lives as long as the mesh, and the callers check the size.
        unsafe {
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(self.copy(place).1));
            gl.buffer_sub_data_u8_slice(glow::ARRAY_BUFFER, offset as i32, bytes);
        }
    }

    /// Returns the copy at a place in the order.
    fn copy(&self, place: usize) -> (glow::VertexArray, glow::Buffer) {
        self.copies[self.order.get()[place]]
    }

    /// Returns the number of indices.
    pub fn index_count(&self) -> usize {
        self.index_count
    }

    /// Binds the vertex array for the following [`Mesh::draw`] calls.
    pub fn bind(&self) {
        // SAFETY: the vertex array lives as long as the mesh.
        unsafe { self.gl.raw().bind_vertex_array(Some(self.copy(0).0)) }
    }

    /// Binds the vertex array as [`Mesh::bind`] does, with one more attribute at the location after the last one: the first
    /// three floats of each vertex before the last [`Mesh::rewrite`], or its present ones if it has not `moved`.
    pub fn bind_with_previous(&self, moved: bool) {
        self.bind();
        let previous = self.copy(usize::from(moved)).1;
        let gl = self.gl.raw();
        // SAFETY: the buffer lives as long as the vertex array, and its vertices begin with three floats or are longer.
        unsafe {
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(previous));
            gl.enable_vertex_attrib_array(self.free_location);
            let stride = self.vertex_bytes as i32;
            gl.vertex_attrib_pointer_f32(self.free_location, 3, glow::FLOAT, false, stride, 0);
        }
    }

    /// Draws all indices as one triangle strip. The mesh must be bound.
    pub fn draw_strip(&self) {
        let gl = self.gl.raw();
        // SAFETY: the count is that of the index buffer, whose values the caller of `new` has checked.
        self.gl.drawing(self.shape(self.index_count), || unsafe {
            gl.draw_elements(glow::TRIANGLE_STRIP, self.index_count as i32, glow::UNSIGNED_INT, 0);
        });
    }

    /// Draws a range of indices as triangles, `instances` times. The mesh must be bound.
    pub fn draw(&self, range: Range<usize>, instances: usize) {
        debug_assert!(range.end <= self.index_count);
        let (count, offset) = (range.len() as i32, (range.start * 4) as i32);
        // SAFETY: the range lies inside the index buffer, whose values the scene loader has checked.
        self.gl.drawing(self.shape(range.len() * instances), || unsafe {
            if instances == 1 {
                self.gl.raw().draw_elements(glow::TRIANGLES, count, glow::UNSIGNED_INT, offset);
            } else {
                let gl = self.gl.raw();
                gl.draw_elements_instanced(
                    glow::TRIANGLES,
                    count,
                    glow::UNSIGNED_INT,
                    offset,
                    instances as i32,
                );
            }
        });
    }

    fn shape(&self, indices: usize) -> Shape {
        let vertices = indices as f64 * self.vertex_count as f64 / self.index_count.max(1) as f64;
        Shape::Mesh {
            indices: indices as u64,
            vertices: vertices.round() as u64,
            vertex_bytes: self.vertex_bytes,
        }
    }
}

impl Drop for Mesh {
    fn drop(&mut self) {
        // SAFETY: created in `new`, deleted once.
        unsafe {
            for &(array, vertices) in &self.copies {
                self.gl.raw().delete_vertex_array(array);
                self.gl.raw().delete_buffer(vertices);
            }
            self.gl.raw().delete_buffer(self.indices);
        }
        self.gl.count(-1 - 2 * self.copies.len() as isize);
    }
}
