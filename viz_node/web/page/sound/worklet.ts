// viz_node/web/page/sound/worklet.ts -- the part of the sound that runs in the audio thread of the
// browser: a file of its own, sound.js.
import { SoundStream, type SoundBlock } from './sound_stream.ts';

// Names of AudioWorkletGlobalScope, which the compiler's libraries leave out.
declare const sampleRate: number;
declare const currentTime: number;
declare class AudioWorkletProcessor {
  readonly port: MessagePort;
}
declare function registerProcessor(name: string, processor: new () => AudioWorkletProcessor): void;

const FIGURES_PERIOD_S = 0.25;

class CordisSound extends AudioWorkletProcessor {
  private readonly stream = new SoundStream(sampleRate);
  private reportedS = 0;

  constructor() {
    super();
    this.port.onmessage = ({ data }: MessageEvent<SoundBlock>) => this.stream.push(data, currentTime);
  }

  process(_inputs: Float32Array[][], outputs: Float32Array[][]): boolean {
    this.stream.read(outputs[0]![0]!, currentTime);
    if (currentTime - this.reportedS >= FIGURES_PERIOD_S) {
      this.reportedS = currentTime;
      this.port.postMessage(this.stream.figures);
    }
    return true;
  }
}

registerProcessor('cordis-sound', CordisSound);
