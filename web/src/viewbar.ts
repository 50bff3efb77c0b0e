// The controls of the view: direction, projection, and section.
import {Box3} from 'three';
import {told} from './colours';
import {button, make} from './dom';
import type {View} from './camera3d';
import type {Robot3d} from './robot3d';
import {AXES} from './section3d';

const STEPS = 1000;  // of the section's slider
const NAMES: [View, string, string][] = [['x', 'x', 'Look along the x axis (x)'], ['y', 'y', 'Look along the y axis (y)'],
                                         ['z', 'z', 'Look down along the z axis (z)'], ['iso', 'Iso', 'Look from the front, the right and above (i)']];

export class Viewbar {
  readonly parallel = button('Ortho', 'Parallel projection (q)', () => {
    this.robot.setOrthographic(this.parallel.classList.toggle('on'));
  });
  private axis = make('select', {'aria-label': 'Section across'}, new Option('no section', ''),
                      ...AXES.map((a, k) => new Option(`section at ${a}`, String(k))));
  private slider = make('input', {type: 'range', min: '0', max: String(STEPS), value: String(STEPS / 2), 'aria-label': 'Where the section is'});
  private side = button('Other side', 'Show the other side of the section', () => {
    this.side.classList.toggle('on');
    this.cut();
  });
  private where = make('span', {className: 'numbers'});
  private box = new Box3();

  constructor(private robot: Robot3d) {
    this.axis.onchange = () => {
      this.box = robot.box();
      this.cut();
    };
    this.slider.oninput = () => this.cut();
    this.slider.className = 'section';
    this.cut();
  }

  parts(): HTMLElement[] {
    return [...NAMES.map(([view, text, title]) => button(text, title, () => this.robot.look(view))), this.parallel,
            this.axis, this.slider, this.side, this.where];
  }

  /** Removes the section when another scene is shown. */
  scene(): void {
    this.axis.value = '';
    this.cut();
  }

  private cut(): void {
    const axis = this.axis.value === '' ? null : Number(this.axis.value);
    for (const part of [this.slider, this.side, this.where]) part.hidden = axis === null;
    const low = this.box.min.getComponent(axis ?? 0), high = this.box.max.getComponent(axis ?? 0);
    const at = low + (high - low) * Number(this.slider.value) / STEPS;
    this.where.textContent = axis === null ? '' : `${AXES[axis]} = ${told(at, 'm')}`;
    this.robot.cut(axis, at, this.side.classList.contains('on'));
  }
}
