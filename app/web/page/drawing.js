// The loop that draws on the canvas.

import { app, element } from './app.js';
import { keepPlace } from './address.js';
import { listen } from './controls.js';
import { choosing, figures, forgetFigures } from './figures.js';
import { label } from './labels.js';
import { magnify } from './magnifier.js';
import { say } from './messages.js';
import { sentence } from './sentence.js';
import { explain } from './why.js';

const { canvas } = app;
/** The canvas has at most so many pixels. */
const MAX_PIXELS = 4e6;
/** So many slow frames in a row end the choice of the cheaper method: this device cannot show the scene. */
const MOST_SLOW = 4;
/** The width of a saved wiggle picture in pixels, at most. */
const WIGGLE = 640;

const controls = listen(canvas, {
  turn: (left, up) => { app.page?.turn(left, up); },
  walk: (right, up, ahead) => { app.page?.walk(right, up, ahead); },
}, () => { if (app.page) { keepPlace(); changed(); } });

/** What is to be done: nothing, showing what is rendered, or rendering. */
const [NOTHING, SHOW, RENDER] = [0, 1, 2];
let due = RENDER;
let scheduled = false;
let last = 0;
let real = false;
/** Seconds that the scene has played. */
let played = 0;
let noted = false;
let drawn = 0;
/** Slow frames in a row. */
let slow = 0;

/** Draws soon: something has changed that is not rendered yet. */
export function changed() {
  due = RENDER;
  slow = 0;
  forgetFigures();
  if (!app.busy && app.page) schedule();
}

/** Shows the rendered images soon: only the divider or the magnifier has moved. */
function moved() {
  due = Math.max(due, SHOW);
  if (!app.busy && app.page) schedule();
}

/** Draws again after somebody else has drawn. */
export function startLoop() {
  last = 0;
  changed();
}

function schedule() {
  if (scheduled) return;
  scheduled = true;
  requestAnimationFrame(frame);
}

/** Returns the share of the picture that shows the real image. */
function divider() {
  if (app.settings.display === 'flicker') return Number(real);
  return element('divider').valueAsNumber / 100;
}

function frame(now) {
  scheduled = false;
  if (!app.page || app.busy) return;
  const seconds = last ? (now - last) / 1000 : 1 / 60;
  const walking = controls.step(seconds);
  const playing = Boolean(app.facts?.moves) && element('play').checked;
  const moving = walking || playing;
  last = moving ? now : 0;
  if (walking) keepPlace();
  if (playing) {
    played += seconds;
    app.page.setTime(played);
  }
  if (moving) {
    due = RENDER;
    forgetFigures();
  }
  const flicker = app.settings.display === 'flicker';
  const turn = flicker && now % 1000 < 500;
  if (turn !== real) due = Math.max(due, SHOW);
  real = turn;
  try {
    const work = due;
    due = NOTHING;
    if (work === RENDER) {
      resize();
      if (app.facts && !noted) {
        // The first picture is there sooner without the real images; they come with the next frame.
        app.page.preview(canvas.width, canvas.height);
        noteFirst();
        changed();
        return;
      }
      app.page.draw(canvas.width, canvas.height, divider());
      app.page.endFrame(now, 0);
      // Frames of a second and more count as pauses: nothing can be chosen by them.
      slow = now - drawn < 1000 ? 0 : slow + 1;
      if (choosing(slow >= MOST_SLOW)) due = RENDER;
      drawn = now;
    }
    if (work !== NOTHING) {
      const magnified = magnify();
      if (magnified || work === SHOW) app.page.show(canvas.width, canvas.height, divider());
      label(real);
      if (!moving) {
        figures();
        explain();
      }
    }
    if (moving || flicker || due !== NOTHING) schedule();
  } catch (error) {
    say(sentence(error));
  }
}

function resize() {
  const ratio = devicePixelRatio * app.settings.scale;
  const [width, height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio];
  const less = Math.min(1, Math.sqrt(MAX_PIXELS / Math.max(width * height, 1)));
  const size = [width, height].map((n) => Math.max(16, Math.round(n * less)));
  if (canvas.width !== size[0]) canvas.width = size[0];
  if (canvas.height !== size[1]) canvas.height = size[1];
}

/** Notes when the first picture was there, in ms since the page was asked for. */
function noteFirst() {
  noted = true;
  const { gl } = app;
  const done = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  const look = () => {
    const state = gl.clientWaitSync(done, 0, 0);
    if (state === gl.TIMEOUT_EXPIRED) {
      setTimeout(look);
      return;
    }
    gl.deleteSync(done);
    const { startTime } = performance.mark('first-picture');
    element('gpu').textContent += `; first picture after ${(startTime / 1000).toFixed(1)} s`;
  };
  setTimeout(look);
}

/** Saves a picture of what is shown. @param {Blob} blob @param {string} kind the end of its name */
function save(blob, kind) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = `yoro-${app.settings.scene ?? 'own'}-${kind}`;
  link.click();
  URL.revokeObjectURL(link.href);
}

/** Saves the picture that is shown as PNG. */
export function savePicture() {
  if (!app.page || app.busy || !app.source) return;
  app.page.show(canvas.width, canvas.height, divider());
  canvas.toBlob((blob) => save(blob, `${app.settings.display}.png`));
}

/** Saves both eyes in turn as an animated GIF. */
export function saveWiggle() {
  if (!app.page || app.busy || !app.source) return;
  try {
    save(new Blob([app.page.wiggle(WIGGLE)], { type: 'image/gif' }), 'wiggle.gif');
  } catch (error) {
    say(sentence(error));
  }
}

/** Listens to the divider and the magnifier. */
export function listenToPicture() {
  new ResizeObserver(changed).observe(canvas);
  element('divider').addEventListener('input', moved);
  element('magnifier').addEventListener('change', moved);
  element('play').addEventListener('change', changed);
  for (const event of ['pointermove', 'pointerleave']) canvas.addEventListener(event, () => { if (element('magnifier').checked) moved(); });
  element('save').addEventListener('click', savePicture);
  element('wiggle').addEventListener('click', saveWiggle);
}
