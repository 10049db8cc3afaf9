// The passes: materials and targets of three's own.

import {
  AlwaysDepth, BufferGeometry, CustomBlending, DepthTexture, FloatType, Group, GLSL3, LessEqualDepth, Mesh, NearestFilter,
  NoBlending, OneFactor, OneMinusSrcAlphaFactor, OrthographicCamera, RawShaderMaterial, RedFormat, RGBAIntegerFormat, ShaderMaterial, UnsignedIntType, WebGLRenderTarget,
} from 'three';
import { guessedDepth, march, marchVertex, precisions, screenVertex, spans, tiles } from './shaders.js';

// The rendered eye, a part of the source.
const copy = /* glsl */`${precisions}
uniform sampler2D depth_map;
uniform sampler2D color_map;
uniform ivec2 crop;
layout(location=0)out vec4 color;
void main(){ivec2 pixel=ivec2(gl_FragCoord.xy)+crop;color=texelFetch(color_map,pixel,0);gl_FragDepth=texelFetch(depth_map,pixel,0).r;}`;

// Where a depth map shows what is nearer than a distance.
const near = /* glsl */`${precisions}
uniform sampler2D depth_map;
uniform vec3 law;
layout(location=0)out vec4 is;
void main(){is=vec4(law.x+law.y*textureLod(depth_map,gl_FragCoord.xy/64.0,0.0).r>law.z);}`;

// An eye that is composed of a wide level and of an inset, which shows through where it knows better. Depth between the
// wide level's pixels is that of a plane where it is one, so that what lies on surfaces stays visible there.
const composed = (fragmentShader, test) => `${fragmentShader.replace('void main()', 'void inset()')}
uniform sampler2D wide_map;
uniform sampler2D wide_depth;
uniform vec4 wide_place;
uniform vec4 inset_rect;
uniform float wide_scale;
float wide_at(ivec2 p){return texelFetch(wide_depth,clamp(p,ivec2(0),textureSize(wide_depth,0)-1),0).r;}
void main(){
bool seen=all(greaterThan(gl_FragCoord.xy,inset_rect.xy))&&all(lessThan(gl_FragCoord.xy,inset_rect.zw));
if(seen){inset();${test}}
if(!seen){
vec2 place=wide_place.xy*gl_FragCoord.xy+wide_place.zw;
color=textureLod(wide_map,place,0.0);
vec2 at=place*vec2(textureSize(wide_depth,0));
vec2 low=floor(at-0.5);
vec2 t=at-0.5-low;
ivec2 p=ivec2(low);
vec4 d=vec4(wide_at(p),wide_at(p+ivec2(1,0)),wide_at(p+ivec2(0,1)),wide_at(p+1));
vec2 rows=mix(d.xz,d.yw,t.x);
vec2 nearer=max(d.xy,d.zw);
vec2 farther=min(d.xy,d.zw);
gl_FragDepth=wide_scale*(max(nearer.x,nearer.y)-min(farther.x,farther.y))<1.0?mix(rows.x,rows.y,t.y):wide_at(ivec2(at));}}`;

/** What differs between the eyes then. */
const OF_EYES = ['wide_map', 'wide_depth', 'wide_place', 'inset_rect', 'target_origin', 'target_size'];

// A surface that comes from beyond the inset's source is a hole at its border.
const isInside = 'float column=(origins.x*gl_FragCoord.x+origins.y-law.y*gl_FragDepth+0.5)/float(source_size.x);seen=column==clamp(column,0.0,1.0);';

// Linear colour becomes what three's own materials would have written; where it covers a pixel in part, that part of it.
const output = /* glsl */`
uniform bool covered;
void main(){
picture();
float share=covered?max(color.a,1e-4):1.0;
color.rgb/=share;
#ifdef TONE_MAPPING
color.rgb=toneMapping(color.rgb);
#endif
color=linearToOutputTexel(color);
color.rgb*=share;}`;

// Without holes, nothing is discarded.
const filled = march.replaceAll('discard', '');

// Pixels that are no holes are marked by depth.
const marked = (fragmentShader) => `${fragmentShader.replace('void main()', 'void unmarked()')}
uniform float mark;
void main(){unmarked();if(mark>=0.0)gl_FragDepth=mark;}`;

const writesDepth = { depthTest: true, depthWrite: true, depthFunc: AlwaysDepth, blendSrc: OneFactor, blendDst: OneMinusSrcAlphaFactor };
const exact = { minFilter: NearestFilter, magFilter: NearestFilter };

/** A target of a texel for each tile. */
const map = () => new WebGLRenderTarget(1, 1, { ...exact, format: RGBAIntegerFormat, internalFormat: 'RGBA32UI', type: UnsignedIntType, depthBuffer: false });

/** Draws both eyes from one eye's colour and depth. */
export class Passes {
  #renderer;
  #camera = new OrthographicCamera();
  /** What all passes read. */
  #shared = {};
  #meshes = [];
  #maps = [map(), map()];
  #tiles;
  #spans;
  #guess;
  #guessed;
  #near;
  #share;
  #isLinear;

  /**
   * @param {import('three').WebGLRenderer} renderer
   * @param {boolean} linear - True if colour is linear, and tone mapped and encoded after the synthesis.
   * @param {Passes|null} [wide] - The passes of the wide level, if these are an inset's.
   */
  constructor(renderer, linear, wide = null) {
    this.#renderer = renderer;
    this.wide = wide;
    const [tileMap, spanMap] = this.#maps;
    this.#shared.tile_map = { value: tileMap.texture };
    this.#shared.span_map = { value: spanMap.texture };
    this.#tiles = this.#triangle(screenVertex, tiles);
    this.#spans = this.#triangle(screenVertex, spans);
    this.#isLinear = linear;
    this.own = this.#picture(screenVertex, copy, '');
    this.other = this.#picture(marchVertex, filled, isInside);
    /** Both eyes' pictures, which are drawn before everything else, whether that is in a group with an order or not. */
    this.eyes = new Group();
    this.eyes.matrixWorldAutoUpdate = false;
    this.eyes.renderOrder = -Infinity;
    this.eyes.add(this.own, this.other);
  }

