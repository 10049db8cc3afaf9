import * as THREE from 'three';
import { asEyes } from './answers.js';
import { createChooser } from './choice.js';
import { createEncoding, encode } from './encoding.js';
import { createReadback, createTimer } from './gpu.js';
import { createHalves } from './halves.js';
import { levelName, levelsOf } from './levels.js';
import { createParts } from './parts.js';
import { createPasses } from './passes.js';
import { aside, having, restoring } from './state.js';
import { troubleOf } from './trouble.js';
import { isReversed, viewsOf } from './views.js';

/** Both eyes are rendered once this share of the view is too near, until less than the second share is. */
const NEAR_SHARES = [0.5, 0.35];
/** Frames between two looks at what is near: with synthesis, and without, where a look costs an eye's draw calls. */
const LOOKS = [12, 45];
/** From the best picture on: three's own two eyes; all that was asked for; with holes filled; without samples. */
const WAYS = ['rendered', 'synthesized', 'filled', 'aliased'];
const MIXED = 'what transmission shows differs between the eyes: layers 1 and 2, or a flat background';

const isOfOneEye = (camera) => camera?.isPerspectiveCamera && !camera.isArrayCamera;

/**
 * Renders a scene for one eye, and synthesizes the other eye from its colour and depth: side by side on a canvas, or for
 * both eyes of a WebXR session.
 *
 * ```js
 * const stereo = new StereoSynthesis(renderer);
 * renderer.setAnimationLoop(() => stereo.render(scene, camera));
 * ```
 */
export class StereoSynthesis {
  /** 'synthesized'; 'rendered' for three's own two eyes; 'auto' for the cheapest way, or with rendered holes the best one that
   * holds the display's rate. */
  mode = 'auto';
  /** The eye that is rendered: 'left' or 'right'. */
  dominantEye = 'right';
  /** What the rendered eye does not see: 'filled' with what lies beside it, or 'rendered': opaque objects that the other eye
   * sees are drawn once more. */
  holes = 'filled';
  /** Samples of the rendered eye's anti-aliasing: 4 if the renderer has `antialias: true`, otherwise 0. */
  samples;
  /** From this distance on, nothing is missing at the other eye's outer border. */
  guardBand = 1;
  /** With `auto`, both eyes are rendered while half of the view is nearer. */
  nearLimit = 0.4;
  /** How much fewer pixels there are where the eyes do not look: 'off', 'low', 'medium' or 'high'. Null: in a session as
   * `renderer.xr.getFoveation()` says, on a canvas 'off'. */
  foveation = null;
  /** Where the eyes look, as a direction in the world; null for straight ahead. */
  gaze = null;
  /** A mask of layers: objects on them are drawn for both eyes, after the synthesis, such as hands. */
  bothEyes = 0;
  /** How the last frame was made: 'synthesized' or 'rendered'. */
  way = null;
  /** Why both eyes had to be rendered in the last frame, in a sentence, or null. */
  trouble = null;

  #halves;
  #chooser = createChooser();
  #timer;
  /** Reads what is near. */
  #share;
  #encoding;
  #parts;
  #between = new THREE.Matrix4();
  /** What is made for the present kind of target. */
  #made = '';
  /** The targets of the source, or of the wide level and the inset, and that of the wide level's other eye. */
  #sources = [];
  #wideOther = null;
  #small = null;
  #passes = null;
  /** The passes of `synthesize`. */
  #given = null;
  #drawnTo;
  /** True if three collects frames in a buffer of linear colour (its `outputBufferType`). */
  #isBuffered = false;
  /** What the headset was asked for, and by whom. */
  #foveations = {};
  /** Frames until it is looked again whether what is behind everything can be synthesized. */
  #pause = 0;
  #isNear = false;
  #isBusy = false;
  #frames = 0;
  #shape = '';

  /**
   * @param {import('three').WebGLRenderer} renderer
   * @param {Object} [options] - `mode`, `dominantEye`, `holes`, `samples`, `guardBand`, `nearLimit`, `foveation`, and
   * `eyeSeparation`: the eyes' distance on a canvas, 0.064 by default. Headsets have their own.
   */
  constructor(renderer, { eyeSeparation = 0.064, ...options } = {}) {
    if (!renderer?.isWebGLRenderer) throw new TypeError('StereoSynthesis needs a WebGLRenderer; WebGPURenderer is not supported yet');
    this.renderer = renderer;
    for (const name in options) this[name] = options[name] ?? this[name];
    this.samples ??= this.#attributes.antialias ? 4 : 0;
    this.#halves = createHalves(renderer);
    /** Its `eyeSep` is the eyes' distance on a canvas, its `aspect` that of an eye relative to the camera's. */
    this.stereoCamera = this.#halves.stereoCamera;
    this.stereoCamera.eyeSep = eyeSeparation;
    this.#listen('addEventListener');
    this.#begin();
  }

