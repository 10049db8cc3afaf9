// What the type checker does not know: the built module, and interfaces that only some browsers have.

declare module '*yoro_web.js' {
  class Built { constructor(...all: any[]); [member: string]: any; static [member: string]: any }
  export default function init(options: { module_or_path: WebAssembly.Module }): Promise<unknown>;
  export function builtinScenes(): string;
  export class Page extends Built { static defaultChoices(): string }
  export class Bench extends Built {}
  export class Phone extends Built {
    static viewerFault(viewer: string): string | undefined;
    static viewerName(viewer: string): string;
    static readCode(rgba: Uint8Array, width: number): string | undefined;
  }
  export class Why extends Built {}
  export class StreamReport extends Built {}
  export class Headset extends Built { static planes(): Float32Array }
}
declare module '*yoro_web_video.js' {
  class Built { constructor(...all: any[]); [member: string]: any }
  export default function init(options: { module_or_path: URL }): Promise<unknown>;
  export class Video extends Built {}
}
declare const XRWebGLLayer: any;
declare class FileReaderSync { readAsArrayBuffer(blob: Blob): ArrayBuffer }
interface Navigator { xr?: any; userAgentData?: { platform: string } }
interface ScreenOrientation { lock(orientation: string): Promise<void> }
interface WebGL2RenderingContext { makeXRCompatible(): Promise<void> }
