// The passes: materials and targets of three's own.

import {
  AlwaysDepth, BufferGeometry, DepthTexture, Group, GLSL3, Mesh, NearestFilter, NoBlending, OrthographicCamera,
  RawShaderMaterial, RedFormat, RGBAIntegerFormat, ShaderMaterial, UnsignedIntType, WebGLRenderTarget,
} from 'three';
import { guessedDepth, march, marchVertex, nearFraction, screenVertex, spans, tiles } from './shaders.js';

// The rendered eye, a part of the source.
const copy = /* glsl */`precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D color_map;
uniform sampler2D depth_map;
uniform ivec2 crop;
layout(location = 0) out vec4 color;
void main() {
ivec2 pixel = ivec2(gl_FragCoord.xy) + crop;
color = texelFetch(color_map, pixel, 0);
gl_FragDepth = texelFetch(depth_map, pixel, 0).r;
}`;

// Linear colour becomes what three's own materials would have written.
const output = /* glsl */`
void main() {
picture();
#ifdef TONE_MAPPING
color.rgb = toneMapping(color.rgb);
#endif
color = linearToOutputTexel(color);
}`;

const NAMES = [
  'source_size', 'target_size', 'law', 'mirrored', 'row_offset', 'target_origin', 'far_displacement', 'near_displacement',
  'columns', 'origins', 'span_place', 'rows', 'first_row', 'farthest', 'source_origin', 'texel', 'crop', 'depth_map',
  'color_map', 'tile_map', 'span_map',
];
/** Sides of the picture of the near part. */
const GRID = 16;

const writesDepth = { depthTest: true, depthWrite: true, depthFunc: AlwaysDepth };

/** A triangle over the viewport, without vertex buffers. */
function triangle(name, vertexShader, fragmentShader, uniforms, settings = {}, linear = false) {
  const geometry = new BufferGeometry();
  geometry.setDrawRange(0, 3);
  const Material = linear ? ShaderMaterial : RawShaderMaterial;
  if (linear) fragmentShader = fragmentShader.replace('void main()', 'void picture()') + output;
  const mesh = new Mesh(geometry, new Material({
    name, vertexShader, fragmentShader, uniforms, glslVersion: GLSL3, blending: NoBlending, depthTest: false,
    depthWrite: false, ...settings,
  }));
  mesh.frustumCulled = mesh.matrixAutoUpdate = mesh.matrixWorldAutoUpdate = false;
  return mesh;
}

/** A target of a texel for each tile. */
const map = () => new WebGLRenderTarget(1, 1, {
  format: RGBAIntegerFormat, internalFormat: 'RGBA32UI', type: UnsignedIntType, minFilter: NearestFilter,
  magFilter: NearestFilter, depthBuffer: false, generateMipmaps: false,
});

/** Draws both eyes from one eye's colour and depth. */
export class Passes {
  /**
   * @param {import('three').WebGLRenderer} renderer
   * @param {boolean} linear - True if colour is linear, and tone mapped and encoded after the synthesis.
   */
  constructor(renderer, linear) {
    this.renderer = renderer;
    this.uniforms = Object.fromEntries(NAMES.map((name) => [name, { value: null }]));
    // The guess reads the depth that it replaces for all other passes.
    this.resolved = { ...this.uniforms, depth_map: { value: null } };
    this.near = { ...this.uniforms, origin: { value: [0, 0] }, size: this.uniforms.source_size, near_depth: { value: 0 }, reversed: { value: false } };
    this.maps = [map(), map()];
    this.uniforms.tile_map.value = this.maps[0].texture;
    this.uniforms.span_map.value = this.maps[1].texture;
    this.tiles = triangle('yoro tiles', screenVertex, tiles, this.uniforms);
    this.spans = triangle('yoro spans', screenVertex, spans, this.uniforms);
    this.own = triangle('yoro own', screenVertex, copy, this.uniforms, writesDepth, linear);
    this.other = triangle('yoro march', marchVertex, march, this.uniforms, writesDepth, linear);
    /** Both eyes' pictures; never a child of the user's scene for longer than a draw. */
    this.eyes = new Group();
    this.eyes.matrixWorldAutoUpdate = false;
    this.eyes.renderOrder = -Infinity;
    this.eyes.add(this.own, this.other);
    // Before everything else, whether in a group with an order or not.
    this.own.renderOrder = this.other.renderOrder = -Infinity;
    this.camera = new OrthographicCamera();
  }

  /**
   * Finds what lies where.
   *
   * @param {Object} views - What `viewsOf` returned.
   * @param {{color: import('three').Texture, depth: import('three').Texture, guess: boolean}} source
   */
  prepare(views, { color, depth, guess }) {
    const { uniforms } = this;
    for (const name in views.uniforms) uniforms[name].value = views.uniforms[name];
    uniforms.color_map.value = color;
    uniforms.depth_map.value = guess ? this.guess(views.size, depth) : depth;
    [this.tiles, this.spans].forEach((mesh, i) => {
      this.maps[i].setSize(...views.maps[i]);
      this.draw(mesh, this.maps[i]);
    });
  }

  /** Returns a texture of each pixel's guessed nearest depth. */
  guess(size, depth) {
    if (!this.guessed) {
      this.guessed = new WebGLRenderTarget(1, 1, { format: RedFormat, minFilter: NearestFilter, magFilter: NearestFilter, generateMipmaps: false });
      this.guessed.depthTexture = new DepthTexture(1, 1, depth.type);
      this.guessing = triangle('yoro guessed depth', screenVertex, guessedDepth, this.resolved, { ...writesDepth, colorWrite: false });
    }
    this.guessed.setSize(...size);
    this.resolved.depth_map.value = depth;
    this.draw(this.guessing, this.guessed);
    return this.guessed.depthTexture;
  }

  /**
   * Draws the share of a source that is nearer than a depth, and returns the target with 16 x 16 partial shares.
   */
  nearPart(size, depth, nearDepth, reversed) {
    if (!this.share) {
      this.share = new WebGLRenderTarget(GRID, GRID, { depthBuffer: false, generateMipmaps: false });
      this.sharing = triangle('yoro near fraction', screenVertex, nearFraction, this.near);
    }
    this.uniforms.source_size.value = size;
    this.uniforms.depth_map.value = depth;
    this.near.near_depth.value = nearDepth;
    this.near.reversed.value = reversed;
    this.draw(this.sharing, this.share);
    return this.share;
  }

  draw(mesh, target) {
    this.renderer.setRenderTarget(target);
    this.renderer.render(mesh, this.camera);
  }

  dispose() {
    for (const target of [...this.maps, this.guessed, this.share]) {
      target?.depthTexture?.dispose();
      target?.dispose();
    }
    for (const mesh of [this.tiles, this.spans, this.own, this.other, this.guessing, this.sharing]) {
      mesh?.geometry.dispose();
      mesh?.material.dispose();
    }
  }
}
