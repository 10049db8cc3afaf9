// Mouse, touch and keys on the canvas: looking and walking.

const RADIANS_PER_PIXEL = 0.004;
const METRES_PER_PIXEL = 0.01;
const METRES_PER_SECOND = 1.6;
const TURN_PER_SECOND = 1.2;

const moves = {
  KeyW: [0, 0, 1], KeyS: [0, 0, -1], KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyQ: [0, -1, 0], KeyE: [0, 1, 0],
  ArrowUp: [0, 0, 1], ArrowDown: [0, 0, -1],
};
const turns = { ArrowLeft: 1, ArrowRight: -1 };

/** Listens to a canvas. `move.turn(left, up)`, `move.walk(right, up, ahead)`; `changed()` after each. */
export function listen(canvas, move, changed) {
  const pointers = new Map();
  const pressed = new Set();
  // Pressed and let go of between two steps: a slow frame loses no key.
  const released = new Set();
  let fast = false;
  for (const name of ['keydown', 'keyup']) addEventListener(name, (event) => { fast = event.shiftKey; });
  canvas.addEventListener('pointerdown', (event) => {
    if (event.isTrusted) canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  for (const name of ['pointerup', 'pointercancel', 'lostpointercapture']) {
    canvas.addEventListener(name, (event) => pointers.delete(event.pointerId));
  }
  canvas.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before[0], event.clientY - before[1]];
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (pointers.size === 1) move.turn(dx * RADIANS_PER_PIXEL, dy * RADIANS_PER_PIXEL);
    // Each of two fingers contributes half.
    else move.walk((-dx * METRES_PER_PIXEL) / 2, 0, (dy * METRES_PER_PIXEL) / 2);
    changed();
  });
  canvas.addEventListener('wheel', (event) => {
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
    /** Moves by the keys that are down, fast with Shift, in `seconds` since the last call; true if any key is down. */
    step(seconds) {
      const dt = Math.min(seconds, 0.1);
      for (const code of pressed) {
        const distance = dt * METRES_PER_SECOND * (fast ? 4 : 1);
        if (moves[code]) move.walk(...moves[code].map((n) => n * distance));
        else move.turn(turns[code] * dt * TURN_PER_SECOND, 0);
      }
      const moved = pressed.size > 0;
      for (const code of released) pressed.delete(code);
      released.clear();
      return moved;
    },
  };
}
