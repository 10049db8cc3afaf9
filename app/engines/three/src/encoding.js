// How three encodes colour in targets of ours.

import * as THREE from 'three';
import { createReadback } from './gpu.js';

/** Has materials write tone mapped and encoded colour into a target, as into a headset's. */
export function encode(target, renderer) {
  target.isXRRenderTarget = true;
  target.texture.internalFormat = 'RGBA8';
  target.texture.colorSpace = renderer.outputColorSpace;
}

/**
 * Makes what finds out whether they do: it is not a public promise of three's, and early versions forget the background and
 * the fog. Grey pixels tell it some frames later.
 *
 * @param {THREE.WebGLRenderer} renderer
 */
export function createEncoding(renderer) {
  const pixels = createReadback(renderer.getContext());
  /** Whether the background and materials are encoded; null until it is known of these. */
  let isBackground = true, areMaterials = null;
  return {
    /** True if materials do not encode. */
    get isMissing() {
      return areMaterials === false;
    },

    /** Takes a step towards the answer: call it each frame. Changes the renderer's target. */
    find() {
      const bytes = pixels.take();
      if (bytes) [isBackground, areMaterials] = [bytes[0] > 150, bytes[4] > 150];
      if (areMaterials !== null || pixels.isWaiting) return;
      const target = new THREE.WebGLRenderTarget(2, 2, { depthBuffer: false });
      encode(target, renderer);
      const scene = new THREE.Scene();
      const color = scene.background = new THREE.Color().setRGB(0.5, 0.5, 0.5);
      const right = new THREE.Mesh(new THREE.PlaneGeometry(1, 2), new THREE.MeshBasicMaterial({ color, toneMapped: false }));
      right.position.x = 0.5;
      scene.add(right);
      renderer.setRenderTarget(target);
      renderer.render(scene, new THREE.OrthographicCamera(-1, 1, 1, -1, -1, 1));
      pixels.begin(2);
      for (const each of [target, right.geometry, right.material]) each.dispose();
    },

    /** Draws a scene, with a background and a fog that are encoded if three forgets it. Changes the colour to clear with. */
    draw(scene, draw) {
      if (isBackground) return draw();
      const clear = renderer.getClearColor(new THREE.Color());
      const colors = [clear, scene.background, scene.fog?.color].filter((color) => color?.isColor);
      const kept = colors.map((color) => color.clone());
      for (const color of colors) color.convertLinearToSRGB();
      renderer.setClearColor(clear, renderer.getClearAlpha());
      try {
        return draw();
      } finally {
        colors.forEach((color, i) => color.copy(kept[i]));
      }
    },

    dispose: pixels.dispose,
  };
}
