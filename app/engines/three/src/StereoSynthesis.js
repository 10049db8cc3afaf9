import {
  ArrayCamera, Color, DepthStencilFormat, DepthTexture, FloatType, HalfFloatType, LinearFilter, Matrix4, PerspectiveCamera,
  StereoCamera, UnsignedByteType, UnsignedInt248Type, UnsignedIntType, UVMapping, Vector2, Vector4, WebGLRenderTarget,
} from 'three';
import { asEyes, asSource } from './answers.js';
import { Chooser } from './choice.js';
import { encode, Encoding } from './encoding.js';
import { Readback, Timer } from './gpu.js';
import { levelName, levelsOf } from './levels.js';
import { drawPart } from './part.js';
import { Passes } from './passes.js';
import { troubleOf } from './trouble.js';
import { project, viewsOf } from './views.js';

/** The layers that three reserves for what one eye alone sees: 1 for the left eye, 2 for the right one. */
const EYE_LAYERS = 0b110;
/** Both eyes are rendered once this share of the view is too near, until less than the second share is. */
const NEAR_SHARES = [0.5, 0.35];
/** Frames between two looks at what is near: with synthesis, and without, where a look costs an eye's draw calls. */
const LOOKS = [12, 45];
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
  #stencil;
  #chooser = new Chooser();
  #timer;
  /** Reads what is near. */
  #share;
  /** The sources' cameras: three keeps a target for transmission for each. */
  #cameras = [new PerspectiveCamera(), new PerspectiveCamera()];
  /** The eyes on a canvas. */
  #pair;
  #size = new Vector2();
  #viewports = [0, 1, 2].map(() => new Vector4());
  #between = new Matrix4();
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
  #encoding;
  /** True if three collects frames in a buffer of linear colour (its `outputBufferType`). */
  #isBuffered = false;
  #byLists = true;
  /** True if what is seen behind the source is drawn for each eye: the source's alpha says how much it covers. */
  #isCovering = false;
  #isFoveated = false;
  /** True if something is seen through transmission. */
  #hasGlass = false;
  /** Frames until it is looked again whether what is behind everything can be synthesized. */
  #pause = 0;
  #isNear = false;
  #isBusy = false;
  #frames = 0;
  #shape = '';

  /**
   * @param {import('three').WebGLRenderer} renderer
   * @param {Object} [options]
   * @param {'auto'|'synthesized'|'rendered'} [options.mode='auto'] - See `mode`.
   * @param {'left'|'right'} [options.dominantEye='right'] - The eye that is rendered.
   * @param {number} [options.samples] - Samples of the rendered eye's anti-aliasing. Default: 4 if the renderer has
   * `antialias: true`, otherwise 0.
   * @param {number} [options.guardBand=1] - From this distance on, nothing is missing at the other eye's outer border.
   * @param {number} [options.nearLimit=0.4] - With `auto`, both eyes are rendered while half of the view is nearer.
   * @param {'off'|'low'|'medium'|'high'|null} [options.foveation=null] - See `foveation`.
   * @param {number} [options.eyeSeparation=0.064] - The eyes' distance on a canvas. Headsets have their own.
   */
  constructor(renderer, { mode = 'auto', dominantEye = 'right', samples, guardBand = 1, nearLimit = 0.4, foveation = null, eyeSeparation = 0.064 } = {}) {
    if (!renderer?.isWebGLRenderer) throw new TypeError('StereoSynthesis needs a WebGLRenderer; WebGPURenderer is not supported yet');
    const { antialias, stencil } = renderer.getContext().getContextAttributes() ?? {};
    this.renderer = renderer;
    /** 'synthesized'; 'rendered' for three's own two eyes; 'auto' for the cheaper of both. */
    this.mode = mode;
    this.dominantEye = dominantEye;
    this.samples = samples ?? (antialias ? 4 : 0);
    this.guardBand = guardBand;
    this.nearLimit = nearLimit;
    /** How much fewer pixels there are where the eyes do not look: 'off', 'low', 'medium' or 'high'. Null: in a session as
     * `renderer.xr.getFoveation()` says, on a canvas 'off'. */
    this.foveation = foveation;
    /** Where the eyes look, as a direction in the world; null for straight ahead. */
    this.gaze = null;
    /** A mask of layers: objects on them are drawn for both eyes, after the synthesis, such as hands. */
    this.bothEyes = 0;
    /** How the last frame was made: 'synthesized' or 'rendered'. */
    this.way = null;
    /** Why both eyes had to be rendered in the last frame, in a sentence, or null. */
    this.trouble = null;
    /** Its `eyeSep` is the eyes' distance on a canvas, its `aspect` that of an eye relative to the camera's. */
    this.stereoCamera = new StereoCamera();
    this.stereoCamera.aspect = 0.5;
    this.stereoCamera.eyeSep = eyeSeparation;

    this.#stencil = stencil;
    const { cameraL, cameraR } = this.stereoCamera;
    this.#pair = new ArrayCamera([cameraL, cameraR]);
    for (const eye of [cameraL, cameraR]) eye.viewport = new Vector4();
    for (const camera of [this.#pair, ...this.#cameras]) camera.matrixAutoUpdate = camera.matrixWorldAutoUpdate = false;
    // Their matrices are not those of an angle.
    for (const camera of this.#cameras) camera.updateProjectionMatrix = () => {};
    this.#listen('addEventListener');
    this.#begin();
  }

  /** The last choice of `auto`: its way and reason and, if they could be compared, the costs of both ways in ms. */
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
    const { matrixWorldAutoUpdate } = scene;
    if (matrixWorldAutoUpdate) scene.updateMatrixWorld();
    if (camera.parent === null && camera.matrixWorldAutoUpdate) camera.updateMatrixWorld();
    // The scene is drawn in up to two parts, with the same matrices.
    scene.matrixWorldAutoUpdate = false;
    this.#isBusy = true;
    try {
      this.#restoring(() => this.#frame(scene, camera));
    } finally {
      this.#timer.end();
      this.#isBusy = false;
      scene.matrixWorldAutoUpdate = matrixWorldAutoUpdate;
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
    if (!this.#isPresenting) return this.#halves(camera);
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
    return views && { camera: this.#look(eyes, views, 0), width: views.size[0], height: views.size[1] };
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
    const passes = this.#given ??= new Passes(renderer, false);
    this.#assign(passes);
    this.#restoring(() => {
      this.#aside(() => passes.prepare(views, color, depth, samples > 0));
      renderer.setRenderTarget(target);
      this.#once(() => {
        renderer.xr.enabled = false;
        renderer.render(passes.eyes, eyes);
      });
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

  get #isReversed() {
    return Boolean(this.renderer.capabilities.reversedDepthBuffer);
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
    this.#timer = new Timer(gl);
    this.#share = new Readback(gl);
    this.#encoding = new Encoding(this.renderer);
    this.#isNear = false;
    this.#chooser.sceneChanged();
  };

  /** Draws, and restores what the renderer draws to: three itself leaves its viewport on the right eye's half. */
  #restoring(draw) {
    const { renderer } = this;
    const [viewport, current, now] = this.#viewports;
    renderer.getViewport(viewport);
    renderer.getCurrentViewport(current);
    const target = [renderer.getRenderTarget(), renderer.getActiveCubeFace(), renderer.getActiveMipmapLevel()];
    try {
      draw();
    } finally {
      renderer.setRenderTarget(...target);
      // That of a render target may have been set by `setViewport`, too.
      if (!renderer.getCurrentViewport(now).equals(current)) renderer.setViewport(viewport);
    }
  }

  /** Draws, and restores what the user has set. */
  #once(draw) {
    const { renderer } = this;
    const { xr, shadowMap, autoClear } = renderer;
    const { enabled } = xr;
    const { autoUpdate } = shadowMap;
    try {
      return draw();
    } finally {
      xr.enabled = enabled;
      renderer.autoClear = autoClear;
      shadowMap.autoUpdate = autoUpdate;
    }
  }

  /** Draws into targets of ours that need not be cleared. */
  #aside(draw) {
    const { renderer } = this;
    const target = renderer.getRenderTarget();
    this.#once(() => {
      renderer.xr.enabled = renderer.autoClear = false;
      draw();
    });
    renderer.setRenderTarget(target);
  }

  #frame(scene, camera) {
    const { renderer } = this;
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
    if (isAuto && views) this.#watch(`${views.map(({ size }) => size)} ${isPresenting}`);
    if (views && !(isAuto && (this.#isNear || chooser.way === 'rendered'))) {
      this.way = 'synthesized';
      this.#synthesize(scene, eyes, shown, views);
    } else {
      if (isAuto && views && this.#isNear) this.#lookNear(scene, eyes, views[0]);
      this.#render(scene, shown);
    }
    if (!isAuto) return;
    this.#timer.end();
    const refresh = isPresenting ? renderer.xr.getSession()?.frameRate ?? 0 : 0;
    chooser.endFrame(performance.now(), refresh, views && !this.#isNear && this.trouble === null ? this.way : null, this.#timer.take());
  }

  /** Follows the picture's size, and what is near. */
  #watch(shape) {
    if (this.#shape !== shape) this.#chooser.sceneChanged();
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

  #synthesize(scene, eyes, shown, views) {
    const { renderer } = this;
    const { info } = renderer;
    const { autoReset } = info;
    const target = renderer.getRenderTarget();
    // The figures of a frame are those of all its passes.
    if (autoReset) info.reset();
    info.autoReset = false;
    try {
      let isDone = false;
      while (!isDone) {
        this.#allocate(target);
        const passes = this.#passes, sources = this.#sources;
        const [left] = views.map((each, i) => this.#draw(sources[i], each.size, scene, eyes, each, i));
        if (this.trouble !== null) return this.#render(scene, shown);
        this.#aside(() => {
          const levels = this.#isFoveated ? [passes.wide, passes] : [passes];
          levels.forEach((each, i) => {
            const { texture, depthTexture, samples } = sources[i];
            each.prepare(views[i], texture, depthTexture, samples > 0);
          });
          if (this.mode === 'auto' && this.#frames % LOOKS[0] === 0) this.#count(views[0]);
          if (!this.#isFoveated) return;
          this.#wideOther.setSize(...views[0].uniforms.target_size);
          passes.wide.drawOther(this.#wideOther);
          passes.compose(views[1], this.#rendered, this.#wideOther);
        });
        this.#assign(passes);
        passes.isCovering = this.#isCovering;
        asEyes(renderer, () => this.#show(scene, shown, left));
        // Whether three collects frames is known once a picture is drawn, which is then drawn again.
        isDone = this.#isBuffered || this.#drawnTo === target;
        this.#isBuffered ||= !isDone;
      }
    } finally {
      info.autoReset = autoReset;
    }
  }

  /** The eyes on the halves of the canvas or render target. */
  #halves(camera) {
    const { renderer, stereoCamera } = this;
    const pair = this.#pair, size = this.#size;
    const target = renderer.getRenderTarget();
    if (target) size.set(target.width, target.height);
    else renderer.getDrawingBufferSize(size);
    const half = Math.floor(size.x / 2);
    if (this.#isReversed) {
      // The renderer would do this later, and change the eyes' matrices.
      if (!camera.reversedDepth) {
        camera._reversedDepth = true;
        camera.updateProjectionMatrix();
      }
      for (const each of [pair, ...pair.cameras]) each._reversedDepth = true;
    }
    stereoCamera.update(camera);
    for (const each of [pair, ...pair.cameras]) {
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
      eye.viewport.set(i * half, 0, half, size.y);
      eye.layers.mask = pair.layers.mask & ~(0b100 >> i);
    });
    return pair;
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
    const name = levelName(this.foveation, this.#isPresenting ? renderer.xr : null);
    const levels = levelsOf(eyes.cameras, this.#rendered, name, this.gaze, this.guardBand, this.#isReversed, renderer.capabilities.maxTextureSize, this.#between);
    this.#isFoveated = levels !== null;
    return levels ?? [views];
  }

  /** Returns what to render with all pixels, or null; then `trouble` says why. */
  #find(eyes) {
    const { renderer } = this;
    const { cameras } = eyes;
    const views = troubleOf(renderer, cameras, this.#isPresenting, this.#isLinear(renderer.getRenderTarget()))
      ?? viewsOf(cameras, this.#rendered, this.guardBand, this.#isReversed, renderer.capabilities.maxTextureSize, this.#between);
    this.trouble = typeof views === 'string' ? views : null;
    return this.trouble === null ? views : null;
  }

  /** True if colour must stay linear until it is drawn into a target. */
  #isLinear(target) {
    return this.#isBuffered || (target === null ? this.#encoding.isMissing : !target.isXRRenderTarget);
  }

  /** Makes the source's target and the passes for a kind of target, unless they are there. */
  #allocate(target) {
    const { renderer } = this;
    this.#aside(() => this.#encoding.find());
    const isLinear = this.#isLinear(target);
    // Where three resolves samples in the tile, depth is lost.
    const isLost = renderer.extensions.has('WEBGL_multisampled_render_to_texture') && !renderer.properties?.get;
    const samples = isLost ? 0 : this.samples, isFoveated = this.#isFoveated;
    const made = `${isLinear} ${samples} ${isFoveated}`;
    if (this.#made !== made) {
      this.#release();
      this.#made = made;
      this.#sources = (isFoveated ? [0, 1] : [0]).map(() => this.#target(isLinear, samples));
      if (isFoveated) this.#wideOther = this.#target(isLinear, 0);
      this.#passes = new Passes(renderer, isLinear, isFoveated ? new Passes(renderer, false) : null);
      this.#passes.own.onBeforeRender = () => {
        this.#drawnTo = renderer.getRenderTarget();
      };
    }
    if (!isLinear) for (const { texture } of this.#sources) texture.colorSpace = renderer.outputColorSpace;
  }

  #target(isLinear, samples) {
    const target = new WebGLRenderTarget(1, 1, {
      samples, type: isLinear ? HalfFloatType : UnsignedByteType, minFilter: LinearFilter, magFilter: LinearFilter,
      generateMipmaps: false, stencilBuffer: this.#stencil,
    });
    target.depthTexture = new DepthTexture(1, 1, this.#isReversed ? FloatType : UnsignedIntType);
    if (this.#stencil) Object.assign(target.depthTexture, { format: DepthStencilFormat, type: UnsignedInt248Type });
    if (!isLinear) encode(target, this.renderer);
    return target;
  }

  #release() {
    for (const target of [...this.#sources, this.#wideOther, this.#small]) {
      target?.depthTexture.dispose();
      target?.dispose();
    }
    this.#passes?.dispose();
    this.#sources = [];
    this.#wideOther = this.#small = this.#passes = null;
    this.#made = '';
  }

  /** Returns the camera of a source. */
  #look(eyes, { frustum }, index) {
    const eye = eyes.cameras[this.#rendered], camera = this.#cameras[index];
    camera.near = eye.near;
    camera.far = eye.far;
    camera.matrixWorld.copy(eye.matrixWorld).decompose(camera.position, camera.quaternion, camera.scale);
    camera.matrixWorldInverse.copy(eye.matrixWorld).invert();
    camera.projectionMatrix.copy(eye.projectionMatrix);
    project(camera.projectionMatrix, frustum);
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
    camera._reversedDepth = this.#isReversed;
    // What one eye alone sees is left out, but counted.
    camera.layers.mask = eye.layers.mask | EYE_LAYERS;
    return camera;
  }

  /** True for what one eye alone sees. */
  #isOfOneEyeAlone({ layers }) {
    return (layers.mask & this.#cameras[0].layers.mask & ~EYE_LAYERS) === 0;
  }

  /** True for what is drawn for each eye, after the synthesis. */
  #isLater(object, kind) {
    if (kind === 'transparent' || this.#isOfOneEyeAlone(object) || (object.layers.mask & this.bothEyes) !== 0) return true;
    // Widths and sizes in pixels are those of the eye's, unless they are seen through something.
    return this.#isFoveated && !this.#hasGlass && (object.isLine || object.isPoints) === true;
  }

  /** Draws what moves with the synthesis into a target. Returns how many objects are left. */
  #draw(target, size, scene, eyes, views, index = 0) {
    const { renderer } = this;
    const before = renderer.getRenderTarget();
    const camera = this.#look(eyes, views, index);
    target.setSize(...size);
    if (target.samples > 0 && renderer.properties?.get) renderer.properties.get(target).__useRenderToTexture = false;
    const { background, overrideMaterial } = scene;
    // A picture that fills the view fills an eye's, not the source's.
    const isPlane = background?.isTexture && !background.isCubeTexture && background.mapping === UVMapping;
    // The levels agree.
    let isCovering = index > 0 ? this.#isCovering : isPlane;
    if (index === 0) this.#hasGlass = false;
    const isWanted = (object, kind, item) => {
      if (kind === 'opaque' && item && index === 0 && this.#isOfOneEyeAlone(object)) isCovering = true;
      if (kind === 'transmissive' && index === 0) this.#hasGlass = true;
      return !this.#isLater(object, kind) && !(kind === 'opaque' && !this.#hasGlass && views.hides?.(object));
    };
    const color = renderer.getClearColor(new Color()), alpha = renderer.getClearAlpha();
    const clear = () => {
      this.#isCovering = Boolean(isCovering && !overrideMaterial);
      if (!this.#isCovering) return;
      if (this.#hasGlass) {
        this.trouble = MIXED;
        this.#pause = LOOKS[1];
      }
      scene.background = null;
      renderer.setClearColor(0, 0);
    };
    const { viewport } = eyes.cameras[this.#rendered];
    const eye = asEyes(renderer, () => renderer.getViewport(new Vector4()), viewport);
    const part = () => asSource(renderer, views, eye, () => {
      try {
        return this.#part(scene, isWanted, camera, clear);
      } finally {
        scene.background = background;
        renderer.setClearColor(color, alpha);
      }
    });
    const left = this.#once(() => {
      renderer.xr.enabled = false;
      // Shadows are those of the first source.
      if (index > 0) renderer.shadowMap.autoUpdate = false;
      renderer.setRenderTarget(target);
      // In headsets, those versions forget the background, too, and what is drawn for both eyes fits to it.
      return before === null && target.isXRRenderTarget ? this.#encoding.draw(scene, part) : part();
    });
    renderer.setRenderTarget(before);
    return left;
  }

  /** Draws a part of the scene. Its list is not a public promise of three's; without it, layers hide objects. */
  #part(scene, isWanted, camera, before) {
    const { renderer } = this;
    const list = this.#byLists ? renderer.renderLists?.get?.(scene, 0) : null;
    const left = drawPart(list?.finish ? list : null, scene, isWanted, () => renderer.render(scene, camera), before);
    if (left < 0) this.#byLists = false;
    return left;
  }

  /** Counts how much is near, to be known some frames later. */
  #count(views, size, depth) {
    if (this.#share.isWaiting) return;
    (this.#passes.wide ?? this.#passes).drawNear(views, (1 / this.nearLimit - views.constant) / views.slope, size, depth);
    this.#share.begin(16);
  }

  /** While both eyes are rendered because much is near: looks whether it still is, in a small picture. */
  #lookNear(scene, eyes, views) {
    if (this.#frames % LOOKS[1] !== 0 || !this.#passes) return;
    const small = this.#small ??= this.#target(false, 0), size = [64, 64];
    this.#draw(small, size, scene, eyes, views);
    this.#aside(() => this.#count(views, size, small.depthTexture));
  }

  /** Gives each eye its picture, by three's layers of one eye. */
  #assign({ own, other }) {
    own.layers.set(1 + this.#rendered);
    other.layers.set(2 - this.#rendered);
  }

  /** Draws both eyes, and over them what is left of the scene, in one pass. */
  #show(scene, shown, left) {
    const { renderer } = this;
    const { eyes, own, other } = this.#passes;
    const { background, overrideMaterial } = scene;
    const isCovering = this.#isCovering;
    const isAll = left === 0 && !isCovering;
    if (isAll || overrideMaterial) renderer.render(eyes, shown);
    if (isAll) return;
    const isWanted = (object, kind, item) => {
      const isPicture = object === own || object === other;
      // What one eye alone sees may be behind the pictures.
      if (isCovering && item && kind === 'opaque' && !isPicture && this.#isOfOneEyeAlone(object)) item.groupOrder = item.renderOrder = -Infinity;
      return isPicture || this.#isLater(object, kind);
    };
    if (!isCovering) scene.background = null;
    if (!overrideMaterial) scene.children.unshift(eyes);
    try {
      this.#once(() => {
        renderer.shadowMap.autoUpdate = false;
        if (overrideMaterial) renderer.autoClear = false;
        this.#part(scene, isWanted, shown);
      });
    } finally {
      if (!overrideMaterial) scene.children.splice(scene.children.indexOf(eyes), 1);
      scene.background = background;
    }
  }
}
