// A headset, by WebXR: the views, projections and framebuffer come from the browser.

import { Headset } from './yoro_web.js';
import { keepPlace } from './address.js';
import { app, element } from './app.js';
import { apply, step } from './choices.js';
import { startLoop } from './drawing.js';
import { clear, isFree, say } from './messages.js';
import { inUse } from './methods.js';
import { sentence } from './sentence.js';

/** The buttons of xr-standard gamepads. Axes 2 and 3 are the thumbstick's. */
const [TRIGGER, SQUEEZE, THUMBSTICK] = [0, 1, 3];
const METRES_PER_SECOND = 1.5;
const TURN = Math.PI / 6;

/** Returns the buttons pressed since the last call, and where the thumbsticks point. */
function controllers(session, before) {
  const presses = { [TRIGGER]: false, [SQUEEZE]: false, [THUMBSTICK]: false };
  const stick = { left: [0, 0], right: [0, 0] };
  for (const source of session.inputSources) {
    const pad = source.gamepad;
    if (!pad) continue;
    for (const button of Object.keys(presses)) {
      const key = `${source.handedness}${button}`;
      const down = Boolean(pad.buttons[button]?.pressed);
      presses[button] ||= down && !before.get(key);
      before.set(key, down);
    }
    if (source.handedness in stick) stick[source.handedness] = [pad.axes[2] ?? 0, pad.axes[3] ?? 0];
  }
  return { presses, stick };
}

/** Returns what is shown, in a word or two. */
const shownBy = () => (app.stream ? 'stream' : inUse());

/** Listens to input sources without buttons of their own: hands, and gaze with a pinch. */
function listenToHands(session) {
  const isHand = ({ inputSource }) => !inputSource.gamepad;
  session.addEventListener('select', (event) => { if (isHand(event)) step('method'); });
  session.addEventListener('squeeze', (event) => { if (isHand(event)) step('viewpoint'); });
}

/** Requests the chosen frame rate, or the nearest one that the session offers. */
async function setRate(session) {
  const wanted = Number(element('headset-rate').value);
  const [nearest] = [...session.supportedFrameRates ?? []].sort((a, b) => Math.abs(a - wanted) - Math.abs(b - wanted));
  if (!wanted) return;
  if (!nearest) say('This browser does not let a page choose the frames a second.');
  else if (nearest !== session.frameRate) await session.updateTargetFrameRate(nearest).catch((error) => say(`The headset refuses ${nearest} frames a second: ${error.message}`));
}

