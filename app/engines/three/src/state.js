// What drawing leaves as it was.

import * as THREE from 'three';

/** Draws while an object has other values. */
export function having(object, values, draw) {
  const own = {};
  for (const name in values) own[name] = object[name];
  try {
    return draw(Object.assign(object, values));
  } finally {
    Object.assign(object, own);
  }
}

/** Draws, and restores what the user has set: three itself leaves its viewport on the right eye's half. */
export function restoring(renderer, draw) {
  const { xr, shadowMap, autoClear } = renderer;
  const { enabled } = xr, { autoUpdate } = shadowMap;
  const viewport = renderer.getViewport(new THREE.Vector4()), current = renderer.getCurrentViewport(new THREE.Vector4());
  const target = [renderer.getRenderTarget(), renderer.getActiveCubeFace(), renderer.getActiveMipmapLevel()];
  const color = renderer.getClearColor(new THREE.Color()), alpha = renderer.getClearAlpha();
  try {
    return draw();
  } finally {
    xr.enabled = enabled;
    shadowMap.autoUpdate = autoUpdate;
    renderer.autoClear = autoClear;
    renderer.setClearColor(color, alpha);
    renderer.setRenderTarget(...target);
    // That of a render target may have been set by `setViewport`, too.
    if (!renderer.getCurrentViewport(new THREE.Vector4()).equals(current)) renderer.setViewport(viewport);
  }
}

/** Draws into targets of ours that need not be cleared. */
export function aside(renderer, draw) {
  restoring(renderer, () => {
    renderer.xr.enabled = renderer.autoClear = false;
    draw();
  });
}
