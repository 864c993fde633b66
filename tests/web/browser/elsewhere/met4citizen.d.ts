/** As much of it as the test uses: the package has no types. */

declare module '@met4citizen/talkinghead' {
  import type { Camera, Mesh, Object3D, Scene, WebGLRenderer } from 'three';

  export class TalkingHead {
    constructor(node: HTMLElement, options?: Record<string, unknown>);
    readonly morphs: Mesh[];
    readonly armature: Object3D;
    readonly renderer: WebGLRenderer;
    readonly scene: Scene;
    readonly camera: Camera;
    readonly poseTemplates: Record<string, object>;
    showAvatar(avatar: { url: string; body?: 'M' | 'F'; avatarMood?: string }): Promise<void>;
    stop(): void;
    speakAudio(speech: {
      audio: ArrayBuffer[];
      words: string[];
      wtimes: number[];
      wdurations: number[];
      visemes: string[];
      vtimes: number[];
      vdurations: number[];
    }): void;
  }
}
