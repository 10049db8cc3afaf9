// The loop that draws on the canvas.

import { app, element } from './app.js';
import { keepPlace } from './address.js';
import { listen } from './controls.js';
import { say } from './messages.js';
import { sentence } from './sentence.js';

const { canvas } = app;
/** The canvas has at most so many pixels. */
const MAX_PIXELS = 4e6;

const controls = listen(canvas, {
  turn: (left, up) => { app.page?.turn(left, up); },
  walk: (right, up, ahead) => { app.page?.walk(right, up, ahead); },
}, () => { if (app.page) { keepPlace(); changed(); } });

let drawn = false;
let scheduled = false;
let last = 0;
let truth = false;
let noted = false;

/** Draws soon: something has changed that is not on the canvas yet. */
export function changed() {
  drawn = false;
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

function frame(now) {
  scheduled = false;
  if (!app.page || app.busy) return;
  const moving = controls.step(last ? (now - last) / 1000 : 1 / 60);
  last = moving ? now : 0;
  if (moving) keepPlace();
  const flicker = app.settings.display === 'flicker';
  const real = flicker && now % 1000 < 500;
  try {
    if (moving || !drawn || real !== truth) {
      resize();
      app.page.draw(canvas.width, canvas.height, real);
      truth = real;
      drawn = true;
      legend();
      if (app.facts && !noted) noteFirst();
    }
    if (moving || flicker) schedule();
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

function legend() {
  const { display, dominant } = app.settings;
  const other = dominant === 'right' ? 'Left' : 'Right';
  const texts = {
    difference: `${other} eye: black where it equals a real render, white where it differs by a quarter of the range or more`,
    flicker: `${other} eye: ${truth ? 'really rendered' : app.settings.method}`,
  };
  const text = app.facts ? texts[display] : undefined;
  element('legend').hidden = !text;
  element('legend').textContent = text ?? '';
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
