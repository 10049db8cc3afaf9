// A-Frame: <a-scene stereo-synthesis>, with the options of StereoSynthesis, such as "dominantEye: left".

import 'aframe';
import { StereoSynthesis } from 'yoro-three';

AFRAME.registerComponent('stereo-synthesis', {
  schema: { mode: { default: 'auto' }, dominantEye: { default: 'right' }, nearLimit: { default: 0.4 } },
  init() {
    const begin = () => {
      this.stereo = new StereoSynthesis(this.el.renderer, this.data);
      this.undo = this.stereo.install();
    };
    if (this.el.renderStarted) begin();
    else this.el.addEventListener('renderstart', begin, { once: true });
  },
  update() {
    if (this.stereo) Object.assign(this.stereo, this.data);
  },
  remove() {
    this.undo?.();
    this.stereo?.dispose();
  },
});
