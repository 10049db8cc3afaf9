// A magnifier at the pointer: the real image and the method's at the same place, side by side.

import { app, element } from './app.js';

/** How many screen pixels show a pixel of the picture, per axis. */
const ZOOM = 4;

const { canvas } = app;
/** The position of the pointer on the canvas in CSS pixels; null if it is elsewhere. */
let at = null;
canvas.addEventListener('pointermove', (event) => { at = [event.offsetX, event.offsetY]; });
canvas.addEventListener('pointerleave', () => { at = null; });

/** Fills and places the magnifier. Returns true if the canvas has to be shown again. */
export function magnify() {
  const lens = element('lens');
  lens.hidden = !element('magnifier').checked || element('magnifier').disabled || !at;
  if (lens.hidden) return false;
  const [half, height] = [lens.width / 2, lens.height];
  const scale = canvas.width / canvas.clientWidth;
  const [width, tall] = [half / ZOOM, height / ZOOM];
  const corner = [at[0] * scale - width / 2, at[1] * scale - tall / 2];
  const paint = lens.getContext('2d');
  paint.imageSmoothingEnabled = false;
  paint.fillStyle = '#000';
  paint.fillRect(0, 0, lens.width, height);
  // First the real image over the whole canvas, then the method's.
  for (const [share, x] of [[1, 0], [0, half]]) {
    app.page.show(canvas.width, canvas.height, share);
    paint.drawImage(canvas, ...corner, width, tall, x, 0, half, height);
  }
  paint.fillStyle = '#fff';
  paint.fillRect(half - 1, 0, 2, height);
  // Beside the pointer, on the side with more room.
  lens.style.left = `${at[0] < canvas.clientWidth / 2 ? at[0] + 24 : at[0] - 24 - lens.clientWidth}px`;
  lens.style.top = `${Math.min(Math.max(at[1] - lens.clientHeight / 2, 0), canvas.clientHeight - lens.clientHeight)}px`;
  return true;
}
