// Draws a part of a scene.

/**
 * Calls `draw`, which renders a scene, so that only a part of it is drawn. Returns how much was left out, or -1 if
 * the whole scene was drawn, since three's list of what is to be drawn could not be changed.
 *
 * @param {Object|null} list - three's render list of the scene; null to hide objects by their layers instead.
 * @param {import('three').Object3D} scene
 * @param {(object: import('three').Object3D, kind: string, item?: Object) => boolean} isWanted - Called with 'transmissive',
 * 'opaque' or 'transparent', in this order, and the list's item.
 * @param {() => void} draw
 * @param {() => void} [before] - Called once it is known what is drawn.
 */
export function drawPart(list, scene, isWanted, draw, before = () => {}) {
  return list ? drawListed(list, isWanted, draw, before) : drawVisible(scene, isWanted, draw, before);
}

function drawListed(list, isWanted, draw, before) {
  let left = -1;
  const { finish } = list;
  list.finish = () => {
    left = 0;
    for (const name of ['transmissive', 'opaque', 'transparent']) {
      const items = list[name];
      let kept = 0;
      for (const item of items) if (isWanted(item.object, name, item)) items[kept++] = item;
      left += items.length - kept;
      items.length = kept;
    }
    before();
    finish();
  };
  try {
    draw();
  } finally {
    list.finish = finish;
  }
  return left;
}

function drawVisible(scene, isWanted, draw, before) {
  const hidden = [];
  scene.traverseVisible((object) => {
    const { material } = object;
    // Lights, cameras and groups stay.
    if (!material) return;
    const all = [material].flat();
    const kind = all.some(({ transmission }) => transmission > 0) ? 'transmissive' : all.every(({ transparent }) => transparent) ? 'transparent' : 'opaque';
    if (!isWanted(object, kind)) hidden.push([object, object.layers.mask]);
  });
  for (const [object] of hidden) object.layers.mask = 0;
  try {
    before();
    draw();
  } finally {
    for (const [object, mask] of hidden) object.layers.mask = mask;
  }
  return hidden.length;
}