async function enter(button) {
  const { gl } = app;
  const session = await navigator.xr.requestSession('immersive-vr', { optionalFeatures: ['local'] });
  const run = { name: 'headset', immersive: true, end: 'The headset shows the scene: leave VR first.', stop: () => session.end().catch(() => {}) };
  app.busy = run;
  button.textContent = 'Leave VR';
  let headset = null;
  session.addEventListener('end', () => {
    headset?.free();
    if (app.busy === run) app.busy = null;
    button.textContent = 'Enter VR';
    if (app.page) {
      apply();
      keepPlace();
    }
    startLoop();
  });
  try {
    await gl.makeXRCompatible();
    apply();
    headset = new Headset(app.page);
    listenToHands(session);
    const layer = new XRWebGLLayer(session, gl, {
      antialias: false, alpha: false, depth: true, stencil: false, framebufferScaleFactor: app.settings.scale,
    });
    // Its pixels are only copied: foveation there would save nothing.
    if (typeof layer.fixedFoveation === 'number') layer.fixedFoveation = 0;
    const [depthNear, depthFar] = Headset.planes();
    await session.updateRenderState({ baseLayer: layer, depthNear, depthFar });
    await setRate(session);
    const space = await session.requestReferenceSpace('local').catch(() => session.requestReferenceSpace('viewer'));
    const pressed = new Map();
    const times = [];
    let text = '';
    let shown = true;
    let turning = false;
    let last = 0;
    let start = 0;
    const frame = (now, xr) => {
      if (app.busy !== run || !app.page) return;
      session.requestAnimationFrame(frame);
      try {
        const dt = last ? Math.min((now - last) / 1000, 0.1) : 0;
        if (last) times.push(now - last);
        last = now;
        start ||= now;
        app.page.setTime((now - start) / 1000);
        const { presses, stick } = controllers(session, pressed);
        if (presses[TRIGGER]) step('method');
        if (presses[SQUEEZE]) step('viewpoint');
        if (presses[THUMBSTICK]) shown = !shown;
        const [right, back] = stick.left;
        if (Math.hypot(right, back) > 0.15) app.page.walk(right * dt * METRES_PER_SECOND, 0, -back * dt * METRES_PER_SECOND);
        const turn = Math.abs(stick.right[0]) > 0.6;
        if (turn && !turning) app.page.turn(-Math.sign(stick.right[0]) * TURN, 0);
        turning = turn;
        const pose = xr.getViewerPose(space);
        if (!pose) return;
        const eyes = ['left', 'right'].map((eye) => pose.views.find((view) => view.eye === eye));
        if (!eyes[0] || !eyes[1]) throw new Error('This headset has no two eyes.');
        const ports = eyes.map((view) => layer.getViewport(view));
        const floats = new Float32Array(46);
        eyes.forEach(({ transform: { position: p, orientation: o }, projectionMatrix }, i) => {
          floats.set([p.x, p.y, p.z, o.x, o.y, o.z, o.w, ...projectionMatrix], i * 23);
        });
        const size = [Math.min(ports[0].width, ports[1].width), Math.min(ports[0].height, ports[1].height)];
        if (times.length >= 36) {
          const mean = times.reduce((sum, ms) => sum + ms, 0) / times.length;
          times.length = 0;
          text = `${shownBy()}\n${mean.toFixed(1)} ms, ${(1000 / mean).toFixed(0)} Hz\n${size.join('x')} per eye`;
        } else if (presses[TRIGGER]) {
          text = shownBy();
          times.length = 0;
        }
        const fits = headset.draw(app.page, floats, ...size, shown ? text : '');
        app.stream?.ask();
        if (!fits && !run.told) {
          run.told = true;
          say('This headset’s eyes are canted or shifted: both are rendered.');
        }
        ports.forEach(({ x, y, width, height }, eye) => {
          gl.bindFramebuffer(gl.FRAMEBUFFER, layer.framebuffer);
          gl.viewport(x, y, width, height);
          headset.show(app.page, eye, x, y, width, height);
        });
        app.page.endFrame(now, session.frameRate ?? 0);
        Object.assign(run, { frames: (run.frames ?? 0) + 1, views: floats, size });
      } catch (error) {
        run.stop();
        say(sentence(error));
      }
    };
    session.requestAnimationFrame(frame);
  } catch (error) {
    await run.stop();
    throw error;
  }
}

/** Sets up the panel. */
export async function offerHeadset() {
  const [button, state] = [element('headset'), element('headset-state')];
  const look = async () => {
    const here = await navigator.xr?.isSessionSupported('immersive-vr').catch(() => false);
    button.disabled = !here;
    if (here) state.textContent = 'A headset is here.';
    else if (!navigator.xr) {
      state.textContent = isSecureContext
        ? 'This browser has no WebXR. A headset’s own browser has it.'
        : 'WebXR needs https, or an address on this machine (localhost).';
    } else state.textContent = 'There is no headset for this browser.';
  };
  for (const id of ['headset-rate', 'headset-foveation']) {
    try {
      // A value that is not offered would leave the field empty.
      const kept = localStorage.getItem(id);
      if ([...element(id).options].some(({ value }) => value === kept)) element(id).value = kept;
    } catch { /* The fields keep what they have. */ }
    element(id).addEventListener('change', ({ target }) => {
      try { localStorage.setItem(id, target.value); } catch { /* To be chosen again next time. */ }
    });
  }
  navigator.xr?.addEventListener?.('devicechange', look);
  button.addEventListener('click', async () => {
    if (app.busy?.name === 'headset') {
      app.busy.stop();
      return;
    }
    if (!isFree('A headset shows', true)) return;
    clear();
    button.disabled = true;
    try {
      await enter(button);
    } catch (error) {
      say(`The headset cannot be entered: ${sentence(error)}`);
    }
    button.disabled = false;
  });
  await look();
}
