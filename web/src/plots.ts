// Live plots of groups of signals over the last seconds.
import uPlot from 'uplot';
import {told} from './colours';
import {button, make} from './dom';
import type {Frame, Scene} from './protocol';

const WINDOW = 10;      // s
const SAMPLES = 1200;   // maximum
const COLOURS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#7a5195', '#5c5c5c'];
const TITLES: Record<string, string> = {
  effort: 'Effort', motion: 'Motion', torque: 'Torque', pressure: 'Pressure', volume: 'Volume', effector: 'Effector', error: 'Error', rotation: 'Rotation',
  'rotation error': 'Rotation error', probe: 'Probes', angle: 'Angles', contact: 'Contact forces', gap: 'Gaps', touching: 'Points that touch', energy: 'Energy',
  'joint N': 'Forces of joints', 'joint N m': 'Moments of joints', 'joint m': 'Gaps and displacements of joints', 'joint rad': 'Angles of joints',
  time: 'Time of a step', solver: 'Solver', 'effort command': 'Commanded effort', 'motion command': 'Commanded motion',
  'torque command': 'Commanded torque', 'angle command': 'Commanded angle', 'pressure command': 'Commanded pressure',
  'volume command': 'Commanded volume', estimate: 'Estimated forces', 'estimate Pa': 'Estimated pressures',
};

const SAME = 4e-3;  // relative to the plot's height: curves that differ by less everywhere look equal
const DASH = 8;     // px, of equal curves
const MOST = 3;  // maximum number of plots
const HEIGHT = 170, LOW = 120;  // px, of a single plot, and of several

/** Groups of two or more curves that look equal, as indices. @param columns (m, n): m curves of n values. */
export function equalCurves(columns: number[][]): number[][] {
  const all = columns.flat().filter(Number.isFinite);
  const range = all.reduce((most, x) => Math.max(most, x), -Infinity) - all.reduce((least, x) => Math.min(least, x), Infinity);
  const same = (a: number[], b: number[]) => a.every((x, k) => Math.abs(x - b[k]) <= SAME * range || (!Number.isFinite(x) && !Number.isFinite(b[k])));
  const left = columns.map((_, k) => k).filter((k) => columns[k].some(Number.isFinite));
  const groups: number[][] = [];
  while (left.length > 0) {
    const group = left.filter((k) => same(columns[left[0]], columns[k]));
    group.forEach((k) => left.splice(left.indexOf(k), 1));
    if (group.length > 1) groups.push(group);
  }
  return groups;
}

/** The signals of all frames of a recorded run; of a long one, of every k-th frame. */
export interface Recorded {times: Float64Array; columns: Float32Array[]}

/** Decodes the history of a recorded run, see docs/view_protocol.md. */
export function decodeHistory(buffer: ArrayBuffer): Recorded {
  const [frames, signals] = new Uint32Array(buffer, 0, 2), begin = 8 + 8 * frames;
  return {times: new Float64Array(buffer, 8, frames),
          columns: Array.from({length: signals}, (_, k) => new Float32Array(buffer, begin + 4 * frames * k, frames))};
}

/** The signals of a run, plotted or not: over the last seconds of a live run, over all of a recorded one. */
class History {
  times: ArrayLike<number> = [];            // s
  private rows: Float64Array[] = [];        // signals at these times, of a live run
  private columns: Float32Array[] | null = null;  // each signal at these times, of a recorded run
  marker = NaN;                             // s, the moment that is shown, if it is not the last one; NaN: none
  recorded = false;                         // whether the run is a recorded one
  version = 0;                              // changes with the samples

  clear(recorded: boolean): void {
    this.times = [];
    this.rows = [];
    this.columns = null;
    this.marker = NaN;
    this.recorded = recorded;
    ++this.version;
  }

  /** Takes all of a recorded run at once. */
  take({times, columns}: Recorded): void {
    this.times = times;
    this.columns = columns;
    ++this.version;
  }

