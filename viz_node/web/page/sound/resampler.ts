// viz_node/web/page/sound/resampler.ts -- the values of a sampled sound between its samples:
// windowed-sinc interpolation.

const CROSSINGS = 32; // zero crossings of the kernel to each side
const PER_CROSSING = 512; // entries of its table; between them it is a line
const KAISER_BETA = 9; // 90 dB beyond the stop band
const CUTOFF = 0.91; // of the lower of the two Nyquist frequencies

/** Modified Bessel function of the first kind, order 0, by its series. */
function bessel0(x: number): number {
  let sum = 1;
  let term = 1;
  for (let k = 1; term > 1e-12 * sum; ++k) {
    term *= (x / (2 * k)) ** 2;
    sum += term;
  }
  return sum;
}

const sinc = (x: number) => (x === 0 ? 1 : Math.sin(Math.PI * x) / (Math.PI * x));

/** Reads a sound at any time between its samples, below the Nyquist frequency of what reads it. */
export class Resampler {
  /** Samples that are read to each side of a time. */
  readonly reach: number;
  private readonly kernel: Float64Array;
  private readonly perSample: number; // entries of the table from one sample to the next

  /**
   * @param inputHz  samples per second of the sound
   * @param outputHz  values per second that are read of it
   */
  constructor(inputHz: number, outputHz: number) {
    const stretch = Math.max(1, inputHz / outputHz); // of the kernel, where the output has the lower rate
    this.reach = Math.ceil(CROSSINGS * stretch);
    this.perSample = PER_CROSSING / stretch;
    const norm = bessel0(KAISER_BETA);
    this.kernel = Float64Array.from({ length: CROSSINGS * PER_CROSSING + 2 }, (_, i) => {
      const x = i / PER_CROSSING;
      const window = x < CROSSINGS ? bessel0(KAISER_BETA * Math.sqrt(1 - (x / CROSSINGS) ** 2)) / norm : 0;
      return (CUTOFF * sinc(CUTOFF * x) * window) / stretch;
    });
  }

  /**
   * The value `fraction` of a sample (0 to below 1) after sample `first` of a ring of samples whose length is a power of 2. The ring holds
   * samples first - reach to first + reach + 1. Cost: 2 x reach products.
   */
  valueAt(ring: Float32Array, first: number, fraction: number): number {
    const mask = ring.length - 1;
    let sum = 0;
    for (let side = 0; side < 2; ++side) {
      const sign = side === 0 ? -1 : 1;
      let place = (side === 0 ? fraction : 1 - fraction) * this.perSample;
      for (let i = 0, sample = first + side; i < this.reach; ++i, sample += sign, place += this.perSample) {
        const entry = Math.floor(place);
        const below = this.kernel[entry];
        if (below === undefined) break; // past the end of the kernel
        sum += (below + (place - entry) * ((this.kernel[entry + 1] ?? 0) - below)) * ring[sample & mask]!;
      }
    }
    return sum;
  }
}
