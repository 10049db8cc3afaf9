// Compares the eyes of a page whose framework has a loop of its own: synthesized, and as three draws them.

import { psnr } from './metrics.js';

/** Both halves of what the canvas shows, read where it is drawn. */
function shown(stereo) {
  const { renderer } = stereo;
  const { width, height } = renderer.domElement;
  const canvas = new OffscreenCanvas(width, height);
  const pen = canvas.getContext('2d', { willReadFrequently: true });
  pen.drawImage(renderer.domElement, 0, 0);
  return [0, width >> 1].map((x) => pen.getImageData(x, 0, width >> 1, height));
}

/** Waits for frames of the framework's loop, and takes the last one. */
function taken(stereo, frames) {
  const { renderer } = stereo;
  const { render } = renderer;
  return new Promise((done) => {
    renderer.render = (scene, camera) => {
      render.call(renderer, scene, camera);
      // The framework draws for the canvas once a frame.
      if (--frames > 0 || renderer.getRenderTarget() !== null) return;
      renderer.render = render;
      done({ halves: shown(stereo), calls: renderer.info.render.calls });
    };
  });
}

/** Sets `compared`, a promise of the comparison, and `ready`. */
export function watch(stereo) {
  const compare = async () => {
    const ours = await taken(stereo, 5);
    const { way, trouble } = stereo;
    stereo.mode = 'rendered';
    const truth = await taken(stereo, 3);
    stereo.mode = 'synthesized';
    return {
      way, trouble, own: psnr(ours.halves[1], truth.halves[1]), psnr: psnr(ours.halves[0], truth.halves[0]),
      same: psnr(truth.halves[1], truth.halves[0]), size: [truth.halves[0].width, truth.halves[0].height],
    };
  };
  globalThis.compared = compare();
  globalThis.ready = true;
}

const scene = document.querySelector('a-scene');
if (scene) {
  const look = () => {
    const { stereo } = scene.components['stereo-synthesis'] ?? {};
    if (stereo) watch(stereo);
    else setTimeout(look, 20);
  };
  look();
}
