// How three encodes colour in targets of ours.

import { Color, OrthographicCamera, Scene, WebGLRenderTarget } from 'three';
import { Readback } from './gpu.js';

/** Has materials write tone mapped and encoded colour into a target, as into a headset's. */
export function encode(target, renderer) {
  target.isXRRenderTarget = true;
  target.texture.internalFormat = 'RGBA8';
  target.texture.colorSpace = renderer.outputColorSpace;
}

/**
 * Finds out whether three does, which is not a public promise of its: by its background, which early versions forget. A grey
 * pixel tells it some frames later.
 */
export class Encoding {
  #renderer;
  #pixels;
  /** True if three does not encode all of it. */
  isMissing = false;
  #isKnown = false;

  /** @param {import('three').WebGLRenderer} renderer */
  constructor(renderer) {
    this.#renderer = renderer;
    this.#pixels = new Readback(renderer.getContext());
  }

  /** Takes a step towards the answer: call it each frame. Changes the renderer's target. */
  find() {
    const renderer = this.#renderer, pixels = this.#pixels;
    const bytes = pixels.take();
    if (bytes) {
      this.isMissing = bytes[0] < 150;
      this.#isKnown = true;
    }
    if (this.#isKnown || pixels.isWaiting) return;
    const target = new WebGLRenderTarget(1, 1, { depthBuffer: false });
    encode(target, renderer);
    const scene = new Scene();
    scene.background = new Color().setRGB(0.5, 0.5, 0.5);
    renderer.setRenderTarget(target);
    renderer.render(scene, new OrthographicCamera());
    pixels.begin(1);
    target.dispose();
  }

  dispose() {
    this.#pixels.dispose();
  }
}
