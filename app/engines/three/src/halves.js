// The eyes on the halves of a canvas or render target.

import { ArrayCamera, StereoCamera, Vector2, Vector4 } from 'three';
import { EYE_LAYERS } from './parts.js';

export class Halves {
  /** Three's own computation of both eyes. */
  stereoCamera = new StereoCamera();
  #pair;

  constructor() {
    const { stereoCamera } = this;
    const eyes = [stereoCamera.cameraL, stereoCamera.cameraR];
    this.#pair = new ArrayCamera(eyes);
    for (const eye of eyes) eye.viewport = new Vector4();
    this.#pair.matrixAutoUpdate = this.#pair.matrixWorldAutoUpdate = false;
    stereoCamera.aspect = 0.5;
  }

  /**
   * Returns both eyes of a camera.
   *
   * @param {import('three').WebGLRenderer} renderer
   * @param {import('three').Camera} camera
   * @return {import('three').ArrayCamera}
   */
  of(renderer, camera) {
    const pair = this.#pair, all = [pair, ...pair.cameras];
    const { width, height } = renderer.getRenderTarget() ?? renderer.getDrawingBufferSize(new Vector2());
    const half = Math.floor(width / 2);
    if (renderer.capabilities.reversedDepthBuffer) {
      // The renderer would do this later, and change the eyes' matrices.
      if (!camera.reversedDepth) {
        camera._reversedDepth = true;
        camera.updateProjectionMatrix();
      }
      for (const each of all) each._reversedDepth = true;
    }
    this.stereoCamera.update(camera);
    for (const each of all) {
      each.near = camera.near;
      each.far = camera.far;
    }
    pair.matrixWorld.copy(camera.matrixWorld);
    pair.matrixWorldInverse.copy(pair.matrixWorld).invert();
    pair.projectionMatrix.copy(camera.projectionMatrix);
    pair.projectionMatrixInverse.copy(camera.projectionMatrixInverse);
    pair.layers.mask = camera.layers.mask | EYE_LAYERS;
    pair.cameras.forEach((eye, i) => {
      eye.updateMatrixWorld();
      eye.projectionMatrixInverse.copy(eye.projectionMatrix).invert();
      eye.viewport.set(i * half, 0, half, height);
      eye.layers.mask = pair.layers.mask & ~(0b100 >> i);
    });
    return pair;
  }
}
