// The passes: materials and targets of three's own.

import * as THREE from 'three';
import { declarations, guessedDepth, march, marchVertex, screenVertex, spans, tiles } from './shaders.js';
import { isReversed } from './views.js';

// The rendered eye, a part of the source.
const copy = /* glsl */`${declarations}
uniform ivec2 crop;
layout(location=0)out vec4 color;
void main(){ivec2 pixel=ivec2(gl_FragCoord.xy)+crop;color=texelFetch(color_map,pixel,0);gl_FragDepth=texelFetch(depth_map,pixel,0).r;}`;

// Where a depth map shows what is nearer than a distance.
const near = /* glsl */`${declarations}
uniform vec3 nearness;
layout(location=0)out vec4 is;
void main(){is=vec4(nearness.x+nearness.y*textureLod(depth_map,gl_FragCoord.xy/64.,0.).r>nearness.z);}`;

/** Has a shader's `main` be called as a function of another one. */
const around = (name, fragmentShader, text) => fragmentShader.replace('main()', `${name}()`) + text;

// An eye that is composed of a wide level and of an inset, which shows through where it knows better. Depth between the
// wide level's pixels is that of a plane where it is one, so that what lies on surfaces stays visible there.
const composed = (test) => `
uniform sampler2D wide_map,wide_depth;
uniform vec4 wide_place,inset_rect;
uniform float wide_scale;
float wide_at(ivec2 p){return texelFetch(wide_depth,clamp(p,ivec2(0),textureSize(wide_depth,0)-1),0).r;}
void main(){
bool seen=all(greaterThan(gl_FragCoord.xy,inset_rect.xy))&&all(lessThan(gl_FragCoord.xy,inset_rect.zw));
if(seen){inset();${test}}
if(!seen){
vec2 place=wide_place.xy*gl_FragCoord.xy+wide_place.zw,at=place*vec2(textureSize(wide_depth,0)),low=floor(at-.5),t=at-.5-low;
color=textureLod(wide_map,place,0.);
ivec2 p=ivec2(low);
vec4 d=vec4(wide_at(p),wide_at(p+ivec2(1,0)),wide_at(p+ivec2(0,1)),wide_at(p+1));
vec2 nearer=max(d.xy,d.zw),farther=min(d.xy,d.zw),across=mix(d.xz,d.yw,t.x);
gl_FragDepth=wide_scale*(max(nearer.x,nearer.y)-min(farther.x,farther.y))<1.?mix(across.x,across.y,t.y):wide_at(ivec2(at));}}`;

// A surface that comes from beyond the inset's source is a hole at its border.
const isInside = 'float column=(origins.x*gl_FragCoord.x+origins.y-law.y*gl_FragDepth+.5)/float(source_size.x);seen=column==clamp(column,0.,1.);';

// Linear colour becomes what three's own materials would have written; where it covers a pixel in part, that part of it.
const output = /* glsl */`
uniform bool covered;
void main(){
picture();
float share=covered?max(color.a,1e-4):1.;
color.rgb/=share;
#ifdef TONE_MAPPING
color.rgb=toneMapping(color.rgb);
#endif
color=linearToOutputTexel(color);
color.rgb*=share;}`;

// Without holes, nothing is discarded.
const filled = march.replaceAll('discard', '');

// Pixels that are no holes are marked by depth.
const marked = /* glsl */`
uniform float mark;
void main(){unmarked();if(mark>=0.)gl_FragDepth=mark;}`;

const exact = { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter };

/** A target of a texel for each tile. */
const map = () => new THREE.WebGLRenderTarget(1, 1, { ...exact, format: THREE.RGBAIntegerFormat, internalFormat: 'RGBA32UI', type: THREE.UnsignedIntType, depthBuffer: false });

/** Sets uniforms. */
function assign(uniforms, values) {
  for (const name in values) uniforms[name] = { value: values[name] };
}

/**
 * Makes what draws both eyes from one eye's colour and depth.
 *
 * @param {THREE.WebGLRenderer} renderer
 * @param {boolean} isLinear - True if colour is linear, and tone mapped and encoded after the synthesis.
 * @param {Object|null} [wide] - The passes of the wide level, if these are an inset's.
 */
