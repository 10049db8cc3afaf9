// What of a scene is drawn where: its opaque part into the sources, the rest of it over both eyes.

import { Color, Frustum, LessEqualDepth, Matrix4, PerspectiveCamera, UVMapping, Vector4 } from 'three';
import { asEyes, asSource } from './answers.js';
import { once } from './state.js';
import { project } from './views.js';

/** The layers that three reserves for what one eye alone sees: 1 for the left eye, 2 for the right one. */
export const EYE_LAYERS = 0b110;
/** The layer of what the rendered eye shows while opaque objects are drawn into the other one's holes. */
const SHOWN = 1 << 31;

export class Parts {
  /** True if what is seen behind the source is drawn for each eye: the source's alpha says how much it covers. */
  isCovering = false;
  /** True if something is seen through transmission. */
  hasGlass = false;
  #stereo;
  #encoding;
  /** The sources' cameras: three keeps a target for transmission for each. */
  #cameras = [new PerspectiveCamera(), new PerspectiveCamera()];
  /** What the other eye's holes may show. */
  #frustum = new Frustum();
  /** True if all opaque objects are tested by depth in the usual way. */
  #isTested = false;
  #isFoveated = false;

  /**
   * @param {import('./StereoSynthesis.js').StereoSynthesis} stereo
   * @param {import('./encoding.js').Encoding} encoding
   */
  constructor(stereo, encoding) {
    this.#stereo = stereo;
    this.#encoding = encoding;
    for (const camera of this.#cameras) {
      camera.matrixAutoUpdate = camera.matrixWorldAutoUpdate = false;
      // Its matrix is not that of an angle.
      camera.updateProjectionMatrix = () => {};
    }
  }

  /** Returns the camera of a source. */
  look(eye, { frustum }, index) {
    const camera = this.#cameras[index];
    camera.near = eye.near;
    camera.far = eye.far;
    camera.matrixWorld.copy(eye.matrixWorld).decompose(camera.position, camera.quaternion, camera.scale);
    camera.matrixWorldInverse.copy(eye.matrixWorld).invert();
    project(camera.projectionMatrix.copy(eye.projectionMatrix), frustum);
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
    camera._reversedDepth = this.#isReversed;
    // What one eye alone sees is left out, but counted.
    camera.layers.mask = eye.layers.mask | EYE_LAYERS;
    return camera;
  }

