// What drawing leaves as it was.

import { Vector4 } from 'three';

/** Draws, and restores what the user has set. */
export function once(renderer, draw) {
  const { xr, shadowMap, autoClear } = renderer;
  const { enabled } = xr;
  const { autoUpdate } = shadowMap;
  try {
    return draw();
  } finally {
    xr.enabled = enabled;
    renderer.autoClear = autoClear;
    shadowMap.autoUpdate = autoUpdate;
  }
}

/** Draws into targets of ours that need not be cleared. */
export function aside(renderer, draw) {
  const target = renderer.getRenderTarget();
  once(renderer, () => {
    renderer.xr.enabled = renderer.autoClear = false;
    draw();
  });
  renderer.setRenderTarget(target);
}

/** Draws, and restores what the renderer draws to: three itself leaves its viewport on the right eye's half. */
export function restoring(renderer, draw) {
  const viewport = renderer.getViewport(new Vector4()), current = renderer.getCurrentViewport(new Vector4());
  const target = [renderer.getRenderTarget(), renderer.getActiveCubeFace(), renderer.getActiveMipmapLevel()];
  try {
    draw();
  } finally {
    renderer.setRenderTarget(...target);
    // That of a render target may have been set by `setViewport`, too.
    if (!renderer.getCurrentViewport(new Vector4()).equals(current)) renderer.setViewport(viewport);
  }
}