export function createPasses(renderer, isLinear, wide = null) {
  const camera = new THREE.OrthographicCamera();
  const geometry = new THREE.BufferGeometry();
  geometry.setDrawRange(0, 3);
  const maps = [map(), map()];
  /** What all passes read, unless they have a uniform of their own. */
  const shared = {};
  assign(shared, { tile_map: maps[0].texture, span_map: maps[1].texture, mark: -1 });
  const materials = [];

  /** Returns a triangle over the viewport, without vertex buffers. */
  const triangle = (vertexShader, fragmentShader, Material = THREE.RawShaderMaterial) => {
    const material = new Material({
      name: 'yoro', vertexShader, fragmentShader, uniforms: Object.create(shared), glslVersion: THREE.GLSL3,
      depthFunc: THREE.AlwaysDepth, blending: THREE.NoBlending, blendSrc: THREE.OneFactor, blendDst: THREE.OneMinusSrcAlphaFactor,
    });
    materials.push(material);
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = mesh.matrixAutoUpdate = mesh.matrixWorldAutoUpdate = false;
    return mesh;
  };

  /** Returns an eye's picture. */
  const picture = (vertexShader, fragmentShader, test) => {
    let shader = fragmentShader;
    if (wide) shader = around('inset', shader, composed(test));
    shader = around('unmarked', shader, marked);
    if (isLinear) shader = around('picture', shader, output);
    const mesh = triangle(vertexShader, shader, isLinear ? THREE.ShaderMaterial : undefined);
    // After what is put at -Infinity.
    mesh.renderOrder = -Number.MAX_VALUE;
    return mesh;
  };

  const draw = (mesh, target) => {
    renderer.setRenderTarget(target);
    renderer.render(mesh, camera);
  };

  const searches = [tiles, spans].map((shader) => triangle(screenVertex, shader));
  const guess = triangle(screenVertex, guessedDepth);
  /** Each pixel's guessed nearest depth. */
  const guessed = new THREE.WebGLRenderTarget(1, 1, { ...exact, format: THREE.RedFormat, depthTexture: new THREE.DepthTexture(1, 1) });
  const nearer = triangle(screenVertex, near), share = new THREE.WebGLRenderTarget(64, 64, { depthBuffer: false });
  const own = picture(screenVertex, copy, ''), other = picture(marchVertex, filled, isInside);
  // The other eye with open holes, and the nearest depth elsewhere; then its depth.
  const [open, depth] = [0, 1].map(() => picture(marchVertex, march, isInside));
  assign(open.material.uniforms, { mark: Number(isReversed(renderer)) });
  guess.material.colorWrite = depth.material.colorWrite = false;
  /** Both eyes' pictures, which are drawn before everything else, whether that is in a group with an order or not. */
  const eyes = new THREE.Group();
  eyes.matrixWorldAutoUpdate = false;
  eyes.renderOrder = -Infinity;
  eyes.add(own, other, open, depth);

  const passes = {
    wide, own, open, eyes,
    /** The colour and the nearest depth that were prepared. */
    source: null,

    /**
     * Chooses the pictures of the eyes, by three's layers of one eye.
     *
     * @param {number} rendered - The rendered eye.
     * @param {boolean} [isCovering] - True if pictures, whose alpha says how much of a pixel they cover, are drawn over
     * what is there already, where they are nearer.
     * @param {boolean} [isOpen] - True if holes are left open.
     */
    choose(rendered, isCovering = false, isOpen = false) {
      assign(shared, { covered: isCovering });
      other.visible = !isOpen;
      open.visible = depth.visible = isOpen;
      for (const each of eyes.children) {
        each.layers.set(each === own ? 1 + rendered : 2 - rendered);
        each.material.blending = isCovering ? THREE.CustomBlending : THREE.NoBlending;
        each.material.depthFunc = isCovering ? THREE.LessEqualDepth : THREE.AlwaysDepth;
      }
    },

    /**
     * Finds what lies where.
     *
     * @param {Object} views - What `viewsOf` returned.
     * @param {Object} source - `texture`, `depthTexture`, and `samples`: the number of those that depth is one of.
     */
    prepare({ uniforms, size, maps: sizes }, { texture, depthTexture, samples }) {
      assign(shared, { ...uniforms, color_map: texture, depth_map: depthTexture });
      if (samples > 0) {
        guessed.depthTexture.type = depthTexture.type === THREE.FloatType ? THREE.FloatType : THREE.UnsignedIntType;
        guessed.setSize(...size);
        draw(guess, guessed);
        shared.depth_map.value = guessed.depthTexture;
      }
      passes.source = { texture, depthTexture: shared.depth_map.value };
      searches.forEach((mesh, i) => {
        maps[i].setSize(...sizes[i]);
        draw(mesh, maps[i]);
      });
    },

    /** Draws the other eye into a target of its own. */
    drawOther(target) {
      draw(other, target);
    },

    /**
     * Has the eyes be composed of this inset and of the wide level.
     *
     * @param {Object} views - The inset's, from `levelsOf`.
     * @param {number} rendered - The rendered eye.
     * @param {THREE.WebGLRenderTarget} image - The wide level's other eye.
     */
    compose(views, rendered, image) {
      for (const each of eyes.children) {
        const [eye, { texture, depthTexture }] = each === own ? [rendered, wide.source] : [1 - rendered, image];
        assign(each.material.uniforms, { ...views.eyes[eye], wide_map: texture, wide_depth: depthTexture });
      }
    },

    /** Draws where the prepared source, or another one, is nearer than a distance: 64 x 64 pixels of 0 or 1. */
    drawNear({ constant, slope }, distance, { depthTexture } = passes.source) {
      assign(nearer.material.uniforms, { depth_map: depthTexture, nearness: [constant, slope, 1 / distance] });
      draw(nearer, share);
    },

    dispose() {
      for (const each of [wide, geometry, guessed, share, ...maps, ...materials]) each?.dispose();
    },
  };
  return passes;
}
