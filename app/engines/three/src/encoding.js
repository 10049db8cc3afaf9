// How three encodes colour in targets of ours.

import { Color, Mesh, MeshBasicMaterial, OrthographicCamera, PlaneGeometry, Scene, WebGLRenderTarget } from 'three';
import { Readback } from './gpu.js';

/** Has materials write tone mapped and encoded colour into a target, as into a headset's. */
export function encode(target, renderer) {
  target.isXRRenderTarget = true;
  target.texture.internalFormat = 'RGBA8';
  target.texture.colorSpace = renderer.outputColorSpace;
}

/**
 * Finds out whether they do: it is not a public promise of three's, and early versions forget the background and the fog.
 * Grey pixels tell it some frames later.
 */
export class Encoding {
  #renderer;
  #pixels;
  /** Whether materials encode, and the background; null until it is known. */
  #materials = null;
  #background = true;

  /** @param {import('three').WebGLRenderer} renderer */
  constructor(renderer) {
    this.#renderer = renderer;
    this.#pixels = new Readback(renderer.getContext());
  }

  /** True if materials do not encode. */
  get isMissing() {
    return this.#materials === false;
  }

  /** Takes a step towards the answer: call it each frame. Changes the renderer's target. */
  find() {
    const renderer = this.#renderer, pixels = this.#pixels;
    const bytes = pixels.take();
    if (bytes) [this.#background, this.#materials] = [bytes[0] > 150, bytes[4] > 150];
    if (this.#materials !== null || pixels.isWaiting) return;
    const target = new WebGLRenderTarget(2, 2, { depthBuffer: false });
    encode(target, renderer);
    const scene = new Scene();
    const color = scene.background = new Color().setRGB(0.5, 0.5, 0.5);
    const right = new Mesh(new PlaneGeometry(1, 2), new MeshBasicMaterial({ color, toneMapped: false }));
    right.position.x = 0.5;
    scene.add(right);
    renderer.setRenderTarget(target);
    renderer.render(scene, new OrthographicCamera(-1, 1, 1, -1, -1, 1));
    pixels.begin(2);
    for (const each of [target, right.geometry, right.material]) each.dispose();
  }

  /** Draws a scene, with a background and a fog that are encoded if three forgets it. Changes the colour to clear with. */
  draw(scene, draw) {
    if (this.#background) return draw();
    const renderer = this.#renderer, clear = renderer.getClearColor(new Color());
    const colors = [clear, scene.background, scene.fog?.color].filter((color) => color?.isColor);
    const kept = colors.map((color) => color.clone());
    for (const color of colors) color.convertLinearToSRGB();
    renderer.setClearColor(clear, renderer.getClearAlpha());
    try {
      return draw();
    } finally {
      colors.forEach((color, i) => color.copy(kept[i]));
    }
  }

  dispose() {
    this.#pixels.dispose();
  }
}
