// Colour maps that do not rely on a difference of red and green, and numbers with SI prefixes.

type Rgb = [number, number, number];

// Samples of viridis and cividis (Smith and van der Walt 2015; Nunez et al. 2018), evenly spaced.
const SAMPLES: Record<string, Rgb[]> = {
  viridis: [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129],
            [92, 200, 99], [170, 220, 50], [253, 231, 37]],
  cividis: [[0, 32, 77], [0, 51, 111], [57, 72, 107], [87, 92, 109], [112, 113, 115], [138, 134, 120],
            [166, 157, 117], [196, 181, 108], [255, 234, 70]],
};
const STEPS = 256;

export const MAPS = Object.keys(SAMPLES);

/** A colour map of STEPS colours, (3 STEPS,) red, green, blue in linear colour space, which shading uses. */
export function linearTable(map: string): Float32Array {
  const samples = SAMPLES[map];
  const table = new Float32Array(3 * STEPS);
  for (let i = 0; i < STEPS; ++i) {
    const x = i / (STEPS - 1) * (samples.length - 1);
    const k = Math.min(Math.floor(x), samples.length - 2);
    for (let c = 0; c < 3; ++c) {
      const value = (samples[k][c] * (1 - x + k) + samples[k + 1][c] * (x - k)) / 255;
      table[3 * i + c] = value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
    }
  }
  return table;
}

/** Writes the colours of values (n,) into `colours` (3 n,). The map extends from low to high. */
export function paint(values: Float32Array, low: number, high: number, table: Float32Array,
                      colours: Float32Array): void {
  const scale = high > low ? (STEPS - 1) / (high - low) : 0;
  for (let i = 0; i < values.length; ++i) {
    const x = (values[i] - low) * scale;
    const k = 3 * (x > 0 ? x < STEPS - 1 ? x | 0 : STEPS - 1 : 0);
    colours[3 * i] = table[k];
    colours[3 * i + 1] = table[k + 1];
    colours[3 * i + 2] = table[k + 2];
  }
}

export function gradient(map: string): string {
  return `linear-gradient(to top, ${SAMPLES[map].map((c) => `rgb(${c.join(',')})`).join(', ')})`;
}

const PREFIXES: [number, string][] = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, '\u00b5'],
                                      [1e-9, 'n'], [1e-12, 'p']];

/** Parses a number written by told(): "12.3 mm" is 0.0123. NaN if the text is no number. */
export function read(text: string): number {
  const found = /^\s*([-+\d.eE]+)\s*([GMkm\u00b5unp]?)/.exec(text);
  if (!found) return NaN;
  const named = found[2] === 'u' ? '\u00b5' : found[2];
  return Number(found[1]) * (PREFIXES.find(([, prefix]) => prefix === named)?.[0] ?? 1);
}

function prefix(size: number): [number, string] {
  return PREFIXES.find(([s]) => size >= 0.9995 * s) ?? PREFIXES[PREFIXES.length - 1];
}

/** Labels of equidistant values from high to low, with one prefix and enough decimals to distinguish them. */
export function ticks(low: number, high: number, count: number, unit: string): string[] {
  if (!(high > low)) return [...Array(count - 1).fill(''), told(low, unit)];
  const [scale, name] = unit === '' ? [1, ''] : prefix(Math.max(Math.abs(low), Math.abs(high)));
  const decimals = Math.min(Math.max(2 - Math.floor(Math.log10((high - low) / scale)), 0), 8);
  return Array.from({length: count}, (_, k) =>
    `${((high - (high - low) * k / (count - 1)) / scale).toFixed(decimals)} ${name}${unit.replace('^3', '\u00b3')}`.trim());
}

export const ROUNDING = 1e-12;  // in the base unit: what is smaller, such as the displacement of a joint at its stop, is shown as zero

/** Formats a number with its unit and an SI prefix: 0.0123 m is "12.3 mm". */
export function told(value: number, unit: string, digits = 3): string {
  if (!Number.isFinite(value)) return '-';
  if (unit.startsWith('m^3')) return told(1e3 * value, unit.replace('m^3', 'l'), digits);  // a prefix of m^3 would be cubed
  if (unit !== '' && Math.abs(value) < ROUNDING) value = 0;
  if (unit.startsWith('rad')) return `${Number((value * 180 / Math.PI).toPrecision(digits))}\u00b0${unit.slice(3)}`;
  if (unit === '' || value === 0) return `${Number(value.toPrecision(digits))}${unit ? ' ' + unit : ''}`;
  const [scale, name] = prefix(Math.abs(value));
  return `${Number((value / scale).toPrecision(digits))} ${name}${unit.replace('^3', '\u00b3')}`;
}
