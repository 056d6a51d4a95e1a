// viz_node/web/page/sound/mix.ts -- the sounds of a scene as one.
import type { Sound } from '../protocol.ts';
import type { SoundBlock } from './sound_stream.ts';

/** The sum of all sounds of a block, each divided by its full scale, so that 1 is the loudest that one sound alone should be. */
export function mixed({ firstStep, stepRateHz, soundCount, stepCount, values }: Sound, fullScales: number[]): SoundBlock {
  const samples = new Float32Array(stepCount);
  for (let step = 0; step < stepCount; ++step) {
    for (let sound = 0; sound < soundCount; ++sound) samples[step]! += values[step * soundCount + sound]! / (fullScales[sound] ?? 1);
  }
  return { firstStep, rateHz: stepRateHz, samples };
}
