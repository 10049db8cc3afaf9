// What to render for two eyes, and the uniforms of the passes: `yoro_kit.h` of the shader kit, for three's cameras.

/** Eyes whose axes differ by less than this angle in radians are parallel. */
const PARALLEL = 1e-3;
/** The largest movement between the eyes in pixels. */
const MAX_MOVEMENT = 4095;
/** Columns and rows of a tile. */
const TILE = [16, 8];

/** True if the renderer's depth is 1 at the near plane, and not 0. */
export const isReversed = ({ capabilities }) => Boolean(capabilities.reversedDepthBuffer);

/** @param {number} pixels */
const roundedUp = (pixels) => Math.max(Math.ceil(pixels - 1e-3), 0);

/**
 * The tangents of the angles to an image's edges: the left and the right one, the lower and the upper one.
 *
 * @param {import('three').Matrix4} projection
 */
export const tangents = ({ elements: e }) => [0, 1].map((i) => [-1, 1].map((side) => (e[8 + i] + side) / e[5 * i]));

/**
 * Computes what to render, and the uniforms; or says in a sentence why the other eye cannot be synthesized.
 *
 * @param {import('three').Camera[]} cameras - The left and the right eye's, with world matrices and viewports.
 * @param {number} rendered - The eye that is rendered: 0 for the left one, 1 for the right one.
 * @param {number} guardBand - From this distance on, nothing is missing at the other eye's outer border; 0 for no band.
 * @param {boolean} zeroToOne - True if clip space's z runs from 0 to 1, as with reversed depth, and not from -1 to 1.
 * @param {number} largest - The largest side of an image in pixels.
 * @param {import('three').Matrix4} between - Receives the other eye's pose in the rendered eye's space.
 * @return {string|Object}
 */
export function viewsOf(cameras, rendered, guardBand, zeroToOne, largest, between) {
  const [source, target] = [cameras[rendered], cameras[1 - rendered]];
  const pose = between.copy(source.matrixWorld).invert().multiply(target.matrixWorld).elements;
  const ipd = Math.abs(pose[12]);
  // Numbers that are not finite must fail, too: so every test says what must hold.
  const isTurned = [0, 1, 2, 4, 5, 6, 8, 9, 10].some((i) => !(Math.abs(pose[i] - Number(i % 5 === 0)) <= PARALLEL));
  if (isTurned) return 'the displays are turned against each other';
  if (!(Math.abs(pose[13]) + Math.abs(pose[14]) <= 0.05 * ipd + 1e-9)) return 'the eyes are not on one horizontal line';
  const toLeft = rendered === 1;
  if (ipd > 0 && (pose[12] < 0) !== toLeft) return 'the left eye is to the right of the right eye';
  const e = source.projectionMatrix.elements;
  if (e[11] !== -1 || e[15] !== 0 || e[1] !== 0 || e[4] !== 0) return 'the camera has no perspective';
  const { x, y, z: width, w: height } = target.viewport;
  const own = source.viewport;
  if (!(width > 0 && height > 0 && own.z === width && own.w === height)) return 'the images of the eyes differ in size';

  const [[sLeft, sRight], [sDown, sUp]] = tangents(source.projectionMatrix), [[tLeft, tRight], [tDown, tUp]] = tangents(target.projectionMatrix);
  const dx = (sRight - sLeft) / width, dy = (sUp - sDown) / height;
  const row = (sDown - tDown) / dy;
  const fits = Math.abs((tRight - tLeft) / dx - width) <= 0.05 && Math.abs((tUp - tDown) / dy - height) <= 0.05
    && Math.abs(row - Math.round(row)) <= 0.05;
  if (!fits) return 'the fields of view of the eyes differ in size, or by a part of a row of pixels';

  // The source: the rendered eye, grown by whole pixels to the union of both frusta and by the guard band, which lies
  // on the side that the other eye sees more of.
  const guard = guardBand > 0 ? roundedUp(ipd / dx / guardBand) : 0;
  const left = roundedUp((sLeft - tLeft) / dx) + (toLeft ? guard : 0);
  const right = roundedUp((tRight - sRight) / dx) + (toLeft ? 0 : guard);
  const below = roundedUp((sDown - tDown) / dy), above = roundedUp((tUp - sUp) / dy);
  const size = [width + left + right, height + below + above];
  if (Math.max(...size) > largest) return `the rendered eye would be larger than the largest image of this GPU (${largest} pixels)`;
  const frustum = [[sLeft - left * dx, sRight + right * dx], [sDown - below * dy, sUp + above * dy]];

  // 1 / distance = constant + slope * depth, read from the projection: three's near and far may be a frame ahead of it.
  const slope = (zeroToOne ? 1 : 2) / e[14];
  const constant = (zeroToOne ? e[10] : e[10] - 1) / e[14];
  // x_other = x + offset + scale * depth.
  const shift = (toLeft ? 1 : -1) * ipd / dx;
  let offset = (frustum[0][0] - tLeft) / dx + shift * constant;
  let scale = shift * slope;
  // Shaders count columns in the direction in which nearer surfaces lie farther along: from the right for a right eye.
  if (!toLeft) [offset, scale] = [width - size[0] - offset, -scale];
  const atNear = offset + Math.max(scale, 0), atFar = offset + Math.min(scale, 0);
  if (!(Math.min(atNear - atFar, width - atFar) <= MAX_MOVEMENT)) {
    return 'the nearest surfaces move too far between the eyes: increase near of the camera';
  }

  const maps = [[size[0], size[1]], [width, size[1]]].map((of) => of.map((n, i) => Math.ceil(n / TILE[i])));
  const rowOffset = Math.round((frustum[1][0] - tDown) / dy);
  const sense = toLeft ? 1 : -1;
  const first = toLeft ? -x - 0.5 : width + x - 0.5;
  const firstRow = y + rowOffset;
  const [across, up] = maps[1].map((n, i) => n * TILE[i]);
  return {
    size, maps, frustum, constant, slope, target, whole: [width, height],
    uniforms: {
      source_size: size,
      target_size: [width, height],
      law: [offset, scale],
      mirrored: !toLeft,
      row_offset: rowOffset,
      target_origin: [x, y],
      far_displacement: atFar,
      near_displacement: atNear,
      columns: [sense / size[0], toLeft ? 0 : 1],
      origins: [sense, first - offset],
      span_place: [sense / across, 1 / up, (first + 0.5) / across, -firstRow / up],
      rows: [1 / size[1], -firstRow / size[1]],
      first_row: firstRow,
      farthest: atFar - offset + 0.01,
      texel: [1 / size[0], 1 / size[1]],
      crop: [left - own.x, below - own.y],
    },
  };
}

/**
 * Writes a frustum into a projection matrix, of which everything else stays, and returns it.
 *
 * @param {import('three').Matrix4} matrix
 */
export function project(matrix, frustum) {
  const e = matrix.elements;
  frustum.forEach(([low, high], i) => {
    e[5 * i] = 2 / (high - low);
    e[8 + i] = (high + low) / (high - low);
  });
  return matrix;
}
