// Why it works: four pictures of the scene in view. They are made when they are in sight and the scene no longer
// changes.

import { Why } from './yoro_web.js';
import { app, element } from './app.js';
import { say } from './messages.js';
import { sentence } from './sentence.js';

/** The pictures' width in pixels. */
const WIDTH = 480;
/** How long the picture must stay unchanged before it is explained, in ms. */
const REST = 700;
/** The share of the pictures that must be in sight. */
const SEEN = 0.4;

const section = element('why');
let isSeen = false;
let timer = 0;
/** The scene and the settings that the pictures show. */
let about = '';

/** Explains the picture, if it stays unchanged for a while. */
export function explain() {
  clearTimeout(timer);
  section.hidden = !app.facts;
  if (isSeen && app.facts) timer = setTimeout(make, REST);
}

function make() {
  if (!app.page || !app.facts || app.busy || document.hidden) return;
  const { dominant, ipd, viewpoint } = app.settings;
  const height = Math.max(1, Math.round((WIDTH * app.canvas.clientHeight) / app.canvas.clientWidth));
  const now = [app.facts.name, viewpoint, app.page.place, dominant, ipd, height].join();
  if (now === about || ipd === 0) return;
  about = now;
  try {
    const why = new Why(app.page, WIDTH, height);
    for (const [i, canvas] of section.querySelectorAll('canvas').entries()) {
      Object.assign(canvas, { width: WIDTH, height });
      canvas.getContext('2d').putImageData(new ImageData(new Uint8ClampedArray(why.picture(i)), WIDTH), 0, 0);
    }
    element('why-eye').textContent = dominant;
    element('why-farthest').textContent = ((why.farthest / WIDTH) * 100).toFixed(1);
    element('why-holes').textContent = (why.holes * 100).toFixed(1);
    why.free();
  } catch (error) {
    say(sentence(error));
  }
}

/** Has the pictures made when they come into sight. */
export function watchWhy() {
  new IntersectionObserver(([{ isIntersecting }]) => {
    isSeen = isIntersecting;
    explain();
  }, { threshold: SEEN }).observe(section);
}
