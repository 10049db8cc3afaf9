// Makes scenes away from the page, since generating and decoding them takes seconds.

import init, { buildScene, loadScene, takeWarnings } from './yoro_web.js';

onmessage = async ({ data }) => {
  try {
    await init({ module_or_path: data.module });
    const bytes = data.builtin
      ? buildScene(data.builtin, (textures, triangles) => postMessage({ textures, triangles }))
      : loadScene(data.main, data.files.map((file) => file.name), data.files.map((file) => new Uint8Array(file.bytes)));
    postMessage({ bytes, warnings: takeWarnings() }, [bytes.buffer]);
  } catch (error) {
    // The module aborts without a message when memory runs out.
    const full = error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
    postMessage({ error: full ? 'The scene could not be made, probably for lack of memory: choose a smaller one.' : error.message });
  }
};
