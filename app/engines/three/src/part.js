// Draws a part of a scene.

/**
 * Calls `draw`, which renders a scene, so that only a part of it is drawn. Returns how much was left out, or -1 if
 * the whole scene was drawn, since three's list of what is to be drawn could not be changed.
 *
 * @param {Object|null} list - three's render list of the scene; null to hide objects by their layers instead.
 * @param {import('three').Object3D} scene
 * @param {(object: import('three').Object3D, isTransparent: boolean) => boolean} isWanted
 * @param {() => void} draw
 */
export function drawPart(list, scene, isWanted, draw) {
  return list ? drawListed(list, isWanted, draw) : drawVisible(scene, isWanted, draw);
}

function drawListed(list, isWanted, draw) {
  let left = -1;
  const { finish } = list;
  list.finish = () => {
    left = 0;
    for (const name of ['opaque', 'transmissive', 'transparent']) {
      const items = list[name];
      let kept = 0;
      for (const item of items) if (isWanted(item.object, name === 'transparent')) items[kept++] = item;
      left += items.length - kept;
      items.length = kept;
    }
    finish();
  };
  try {
    draw();
  } finally {
    list.finish = finish;
  }
  return left;
}

function drawVisible(scene, isWanted, draw) {
  const hidden = [];
  scene.traverseVisible((object) => {
    const { material } = object;
    // Lights, cameras and groups stay.
    if (!material) return;
    const isTransparent = [material].flat().every((each) => each.transparent && !(each.transmission > 0));
    if (!isWanted(object, isTransparent)) hidden.push([object, object.layers.mask]);
  });
  for (const [object] of hidden) object.layers.mask = 0;
  try {
    draw();
  } finally {
    for (const [object, mask] of hidden) object.layers.mask = mask;
  }
  return hidden.length;
}
