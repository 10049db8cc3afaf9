import type { ArrayCamera, Camera, DepthTexture, Object3D, PerspectiveCamera, StereoCamera, Texture, Vector3, WebGLRenderer, WebGLRenderTarget } from 'three';

export type Way = 'synthesized' | 'rendered';

/** Ways of `auto`: with holes filled although `holes` is `'rendered'`; with that, and without samples. */
export type MeasuredWay = Way | 'filled' | 'aliased';

export type Holes = 'filled' | 'rendered';

export type Foveation = 'off' | 'low' | 'medium' | 'high';

export interface StereoSynthesisOptions {
  /** Default: `'auto'`. */
  mode?: 'auto' | Way;
  /** The eye that is rendered. Default: `'right'`. */
  dominantEye?: 'left' | 'right';
  /** Default: `'filled'`. */
  holes?: Holes;
  /** Samples of the rendered eye's anti-aliasing. Default: 4 if the renderer has `antialias: true`, otherwise 0. */
  samples?: number;
  /** From this distance in metres on, nothing is missing at the other eye's outer border; 0 for no band. Default: 1. */
  guardBand?: number;
  /** With `auto`, both eyes are rendered while half of the view is nearer than this, in metres. Default: 0.4. */
  nearLimit?: number;
  /** Default: null. */
  foveation?: Foveation | null;
  /** The eyes' distance on a canvas in metres. Headsets have their own. Default: 0.064. */
  eyeSeparation?: number;
}

export interface Choice {
  way: MeasuredWay;
  reason: 'unmeasured' | 'cheaper' | 'similar' | 'holds the rate' | 'both hold the rate' | 'incomparable';
  /** Milliseconds of a frame of each way, if they could be compared. */
  costs: (Record<Way, number> & Partial<Record<MeasuredWay, number>>) | null;
}

/** Renders a scene for one eye, and synthesizes the other eye from its colour and depth. */
export class StereoSynthesis {
  constructor(renderer: WebGLRenderer, options?: StereoSynthesisOptions);
  readonly renderer: WebGLRenderer;
  /** `'rendered'`: three's own two eyes; `'auto'`: the cheapest way, or with rendered holes the best one that holds the display's rate. */
  mode: 'auto' | Way;
  dominantEye: 'left' | 'right';
  /** What the rendered eye does not see: filled with what lies beside it, or opaque objects drawn once more. */
  holes: Holes;
  samples: number;
  guardBand: number;
  nearLimit: number;
  /** How much fewer pixels there are where the eyes do not look; null: what three asks the headset for, `'off'` on a canvas. */
  foveation: Foveation | null;
  /** Where the eyes look, as a direction in the world; null for straight ahead. */
  gaze: Vector3 | null;
  /** A mask of layers whose objects are drawn for both eyes, after the synthesis, such as hands. */
  bothEyes: number;
  /** How the last frame was made; null before the first one. */
  readonly way: Way | null;
  /** Why both eyes had to be rendered in the last frame, in a sentence, or null. */
  readonly trouble: string | null;
  /** The last choice of `auto`. */
  readonly choice: Choice;
  /** The eyes on a canvas: `eyeSep`, `aspect`. */
  readonly stereoCamera: StereoCamera;
  /** Renders both eyes: call it in place of `renderer.render`. */
  render(scene: Object3D, camera: Camera): void;
  /** Has `renderer.render` render both eyes. Returns a function that undoes it. */
  install(): () => void;
  /** Has `auto` measure again. */
  sceneChanged(): void;
  /** Both eyes' cameras, with viewports. */
  eyes(camera: Camera): ArrayCamera;
  /** The view to render for `synthesize`, with its size in pixels; null if that cannot be (`trouble`). */
  view(eyes: ArrayCamera): { camera: PerspectiveCamera; width: number; height: number } | null;
  /** Draws both eyes from textures of `view`. Returns false, and draws nothing, if that cannot be (`trouble`). */
  synthesize(source: { color: Texture; depth: DepthTexture; samples?: number }, eyes: ArrayCamera, target?: WebGLRenderTarget | null): boolean;
  /** Frees what this has on the GPU. */
  dispose(): void;
}
