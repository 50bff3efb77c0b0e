// Live plots of the signals that were chosen, by group, over the last seconds.
import uPlot from 'uplot';
import {told} from './colours';
import type {Frame, Scene} from './protocol';

const WINDOW = 10;      // s
const SAMPLES = 1200;   // at most
const COLOURS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#7a5195', '#5c5c5c'];
const TITLES: Record<string, string> = {
  effort: 'Effort', motion: 'Motion', effector: 'Effector', error: 'Error', energy: 'Energy',
  time: 'Time of a step', solver: 'Solver',
};

export class Plots {
  private plot: uPlot | null = null;
  private columns: number[] = [];
  private data: number[][] = [];
  private unit = '';
  private select: HTMLSelectElement;
  private box: HTMLElement;
  private scene: Scene | null = null;
  private last = -1;
  private drawn = 0;

  constructor(private section: HTMLElement) {
    this.select = document.createElement('select');
    this.select.setAttribute('aria-label', 'Signals to plot');
    this.select.onchange = () => this.choose(this.select.value);
    this.box = document.createElement('div');
    this.box.className = 'plot';
    section.append(this.select, this.box);
    new ResizeObserver(() => this.resize()).observe(section);
  }

  setScene(scene: Scene): void {
    this.scene = scene;
    const groups = [...new Set(scene.signals.map((s) => s.group))];
    this.select.replaceChildren(...groups.map((g) => new Option(TITLES[g] ?? g, g)));
    this.choose(groups[0] ?? '');
  }

  choose(group: string): void {
    this.columns = [];
    this.scene?.signals.forEach((s, k) => { if (s.group === group) this.columns.push(k); });
    this.data = [[], ...this.columns.map(() => [] as number[])];
    this.last = -1;
    this.plot?.destroy();
    const signals = this.columns.map((k) => this.scene!.signals[k]);
    this.unit = signals[0]?.unit ?? '';
    const ink = getComputedStyle(document.documentElement).getPropertyValue('--ink').trim();
    const faint = getComputedStyle(document.documentElement).getPropertyValue('--line').trim();
    const axis = {stroke: ink, grid: {stroke: faint, width: 1}, ticks: {stroke: faint, width: 1}};
    this.plot = new uPlot({
      width: 300, height: 160, cursor: {show: true}, legend: {live: false},
      scales: {x: {time: false}},
      axes: [{...axis, label: 'time (s)', labelSize: 16, size: 30},
             {...axis, size: 64, values: (_, ticks) => ticks.map((v) => told(v, this.unit))}],
      series: [{}, ...signals.map((s, k) => ({label: s.label, stroke: COLOURS[k % COLOURS.length],
                                               width: 1.5, dash: k >= COLOURS.length ? [5, 4] : undefined}))],
    }, this.data as uPlot.AlignedData, this.box);
    this.resize();
  }

  add(frame: Frame): void {
    if (frame.time < this.last) this.data.forEach((column) => { column.length = 0; });
    if (frame.time === this.last) return;
    this.last = frame.time;
    this.data[0].push(frame.time);
    this.columns.forEach((k, c) => this.data[c + 1].push(frame.signals[k]));
    const times = this.data[0];
    if (times.length > SAMPLES || times[0] < frame.time - 1.2 * WINDOW) {
      const first = times.findIndex((t) => t >= frame.time - WINDOW);
      const drop = Math.max(first, times.length - SAMPLES + 100, 0);
      this.data.forEach((column) => column.splice(0, drop));
    }
  }

  draw(now: number): void {
    if (now - this.drawn < 100 || !this.plot) return;  // ten times a second is enough to read
    this.drawn = now;
    this.plot.setData(this.data as uPlot.AlignedData);
  }

  private resize(): void {
    this.plot?.setSize({width: Math.max(this.section.clientWidth - 16, 120), height: 170});
  }
}
