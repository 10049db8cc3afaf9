// What comes back from the GPU some frames later. Nothing here waits for it.

/** Queries that may be waiting. */
const MOST = 8;

/**
 * Makes what times frames, where the browser allows it.
 *
 * @param {WebGL2RenderingContext} gl
 */
export function createTimer(gl) {
  const extension = gl.getExtension('EXT_disjoint_timer_query_webgl2');
  const elapsed = extension?.TIME_ELAPSED_EXT;
  let waiting = [], query = null, frame = 0;
  return {
    /** Begins a frame. Others may have a query of their own, of which a context has one at a time. */
    begin() {
      frame++;
      if (!elapsed || waiting.length >= MOST || gl.getQuery(elapsed, gl.CURRENT_QUERY)) return;
      query = gl.createQuery();
      if (query) gl.beginQuery(elapsed, query);
    },

    end() {
      if (!query) return;
      gl.endQuery(elapsed);
      waiting.push([query, frame]);
      query = null;
    },

    /**
     * Returns how many frames ago was the oldest frame whose time is known now, and that time in milliseconds.
     *
     * @return {[number, number]|null}
     */
    take() {
      const [oldest, number] = waiting[0] ?? [];
      if (!oldest || !gl.getQueryParameter(oldest, gl.QUERY_RESULT_AVAILABLE)) return null;
      waiting.shift();
      const ms = gl.getQueryParameter(oldest, gl.QUERY_RESULT) / 1e6;
      gl.deleteQuery(oldest);
      return gl.getParameter(extension.GPU_DISJOINT_EXT) ? null : [frame - number, ms];
    },

    dispose() {
      for (const [each] of waiting) gl.deleteQuery(each);
      waiting = [];
    },
  };
}

/**
 * Makes what reads a small picture of bytes.
 *
 * @param {WebGL2RenderingContext} gl
 */
export function createReadback(gl) {
  const pack = gl.PIXEL_PACK_BUFFER;
  let buffer = null, sync = null, bytes;
  const readback = {
    /** True from `begin` until `take` has returned the picture. */
    get isWaiting() {
      return sync !== null;
    },

    /** Begins to read a square of the framebuffer that is bound. */
    begin(side) {
      bytes = new Uint8Array(4 * side * side);
      buffer ??= gl.createBuffer();
      gl.bindBuffer(pack, buffer);
      gl.bufferData(pack, bytes.length, gl.STREAM_READ);
      gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, 0);
      gl.bindBuffer(pack, null);
      sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    },

    /** Returns the bytes, once, when they are here. */
    take() {
      if (!sync || gl.getSyncParameter(sync, gl.SYNC_STATUS) !== gl.SIGNALED) return null;
      gl.bindBuffer(pack, buffer);
      gl.getBufferSubData(pack, 0, bytes);
      gl.bindBuffer(pack, null);
      readback.dispose();
      return bytes;
    },

    dispose() {
      gl.deleteBuffer(buffer);
      gl.deleteSync(sync);
      buffer = sync = null;
    },
  };
  return readback;
}
