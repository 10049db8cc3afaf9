// A phone in a Cardboard-compatible viewer.

import { Phone } from './yoro_web.js';
import { keepPlace } from './address.js';
import { app, element } from './app.js';
import { apply } from './choices.js';
import { startLoop } from './drawing.js';
import { clear, isFree, say } from './messages.js';
import { scan } from './scan.js';
import { sentence } from './sentence.js';

/** After this time without a reading, in ms, the device counts as having no sensors. */
const SILENCE = 1500;
/** The smallest length of a screen's short edge in mm, which the lenses require. */
const SHORTEST = 30;

const { canvas } = app;

/** Asks for permission to use the sensors if the browser requires it. Throws a sentence if that is refused. */
async function askForSensors() {
  if (typeof DeviceOrientationEvent === 'undefined') throw new Error('This browser does not report how it is held.');
  // Only Apple's browsers require permission.
  const { requestPermission } = /** @type {any} */ (DeviceOrientationEvent);
  if (requestPermission) {
    const answer = await requestPermission.call(DeviceOrientationEvent).catch((error) => error.message);
    if (answer !== 'granted') throw new Error('The motion sensors are not allowed: allow them in the browser’s settings for this page, and try again.');
  }
}

/** Checks both fields, and marks the first invalid one. Returns true if both are valid. */
function checkFields() {
  const [viewer, long] = ['phone-viewer', 'phone-width'].map(element);
  viewer.setCustomValidity(Phone.viewerFault(viewer.value) ?? '');
  const [width, height] = [screen.width, screen.height];
  const short = (long.valueAsNumber * Math.min(width, height)) / Math.max(width, height);
  long.setCustomValidity(short < SHORTEST
    ? `The short edge of this screen would be ${(short / 10).toFixed(1)} cm: it must be ${SHORTEST / 10} cm or more.` : '');
  return viewer.reportValidity() && long.reportValidity();
}

/** One use of the viewer: draws until the user leaves it. */
class Visit {
  name = 'phone';
  immersive = true;
  end = 'The viewer shows the scene: leave it first.';
  /** The phone in the viewer, once the size of the screen is known. @type {Phone | undefined} */
  #phone;
  #size = '';
  /** The last reading of the sensors: alpha, beta, gamma and the screen's rotation, in degrees. */
  #angles = null;
  #awake = null;
  #silence = 0;
  /** When the scene began to play, in ms. */
  #start = performance.now();
  #listeners = new AbortController();

  constructor() {
    // Some browsers have no fullscreen for elements: there the canvas fills the window.
    document.body.classList.add('filling');
    element('phone-leave').hidden = false;
    const { signal } = this.#listeners;
    const listen = (target, name, call) => target.addEventListener(name, call, { signal });
    listen(globalThis, 'deviceorientation', (event) => this.#turned(event));
    listen(document, 'fullscreenchange', () => { if (!document.fullscreenElement) this.stop(); });
    listen(document, 'visibilitychange', () => this.#keepAwake());
    listen(canvas, 'click', () => this.#phone?.recenter());
    listen(element('phone-leave'), 'click', () => this.stop());
    this.#keepAwake();
    this.#silence = setTimeout(() => say('This device’s sensors report nothing: drag to look.'), SILENCE);
    requestAnimationFrame((now) => this.#frame(now));
  }

  async #keepAwake() {
    if (document.visibilityState !== 'visible') return;
    this.#awake = await navigator.wakeLock?.request('screen').catch(() => null);
    if (app.busy !== this) this.#awake?.release();
  }

  #turned({ alpha, beta, gamma }) {
    if (alpha === null) return;
    clearTimeout(this.#silence);
    this.#angles = [alpha, beta, gamma, screen.orientation?.angle ?? globalThis.orientation ?? 0];
  }

  stop() {
    if (app.busy !== this) return;
    app.busy = null;
    this.#listeners.abort();
    clearTimeout(this.#silence);
    element('phone-leave').hidden = true;
    element('phone-upright').hidden = true;
    document.body.classList.remove('filling');
    this.#awake?.release();
    this.#phone?.free();
    this.#phone = undefined;
    if (document.fullscreenElement) document.exitFullscreen();
    if (app.page) {
      apply();
      keepPlace();
    }
    startLoop();
  }

  #frame(now) {
    if (app.busy !== this || !app.page) return;
    try {
      const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((n) => Math.max(16, Math.round(n * devicePixelRatio)));
      element('phone-upright').hidden = width > height;
      if (this.#size !== `${width}x${height}`) {
        this.#size = `${width}x${height}`;
        Object.assign(canvas, { width, height });
        const long = element('phone-width').valueAsNumber / 1000;
        const metres = [width, height].map((n) => (long * n) / Math.max(width, height));
        // The new phone takes over the direction straight ahead, which consumes the previous phone.
        const before = this.#phone;
        this.#phone = undefined;
        this.#phone = new Phone(app.page, element('phone-viewer').value, ...metres, before);
      }
      if (this.#angles) this.#phone.turn(...this.#angles);
      app.page.setTime((performance.now() - this.#start) / 1000);
      this.#phone.draw(app.page, width, height, app.settings.scale);
      app.page.endFrame(now, 0);
      requestAnimationFrame((then) => this.#frame(then));
    } catch (error) {
      this.stop();
      say(sentence(error));
    }
  }
}

/** Stores the viewer and the size of the screen for the next use. */
function remember() {
  try {
    localStorage.setItem('viewer', element('phone-viewer').value);
    localStorage.setItem('screen', element('phone-width').value);
  } catch { /* The fields are to be filled again next time. */ }
}

/** Shows the name of the viewer in the field. */
function nameViewer() {
  element('phone-name').textContent = Phone.viewerName(element('phone-viewer').value);
}

/** Sets up the panel. */
export function offerPhone() {
  // The viewer that was used last. A browser may refuse to store anything.
  try {
    element('phone-viewer').value = localStorage.getItem('viewer') ?? 'v1';
    element('phone-width').value = localStorage.getItem('screen') ?? '140';
  } catch { /* The fields keep what they have. */ }
  element('phone').addEventListener('click', async () => {
    if (!isFree('A viewer shows', true) || !checkFields()) return;
    clear();
    const sensors = askForSensors();
    const full = element('stage').requestFullscreen?.({ navigationUI: 'hide' });
    try {
      await sensors;
      await full;
    } catch (error) {
      say(error.message);
      if (document.fullscreenElement) await document.exitFullscreen();
      return;
    }
    // Only some browsers can do this, and the phone may be locked upright.
    await screen.orientation?.lock?.('landscape').catch(() => {});
    remember();
    app.busy = new Visit();
    apply();
  });
  element('phone-scan').addEventListener('click', async () => {
    const text = await scan();
    if (!text) return;
    element('phone-viewer').value = text;
    remember();
    nameViewer();
  });
  element('phone-viewer').addEventListener('input', nameViewer);
  nameViewer();
  for (const id of ['phone-viewer', 'phone-width']) {
    element(id).addEventListener('input', ({ target }) => target.setCustomValidity(''));
  }
}