  /** A signal at all times. */
  column(signal: number, scale: number): ArrayLike<number> {
    if (!this.columns) return this.rows.map((signals) => scale * signals[signal]);
    const values = this.columns[signal] ?? new Float32Array(this.times.length).fill(NaN);
    return scale === 1 ? values : values.map((x) => scale * x);
  }

  // When a run continues from an earlier moment, the samples after that moment are dropped.
  add(frame: Frame): void {
    const past = frame.timeline !== undefined && frame.timeline.shown < frame.timeline.latest;
    this.marker = past || this.recorded ? frame.time : NaN;
    // The frames of a recorded run that were visited are no curve: it comes as a whole.
    if (past || this.recorded) return;
    const times = this.times as number[], rows = this.rows;
    ++this.version;
    while (times[times.length - 1] >= frame.time) times.length = rows.length = times.length - 1;
    times.push(frame.time);
    rows.push(frame.signals.slice());
    if (times.length <= SAMPLES && times[0] >= frame.time - 1.2 * WINDOW) return;
    const drop = Math.max(times.findIndex((t) => t >= frame.time - WINDOW), times.length - SAMPLES + 100, 0);
    times.splice(0, drop);
    rows.splice(0, drop);
  }
}

/** A plot of one group of signals. A click on a name in the legend hides or shows its curve. */
class Plot {
  readonly element = make('div', {});
  group = '';
  private plot: uPlot | null = null;
  private columns: number[] = [];
  private unit = '';
  private scale = 1;  // angles are drawn in degrees, so that their ticks are round numbers
  private select = make('select', {'aria-label': 'Signals to plot'});
  private box = make('div', {className: 'plot'});
  private scene: Scene | null = null;
  private equal: number[][] = [];
  private drawn = {version: -1, marker: NaN};  // what the canvas shows

  constructor(private history: History, ...buttons: HTMLElement[]) {
    this.select.onchange = () => this.choose(this.select.value);
    this.element.append(make('div', {className: 'line'}, this.select, ...buttons), this.box);
  }

  /** Shows the wanted group, or the first one if the scene has no such group. */
  setScene(scene: Scene, wanted: string): void {
    this.scene = scene;
    const groups = [...new Set(scene.signals.map((s) => s.group))];
    this.select.replaceChildren(...groups.map((g) => new Option(TITLES[g] ?? g, g)));
    this.choose(groups.includes(wanted) ? wanted : groups[0] ?? '');
  }

  private choose(group: string): void {
    this.group = this.select.value = group;
    this.columns = [];
    this.scene?.signals.forEach((s, k) => { if (s.group === group) this.columns.push(k); });
    this.plot?.destroy();
    this.drawn.version = -1;
    const signals = this.columns.map((k) => this.scene!.signals[k]);
    this.unit = signals[0]?.unit ?? '';
    this.scale = this.unit === 'rad' ? 180 / Math.PI : 1;
    const ink = getComputedStyle(document.documentElement).getPropertyValue('--ink').trim();
    const faint = getComputedStyle(document.documentElement).getPropertyValue('--line').trim();
    const axis = {stroke: ink, grid: {stroke: faint, width: 1}, ticks: {stroke: faint, width: 1}};
    this.plot = new uPlot({
      width: 300, height: 160, cursor: {show: true}, legend: {live: false},
      scales: {x: {time: false}},
      axes: [{...axis, label: 'time (s)', labelSize: 16, size: 30},
             {...axis, size: 76, values: (_, ticks) => ticks.map((v) => told(v / this.scale, this.unit))}],
      hooks: {draw: [(plot) => this.drawMarker(plot, ink)]},
      series: [{}, ...signals.map((s, k) => ({label: s.label, stroke: COLOURS[k % COLOURS.length], points: {show: false},
                                               width: 1.5, dash: this.ownDash(k)}))],
    }, this.data(), this.box);
  }

  end(): void {
    this.plot?.destroy();
    this.element.remove();
  }

  private ownDash(k: number): number[] | undefined { return k >= COLOURS.length ? [5, 4] : undefined; }