  /**
   * Chooses the other eye's picture.
   *
   * @param {boolean} isOpen - True if holes are left open, and depth is the nearest elsewhere.
   * @param {boolean} isReversed - True if depth is 1 at the near plane, and not 0.
   */
  choose(isOpen, isReversed) {
    if (isOpen && !this.open) {
      for (const name of ['open', 'depth']) this.eyes.add(this[name] = this.#picture(marchVertex, march, isInside, marked));
      this.open.material.uniforms.mark.value = Number(isReversed);
      this.depth.material.uniforms.mark.value = -1;
      this.depth.material.colorWrite = false;
    }
    this.other.visible = !isOpen;
    if (!this.open) return;
    this.open.visible = this.depth.visible = isOpen;
  }

  /** Gives each eye its picture, by three's layers of one eye. */
  assign(rendered) {
    for (const each of this.eyes.children) each.layers.set(each === this.own ? 1 + rendered : 2 - rendered);
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
    for (const name in views.uniforms) (shared[name] ??= {}).value = views.uniforms[name];
    shared.color_map.value = color;
    shared.depth_map.value = isResolved ? this.#guessFrom(views.size, depth) : depth;
    [this.#tiles, this.#spans].forEach((mesh, i) => {
      this.#maps[i].setSize(...views.maps[i]);
      this.#draw(mesh, this.#maps[i]);
    });
  }

  /** Draws the other eye into a target of its own. */
  drawOther(target) {
    this.#draw(this.other, target);
  }

  /**
   * Has the eyes be composed of this inset and of the wide level.
   *
   * @param {Object} views - The inset's, from `levelsOf`.
   * @param {number} rendered - The rendered eye.
   * @param {WebGLRenderTarget} other - The wide level's other eye.
   */
  compose({ eyes }, rendered, other) {
    const { color_map: map, depth_map: depth } = this.wide.#shared;
    const set = ({ material }, values) => {
      for (const name in values) (material.uniforms[name] ?? {}).value = values[name];
    };
    for (const each of this.eyes.children) {
      set(each, each === this.own ? { ...eyes[rendered], wide_map: map.value, wide_depth: depth.value }
        : { ...eyes[1 - rendered], wide_map: other.texture, wide_depth: other.depthTexture });
    }
  }

  /** Has pictures, whose alpha says how much of a pixel they cover, be drawn over what is there already, where they are nearer. */
  set isCovering(is) {
    (this.#shared.covered ??= {}).value = is;
    for (const { material } of [this.own, this.other]) {
      material.blending = is ? CustomBlending : NoBlending;
      material.depthFunc = is ? LessEqualDepth : AlwaysDepth;
    }
  }

  /** Draws where the prepared source, or another one, is nearer than a distance: 64 x 64 pixels of 0 or 1. */
  drawNear({ constant, slope }, distance, depth = this.#shared.depth_map.value) {
    this.#share ??= new WebGLRenderTarget(64, 64, { depthBuffer: false });
    this.#near ??= this.#triangle(screenVertex, near, {}, ['depth_map', 'law']);
    const { uniforms } = this.#near.material;
    uniforms.depth_map.value = depth;
    uniforms.law.value = [constant, slope, 1 / distance];
    this.#draw(this.#near, this.#share);
  }

  dispose() {
    this.wide?.dispose();
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
      this.#guessed.depthTexture = new DepthTexture(1, 1, depth.type === FloatType ? FloatType : undefined);
      this.#guess = this.#triangle(screenVertex, guessedDepth, { ...writesDepth, colorWrite: false }, ['depth_map']);
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

  /** Returns an eye's picture. */
  #picture(vertexShader, fragmentShader, test, marked = (shader) => shader) {
    const { wide } = this;
    const mesh = this.#triangle(vertexShader, marked(wide ? composed(fragmentShader, test) : fragmentShader), writesDepth, ['mark', ...(wide ? OF_EYES : [])], this.#isLinear);
    // After what is put at -Infinity.
    mesh.renderOrder = -Number.MAX_VALUE;
    return mesh;
  }

  /** Returns a triangle over the viewport, without vertex buffers. It shares the uniforms that are not its own. */
  #triangle(vertexShader, fragmentShader, settings = {}, own = [], linear = false) {
    const geometry = new BufferGeometry();
    geometry.setDrawRange(0, 3);
    const Material = linear ? ShaderMaterial : RawShaderMaterial;
    if (linear) fragmentShader = fragmentShader.replace('void main()', 'void picture()') + output;
    const uniforms = {};
    for (const [, name] of (vertexShader + fragmentShader).matchAll(/uniform .*?(\w+);/g)) {
      uniforms[name] = own?.includes(name) ? { value: null } : this.#shared[name] ??= { value: null };
    }
    const mesh = new Mesh(geometry, new Material({
      name: 'yoro', vertexShader, fragmentShader, uniforms, glslVersion: GLSL3,
      blending: NoBlending, depthTest: false, depthWrite: false, ...settings,
    }));
    mesh.frustumCulled = mesh.matrixAutoUpdate = mesh.matrixWorldAutoUpdate = false;
    this.#meshes.push(mesh);
    return mesh;
  }
}
