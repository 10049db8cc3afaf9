// The passes: materials and targets of three's own.

import {
  AlwaysDepth, BufferGeometry, DepthTexture, FloatType, Group, GLSL3, Mesh, NearestFilter, NoBlending, OrthographicCamera,
  RawShaderMaterial, RedFormat, RGBAIntegerFormat, ShaderMaterial, UnsignedIntType, WebGLRenderTarget,
} from 'three';
import { guessedDepth, march, marchVertex, nearFraction, precisions, screenVertex, spans, tiles } from './shaders.js';

// The rendered eye, a part of the source.
const copy = /* glsl */`${precisions}
uniform sampler2D depth_map;
uniform sampler2D color_map;
uniform ivec2 crop;
layout(location=0)out vec4 color;
void main(){ivec2 pixel=ivec2(gl_FragCoord.xy)+crop;color=texelFetch(color_map,pixel,0);gl_FragDepth=texelFetch(depth_map,pixel,0).r;}`;

// Linear colour becomes what three's own materials would have written.
const output = /* glsl */`
void main(){
picture();
#ifdef TONE_MAPPING
color.rgb=toneMapping(color.rgb);
#endif
color=linearToOutputTexel(color);}`;

const writesDepth = { depthTest: true, depthWrite: true, depthFunc: AlwaysDepth };
const exact = { minFilter: NearestFilter, magFilter: NearestFilter, generateMipmaps: false };

/** A target of a texel for each tile. */
const map = () => new WebGLRenderTarget(1, 1, { ...exact, format: RGBAIntegerFormat, internalFormat: 'RGBA32UI', type: UnsignedIntType, depthBuffer: false });

/** Draws both eyes from one eye's colour and depth. */
export class Passes {
  #renderer;
  #camera = new OrthographicCamera();
  /** What all passes read. */
  #shared = { depth_map: { value: null }, color_map: { value: null }, tile_map: { value: null }, span_map: { value: null } };
  #meshes = [];
  #maps = [map(), map()];
  #tiles;
  #spans;
  #guess;
  #guessed;
  #near;
  #share;

  /**
   * @param {import('three').WebGLRenderer} renderer
   * @param {boolean} linear - True if colour is linear, and tone mapped and encoded after the synthesis.
   */
  constructor(renderer, linear) {
    this.#renderer = renderer;
    const [tileMap, spanMap] = this.#maps;
    this.#shared.tile_map.value = tileMap.texture;
    this.#shared.span_map.value = spanMap.texture;
    for (const name of ['source_size', 'target_size', 'law', 'mirrored', 'row_offset', 'target_origin', 'far_displacement', 'near_displacement', 'columns', 'origins', 'span_place', 'rows', 'first_row', 'farthest', 'source_origin', 'texel', 'crop']) this.#shared[name] = { value: null };
    this.#tiles = this.#triangle(screenVertex, tiles);
    this.#spans = this.#triangle(screenVertex, spans);
    this.own = this.#triangle(screenVertex, copy, writesDepth, {}, linear);
    this.other = this.#triangle(marchVertex, march, writesDepth, {}, linear);
    /** Both eyes' pictures, which are drawn before everything else, whether that is in a group with an order or not. */
    this.eyes = new Group();
    this.eyes.matrixWorldAutoUpdate = false;
    this.eyes.renderOrder = this.own.renderOrder = this.other.renderOrder = -Infinity;
    this.eyes.add(this.own, this.other);
  }

  /**
   * Finds what lies where.
   *
   * @param {Object} views - What `viewsOf` returned.
   * @param {import('three').Texture} color
   * @param {import('three').DepthTexture} depth
   * @param {boolean} isResolved - True if depth is that of one of several samples.
   */
  prepare(views, color, depth, isResolved) {
    const shared = this.#shared;
    for (const name in views.uniforms) shared[name].value = views.uniforms[name];
    shared.color_map.value = color;
    shared.depth_map.value = isResolved ? this.#guessFrom(views.size, depth) : depth;
    [this.#tiles, this.#spans].forEach((mesh, i) => {
      this.#maps[i].setSize(...views.maps[i]);
      this.#draw(mesh, this.#maps[i]);
    });
  }

  /** Draws how much of the prepared source, or of another one of its eye, is nearer than a depth: 16 x 16 shares. */
  drawNear(views, nearDepth, size = views.size, depth = this.#shared.depth_map.value) {
    const value = (of) => ({ value: of });
    this.#share ??= new WebGLRenderTarget(16, 16, { depthBuffer: false, generateMipmaps: false });
    this.#near ??= this.#triangle(screenVertex, nearFraction, {}, { depth_map: value(null), origin: value([0, 0]), size: value(null), near_depth: value(0), reversed: value(false) });
    const { uniforms } = this.#near.material;
    uniforms.depth_map.value = depth;
    uniforms.size.value = size;
    uniforms.near_depth.value = nearDepth;
    uniforms.reversed.value = views.slope > 0;
    this.#draw(this.#near, this.#share);
  }

  dispose() {
    for (const target of [...this.#maps, this.#guessed, this.#share]) {
      target?.depthTexture?.dispose();
      target?.dispose();
    }
    for (const { geometry, material } of this.#meshes) {
      geometry.dispose();
      material.dispose();
    }
  }

  /** Returns a texture of each pixel's guessed nearest depth. */
  #guessFrom(size, depth) {
    if (!this.#guessed) {
      this.#guessed = new WebGLRenderTarget(1, 1, { ...exact, format: RedFormat });
      this.#guessed.depthTexture = new DepthTexture(1, 1, depth.type === FloatType ? FloatType : UnsignedIntType);
      this.#guess = this.#triangle(screenVertex, guessedDepth, { ...writesDepth, colorWrite: false }, { depth_map: { value: null } });
    }
    this.#guessed.setSize(...size);
    this.#guess.material.uniforms.depth_map.value = depth;
    this.#draw(this.#guess, this.#guessed);
    return this.#guessed.depthTexture;
  }

  #draw(mesh, target) {
    this.#renderer.setRenderTarget(target);
    this.#renderer.render(mesh, this.#camera);
  }

  /** Returns a triangle over the viewport, without vertex buffers. */
  #triangle(vertexShader, fragmentShader, settings = {}, own = {}, linear = false) {
    const geometry = new BufferGeometry();
    geometry.setDrawRange(0, 3);
    const Material = linear ? ShaderMaterial : RawShaderMaterial;
    if (linear) fragmentShader = fragmentShader.replace('void main()', 'void picture()') + output;
    const mesh = new Mesh(geometry, new Material({
      name: 'yoro', vertexShader, fragmentShader, uniforms: { ...this.#shared, ...own }, glslVersion: GLSL3,
      blending: NoBlending, depthTest: false, depthWrite: false, ...settings,
    }));
    mesh.frustumCulled = mesh.matrixAutoUpdate = mesh.matrixWorldAutoUpdate = false;
    this.#meshes.push(mesh);
    return mesh;
  }
}
