// viz_node/web/page/sound/sound_panel.ts -- the button that lets the scene be heard, how loud, and
// how well its sound arrives.
import type { Connection } from '../connection.ts';
import type { Description, Sound } from '../protocol.ts';
import { count } from '../format.ts';
import { setText } from '../rows.ts';
import { mixed } from './mix.ts';
import type { SoundFigures } from './sound_stream.ts';

const RAMP_S = 0.02; // of the volume: no click when it changes
const FFT_SIZE = 32768;
const INSECURE = 'Browsers play sound on localhost or over https only. From here: ssh -L 8080:localhost:8080, then http://localhost:8080';

/** What plays, once a person has asked for it. */
interface Output {
  context: AudioContext;
  source: AudioWorkletNode;
  analyser: AnalyserNode; // for tests and for the curious
  volume: GainNode;
}

/** Levels of a sound [dB], one each `binHz`: of the last `lengthS` before `nowS`, by the clock of the sound card. */
export interface Spectrum {
  binHz: number;
  levels: number[];
  nowS: number;
  lengthS: number;
}

export class SoundPanel {
  isOn = false;
  figures: SoundFigures | null = null;

  private readonly panel = document.querySelector<HTMLElement>('#sound')!;
  private readonly button = document.querySelector<HTMLButtonElement>('#sound-on')!;
  private readonly slider = document.querySelector<HTMLInputElement>('#volume')!;
  private readonly text = document.querySelector<HTMLElement>('#sound-text')!;
  private output: Output | null = null;
  private fullScales: number[] = [];

  constructor(
    private readonly connection: Connection,
    private readonly failed: (error: unknown) => void,
  ) {
    if (!window.isSecureContext) this.button.title = INSECURE;
    this.button.addEventListener('click', () => {
      this.button.blur();
      this.toggle().catch((error: unknown) => this.fail(error));
    });
    this.slider.addEventListener('input', () => this.setVolume());
    this.slider.addEventListener('change', () => this.slider.blur());
  }

  describe({ signals }: Description): void {
    const sounds = signals.filter(({ sound }) => sound);
    this.fullScales = sounds.map(({ full_scale }) => full_scale ?? 1);
    this.panel.hidden = sounds.length === 0;
    this.button.title = window.isSecureContext ? `Hear ${sounds.map(({ name }) => name).join(', ')}` : INSECURE;
  }

  /** A new connection is silent until it is asked. */
  reopen(): void {
    if (this.isOn) this.connection.listen(true);
  }

  take(sound: Sound): void {
    if (!this.isOn || this.output === null) return;
    const block = mixed(sound, this.fullScales);
    this.output.source.port.postMessage(block, [block.samples.buffer]);
  }

  /** The spectrum of what is played, before the volume; null while nothing is. */
  spectrum(): Spectrum | null {
    if (this.output === null) return null;
    const { analyser, context } = this.output;
    const levels = new Float32Array(analyser.frequencyBinCount);
    analyser.getFloatFrequencyData(levels);
    return { binHz: context.sampleRate / FFT_SIZE, levels: [...levels], nowS: context.currentTime, lengthS: FFT_SIZE / context.sampleRate };
  }

  private async toggle(): Promise<void> {
    if (!window.isSecureContext) return this.say(INSECURE);
    this.isOn = !this.isOn;
    this.button.classList.toggle('on', this.isOn);
    this.slider.hidden = !this.isOn;
    this.say(this.isOn ? 'starting' : '');
    if (this.isOn) {
      this.output ??= await this.build();
      await this.output.context.resume();
    }
    this.connection.listen(this.isOn);
    this.setVolume();
  }

  private async build(): Promise<Output> {
    const context = new AudioContext({ latencyHint: 'interactive' });
    await context.audioWorklet.addModule('/sound.js');
    const source = new AudioWorkletNode(context, 'cordis-sound', { numberOfInputs: 0, outputChannelCount: [1] });
    const analyser = new AnalyserNode(context, { fftSize: FFT_SIZE, smoothingTimeConstant: 0 });
    const volume = new GainNode(context, { gain: 0 });
    source.connect(analyser).connect(volume).connect(context.destination);
    source.port.onmessage = ({ data }: MessageEvent<SoundFigures>) => this.report(data);
    source.onprocessorerror = () => this.fail(new Error('the audio thread of the browser failed'));
    return { context, source, analyser, volume };
  }

  /** As an ear measures: half way is a quarter of the amplitude. */
  private setVolume(): void {
    const share = this.isOn ? Number(this.slider.value) / 100 : 0;
    const { volume, context } = this.output ?? {};
    if (context !== undefined) volume?.gain.setTargetAtTime(share ** 2, context.currentTime, RAMP_S);
  }

  private report(figures: SoundFigures): void {
    this.figures = figures;
    if (!this.isOn) return;
    const { state, bufferS, targetS, dropouts, lostS, ratio, sceneRate } = figures;
    const missed = `${count(dropouts)} ${dropouts === 1 ? 'dropout' : 'dropouts'}`;
    if (state === 'off rate') this.say(`silent: the scene runs at ×${sceneRate.toFixed(2)}`);
    else if (state === 'playing') this.say(`${(1000 * (bufferS + this.outputS)).toFixed(0)} ms, ${missed}`);
    else this.say(`${state === 'paused' ? 'no sound comes' : 'waiting'}, ${missed}`);
    this.text.title = [
      `buffer ${(1000 * bufferS).toFixed(0)} ms of ${(1000 * targetS).toFixed(0)} ms`,
      `clock of the scene followed by ${(1e6 * (ratio - 1)).toFixed(0)} ppm`,
      `${(1000 * lostS).toFixed(0)} ms never came`,
    ].join(', ');
  }

  /** What the browser and the sound card add to the buffer, where the browser says so [s]. */
  private get outputS(): number {
    const { baseLatency = 0, outputLatency = 0 } = this.output?.context ?? {};
    return Math.max(baseLatency, outputLatency);
  }

  private fail(error: unknown): void {
    this.isOn = false;
    this.connection.listen(false);
    this.button.classList.remove('on');
    this.slider.hidden = true;
    this.say('the browser plays no sound');
    this.failed(error);
  }

  private say(text: string): void {
    setText(this.text, text);
  }
}
