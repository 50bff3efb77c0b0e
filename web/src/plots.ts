// Live plots of the signals that were chosen, by group, over the last seconds.
import uPlot from 'uplot';
import {told} from './colours';
import {button, make} from './dom';
import type {Frame, Scene} from './protocol';

const WINDOW = 10;      // s
const SAMPLES = 1200;   // at most
const COLOURS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#7a5195', '#5c5c5c'];
const TITLES: Record<string, string> = {
  effort: 'Effort', motion: 'Motion', torque: 'Torque', pressure: 'Pressure', volume: 'Volume', effector: 'Effector', error: 'Error', rotation: 'Rotation',
  'rotation error': 'Rotation error', probe: 'Probes', angle: 'Angles', contact: 'Contact forces', gap: 'Gaps', touching: 'Points that touch', energy: 'Energy',
  'joint N': 'Forces of joints', 'joint N m': 'Moments of joints', 'joint m': 'Gaps and displacements of joints', 'joint rad': 'Angles of joints',
  time: 'Time of a step', solver: 'Solver', 'effort command': 'Commanded effort', 'motion command': 'Commanded motion',
  'torque command': 'Commanded torque', 'angle command': 'Commanded angle', 'pressure command': 'Commanded pressure',
  'volume command': 'Commanded volume',
};

const MOST = 3;  // plots at once
const HEIGHT = 170, LOW = 120;  // px of a plot: alone, and among others

/** The signals of one group; a click on a name in the legend hides or shows it. */
class Plot {
  readonly element = make('div', {});
  group = '';
  private plot: uPlot | null = null;
  private columns: number[] = [];
  private data: number[][] = [];
  private unit = '';
  private scale = 1;  // angles are drawn in degrees, so that their ticks are round
  private select = make('select', {'aria-label': 'Signals to plot'});
  private box = make('div', {className: 'plot'});
  private scene: Scene | null = null;
  private last = -1;

  constructor(...buttons: HTMLElement[]) {
    this.select.onchange = () => this.choose(this.select.value);
    this.element.append(make('div', {className: 'line'}, this.select, ...buttons), this.box);
  }

  /** Shows a group, or the one that it showed where there is none of this name. */
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
    this.data = [[], ...this.columns.map(() => [] as number[])];
    this.last = -1;
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
      series: [{}, ...signals.map((s, k) => ({label: s.label, stroke: COLOURS[k % COLOURS.length],
                                               width: 1.5, dash: k >= COLOURS.length ? [5, 4] : undefined}))],
    }, this.data as uPlot.AlignedData, this.box);
  }

  end(): void {
    this.plot?.destroy();
    this.element.remove();
  }

  add(frame: Frame): void {
    if (frame.time < this.last) this.data.forEach((column) => { column.length = 0; });
    if (frame.time === this.last) return;
    this.last = frame.time;
    this.data[0].push(frame.time);
    this.columns.forEach((k, c) => this.data[c + 1].push(this.scale * frame.signals[k]));
    const times = this.data[0];
    if (times.length > SAMPLES || times[0] < frame.time - 1.2 * WINDOW) {
      const first = times.findIndex((t) => t >= frame.time - WINDOW);
      const drop = Math.max(first, times.length - SAMPLES + 100, 0);
      this.data.forEach((column) => column.splice(0, drop));
    }
  }

  draw(): void { this.plot?.setData(this.data as uPlot.AlignedData); }

  resize(width: number, height: number): void { this.plot?.setSize({width: Math.max(width, 120), height}); }
}

/** Up to three plots, one above the other. */
export class Plots {
  private plots: Plot[] = [];
  private scene: Scene | null = null;
  private drawn = 0;

  constructor(private section: HTMLElement) {
    this.insert(new Plot(button('+', 'Another plot', () => this.another())));
    new ResizeObserver(() => this.resize()).observe(section);
  }

  setScene(scene: Scene): void {
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
    const plot: Plot = new Plot(button('-', 'No longer this plot', () => {
      plot.end();
      this.plots = this.plots.filter((p) => p !== plot);
      this.resize();
    }));
    const shown = this.plots.map((p) => p.group);
    plot.setScene(this.scene, this.scene.signals.map((s) => s.group).find((g) => !shown.includes(g)) ?? '');
    this.insert(plot);
    this.resize();
  }

  add(frame: Frame): void { for (const plot of this.plots) plot.add(frame); }

  draw(now: number): void {
    if (now - this.drawn < 100) return;  // ten times a second is enough to read
    this.drawn = now;
    for (const plot of this.plots) plot.draw();
  }

  private resize(): void {
    for (const plot of this.plots) {
      plot.resize(this.section.clientWidth - 16, this.plots.length > 1 ? LOW : HEIGHT);
    }
  }
}
