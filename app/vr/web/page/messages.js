// Messages to the user: errors, hints and progress.

import { app, element } from './app.js';

/** Shows an error or a hint, above everything else. @param {string} text */
export function say(text) {
  const message = element('message');
  element('message-text').textContent = text;
  message.hidden = false;
  // The popover that is shown last lies above a fullscreen element.
  message.hidePopover?.();
  message.showPopover?.();
}

/** Adds a sentence to the message on display. @param {string} text */
export function sayAlso(text) {
  say(element('message').hidden ? text : `${element('message-text').textContent} ${text}`);
}

/** Hides the message. */
export function clear() {
  element('message').hidden = true;
}

/**
 * Returns true if nothing else draws and a scene is shown. Otherwise says what is missing.
 * @param {string} need a sentence that says what needs a scene
 * @param {boolean} streams true if a stream is enough
 */
export function isFree(need, streams = false) {
  const shown = Boolean(app.page && (app.facts || (streams && app.stream)));
  if (app.busy) say(app.busy.end);
  else if (!shown) say(`${need} a scene: choose one of the list.`);
  return !app.busy && shown;
}

/**
 * Shows the work in progress, or hides the display if the text is null.
 * @param {string | null} text
 * @param {number | null} part the progress from 0 to 1, null if unknown
 * @param {string} count the same in words
 */
export function loading(text, part = null, count = '') {
  element('loading').hidden = !text;
  // There is nothing to go back to before the first scene.
  element('loading-cancel').hidden = !app.wanted || !app.source;
  if (element('loading-text').textContent !== text) element('loading-text').textContent = text ?? '';
  element('loading-count').textContent = count;
  if (part === null) element('progress').removeAttribute('value');
  else element('progress').value = part;
}
