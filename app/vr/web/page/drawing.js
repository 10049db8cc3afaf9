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
/** The largest number of pixels of the canvas. */
const MAX_PIXELS = 4e6;
/** This many slow frames in a row end the choice of the cheaper method: the device is too slow for the scene. */
const MAX_SLOW = 4;
/** The maximum width of a saved wiggle picture in pixels. */
const WIGGLE = 640;

const controls = listen(canvas, {
  turn: (left, up) => { app.page?.turn(left, up); },
  walk: (right, up, ahead) => { app.page?.walk(right, up, ahead); },
}, () => { if (app.page) { keepPlace(); changed(); } });

/** The work that is due: nothing, showing the rendered images, or rendering. */
const [NOTHING, SHOW, RENDER] = [0, 1, 2];
let due = RENDER;
let scheduled = false;
let last = 0;
let real = false;
/** For how long the scene has played, in seconds. */
let played = 0;
let noted = false;
let drawn = 0;
/** The number of slow frames in a row. */
let slow = 0;

/** Renders in the next frame: something has changed. */
export function changed() {
  due = RENDER;
  slow = 0;
  forgetFigures();
  if (!app.busy && app.page) schedule();
}

/** Shows the rendered images again in the next frame: only the divider or the magnifier has moved. */
function moved() {
  due = Math.max(due, SHOW);
  if (!app.busy && app.page) schedule();
}

/** Restarts the loop after something else has drawn on the canvas. */
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
        // The first picture appears sooner without the real images, which come with the next frame.
        app.page.preview(canvas.width, canvas.height);
        noteFirst();
        changed();
        return;
      }
      app.page.draw(canvas.width, canvas.height, divider());
      app.page.endFrame(now, 0);
      // Frames of a second or more count as pauses, which say nothing about the methods' costs.
      slow = now - drawn < 1000 ? 0 : slow + 1;
      if (choosing(slow >= MAX_SLOW)) due = RENDER;
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

/** Records when the first picture was complete, in ms since the page was requested. */
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

/** Saves a picture as a file. @param {Blob} blob @param {string} kind the end of the file's name */
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
