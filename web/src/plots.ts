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

/** The history of all signals over the last seconds, plotted or not. */
class History {
  times: number[] = [];         // s
  rows: Float64Array[] = [];    // signals at these times
  marker = NaN;                 // s, the moment to which the run was set back; NaN: none

  clear(): void {
    this.times = [];
    this.rows = [];
    this.marker = NaN;
  }

  // When a run continues from an earlier moment, the samples after that moment are dropped.
  add(frame: Frame): void {
    const past = frame.timeline !== undefined && frame.timeline.shown < frame.timeline.latest;
    this.marker = past ? frame.time : NaN;
    const {times, rows} = this;
    if (past) return;
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
    const {times, rows} = this.history;
    return [times, ...this.columns.map((k) => rows.map((signals) => this.scale * signals[k]))];
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
    const data = this.data();
    this.equal = equalCurves(data.slice(1) as number[][]);
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

  setScene(scene: Scene): void {
    if (scene !== this.scene) this.history.clear();
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
