// What each part of the picture shows.

import { app, element } from './app.js';
import { making } from './methods.js';

const capital = (text) => text[0].toUpperCase() + text.slice(1);

/** Returns a text that names an eye and how it was made. */
function describe(eye) {
  if (!app.source.color) return `${eye} eye: ${making(app.page.methodInUse, eye === app.settings.dominant)}`;
  return `${eye} eye: ${element('picture-source').value === eye ? 'your picture' : 'synthesized'}`;
}

/** Returns the texts on the left and on the right. */
function texts(real) {
  const { display, dominant } = app.settings;
  const method = app.page.methodInUse;
  const other = dominant === 'right' ? 'left' : 'right';
  const made = describe(other);
  const rendered = `${other} eye: really rendered`;
  switch (display) {
    case 'side-by-side': return [describe('left'), describe('right')];
    case 'cross-eyed': return [describe('right'), describe('left')];
    case 'anaglyph': return [`Red: ${describe('left')}`, `cyan: ${describe('right')}`];
    case 'left': case 'right': return [describe(display), ''];
    case 'flicker': return [real ? rendered : `${made} (${method})`, ''];
    case 'difference': return [rendered, 'error: black where equal, white from a quarter of the range'];
    default: return [rendered, `${made} (${method})`];
  }
}

/** Labels the parts of the picture. @param {boolean} real true if a display of pictures in turn shows the real one */
export function label(real) {
  const { display } = app.settings;
  const compares = Boolean(app.facts) && ['divider', 'difference'].includes(display);
  const [left, right] = app.source ? (app.source.color && !['side-by-side', 'cross-eyed', 'anaglyph', 'left', 'right'].includes(display)
    ? [describe(element('picture-source').value === 'left' ? 'right' : 'left'), '']
    : texts(real)) : ['', ''];
  for (const [id, text] of [['label-left', left], ['label-right', right]]) {
    element(id).hidden = !text;
    if (text) element(id).textContent = capital(text);
  }
  element('stage').dataset.display = display;
  element('divider').hidden = !compares;
  element('magnifier').disabled = !compares;
  element('error').disabled = !app.facts;
  element('play').disabled = !app.facts?.moves && !app.stream?.video;
  element('stage').style.setProperty('--divider', `${element('divider').value}%`);
}
