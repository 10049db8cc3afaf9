// What comes back from the GPU some frames later. Nothing here waits for it.

/** Queries that may be waiting. */
const MOST = 8;

/** Times frames, where the browser allows it. */
export class Timer {
  #gl;
  #extension;
  #waiting = [];
  #query = null;
  #frame = 0;

  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.#gl = gl;
    this.#extension = gl.getExtension('EXT_disjoint_timer_query_webgl2');
  }

  /** Begins a frame. Others may have a query of their own, of which a context has one at a time. */
  begin() {
    const gl = this.#gl, elapsed = this.#extension?.TIME_ELAPSED_EXT;
    this.#frame++;
    if (!elapsed || this.#waiting.length >= MOST || gl.getQuery(elapsed, gl.CURRENT_QUERY)) return;
    this.#query = gl.createQuery();
    if (this.#query) gl.beginQuery(elapsed, this.#query);
  }

  end() {
    if (!this.#query) return;
    this.#gl.endQuery(this.#extension.TIME_ELAPSED_EXT);
    this.#waiting.push([this.#query, this.#frame]);
    this.#query = null;
  }

  /**
   * Returns how many frames ago was the oldest frame whose time is known now, and that time in milliseconds.
   *
   * @return {[number, number]|null}
   */
  take() {
    const gl = this.#gl;
    const [query, frame] = this.#waiting[0] ?? [];
    if (!query || !gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE)) return null;
    this.#waiting.shift();
    const ms = gl.getQueryParameter(query, gl.QUERY_RESULT) / 1e6;
    gl.deleteQuery(query);
    return gl.getParameter(this.#extension.GPU_DISJOINT_EXT) ? null : [this.#frame - frame, ms];
  }

  dispose() {
    for (const [query] of this.#waiting) this.#gl.deleteQuery(query);
    this.#waiting = [];
  }
}

/** Reads a small picture of bytes. */
export class Readback {
  #gl;
  #buffer = null;
  #sync = null;
  #bytes;

  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.#gl = gl;
  }

  /** True from `begin` until `take` has returned the picture. */
  get isWaiting() {
    return this.#sync !== null;
  }

  /** Begins to read a square of the framebuffer that is bound. */
  begin(side) {
    const gl = this.#gl, pack = gl.PIXEL_PACK_BUFFER;
    this.#bytes = new Uint8Array(4 * side * side);
    this.#buffer ??= gl.createBuffer();
    gl.bindBuffer(pack, this.#buffer);
    gl.bufferData(pack, this.#bytes.length, gl.STREAM_READ);
    gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, 0);
    gl.bindBuffer(pack, null);
    this.#sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  }

  /** Returns the bytes, once, when they are here. */
  take() {
    const gl = this.#gl, pack = gl.PIXEL_PACK_BUFFER;
    if (!this.#sync || gl.getSyncParameter(this.#sync, gl.SYNC_STATUS) !== gl.SIGNALED) return null;
    gl.bindBuffer(pack, this.#buffer);
    gl.getBufferSubData(pack, 0, this.#bytes);
    gl.bindBuffer(pack, null);
    this.dispose();
    return this.#bytes;
  }

  dispose() {
    this.#gl.deleteBuffer(this.#buffer);
    this.#gl.deleteSync(this.#sync);
    this.#buffer = this.#sync = null;
  }
}