  /**
   * Draws what moves with the synthesis into a target. Returns how many objects are left.
   *
   * @param {import('three').WebGLRenderTarget} target
   * @param {number[]} size - The target's, in pixels.
   * @param {import('three').Object3D} scene
   * @param {import('three').Camera} eye - The rendered one.
   * @param {Object} views - From `viewsOf`.
   * @param {number} [index=0] - 1 for the inset.
   */
  draw(target, size, scene, eye, views, index = 0) {
    const { renderer } = this.#stereo;
    const before = renderer.getRenderTarget();
    const camera = this.look(eye, views, index);
    target.setSize(...size);
    if (target.samples > 0 && renderer.properties?.get) renderer.properties.get(target).__useRenderToTexture = false;
    const { background, overrideMaterial } = scene;
    // The levels agree.
    const isFirst = index === 0;
    if (isFirst) {
      // A picture that fills the view fills an eye's, not the source's.
      this.isCovering = Boolean(background?.isTexture) && !background.isCubeTexture && background.mapping === UVMapping;
      this.hasGlass = false;
      this.#isFoveated = Boolean(views.hides);
      this.#isTested = !overrideMaterial && renderer.sortObjects;
    }
    const isWanted = (object, kind, item) => {
      if (isFirst && kind === 'transmissive') this.hasGlass = true;
      const isOpaque = kind === 'opaque', isLater = this.#isLater(object, kind);
      if (isFirst && isOpaque) {
        if (this.#isOfOneEyeAlone(object)) this.isCovering = true;
        const { depthTest, depthWrite, depthFunc } = item.material;
        // A sky that writes no depth lies at the near plane if depth is reversed.
        this.#isTested &&= isLater || (depthTest && depthFunc === LessEqualDepth && (depthWrite || !this.#isReversed));
      }
      return !isLater && !(isOpaque && !this.hasGlass && views.hides?.(object));
    };
    const color = renderer.getClearColor(new Color()), alpha = renderer.getClearAlpha();
    const clear = () => {
      if (overrideMaterial) this.isCovering = false;
      if (!this.isCovering) return;
      scene.background = null;
      renderer.setClearColor(0, 0);
    };
    const viewport = asEyes(renderer, () => renderer.getViewport(new Vector4()), eye.viewport);
    try {
      return once(renderer, () => {
        renderer.xr.enabled = false;
        // Shadows are those of the first source.
        if (!isFirst) renderer.shadowMap.autoUpdate = false;
        renderer.setRenderTarget(target);
        const part = () => asSource(renderer, views, viewport, () => this.#part(scene, isWanted, camera, clear));
        // In headsets, those versions forget the background, too, and what is drawn for both eyes fits to it.
        return before === null && target.isXRRenderTarget ? this.#encoding.draw(scene, part) : part();
      });
    } finally {
      renderer.setRenderTarget(before);
      renderer.setClearColor(color, alpha);
      scene.background = background;
    }
  }

  /**
   * Draws both eyes, and over them what is left of the scene, in one pass. Opaque objects are drawn into open holes of the
   * other eye: elsewhere, depth is the nearest there until they are drawn.
   *
   * @param {import('./passes.js').Passes} passes
   * @param {import('three').Camera} shown - What three draws both eyes for.
   * @param {import('three').Camera} eye - The rendered one.
   * @param {number} left - How many objects are left.
   * @param {Object|null} target - The other eye's part that has open holes, as `viewsOf` names it; null without.
   */
  show(passes, scene, shown, eye, left, target) {
    const { renderer } = this.#stereo;
    const { eyes } = passes;
    const { background, overrideMaterial } = scene;
    const { isCovering } = this;
    const own = eye.layers;
    const isOpen = target !== null;
    const isAll = left === 0 && !isCovering && !isOpen;
    if (isAll || overrideMaterial) renderer.render(eyes, shown);
    if (isAll) return;
    const frustum = this.#frustum;
    if (isOpen) frustum.setFromProjectionMatrix(new Matrix4().copy(target.matrixWorld).invert().premultiply(target.projectionMatrix), undefined, this.#isReversed);
    const masks = [];
    const mask = (layers, value) => {
      masks.push([layers, layers.mask]);
      layers.mask = value;
    };
    const isWanted = (object, kind, item) => {
      const isPicture = object.parent === eyes, isOpaque = kind === 'opaque';
      if (!isPicture && !this.#isLater(object, kind)) return isOpen && isOpaque && (!object.frustumCulled || frustum.intersectsObject(object));
      // What one eye alone sees may be behind the pictures.
      if (isCovering && isOpaque && !isPicture && this.#isOfOneEyeAlone(object)) item.groupOrder = item.renderOrder = -Infinity;
      if (isOpen) {
        // After all that holes show.
        if (isOpaque && object !== passes.own && object !== passes.open) item.groupOrder = isPicture ? Number.MAX_VALUE : Infinity;
        if (object.layers.test(own)) mask(object.layers, object.layers.mask | SHOWN);
      }
      return true;
    };
    if (!isCovering && !isOpen) scene.background = null;
    if (!overrideMaterial) scene.children.unshift(eyes);
    try {
      once(renderer, () => {
        renderer.shadowMap.autoUpdate = false;
        if (overrideMaterial) renderer.autoClear = false;
        this.#part(scene, isWanted, shown, () => {
          if (!isOpen) return;
          mask(own, SHOWN);
          // Mirrors draw the scene, too.
          eyes.visible = false;
        });
      });
    } finally {
      for (const [layers, value] of masks.reverse()) layers.mask = value;
      eyes.visible = true;
      if (!overrideMaterial) scene.children.splice(scene.children.indexOf(eyes), 1);
      scene.background = background;
    }
  }

  /** True if the holes of what was drawn can be drawn into. */
  get canOpen() {
    return this.#isTested && !this.isCovering && !this.hasGlass;
  }

  get #isReversed() {
    return Boolean(this.#stereo.renderer.capabilities.reversedDepthBuffer);
  }

  /** True for what one eye alone sees. */
  #isOfOneEyeAlone({ layers }) {
    return (layers.mask & this.#cameras[0].layers.mask & ~EYE_LAYERS) === 0;
  }

  /** True for what is drawn for each eye, after the synthesis. */
  #isLater(object, kind) {
    if (kind === 'transparent' || this.#isOfOneEyeAlone(object) || (object.layers.mask & this.#stereo.bothEyes) !== 0) return true;
    // Widths and sizes in pixels are those of the eye's, unless they are seen through something.
    return this.#isFoveated && !this.hasGlass && (object.isLine || object.isPoints) === true;
  }

  /**
   * Draws a part of the scene: changes three's list of what it draws, before it is sorted. Returns how much was left out.
   *
   * @param {(object: import('three').Object3D, kind: string, item: Object) => boolean} isWanted - Called with
   * 'transmissive', 'opaque' or 'transparent', in this order, and the list's item.
   * @param {import('three').Camera} camera
   * @param {() => void} before - Called once it is known what is drawn.
   */
  #part(scene, isWanted, camera, before) {
    const { renderer } = this.#stereo;
    const list = renderer.renderLists.get(scene, 0);
    const { finish } = list;
    let left = 0;
    list.finish = () => {
      for (const name of ['transmissive', 'opaque', 'transparent']) {
        const items = list[name];
        let kept = 0;
        for (const item of items) if (isWanted(item.object, name, item)) items[kept++] = item;
        left += items.length - kept;
        items.length = kept;
      }
      before();
      finish();
    };
    try {
      renderer.render(scene, camera);
    } finally {
      list.finish = finish;
    }
    return left;
  }
}