  /** The last choice of `auto`: its way and reason and, if they could be compared, the costs of all ways in ms. */
  get choice() {
    return this.#chooser.choice;
  }

  /** Has `auto` measure again: for another scene, or another place in it. */
  sceneChanged() {
    this.#chooser.sceneChanged();
  }

  /**
   * Renders both eyes: call it in place of `renderer.render`.
   *
   * @param {import('three').Object3D} scene
   * @param {import('three').Camera} camera
   */
  render(scene, camera) {
    if (this.renderer.getContext().isContextLost()) return;
    if (scene.matrixWorldAutoUpdate) scene.updateMatrixWorld();
    if (camera.parent === null && camera.matrixWorldAutoUpdate) camera.updateMatrixWorld();
    this.#isBusy = true;
    try {
      // The scene is drawn in up to two parts, with the same matrices.
      having(scene, { matrixWorldAutoUpdate: false }, () => restoring(this.renderer, () => this.#frame(scene, camera)));
    } finally {
      this.#timer.end();
      this.#isBusy = false;
    }
  }

  /**
   * Has `renderer.render` render both eyes of what goes to the canvas or the headset: for frameworks with a loop of
   * their own. Returns a function that undoes it.
   */
  install() {
    const { renderer } = this;
    const { render } = renderer;
    const both = (scene, camera) => {
      const target = renderer.getRenderTarget();
      const isShown = target === null || target.isXRRenderTarget;
      if (this.#isBusy || !isShown || !isOfOneEye(camera)) render.call(renderer, scene, camera);
      else this.render(scene, camera);
    };
    renderer.render = both;
    return () => {
      if (renderer.render === both) renderer.render = render;
    };
  }

  /**
   * Returns both eyes' cameras, with viewports: those of the headset, or the halves of canvas or render target.
   *
   * @param {import('three').Camera} camera - The user's, whose world matrix is up to date.
   * @return {import('three').ArrayCamera}
   */
  eyes(camera) {
    const { xr } = this.renderer;
    if (!this.#isPresenting) return this.#halves.of(camera);
    if (xr.cameraAutoUpdate) xr.updateCamera(camera);
    return xr.getCamera();
  }

  /**
   * Returns the view to render for `synthesize`: a camera that sees a little more than the rendered eye, and the size
   * of its image in pixels. Returns null if the other eye cannot be synthesized; then `trouble` says why.
   *
   * @param {import('three').ArrayCamera} eyes - From `eyes`.
   */
  view(eyes) {
    const views = this.#find(eyes);
    return views && { camera: this.#parts.look(eyes.cameras[this.#rendered], views), width: views.size[0], height: views.size[1] };
  }

  /**
   * Draws both eyes from textures of the view that `view` has named: for pictures with effects of their own. Colours are
   * drawn as they are. Returns false if the other eye cannot be synthesized; then nothing is drawn.
   *
   * @param {{color: import('three').Texture, depth: import('three').DepthTexture, samples?: number}} source - Textures
   * of the view's size. With samples, depth was resolved from them.
   * @param {import('three').ArrayCamera} eyes - From `eyes`.
   * @param {import('three').WebGLRenderTarget|null} [target] - Where to draw; the canvas by default.
   */
  synthesize({ color, depth, samples = 0 }, eyes, target = null) {
    const { renderer } = this;
    const views = this.#find(eyes);
    if (!views) return false;
    const passes = this.#given ??= createPasses(renderer, false);
    passes.choose(this.#rendered);
    aside(renderer, () => passes.prepare(views, { texture: color, depthTexture: depth, samples }));
    restoring(renderer, () => {
      renderer.xr.enabled = false;
      renderer.setRenderTarget(target);
      renderer.render(passes.eyes, eyes);
    });
    return true;
  }

  /** Frees what this has on the GPU. */
  dispose() {
    this.#listen('removeEventListener');
    this.#free();
  }

  get #isPresenting() {
    const { xr } = this.renderer;
    return xr.enabled && xr.isPresenting;
  }

  /** The index of the rendered eye. */
  get #rendered() {
    return this.dominantEye === 'left' ? 0 : 1;
  }

  /** What `viewsOf` is told of the renderer. */
  get #limits() {
    return [isReversed(this.renderer), this.renderer.capabilities.maxTextureSize, this.#between];
  }

  get #attributes() {
    return this.renderer.getContext().getContextAttributes() ?? {};
  }

  #listen(change) {
    const { domElement } = this.renderer;
    // Objects of a lost context are freed while it is lost.
    domElement[change]?.('webglcontextlost', this.#free);
    domElement[change]?.('webglcontextrestored', this.#begin);
  }

  #free = () => {
    for (const reader of [this.#timer, this.#share, this.#encoding]) reader.dispose();
    this.#release();
    this.#given?.dispose();
    this.#given = null;
  };

  /** Begins with a new context, or one that was restored. */
  #begin = () => {
    const gl = this.renderer.getContext();
    this.#timer = createTimer(gl);
    this.#share = createReadback(gl);
    this.#encoding = createEncoding(this.renderer);
    this.#parts = createParts(this, this.#encoding);
    this.#isNear = false;
    this.#chooser.sceneChanged();
  };

  #frame(scene, camera) {
    const { renderer } = this;
    const { info } = renderer;
    const isPresenting = this.#isPresenting;
    const isAuto = this.mode === 'auto';
    const chooser = this.#chooser;
    if (!isPresenting && !isOfOneEye(camera)) {
      this.way = 'rendered';
      this.trouble = 'the camera has no perspective, or several';
      renderer.render(scene, camera);
      return;
    }
    if (isAuto) this.#timer.begin();
    const eyes = this.eyes(camera);
    const shown = isPresenting ? camera : eyes;
    this.trouble = null;
    const views = this.mode === 'rendered' ? null : this.#findLevels(eyes);
    if (isAuto && views) this.#watch(`${views.map(({ size }) => size)} ${isPresenting} ${this.#ways}`);
    // One of the ways of `auto`, or all that was asked for.
    const way = isAuto ? chooser.way : WAYS[1];
    if (views && !(isAuto && this.#isNear) && way !== WAYS[0]) {
      this.way = WAYS[1];
      // The figures of a frame are those of all its passes.
      if (info.autoReset) info.reset();
      having(info, { autoReset: false }, () => this.#synthesize(scene, eyes, shown, views, way));
    } else {
      if (isAuto && views && this.#isNear) this.#lookNear(scene, eyes, views[0]);
      this.#render(scene, shown);
    }
    if (!isAuto) return;
    this.#timer.end();
    const refresh = isPresenting ? renderer.xr.getSession()?.frameRate ?? 0 : 0;
    const isCounted = views && !this.#isNear && this.trouble === null;
    chooser.endFrame(performance.now(), refresh, isCounted ? way : null, this.#timer.take());
  }

  /** Follows the picture's size, and what is near. */
  #watch(shape) {
    if (this.#shape !== shape) this.#chooser.sceneChanged(this.#ways, this.holes === 'rendered');
    this.#shape = shape;
    this.#frames++;
    const bytes = this.#share.take();
    if (!bytes) return;
    let sum = 0;
    for (const byte of bytes) sum += byte;
    // All four channels are the share.
    this.#isNear = sum / (255 * bytes.length) >= NEAR_SHARES[Number(this.#isNear)];
  }

  /** Draws three's own two eyes. */
  #render(scene, shown) {
    this.way = 'rendered';
    asEyes(this.renderer, () => this.renderer.render(scene, shown));
  }

  #synthesize(scene, eyes, shown, views, way) {
    const { renderer } = this;
    const target = renderer.getRenderTarget();
    const own = eyes.cameras[this.#rendered], parts = this.#parts, isFoveated = views.length > 1;
    let isDone = false;
    while (!isDone) {
      this.#allocate(target, isFoveated, way === WAYS[3] ? 0 : this.samples);
      const passes = this.#passes, sources = this.#sources;
      const [{ left, isCovering, hasGlass, canOpen }] = views.map((each, i) => parts.draw(sources[i], each.size, scene, own, each, i));
      if (isCovering && hasGlass) {
        this.trouble = MIXED;
        this.#pause = LOOKS[1];
        return this.#render(scene, shown);
      }
      const isOpen = this.holes === 'rendered' && way === WAYS[1] && canOpen;
      passes.choose(this.#rendered, isCovering, isOpen);
      aside(renderer, () => {
        [passes.wide ?? passes, passes].slice(0, views.length).forEach((each, i) => each.prepare(views[i], sources[i]));
        if (this.mode === 'auto' && this.#frames % LOOKS[0] === 0) this.#count(views[0]);
        if (!isFoveated) return;
        this.#wideOther.setSize(...views[0].uniforms.target_size);
        passes.wide.drawOther(this.#wideOther);
        passes.compose(views[1], this.#rendered, this.#wideOther);
      });
      asEyes(renderer, () => parts.show(passes, scene, shown, own, left, isOpen ? views.at(-1).target : null));
      // Whether three collects frames is known once a picture is drawn, which is then drawn again.
      isDone = this.#isBuffered || this.#drawnTo === target;
      this.#isBuffered ||= !isDone;
    }
  }

  /** Returns what to render for each level, or null; then `trouble` says why. */
  #findLevels(eyes) {
    const { renderer } = this;
    const views = this.#find(eyes);
    if (!views) return null;
    if (this.#pause > 0) {
      this.#pause--;
      this.trouble = MIXED;
      return null;
    }
    const name = levelName(this.foveation, this.#isPresenting ? renderer.xr : null, this.#foveations);
    return levelsOf(eyes.cameras, this.#rendered, name, this.gaze, this.guardBand, ...this.#limits) ?? [views];
  }

  /** Returns what to render with all pixels, or null; then `trouble` says why. */
  #find(eyes) {
    const { renderer } = this;
    const { cameras } = eyes;
    const views = troubleOf(renderer, cameras, this.#isPresenting, this.#isLinear(renderer.getRenderTarget()))
      ?? viewsOf(cameras, this.#rendered, this.guardBand, ...this.#limits);
    this.trouble = typeof views === 'string' ? views : null;
    return this.trouble === null ? views : null;
  }

  /** True if colour must stay linear until it is drawn into a target. */
  #isLinear(target) {
    return this.#isBuffered || (target === null ? this.#encoding.isMissing : !target.isXRRenderTarget);
  }

  /** The ways of `auto`, the best one first. */
  get #ways() {
    return WAYS.filter((_, i) => (i !== 2 || this.holes === 'rendered') && (i !== 3 || (this.samples > 0 && this.#isTiled)));
  }

  /** True where three resolves samples in the tile, which loses depth: those of the source go through memory. */
  get #isTiled() {
    return this.renderer.extensions.has('WEBGL_multisampled_render_to_texture');
  }

  /** Makes the sources' targets and the passes for a kind of target, unless they are there. */
  #allocate(target, isFoveated, samples) {
    const { renderer } = this;
    aside(renderer, () => this.#encoding.find());
    const isLinear = this.#isLinear(target);
    const made = `${isLinear} ${isFoveated}`;
    if (this.#made !== made) {
      this.#release();
      this.#made = made;
      this.#sources = (isFoveated ? [0, 1] : [0]).map(() => this.#target(isLinear));
      if (isFoveated) this.#wideOther = this.#target(isLinear);
      this.#passes = createPasses(renderer, isLinear, isFoveated ? createPasses(renderer, false) : null);
      this.#passes.own.onBeforeRender = () => {
        this.#drawnTo = renderer.getRenderTarget();
      };
    }
    if (this.#isTiled && !renderer.properties?.get) samples = 0;
    for (const source of this.#sources) {
      if (!isLinear) source.texture.colorSpace = renderer.outputColorSpace;
      if (source.samples !== samples) source.dispose();
      source.samples = samples;
    }
  }

  #target(isLinear) {
    const stencilBuffer = this.#attributes.stencil;
    const depthTexture = new THREE.DepthTexture(1, 1, isReversed(this.renderer) ? THREE.FloatType : undefined);
    if (stencilBuffer) Object.assign(depthTexture, { format: THREE.DepthStencilFormat, type: THREE.UnsignedInt248Type });
    const target = new THREE.WebGLRenderTarget(1, 1, { stencilBuffer, depthTexture, ...(isLinear && { type: THREE.HalfFloatType }) });
    if (!isLinear) encode(target, this.renderer);
    return target;
  }

  #release() {
    for (const each of [...this.#sources, this.#wideOther, this.#small, this.#passes]) each?.dispose();
    this.#sources = [];
    this.#wideOther = this.#small = this.#passes = null;
    this.#made = '';
  }

  /** Looks at what is near, to be known some frames later. */
  #count(views, source) {
    if (this.#share.isWaiting) return;
    (this.#passes.wide ?? this.#passes).drawNear(views, this.nearLimit, source);
    this.#share.begin(64);
  }

  /** While both eyes are rendered because much is near: looks whether it still is, in a small picture. */
  #lookNear(scene, eyes, views) {
    if (this.#frames % LOOKS[1] !== 0 || !this.#passes) return;
    const small = this.#small ??= this.#target(false);
    this.#parts.draw(small, [64, 64], scene, eyes.cameras[this.#rendered], views);
    aside(this.renderer, () => this.#count(views, small));
  }
}
