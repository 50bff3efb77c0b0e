// The list of joints in the panel: names and current values. A click on a joint selects it in the picture.
import {make} from './dom';
import type {Joints3d} from './joints3d';
import type {Scene} from './protocol';

export class JointList {
  private outputs: HTMLElement[] = [];
  private shown = make('input', {type: 'checkbox', checked: true});

  constructor(private joints: Joints3d) {
    this.shown.onchange = () => { joints.visible = this.shown.checked; };
  }

  /** Shows or hides the markers. */
  toggle(): void { if (this.outputs.length > 0) this.shown.click(); }

  rows(scene: Scene): HTMLElement[] {
    this.outputs = scene.joints.map(({name}) => make('output', {'aria-label': `${name}: joint`}));
    if (scene.joints.length === 0) return [];
    const rows = scene.joints.map(({name, type, bodies}, k) => {
      const row = make('div', {className: 'measured', title: `${type} of ${bodies.join(' and ')}`},
                       make('span', {className: 'name', textContent: name}), this.outputs[k]);
      row.onclick = () => this.joints.choose(k);
      return row;
    });
    return [make('h2', {textContent: 'Joints'}), make('label', {className: 'line'}, this.shown, 'drawn (j)'), ...rows];
  }

  show(): void {
    this.outputs.forEach((output, k) => {
      const text = this.joints.text(k);
      if (output.textContent !== text) output.textContent = text;
    });
  }
}
