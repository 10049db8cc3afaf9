// Messages to the user: errors, hints and progress.

import { element } from './app.js';

/** Shows an error or a hint. @param {string} text */
export function say(text) {
  const message = element('message');
  message.textContent = text;
  message.hidden = false;
}

/** Hides the message. */
export function clear() {
  element('message').hidden = true;
}

/**
 * Shows the work in progress; hides the display for null.
 * @param {string | null} text
 * @param {number | null} part the progress from 0 to 1, null if unknown
 * @param {string} count the same in words
 */
export function loading(text, part = null, count = '') {
  element('loading').hidden = !text;
  if (element('loading-text').textContent !== text) element('loading-text').textContent = text ?? '';
  element('loading-count').textContent = count;
  if (part === null) element('progress').removeAttribute('value');
  else element('progress').value = part;
}
