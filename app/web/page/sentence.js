// Errors as sentences.

/**
 * Returns a sentence for a thrown value.
 * @param {Error} error
 * @returns {string}
 */
export function sentence(error) {
  if (error instanceof WebAssembly.RuntimeError) {
    return `The module has failed (${error.message}), perhaps for lack of memory: reload the page, and choose a smaller scene.`;
  }
  return error.message ?? String(error);
}
