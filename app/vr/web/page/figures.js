// The figures below the picture, measured while nothing moves: the method against two renders.

import { app, element } from './app.js';
import { inUse } from './methods.js';
import { median, nextTask } from './timing.js';

/** How long the picture must stay unchanged before it is measured, in ms. */
const REST = 500;
/** How long a measurement takes, in ms. */
const LENGTH = 1000;
/** The shortest batch, in ms: browsers round their clocks, at worst to 1 ms. */
const BATCH = 20;
const MAX_FRAMES = 200;

let timer = 0;
/** The measurement in progress; another one ends it. */
let current = null;
/** The settings that the sentence on display is about. */
let about = '';

const compares = () => Boolean(app.facts && app.page && !app.busy) && ['divider', 'difference'].includes(app.settings.display);

/** Ends the measurement, since the picture changes. */
export function forgetFigures() {
  clearTimeout(timer);
  current = null;
  const { method, msaa, holes, ipd, scale, scene, dominant } = app.settings;
  const now = [method, msaa, holes, ipd, scale, scene, dominant, app.facts?.name].join();
  if (about !== now || !(compares() || app.page?.reason)) element('figures').textContent = '';
  about = now;
}

/** Measures the picture once it has stayed unchanged for a while. */
export function figures() {
  clearTimeout(timer);
  if (!compares() || current) return;
  timer = setTimeout(() => {
    if (!compares() || document.hidden) return;
    current = {};
    measure(current).catch(() => {});
  }, REST);
}

/**
 * Says what `auto` has chosen, and why. Returns true while it still measures, for which it needs frames.
 * @param {boolean} slow whether frames come too slowly to measure
 */
export function choosing(slow) {
  const { reason, costs, isMeasuring } = app.page;
  if (!reason) return false;
  const text = isMeasuring && slow ? 'A frame takes longer than a second here: nothing can be chosen by that.'
    : isMeasuring ? 'Two renders and yoro take turns.'
    : costs ? sentences('yoro', costs[1] / costs[0], costs[1], costs[0]) : 'The two cannot be compared here.';
  const said = `${inUse()}. ${text}`;
  if (element('figures').textContent !== said) element('figures').textContent = said;
  return isMeasuring && !slow;
}

/** Measures two batches, one of the method and one of two renders. Returns the ms per frame of each, and the frames of
 * a batch. */
function pair(frames) {
  return [false, true].map((real, i) => {
    const start = performance.now();
    app.page.repeat(real, frames[i]);
    return performance.now() - start;
  });
}

async function measure(run) {
  const frames = [1, 1];
  let pairs = [];
  // The first frames warm up.
  app.page.repeat(false, 1);
  app.page.repeat(true, 1);
  const end = performance.now() + LENGTH;
  while (performance.now() < end || pairs.length < 3) {
    await nextTask();
    if (current !== run || !compares()) return;
    const taken = pair(frames);
    const short = taken.map((ms, i) => ms < BATCH && frames[i] < MAX_FRAMES);
    if (short.includes(true)) {
      pairs = [];
      taken.forEach((ms, i) => {
        if (short[i]) frames[i] = Math.min(MAX_FRAMES, Math.max(frames[i] + 1, Math.ceil((frames[i] * BATCH * 1.3) / Math.max(ms, 0.5))));
      });
    } else {
      pairs.push(taken.map((ms, i) => ms / frames[i]));
    }
    if (performance.now() > end + 4 * LENGTH) break;
  }
  if (!pairs.length) return;
  const [made, real] = [0, 1].map((i) => median(pairs.map((times) => times[i])));
  const share = made / real;
  element('figures').textContent = sentences(app.page.methodInUse, share, made, real, app.page.psnr);
  app.figures = { share, made, real };
}

/** Returns the figures in words. `psnr` is undefined if there is no real render to compare with. */
export function sentences(method, share, made, real, psnr = undefined) {
  const digits = (ms) => `${ms.toFixed(ms < 10 ? 2 : ms < 100 ? 1 : 0)} ms`;
  const who = /llvmpipe|swiftshader|software|basic render/i.test(app.page.gpu) ? 'This device’s processor, without a GPU,' : 'Your GPU';
  const seen = !psnr ? '' : psnr[0] === Infinity ? ', without any difference to a real render'
    : `, at ${psnr[0].toFixed(1)} dB PSNR against a real render (the same image to both eyes: ${psnr[1].toFixed(1)} dB)`;
  if (method === 'conventional') return `${who} draws this stereo picture by two renders in ${digits(real)}. Choose yoro to compare.`;
  const both = `${digits(made)} against ${digits(real)}`;
  const percent = Math.round(share * 100);
  if (share < 0.995) return `${who} draws this stereo picture in ${percent} % of the time of two renders (${both})${seen}.`;
  return `Two renders are cheaper for this picture here: ${method} takes ${percent} % of their time (${both})${seen}.`;
}
