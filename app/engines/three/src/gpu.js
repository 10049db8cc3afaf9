// What comes back from the GPU some frames later. Nothing here waits for it.

/** Queries that may be waiting. */
const MOST = 8;

/** Times frames, where the browser allows it. */
export class Timer {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.extension = gl.getExtension('EXT_disjoint_timer_query_webgl2');
    this.waiting = [];
    this.running = null;
    this.frame = 0;
  }

  /** Begins a frame. Others may have a query of their own, of which a context has one at a time. */
  begin() {
    const { gl, extension } = this;
    this.frame++;
    if (!extension || this.waiting.length >= MOST || gl.getQuery(extension.TIME_ELAPSED_EXT, gl.CURRENT_QUERY)) return;
    this.running = gl.createQuery();
    if (this.running) gl.beginQuery(extension.TIME_ELAPSED_EXT, this.running);
  }

  end() {
    if (!this.running) return;
    this.gl.endQuery(this.extension.TIME_ELAPSED_EXT);
    this.waiting.push({ query: this.running, frame: this.frame });
    this.running = null;
  }

  /** Returns the time of the oldest frame that is known now, in milliseconds, and how many frames ago it was. */
  take() {
    const { gl, extension, waiting } = this;
    if (waiting.length === 0 || !gl.getQueryParameter(waiting[0].query, gl.QUERY_RESULT_AVAILABLE)) return null;
    const { query, frame } = waiting.shift();
    const ms = gl.getQueryParameter(query, gl.QUERY_RESULT) / 1e6;
    gl.deleteQuery(query);
    return gl.getParameter(extension.GPU_DISJOINT_EXT) ? null : { framesAgo: this.frame - frame, ms };
  }

  dispose() {
    for (const { query } of this.waiting) this.gl.deleteQuery(query);
    this.waiting.length = 0;
  }
}

/** Reads a small picture of bytes. */
export class Readback {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.buffer = null;
    this.sync = null;
    this.bytes = null;
  }

  get isWaiting() {
    return this.sync !== null;
  }

  /** Begins to read the framebuffer that is bound. */
  begin(width, height) {
    const { gl } = this;
    this.bytes = new Uint8Array(4 * width * height);
    this.buffer ??= gl.createBuffer();
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, this.buffer);
    gl.bufferData(gl.PIXEL_PACK_BUFFER, this.bytes.length, gl.STREAM_READ);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, 0);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    this.sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  }

  /** Returns the bytes, once, when they are here. */
  take() {
    const { gl, sync } = this;
    if (sync === null || gl.getSyncParameter(sync, gl.SYNC_STATUS) !== gl.SIGNALED) return null;
    gl.deleteSync(sync);
    this.sync = null;
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, this.buffer);
    gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, this.bytes);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    return this.bytes;
  }

  dispose() {
    this.gl.deleteBuffer(this.buffer);
    this.gl.deleteSync(this.sync);
    this.buffer = this.sync = null;
  }
}
