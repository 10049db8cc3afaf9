import {
  ArrayCamera, Color, DepthStencilFormat, DepthTexture, FloatType, HalfFloatType, LinearFilter, Matrix4, Mesh,
  MeshBasicMaterial, NearestFilter, OrthographicCamera, PerspectiveCamera, PlaneGeometry, StereoCamera, UnsignedByteType,
  UnsignedInt248Type, UnsignedIntType, Vector2, Vector4, WebGLRenderTarget,
} from 'three';
import { Chooser } from './choice.js';
import { Readback, Timer } from './gpu.js';
import { drawPart } from './part.js';
import { Passes } from './passes.js';
import { project, viewsOf } from './views.js';

/** The layers that three reserves for what one eye alone sees: 1 for the left eye, 2 for the right one. */
const EYE_LAYERS = 0b110;
/** Both eyes are rendered once this share of the view is too near, until less than the second share is. */
const NEAR_SHARES = [0.5, 0.35];
/** Frames between two looks at what is near. Without synthesis, a look costs the draw calls of an eye. */
const LOOKS = { synthesized: 12, rendered: 45 };

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
  /**
   * @param {import('three').WebGLRenderer} renderer
   * @param {Object} [options]
   * @param {'auto'|'synthesized'|'rendered'} [options.mode='auto'] - See `mode`.
   * @param {'left'|'right'} [options.dominantEye='right'] - The eye that is rendered.
   * @param {number} [options.samples] - Samples of the rendered eye's anti-aliasing. Default: 4 if the renderer has
   * `antialias: true`, otherwise 0.
   * @param {number} [options.guardBand=1] - From this distance on, nothing is missing at the other eye's outer border.
   * @param {number} [options.nearLimit=0.4] - With `auto`, both eyes are rendered while half of the view is nearer.
   * @param {number} [options.eyeSeparation=0.064] - The eyes' distance on a canvas. Headsets have their own.
   */
  constructor(renderer, options = {}) {
    if (!renderer?.isWebGLRenderer) throw new TypeError('StereoSynthesis needs a WebGLRenderer: WebGPURenderer is not supported yet.');
    const gl = renderer.getContext(), attributes = gl.getContextAttributes() ?? {};
    this.renderer = renderer;
    /** 'synthesized'; 'rendered' for three's own two eyes; 'auto' for the cheaper of both. */
    this.mode = options.mode ?? 'auto';
    this.dominantEye = options.dominantEye ?? 'right';
    this.samples = options.samples ?? (attributes.antialias ? 4 : 0);
    this.guardBand = options.guardBand ?? 1;
    this.nearLimit = options.nearLimit ?? 0.4;
    /** A mask of layers: objects on them are drawn for both eyes, after the synthesis, such as hands. */
    this.bothEyes = 0;
    /** How the last frame was made: 'synthesized' or 'rendered'. */
    this.way = null;
    /** Why both eyes had to be rendered in the last frame, in a sentence, or null. */
    this.trouble = null;
    /** Its `eyeSep` is the eyes' distance on a canvas, its `aspect` that of an eye to the camera's. */
    this.stereoCamera = new StereoCamera();
    this.stereoCamera.aspect = 0.5;
    this.stereoCamera.eyeSep = options.eyeSeparation ?? 0.064;
    this.chooser = new Chooser();

    this._stencil = Boolean(attributes.stencil);
    this._timer = new Timer(gl);
    this._share = new Readback(gl);
    this._code = new Readback(gl);
    this._camera = new PerspectiveCamera();
    this._camera.matrixAutoUpdate = this._camera.matrixWorldAutoUpdate = false;
    // Its matrices are not those of an angle.
    this._camera.updateProjectionMatrix = () => {};
    this._pair = new ArrayCamera([this.stereoCamera.cameraL, this.stereoCamera.cameraR]);
    this._pair.matrixAutoUpdate = this._pair.matrixWorldAutoUpdate = false;
    for (const eye of this._pair.cameras) eye.viewport = new Vector4();
    this._size = new Vector2();
    this._between = new Matrix4();
    this._restored = () => this._forget();
    renderer.domElement.addEventListener?.('webglcontextrestored', this._restored);
    this._forget();
  }

  /** The last choice of `auto`: its way and reason and, if they could be compared, both costs in milliseconds. */
  get choice() {
    return this.chooser.choice;
  }

  /** Has `auto` measure again: for another scene, or another place in it. */
  sceneChanged() {
    this.chooser.sceneChanged();
  }

  /**
   * Renders both eyes: call it in place of `renderer.render`.
   *
   * @param {import('three').Object3D} scene
   * @param {import('three').Camera} camera
   */
  render(scene, camera) {
    const { renderer } = this;
    if (renderer.getContext().isContextLost()) return;
    const { matrixWorldAutoUpdate } = scene;
    if (matrixWorldAutoUpdate) scene.updateMatrixWorld();
    if (camera.parent === null && camera.matrixWorldAutoUpdate) camera.updateMatrixWorld();
    // The scene is drawn in up to two parts, of the same matrices.
    scene.matrixWorldAutoUpdate = false;
    try {
      this._frame(scene, camera);
    } finally {
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
    let isBusy = false;
    const both = (scene, camera) => {
      const target = renderer.getRenderTarget();
      const isShown = target === null || target.isXRRenderTarget === true;
      if (isBusy || !isShown || !camera?.isPerspectiveCamera) return render.call(renderer, scene, camera);
      isBusy = true;
      try {
        this.render(scene, camera);
      } finally {
        isBusy = false;
      }
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
    if (!this._isPresenting) return this._halves(camera);
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
    const views = this._views(eyes);
    this.trouble = typeof views === 'string' ? views : null;
    if (this.trouble !== null) return null;
    return { camera: this._see(eyes.cameras[this._rendered], views), width: views.size[0], height: views.size[1] };
  }

  /**
   * Draws both eyes from textures of the view that `view` has named: for images with effects of their own. Colours are
   * drawn as they are. Returns false if the other eye cannot be synthesized; then nothing is drawn.
   *
   * @param {{color: import('three').Texture, depth: import('three').DepthTexture, samples?: number}} source - Images of
   * the view's size. With samples, depth was resolved from them.
   * @param {import('three').ArrayCamera} eyes - From `eyes`.
   * @param {import('three').WebGLRenderTarget|null} [target] - Where to draw; the canvas by default.
   */
  synthesize({ color, depth, samples = 0 }, eyes, target = null) {
    const { renderer } = this;
    const views = this._views(eyes);
    this.trouble = typeof views === 'string' ? views : null;
    if (this.trouble !== null) return false;
    this._raw ??= new Passes(renderer, false);
    const { xr, autoClear } = renderer;
    const { enabled } = xr;
    xr.enabled = renderer.autoClear = false;
    try {
      this._raw.prepare(views, { color, depth, guess: samples > 0 });
      renderer.setRenderTarget(target);
      this._assign(this._raw);
      renderer.render(this._raw.eyes, eyes);
    } finally {
      xr.enabled = enabled;
      renderer.autoClear = autoClear;
    }
    return true;
  }

  /** Frees what this has on the GPU. */
  dispose() {
    this.renderer.domElement.removeEventListener?.('webglcontextrestored', this._restored);
    this._timer.dispose();
    this._share.dispose();
    this._code.dispose();
    this._release();
    this._raw?.dispose();
    this._raw = null;
  }

  get _isPresenting() {
    const { xr } = this.renderer;
    return xr.enabled && xr.isPresenting;
  }

  /** The index of the rendered eye. */
  get _rendered() {
    return this.dominantEye === 'left' ? 0 : 1;
  }

  /** Begins anew: nothing is known of the GPU, which has lost all objects. */
  _forget() {
    const gl = this.renderer.getContext();
    this._timer = new Timer(gl);
    this._share = new Readback(gl);
    this._code = new Readback(gl);
    /** Whether three's materials write encoded colour into a target of ours; null until it is known. */
    this._encodes = null;
    /** True if three collects frames in a buffer of linear colour (its `outputBufferType`). */
    this._isBuffered ??= false;
    this._byLists = true;
    this._isNear = false;
    this._frames = 0;
    this._kind = '';
    this.chooser.sceneChanged();
  }

  _frame(scene, camera) {
    const { renderer, chooser } = this;
    const isPresenting = this._isPresenting;
    const isAuto = this.mode === 'auto';
    if (!isPresenting && !camera.isPerspectiveCamera) {
      this.trouble = 'the camera has no perspective';
      this.way = 'rendered';
      renderer.render(scene, camera);
      return;
    }
    if (isAuto) this._timer.begin();
    const eyes = this.eyes(camera);
    const shown = isPresenting ? camera : eyes;
    const views = this.mode === 'rendered' ? null : this._views(eyes);
    this.trouble = typeof views === 'string' ? views : null;
    const isPossible = views !== null && this.trouble === null;
    if (isAuto && isPossible) this._watch(eyes.cameras[0].viewport, isPresenting);
    const isSynthesized = isPossible && !(isAuto && (this._isNear || chooser.way === 'rendered'));
    this.way = isSynthesized ? 'synthesized' : 'rendered';
    if (isSynthesized) {
      this._synthesized(scene, camera, eyes, shown, views);
    } else {
      if (isAuto && isPossible && this._isNear) this._look(scene, camera, eyes, views);
      renderer.render(scene, shown);
    }
    if (!isAuto) return;
    this._timer.end();
    chooser.endFrame({
      now: performance.now(),
      refresh: isPresenting ? renderer.xr.getSession()?.frameRate ?? 0 : 0,
      rendered: isPossible && !this._isNear ? this.way : null,
      cost: this._timer.take(),
    });
  }

  /** Follows changes of size and what is near. */
  _watch({ z: width, w: height }, isPresenting) {
    const kind = `${width} ${height} ${isPresenting}`;
    if (kind !== this._kind) {
      if (this._kind !== '') this.chooser.sceneChanged();
      this._kind = kind;
    }
    this._frames++;
    const bytes = this._share.take();
    if (!bytes) return;
    let sum = 0;
    for (let i = 0; i < bytes.length; i += 4) sum += bytes[i];
    this._isNear = sum / (255 * bytes.length / 4) >= NEAR_SHARES[Number(this._isNear)];
  }

  _synthesized(scene, camera, eyes, shown, views) {
    const { renderer } = this;
    const { xr, info } = renderer;
    const { enabled } = xr;
    const { autoReset } = info;
    const target = renderer.getRenderTarget();
    // The figures of a frame are those of all its passes.
    if (autoReset) info.reset();
    info.autoReset = false;
    try {
      for (let isDone = false; !isDone;) {
        const passes = this._allocate(target);
        xr.enabled = false;
        const eye = this._see(eyes.cameras[this._rendered], views);
        const left = this._draw(this._source, views.size, scene, eye);
        this._pass(() => {
          passes.prepare(views, {
            color: this._source.texture, depth: this._source.depthTexture, guess: this._source.samples > 0,
          });
          if (this.mode === 'auto' && this._frames % LOOKS.synthesized === 0) this._count(views, passes.uniforms.depth_map.value);
        });
        xr.enabled = enabled;
        renderer.setRenderTarget(target);
        this._assign(passes);
        this._show(scene, camera, shown, left);
        // Known when the first picture is drawn, which is then drawn again.
        isDone = this._isBuffered || this._drawnTo === target;
        this._isBuffered ||= !isDone;
      }
    } finally {
      xr.enabled = enabled;
      renderer.setRenderTarget(target);
      info.autoReset = autoReset;
    }
  }

  /** The eyes on the halves of the canvas or render target. */
  _halves(camera) {
    const { renderer, _pair: pair, _size: size, stereoCamera } = this;
    const target = renderer.getRenderTarget();
    if (target) size.set(target.width, target.height);
    else renderer.getDrawingBufferSize(size);
    const half = Math.floor(size.x / 2);
    if (renderer.capabilities.reversedDepthBuffer) {
      // The renderer would do this later, and change the eyes' matrices.
      if (camera.reversedDepth !== true) {
        camera._reversedDepth = true;
        camera.updateProjectionMatrix();
      }
      for (const each of [pair, ...pair.cameras]) each._reversedDepth = true;
    }
    stereoCamera.update(camera);
    pair.near = camera.near;
    pair.far = camera.far;
    pair.matrixWorld.copy(camera.matrixWorld);
    pair.matrixWorldInverse.copy(pair.matrixWorld).invert();
    pair.projectionMatrix.copy(camera.projectionMatrix);
    pair.projectionMatrixInverse.copy(camera.projectionMatrixInverse);
    pair.layers.mask = camera.layers.mask | EYE_LAYERS;
    pair.cameras.forEach((eye, i) => {
      eye.updateMatrixWorld();
      eye.near = camera.near;
      eye.far = camera.far;
      eye.projectionMatrixInverse.copy(eye.projectionMatrix).invert();
      eye.viewport.set(i * half, 0, half, size.y);
      eye.layers.mask = pair.layers.mask & ~(0b100 >> i);
    });
    return pair;
  }

  /** What to render; or in a sentence why the other eye cannot be synthesized. */
  _views({ cameras }) {
    const { renderer } = this;
    const { capabilities, xr } = renderer;
    const reversed = Boolean(capabilities.reversedDepthBuffer);
    if (cameras.length !== 2) return `there are ${cameras.length} eyes`;
    if (capabilities.logarithmicDepthBuffer) return 'the depth buffer is logarithmic: create the renderer without logarithmicDepthBuffer';
    if (reversed && this._isPresenting) return 'three has no reversed depth in headsets: create the renderer without reversedDepthBuffer';
    if (reversed && cameras[0].reversedDepth !== true) return 'this version of three does not say that depth is reversed';
    if (this._isPresenting && xr.hasDepthSensing?.()) return 'real things hide the scene: the session uses depth sensing';
    if (!renderer.autoClear) return 'the picture is not cleared before it is drawn: renderer.autoClear is false';
    const views = viewsOf(cameras, this._rendered, this.guardBand, reversed, this._between);
    if (typeof views === 'string') return views;
    const { maxTextureSize } = capabilities;
    if (Math.max(...views.size) > maxTextureSize) return `the rendered eye would have ${views.size.join(' x ')} pixels, and this GPU’s textures ${maxTextureSize} at most`;
    if (this._isLinear(renderer.getRenderTarget()) && !this._hasHalfFloats()) return 'this GPU cannot render to half floats, which linear colour needs';
    return views;
  }

  _hasHalfFloats() {
    const gl = this.renderer.getContext();
    return Boolean(gl.getExtension('EXT_color_buffer_float') ?? gl.getExtension('EXT_color_buffer_half_float'));
  }

  /** True if colour must stay linear until it is drawn into a target. */
  _isLinear(target) {
    return this._isBuffered || this._encodes === false || (target !== null && target.isXRRenderTarget !== true);
  }

  /** Makes the source's target and the passes for what is drawn to, unless they are there. */
  _allocate(target) {
    const { renderer } = this;
    this._findEncoding();
    const isLinear = this._isLinear(target);
    // Where three resolves samples in the tile, depth is lost.
    const isResolved = renderer.extensions.has('WEBGL_multisampled_render_to_texture') && !renderer.properties?.get;
    const samples = isResolved ? 0 : Math.min(this.samples, renderer.capabilities.maxSamples ?? this.samples);
    const kind = `${isLinear} ${samples}`;
    if (this._made !== kind) {
      this._release();
      this._made = kind;
      this._source = this._target(isLinear, samples);
      this._passes = new Passes(renderer, isLinear);
      this._passes.own.onBeforeRender = () => {
        this._drawnTo = renderer.getRenderTarget();
      };
    }
    if (!isLinear) this._source.texture.colorSpace = renderer.outputColorSpace;
    return this._passes;
  }

  _target(isLinear, samples) {
    const target = new WebGLRenderTarget(1, 1, {
      samples, type: isLinear ? HalfFloatType : UnsignedByteType, minFilter: LinearFilter, magFilter: LinearFilter,
      generateMipmaps: false, stencilBuffer: this._stencil,
    });
    target.depthTexture = new DepthTexture(1, 1, this.renderer.capabilities.reversedDepthBuffer ? FloatType : UnsignedIntType);
    if (this._stencil) Object.assign(target.depthTexture, { format: DepthStencilFormat, type: UnsignedInt248Type });
    if (!isLinear) markEncoded(target, this.renderer);
    return target;
  }

  _release() {
    for (const target of [this._source, this._small]) {
      target?.depthTexture.dispose();
      target?.dispose();
    }
    this._passes?.dispose();
    this._source = this._small = this._passes = this._made = null;
  }

  /**
   * Finds out whether three's materials write encoded colour into targets of ours, as they do into a headset's: a grey
   * pixel tells it some frames later. If not, colour stays linear until the last pass.
   */
  _findEncoding() {
    const { renderer, _code: code } = this;
    if (this._encodes !== null) return;
    if (code.sync !== null || code.bytes !== null) {
      const bytes = code.take();
      if (bytes) this._encodes = bytes[0] > 150;
      return;
    }
    const target = new WebGLRenderTarget(1, 1, { depthBuffer: false, magFilter: NearestFilter });
    markEncoded(target, renderer);
    const material = new MeshBasicMaterial({ color: new Color().setRGB(0.5, 0.5, 0.5), toneMapped: false });
    const plane = new Mesh(new PlaneGeometry(2, 2), material);
    plane.frustumCulled = false;
    const { xr } = renderer;
    const { enabled } = xr;
    const before = renderer.getRenderTarget();
    xr.enabled = false;
    renderer.setRenderTarget(target);
    renderer.render(plane, new OrthographicCamera(-1, 1, 1, -1, -1, 1));
    code.begin(1, 1);
    renderer.setRenderTarget(before);
    xr.enabled = enabled;
    plane.geometry.dispose();
    material.dispose();
    target.dispose();
  }

  /** Returns the camera of the source. */
  _see(eye, { frustum }) {
    const { _camera: camera } = this;
    camera.near = eye.near;
    camera.far = eye.far;
    camera.matrixWorld.copy(eye.matrixWorld);
    camera.matrixWorldInverse.copy(eye.matrixWorld).invert();
    camera.matrixWorld.decompose(camera.position, camera.quaternion, camera.scale);
    camera.projectionMatrix.copy(eye.projectionMatrix);
    project(camera.projectionMatrix, frustum);
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
    camera._reversedDepth = Boolean(this.renderer.capabilities.reversedDepthBuffer);
    // What one eye alone sees is left out, but counted.
    camera.layers.mask = eye.layers.mask | EYE_LAYERS;
    return camera;
  }

  /** True for what is drawn for each eye, after the synthesis. */
  _isLater(object) {
    const { mask } = object.layers;
    return (mask & this._camera.layers.mask & ~EYE_LAYERS) === 0 || (mask & this.bothEyes) !== 0;
  }

  /** Draws what moves with the synthesis into a target. Returns how many objects are left. */
  _draw(target, size, scene, camera) {
    const { renderer } = this;
    target.setSize(...size);
    if (target.samples > 0 && renderer.properties?.get) renderer.properties.get(target).__useRenderToTexture = false;
    renderer.setRenderTarget(target);
    return this._part(scene, (object, isTransparent) => !isTransparent && !this._isLater(object), () => renderer.render(scene, camera));
  }

  _part(scene, isWanted, draw) {
    const lists = this._byLists ? this.renderer.renderLists : null;
    const list = lists?.get?.(scene, 0);
    const left = drawPart(list?.finish ? list : null, scene, isWanted, draw);
    // From the next frame on, objects are hidden by their layers.
    if (left < 0) this._byLists = false;
    return left;
  }

  _pass(draw) {
    const { renderer } = this;
    const { autoClear } = renderer;
    renderer.autoClear = false;
    try {
      draw();
    } finally {
      renderer.autoClear = autoClear;
    }
  }

  /** Counts how much of a source is near, to be known some frames later. */
  _count({ size, constant, slope }, depth) {
    if (this._share.isWaiting) return;
    this.renderer.setRenderTarget(this._passes.nearPart(size, depth, (1 / this.nearLimit - constant) / slope, slope > 0));
    this._share.begin(16, 16);
  }

  /** While both eyes are rendered because much is near: looks whether that is still so, in a small picture. */
  _look(scene, camera, eyes, views) {
    if (this._frames % LOOKS.rendered !== 0 || !this._passes) return;
    const { renderer } = this;
    const { xr } = renderer;
    const { enabled } = xr;
    const target = renderer.getRenderTarget();
    this._small ??= this._target(false, 0);
    xr.enabled = false;
    try {
      const size = [64, 64];
      this._draw(this._small, size, scene, this._see(eyes.cameras[this._rendered], views));
      this._pass(() => this._count({ ...views, size }, this._small.depthTexture));
    } finally {
      xr.enabled = enabled;
      renderer.setRenderTarget(target);
    }
  }

  /** Gives each eye its picture, by three's layers of one eye. */
  _assign({ own, other }) {
    own.layers.set(1 + this._rendered);
    other.layers.set(2 - this._rendered);
  }

  /** Draws both eyes, and over them what is left of the scene, in one pass. */
  _show(scene, camera, shown, left) {
    const { renderer, _passes: { eyes, own, other } } = this;
    const { shadowMap } = renderer;
    const { background, overrideMaterial } = scene;
    const { autoUpdate } = shadowMap;
    if (left === 0 || overrideMaterial) renderer.render(eyes, shown);
    if (left === 0) return;
    const isWanted = (object, isTransparent) => object === own || object === other || isTransparent || this._isLater(object);
    shadowMap.autoUpdate = false;
    scene.background = null;
    if (!overrideMaterial) scene.children.unshift(eyes);
    const draw = () => this._part(scene, isWanted, () => renderer.render(scene, shown));
    try {
      if (overrideMaterial) this._pass(draw);
      else draw();
    } finally {
      if (!overrideMaterial) scene.children.splice(scene.children.indexOf(eyes), 1);
      scene.background = background;
      shadowMap.autoUpdate = autoUpdate;
    }
  }
}

/** Has materials write tone mapped and encoded colour into a target, as into a headset's. */
function markEncoded(target, renderer) {
  target.isXRRenderTarget = true;
  target.texture.internalFormat = 'RGBA8';
  target.texture.colorSpace = renderer.outputColorSpace;
}
