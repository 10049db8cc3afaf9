// Errors as sentences.

/**
 * Returns a sentence for a thrown value.
 * @param {any} error
 * @returns {string}
 */
export function sentence(error) {
  // After a failure, the module's objects stay locked, which the bindings report as recursive use.
  if (error instanceof WebAssembly.RuntimeError || /recursive use of an object/.test(error.message)) {
    return `The module has failed (${error.message}), perhaps for lack of memory: reload the page, and choose a smaller scene.`;
  }
  return error.message ?? String(error);
}
