// The eyes on the halves of a canvas or render target.

import * as THREE from 'three';
import { EYE_LAYERS } from './parts.js';
import { isReversed } from './views.js';

/** @param {THREE.WebGLRenderer} renderer */
export function createHalves(renderer) {
  /** Three's own computation of both eyes. */
  const stereoCamera = new THREE.StereoCamera();
  stereoCamera.aspect = 0.5;
  const { cameraL, cameraR } = stereoCamera;
  const pair = new THREE.ArrayCamera([cameraL, cameraR]);
  pair.matrixAutoUpdate = pair.matrixWorldAutoUpdate = false;
  for (const eye of pair.cameras) eye.viewport = new THREE.Vector4();

  /**
   * Returns both eyes of a camera.
   *
   * @param {THREE.Camera} camera
   * @return {THREE.ArrayCamera}
   */
  const of = (camera) => {
    const { near, far, layers, matrixWorld } = camera;
    const { width, height } = renderer.getRenderTarget() ?? renderer.getDrawingBufferSize(new THREE.Vector2());
    const half = Math.floor(width / 2), _reversedDepth = isReversed(renderer);
    if (_reversedDepth && !camera.reversedDepth) {
      // The renderer would do this later, and change the eyes' matrices.
      camera._reversedDepth = true;
      camera.updateProjectionMatrix();
    }
    stereoCamera.update(camera);
    for (const each of [pair, cameraL, cameraR]) Object.assign(each, { near, far, _reversedDepth });
    pair.matrixWorld.copy(matrixWorld);
    pair.matrixWorldInverse.copy(matrixWorld).invert();
    pair.projectionMatrix.copy(camera.projectionMatrix);
    pair.projectionMatrixInverse.copy(camera.projectionMatrixInverse);
    pair.layers.mask = layers.mask | EYE_LAYERS;
    pair.cameras.forEach((eye, i) => {
      eye.updateMatrixWorld();
      eye.projectionMatrixInverse.copy(eye.projectionMatrix).invert();
      eye.viewport.set(i * half, 0, half, height);
      eye.layers.mask = pair.layers.mask & ~(0b100 >> i);
    });
    return pair;
  };

  return { stereoCamera, of };
}
