// What is known of the node that was clicked.
import type {Vector3} from 'three';
import {told} from './colours';
import {button, make} from './dom';
import type {Frame, Scene} from './protocol';

export interface Place {position: Vector3; rest: Vector3; force: Vector3 | null}

/** Three numbers of one prefix: "1.2, -30, 4 mm". */
function vector(v: Vector3, unit: string): string {
  const size = Math.max(...v.toArray().map(Math.abs));
  const [number, ...name] = told(size, unit).split(' ');
  const scale = size > 0 ? Number(number) / size : 1;
  return `${v.toArray().map((x) => Number((x * scale).toPrecision(3))).join(', ')} ${name.join(' ')}`;
}

export class Picked {
  readonly element = make('div', {id: 'picked', className: 'card', hidden: true});
  private rows = new Map<string, HTMLElement>();
  private title = make('b', {});
  private table = make('div', {});
  at: {body: number; vertex: number} | null = null;

  constructor(close: () => void) {
    this.element.append(make('div', {className: 'measured'}, this.title, button('Close', 'Close the values of the node', close)), this.table);
  }

  choose(at: {body: number; vertex: number} | null): void {
    this.at = at;
    this.element.hidden = true;  // until its values come
    this.rows.clear();
    this.table.replaceChildren();
  }

  private row(label: string, title: string, text: string): void {
    let value = this.rows.get(label);
    if (!value) {
      value = make('output', {'aria-label': `${label} at the node`});
      this.rows.set(label, value);
      this.table.append(make('div', {className: 'measured', title}, make('span', {textContent: label}), value));
    }
    if (value.textContent !== text) value.textContent = text;
  }

  /** Shows a frame's values; `place`: where the node is, and the contact force on it. */
  show(scene: Scene, frame: Frame, place: Place): void {
    const {pick} = frame;
    if (!this.at || !pick || pick.body !== this.at.body || pick.vertex !== this.at.vertex) return;
    this.element.hidden = false;
    this.title.textContent = `${scene.bodies[pick.body].name}, node ${pick.node}`;
    const moved = place.position.clone().sub(place.rest);
    this.row('Position', 'x, y, z', vector(place.position, 'm'));
    this.row('Moved', 'x, y, z from the rest position', vector(moved, 'm'));
    scene.fields.forEach((field, k) => {
      const value = pick.fields[k];
      if (Number.isFinite(value)) this.row(field.label, field.description, told(value, field.unit));
    });
    if (place.force) {
      this.row('Contact force', 'on the body: its size; x, y, z', `${told(place.force.length(), 'N')} (${vector(place.force, 'N')})`);
    }
  }
}
