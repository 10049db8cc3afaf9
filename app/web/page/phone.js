// A phone in a Cardboard-compatible viewer.

import { Phone } from './yoro_web.js';
import { element } from './app.js';
import { sentence } from './sentence.js';

const RADIANS = Math.PI / 180;

const multiply = ([ax, ay, az, aw], [bx, by, bz, bw]) => [
  aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
  aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz,
];
const about = (axis, angle) => {
  const out = [0, 0, 0, Math.cos(angle / 2)];
  out[axis] = Math.sin(angle / 2);
  return out;
};

/** Returns the head's orientation for a device's angles (degrees, in browsers' convention) and its screen's rotation
 * `screen` in degrees: a quaternion x, y, z, w in a world with Y up. */
export function orientation(alpha, beta, gamma, screen) {
  // Turns about the Earth's axes Z, X and Y, with Z up; then the screen against the device.
  const device = multiply(multiply(about(2, alpha * RADIANS), about(0, beta * RADIANS)), about(1, gamma * RADIANS));
  const upright = multiply(about(0, -Math.PI / 2), device);
  return multiply(upright, about(2, -screen * RADIANS));
}

/** Asks for permission to use the sensors if the browser requires it; throws a sentence. */
async function askForSensors() {
  if (typeof DeviceOrientationEvent === 'undefined') throw new Error('This browser does not report how it is held.');
  if (DeviceOrientationEvent.requestPermission) {
    const answer = await DeviceOrientationEvent.requestPermission().catch((error) => error.message);
    if (answer !== 'granted') throw new Error('The motion sensors are not allowed: allow them in the browser’s settings for this page, and try again.');
  }
}

/** Makes the panel work. */
export function offerPhone(app) {
  const { canvas } = app;
  const [button, leave] = ['phone', 'phone-leave'].map(element);
  button.addEventListener('click', async () => {
    if (!app.facts || app.busy) {
      app.say('A viewer shows a scene: choose one above.');
      return;
    }
    app.clear();
    const sensors = askForSensors();
    const full = element('stage').requestFullscreen?.({ navigationUI: 'hide' });
    try {
      await sensors;
      await full;
    } catch (error) {
      app.say(error.message);
      if (document.fullscreenElement) await document.exitFullscreen();
      return;
    }
    // Only some browsers can, and the phone may be locked upright.
    await screen.orientation?.lock?.('landscape').catch(() => {});
    let awake = await navigator.wakeLock?.request('screen').catch(() => null);
    let head = [0, 0, 0, 1];
    let size = '';
    /** The phone in the viewer, once the size of the screen is known. */
    let phone;
    const turned = ({ alpha, beta, gamma }) => {
      if (alpha !== null) head = orientation(alpha, beta, gamma, screen.orientation?.angle ?? globalThis.orientation ?? 0);
    };
    const tapped = () => phone?.recenter();
    const seen = async () => {
      if (document.visibilityState === 'visible') awake = await navigator.wakeLock?.request('screen').catch(() => null);
    };
    const run = {
      name: 'phone',
      stop() {
        if (app.busy !== run) return;
        app.busy = null;
        removeEventListener('deviceorientation', turned);
        document.removeEventListener('fullscreenchange', left);
        document.removeEventListener('visibilitychange', seen);
        canvas.removeEventListener('click', tapped);
        leave.removeEventListener('click', run.stop);
        leave.hidden = true;
        document.body.classList.remove('filling');
        awake?.release();
        phone?.free();
        phone = undefined;
        if (document.fullscreenElement) document.exitFullscreen();
        app.startLoop();
      },
    };
    const left = () => {
      if (!document.fullscreenElement) run.stop();
    };
    app.busy = run;
    // Some browsers give no element the whole screen: it fills the window there.
    document.body.classList.add('filling');
    leave.hidden = false;
    leave.addEventListener('click', run.stop);
    addEventListener('deviceorientation', turned);
    document.addEventListener('fullscreenchange', left);
    document.addEventListener('visibilitychange', seen);
    canvas.addEventListener('click', tapped);
    const frame = () => {
      if (app.busy !== run || !app.page) return;
      try {
        const ratio = devicePixelRatio;
        const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((n) => Math.max(16, Math.round(n * ratio)));
        if (canvas.width !== width) canvas.width = width;
        if (canvas.height !== height) canvas.height = height;
        if (size !== `${width}x${height}`) {
          size = `${width}x${height}`;
          const long = element('phone-width').valueAsNumber / 1000;
          const metres = [width, height].map((n) => (long * n) / Math.max(width, height));
          // The new phone takes over the direction straight ahead, which consumes the phone before.
          const before = phone;
          phone = undefined;
          phone = new Phone(app.page, element('phone-viewer').value, ...metres, before);
        }
        phone.draw(app.page, width, height, new Float32Array(head), app.settings.scale);
        requestAnimationFrame(frame);
      } catch (error) {
        run.stop();
        app.say(sentence(error));
      }
    };
    requestAnimationFrame(frame);
  });
}
