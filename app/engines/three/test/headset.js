// Completes the emulated headset, whose layer is the page's canvas: a layer of its own size, frusta as devices have them.
// To be run after the emulator, before the page's scripts.

/**
 * @param {Object} options
 * @param {number} options.size - Width and height of an eye's image in pixels.
 * @param {number} [options.skew] - What an eye sees more of on its outer side.
 * @param {number} [options.lift] - What both see more of upwards.
 * @param {number} [options.cant] - The angle between the displays in radians.
 * @param {boolean} [options.hasLayers] - A projection layer in place of an XRWebGLLayer.
 */
globalThis.installHeadset = ({ size, skew = 0, lift = 0, cant = 0, hasLayers = false }) => {
  const property = (of, name, get) => Object.defineProperty(of.prototype, name, { get, configurable: true });
  const getter = (of, name) => Object.getOwnPropertyDescriptor(of.prototype, name).get;
  globalThis.headset = new IWER.XRDevice(IWER.metaQuest3, { stereoEnabled: true });
  headset.installRuntime({ forceInstall: true });
  headset.fovy = 1.6;
  if (hasLayers) new (globalThis.WebXRLayersPolyfill.default ?? globalThis.WebXRLayersPolyfill)();
  const projection = getter(XRView, 'projectionMatrix');
  property(XRView, 'projectionMatrix', function () {
    const m = Float32Array.from(projection.call(this));
    m[8] += this.eye === 'left' ? -skew : skew;
    m[9] += lift;
    return m;
  });
  const transform = getter(XRView, 'transform');
  if (cant !== 0) {
    property(XRView, 'transform', function () {
      const { position, orientation: o } = transform.call(this);
      const angle = (this.eye === 'left' ? 1 : -1) * cant / 2, s = Math.sin(angle), c = Math.cos(angle);
      return new XRRigidTransform(position, { x: o.x * c - o.z * s, y: o.w * s + o.y * c, z: o.z * c + o.x * s, w: o.w * c - o.y * s });
    });
  }
  if (hasLayers) return;
  property(XRWebGLLayer, 'framebufferWidth', () => 2 * size);
  property(XRWebGLLayer, 'framebufferHeight', () => size);
  property(XRWebGLLayer, 'ignoreDepthValues', () => false);
  XRWebGLLayer.prototype.getViewport = ({ eye }) => ({ x: eye === 'right' ? size : 0, y: 0, width: size, height: size });
  const framebuffers = new WeakMap();
  property(XRWebGLLayer, 'framebuffer', function () {
    if (!framebuffers.has(this)) {
      const gl = this.context;
      const framebuffer = gl.createFramebuffer();
      const bound = gl.getParameter(gl.FRAMEBUFFER_BINDING);
      gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
      for (const [attachment, format] of [[gl.COLOR_ATTACHMENT0, gl.RGBA8], [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24]]) {
        const buffer = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
        gl.renderbufferStorage(gl.RENDERBUFFER, format, 2 * size, size);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
      }
      gl.bindFramebuffer(gl.FRAMEBUFFER, bound);
      framebuffers.set(this, framebuffer);
      globalThis.layerFramebuffer = framebuffer;
    }
    return framebuffers.get(this);
  });
};
