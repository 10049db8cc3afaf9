// Keys for the whole page, and the dialog that lists them.

import { element } from './app.js';

/**
 * Listens to keys.
 * @param {Record<string, () => void>} actions by the key's code
 */
export function listenToKeys(actions) {
  const dialog = element('keys');
  element('keys-open').addEventListener('click', () => dialog.showModal());
  addEventListener('keydown', (event) => {
    const typing = event.target instanceof Element && event.target.closest('input:not([type=checkbox], [type=range]), select, dialog');
    if (typing || event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
    if (event.key === '?') dialog.showModal();
    else actions[event.code]?.();
  });
}
