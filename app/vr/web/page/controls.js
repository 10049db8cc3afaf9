// Mouse, touch and keys on the canvas: looking and walking.

const RADIANS_PER_PIXEL = 0.004;
const METRES_PER_PIXEL = 0.01;
const METRES_PER_SECOND = 1.6;
const TURN_PER_SECOND = 1.2;
/** A turn continues for about the inverse of this, in seconds. */
const FRICTION = 6;

const moves = {
  KeyW: [0, 0, 1], KeyS: [0, 0, -1], KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyQ: [0, -1, 0], KeyE: [0, 1, 0],
  ArrowUp: [0, 0, 1], ArrowDown: [0, 0, -1],
};
const turns = { ArrowLeft: 1, ArrowRight: -1 };

/** Listens to a canvas. Calls `move.turn(left, up)` or `move.walk(right, up, ahead)`, then `changed()`. */
export function listen(canvas, move, changed) {
  const pointers = new Map();
  const pressed = new Set();
  // Released keys stay pressed until the next step, so that a slow frame loses none.
  const released = new Set();
  let fast = false;
  /** The turn that continues after a drag, in radians per second to the left and upwards. */
  let spin = [0, 0];
  let dragged = 0;
  addEventListener('keydown', (event) => { fast = event.shiftKey; });
  addEventListener('keyup', (event) => { fast = event.shiftKey; });
  canvas.addEventListener('pointerdown', (event) => {
    if (event.isTrusted) canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    spin = [0, 0];
  });
  canvas.addEventListener('pointerup', (event) => {
    // If the finger rested before it was lifted, the turn stops.
    if (event.timeStamp - dragged > 60) spin = [0, 0];
    else changed();
  });
  for (const name of ['pointerup', 'pointercancel', 'lostpointercapture']) {
    canvas.addEventListener(name, (event) => pointers.delete(event.pointerId));
  }
  canvas.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    pointers.set(event.pointerId, now);
    if (pointers.size === 1) {
      const turn = [dx * RADIANS_PER_PIXEL, dy * RADIANS_PER_PIXEL];
      const seconds = Math.max((event.timeStamp - dragged) / 1000, 0.008);
      spin = seconds < 0.1 ? turn.map((angle) => angle / seconds) : [0, 0];
      dragged = event.timeStamp;
      move.turn(...turn);
    } else {
      // Each of two fingers contributes half. Spreading them walks forward.
      const [other] = [...pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
      const away = (place) => Math.hypot(place[0] - other[0], place[1] - other[1]);
      const pinch = away(now) - away(before);
      move.walk((-dx * METRES_PER_PIXEL) / 2, 0, (dy * METRES_PER_PIXEL) / 2 + pinch * METRES_PER_PIXEL);
      spin = [0, 0];
    }
    changed();
  });
  canvas.addEventListener('wheel', (event) => {
    // Unless the picture has the focus, the wheel scrolls the page. With ctrl it zooms the page.
    if (event.ctrlKey || (document.activeElement !== canvas && !document.fullscreenElement)) return;
    move.walk(0, 0, -event.deltaY * METRES_PER_PIXEL * 0.3);
    event.preventDefault();
    changed();
  }, { passive: false });
  canvas.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !(event.code in moves || event.code in turns)) return;
    pressed.add(event.code);
    released.delete(event.code);
    event.preventDefault();
    changed();
  });
  canvas.addEventListener('keyup', (event) => released.add(event.code));
  canvas.addEventListener('blur', () => pressed.clear());

  return {
    /** Moves by the keys that are down, fast with Shift, and by a turn that continues after a drag, for the `seconds`
     * since the last call. Returns true if anything moves. */
    step(seconds) {
      const dt = Math.min(seconds, 0.1);
      for (const code of pressed) {
        const distance = dt * METRES_PER_SECOND * (fast ? 4 : 1);
        if (moves[code]) move.walk(...moves[code].map((n) => n * distance));
        else move.turn(turns[code] * dt * TURN_PER_SECOND, 0);
      }
      const spins = pointers.size === 0 && Math.hypot(...spin) > 0.05;
      if (spins) {
        move.turn(spin[0] * dt, spin[1] * dt);
        spin = spin.map((speed) => speed * Math.exp(-dt * FRICTION));
      }
      const moved = pressed.size > 0 || spins;
      for (const code of released) pressed.delete(code);
      released.clear();
      return moved;
    },
  };
}
