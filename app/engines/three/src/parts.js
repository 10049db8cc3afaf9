// What of a scene is drawn where: its opaque part into the sources, the rest of it over both eyes.

import * as THREE from 'three';
import { asEyes, asSource } from './answers.js';
import { having, restoring } from './state.js';
import { isReversed, project } from './views.js';

/** The layers that three reserves for what one eye alone sees: 1 for the left eye, 2 for the right one. */
export const EYE_LAYERS = 0b110;
/** The layer of what the rendered eye shows while opaque objects are drawn into the other one's holes. */
const SHOWN = 1 << 31;

/**
 * @param {import('./StereoSynthesis.js').StereoSynthesis} stereo
 * @param {Object} encoding - From `createEncoding`.
 */
export function createParts(stereo, encoding) {
  const { renderer } = stereo;
  const hasReversedDepth = isReversed(renderer);
  /** The sources' cameras: three keeps a target for transmission for each. */
  const cameras = [new THREE.PerspectiveCamera(), new THREE.PerspectiveCamera()];
  for (const camera of cameras) {
    camera.matrixAutoUpdate = camera.matrixWorldAutoUpdate = false;
    // Its matrix is not that of an angle.
    camera.updateProjectionMatrix = () => {};
  }
  /** What the other eye's holes may show. */
  const frustum = new THREE.Frustum();
  /** True if what is seen behind the source is drawn for each eye: the source's alpha says how much it covers. */
  let isCovering = false;
  /** True if something is seen through transmission. */
  let hasGlass = false;
  /** True if all opaque objects are tested by depth in the usual way. */
  let isTested = false;
  let isFoveated = false;

  /** True for what one eye alone sees. */
  const isOfOneEyeAlone = ({ layers }) => (layers.mask & cameras[0].layers.mask & ~EYE_LAYERS) === 0;

  /** True for what is drawn for each eye, after the synthesis. */
  const isLater = (object, kind) => kind === 'transparent' || isOfOneEyeAlone(object) || (object.layers.mask & stereo.bothEyes) !== 0
    // Widths and sizes in pixels are those of the eye's, unless they are seen through something.
    || (isFoveated && !hasGlass && (object.isLine || object.isPoints) === true);

  /**
   * Draws a part of the scene: changes three's list of what it draws, before it is sorted. Returns how much was left out.
   *
   * @param {(object: THREE.Object3D, kind: string, item: Object) => boolean} isWanted - Called with 'transmissive',
   * 'opaque' or 'transparent', in this order, and the list's item.
   * @param {THREE.Camera} camera
   * @param {() => void} before - Called once it is known what is drawn.
   */
  const drawPart = (scene, isWanted, camera, before) => {
    const list = renderer.renderLists.get(scene, 0);
    const { finish } = list;
    let left = 0;
    const finishPart = () => {
      for (const kind of ['transmissive', 'opaque', 'transparent']) {
        const items = list[kind];
        let kept = 0;
        for (const item of items) if (isWanted(item.object, kind, item)) items[kept++] = item;
        left += items.length - kept;
        items.length = kept;
      }
      before();
      finish();
    };
    having(list, { finish: finishPart }, () => renderer.render(scene, camera));
    return left;
  };

  /** Returns the camera of a source. */
  const look = (eye, views, index = 0) => {
    const camera = cameras[index];
    const { near, far, matrixWorld } = eye;
    Object.assign(camera, { near, far, _reversedDepth: hasReversedDepth });
    camera.matrixWorld.copy(matrixWorld).decompose(camera.position, camera.quaternion, camera.scale);
    camera.matrixWorldInverse.copy(matrixWorld).invert();
    project(camera.projectionMatrix.copy(eye.projectionMatrix), views.frustum);
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
    // What one eye alone sees is left out, but counted.
    camera.layers.mask = eye.layers.mask | EYE_LAYERS;
    return camera;
  };

  /**
   * Draws what moves with the synthesis into a target. Returns how many objects are `left`, what `isCovering` and
   * `hasGlass` are, and if holes can be drawn into (`canOpen`).
   *
   * @param {THREE.WebGLRenderTarget} target
   * @param {number[]} size - The target's, in pixels.
   * @param {THREE.Object3D} scene
   * @param {THREE.Camera} eye - The rendered one.
   * @param {Object} views - From `viewsOf`.
   * @param {number} [index=0] - 1 for the inset.
   */
  const draw = (target, size, scene, eye, views, index = 0) => {
    const camera = look(eye, views, index);
    target.setSize(...size);
    if (target.samples > 0 && renderer.properties?.get) renderer.properties.get(target).__useRenderToTexture = false;
    const { background, overrideMaterial } = scene;
    // The levels agree.
    const isFirst = index === 0;
    if (isFirst) {
      // A picture that fills the view fills an eye's, not the source's.
      isCovering = Boolean(background?.isTexture) && !background.isCubeTexture && background.mapping === THREE.UVMapping;
      hasGlass = false;
      isFoveated = Boolean(views.hides);
      isTested = !overrideMaterial && renderer.sortObjects;
    }
    const isWanted = (object, kind, { material }) => {
      if (isFirst && kind === 'transmissive') hasGlass = true;
      const isOpaque = kind === 'opaque', comesLater = isLater(object, kind);
      if (isFirst && isOpaque) {
        if (isOfOneEyeAlone(object)) isCovering = true;
        const { depthTest, depthWrite, depthFunc } = material;
        // A sky that writes no depth lies at the near plane if depth is reversed.
        isTested &&= comesLater || (depthTest && depthFunc === THREE.LessEqualDepth && (depthWrite || !hasReversedDepth));
      }
      return !comesLater && !(isOpaque && !hasGlass && views.hides?.(object));
    };
    const clear = () => {
      if (overrideMaterial) isCovering = false;
      if (!isCovering) return;
      scene.background = null;
      renderer.setClearColor(0, 0);
    };
    const viewport = asEyes(renderer, () => renderer.getViewport(new THREE.Vector4()), eye.viewport);
    const part = () => asSource(renderer, views, viewport, () => drawPart(scene, isWanted, camera, clear));
    const isOnCanvas = renderer.getRenderTarget() === null;
    const left = having(scene, { background }, () => restoring(renderer, () => {
      renderer.xr.enabled = false;
      // Shadows are those of the first source.
      if (!isFirst) renderer.shadowMap.autoUpdate = false;
      renderer.setRenderTarget(target);
      // In headsets, those versions forget the background, too, and what is drawn for both eyes fits to it.
      return isOnCanvas && target.isXRRenderTarget ? encoding.draw(scene, part) : part();
    }));
    return { left, isCovering, hasGlass, canOpen: isTested && !isCovering && !hasGlass };
  };

  /**
   * Draws both eyes, and over them what is left of the scene, in one pass. Opaque objects are drawn into open holes of the
   * other eye: elsewhere, depth is the nearest there until they are drawn.
   *
   * @param {Object} passes - From `createPasses`.
   * @param {THREE.Camera} shown - What three draws both eyes for.
   * @param {THREE.Camera} eye - The rendered one.
   * @param {number} left - How many objects are left.
   * @param {Object|null} target - The other eye's part that has open holes, as `viewsOf` names it; null without.
   */
  const show = ({ eyes, own, open }, scene, shown, { layers }, left, target) => {
    const { background, overrideMaterial } = scene;
    const isOpen = target !== null;
    const isAll = left === 0 && !isCovering && !isOpen;
    if (isAll || overrideMaterial) renderer.render(eyes, shown);
    if (isAll) return;
    if (isOpen) frustum.setFromProjectionMatrix(new THREE.Matrix4().copy(target.matrixWorld).invert().premultiply(target.projectionMatrix), undefined, hasReversedDepth);
    const masks = [];
    const mask = (of, value) => {
      masks.push([of, of.mask]);
      of.mask = value;
    };
    const isWanted = (object, kind, item) => {
      const isPicture = object.parent === eyes, isOpaque = kind === 'opaque';
      if (!isPicture && !isLater(object, kind)) return isOpen && isOpaque && (!object.frustumCulled || frustum.intersectsObject(object));
      // What one eye alone sees may be behind the pictures.
      if (isCovering && isOpaque && !isPicture && isOfOneEyeAlone(object)) item.groupOrder = item.renderOrder = -Infinity;
      if (isOpen) {
        // After all that holes show.
        if (isOpaque && object !== own && object !== open) item.groupOrder = isPicture ? Number.MAX_VALUE : Infinity;
        if (object.layers.test(layers)) mask(object.layers, object.layers.mask | SHOWN);
      }
      return true;
    };
    const hide = () => {
      if (!isOpen) return;
      mask(layers, SHOWN);
      // Mirrors draw the scene, too.
      eyes.visible = false;
    };
    if (!overrideMaterial) scene.children.unshift(eyes);
    try {
      having(scene, { background: isCovering || isOpen ? background : null }, () => restoring(renderer, () => {
        renderer.shadowMap.autoUpdate = false;
        if (overrideMaterial) renderer.autoClear = false;
        drawPart(scene, isWanted, shown, hide);
      }));
    } finally {
      for (const [of, value] of masks.reverse()) of.mask = value;
      eyes.visible = true;
      if (!overrideMaterial) scene.children.splice(scene.children.indexOf(eyes), 1);
    }
  };

  return { look, draw, show };
}