  private data(): uPlot.AlignedData {
    return [this.history.times, ...this.columns.map((k) => this.history.column(k, this.scale))] as uPlot.AlignedData;
  }

  private drawMarker(plot: uPlot, ink: string): void {
    const {marker} = this.history;
    if (!(marker >= plot.scales.x.min! && marker <= plot.scales.x.max!)) return;
    const {ctx, bbox} = plot, x = plot.valToPos(marker, 'x', true);
    ctx.save();
    ctx.strokeStyle = ink;
    ctx.lineWidth = devicePixelRatio;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }

  /** Draws the curves. Those that look equal alternate: the dashes of each lie in the gaps of the others. */
  draw(): void {
    if (!this.plot) return;
    const {version, marker} = this.history, {drawn} = this;
    if (drawn.version === version && Object.is(drawn.marker, marker)) return;
    this.drawn = {version, marker};
    if (drawn.version === version) return this.plot.redraw(false);
    const data = this.data(), stride = Math.ceil(this.history.times.length / SAMPLES);
    this.equal = equalCurves(data.slice(1).map((values) => Array.from(values as ArrayLike<number>).filter((_, k) => k % stride === 0)));
    this.columns.forEach((_, k) => { this.plot!.series[k + 1].dash = this.ownDash(k); });
    for (const group of this.equal) {
      group.forEach((k, turn) => {
        this.plot!.series[k + 1].dash = [0, DASH * turn, DASH, DASH * (group.length - 1 - turn)];
      });
    }
    this.plot.setData(data);
  }

  /** For tests: labels of curves that look equal, first and last time of the samples, and the marker. */
  told() {
    const label = (k: number) => this.scene!.signals[this.columns[k]].label;
    const {times, marker} = this.history;
    return {group: this.group, equal: this.equal.map((g) => g.map(label)), from: times[0], to: times[times.length - 1], samples: times.length, marker};
  }

  resize(width: number, height: number): void { this.plot?.setSize({width: Math.max(width, 120), height}); }
}

/** Up to three plots, one above the other. */
export class Plots {
  private plots: Plot[] = [];
  private scene: Scene | null = null;
  private drawn = 0;
  private history = new History();

  constructor(private section: HTMLElement) {
    this.insert(new Plot(this.history, button('+', 'Another plot', () => this.another())));
    new ResizeObserver(() => this.resize()).observe(section);
  }

  /** @param recorded whether the scene is that of a recorded run, whose history will come as a whole. */
  setScene(scene: Scene, recorded: boolean): void {
    if (scene !== this.scene) this.history.clear(recorded);
    this.scene = scene;
    for (const plot of this.plots) plot.setScene(scene, plot.group);
    this.resize();
  }

  private insert(plot: Plot): void {
    this.plots.push(plot);
    this.section.append(plot.element);
  }

  private another(): void {
    if (this.plots.length >= MOST || !this.scene) return;
    const plot: Plot = new Plot(this.history, button('-', 'No longer this plot', () => {
      plot.end();
      this.plots = this.plots.filter((p) => p !== plot);
      this.resize();
    }));
    const shown = this.plots.map((p) => p.group);
    plot.setScene(this.scene, this.scene.signals.map((s) => s.group).find((g) => !shown.includes(g)) ?? '');
    this.insert(plot);
    this.resize();
  }

  told() { return this.plots.map((plot) => plot.told()); }

  add(frame: Frame): void { this.history.add(frame); }

  /** Takes the history of a recorded run. */
  take(recorded: Recorded): void { this.history.take(recorded); }

  draw(now: number): void {
    if (now - this.drawn < 100) return;  // ten times a second suffice for the eye
    this.drawn = now;
    for (const plot of this.plots) plot.draw();
  }

  private resize(): void {
    for (const plot of this.plots) {
      plot.resize(this.section.clientWidth - 16, this.plots.length > 1 ? LOW : HEIGHT);
    }
  }
}
