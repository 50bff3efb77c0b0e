// The card with the values of the node or element that was clicked.
import {Vector3} from 'three';
import {told} from './colours';
import {button, make} from './dom';
import type {Frame, Pick, PickKind, Scene} from './protocol';

/** A clicked place: the nearest node, and the element, -1 if the body has none there. */
export interface Spot {body: number; node: number; element: number}
export interface Place {position: Vector3; rest: Vector3; force: Vector3 | null}

/** Formats three numbers with one prefix: "1.2, -30, 4 mm". */
function vector(v: Vector3, unit: string): string {
  const size = Math.max(...v.toArray().map(Math.abs));
  const [number, ...name] = told(size, unit).split(' ');
  const scale = size > 0 ? Number(number) / size : 1;
  return `${v.toArray().map((x) => Number((x * scale).toPrecision(3))).join(', ')} ${name.join(' ')}`;
}

/** The mean of points (3 k,). */
export function middle(points: Float32Array): Vector3 {
  const sum = new Vector3();
  for (let at = 0; at < points.length; at += 3) sum.add(new Vector3().fromArray(points, at));
  return sum.divideScalar(points.length / 3);
}

export class Picked {
  readonly element = make('div', {id: 'picked', className: 'card', hidden: true});
  private rows = new Map<string, HTMLElement>();
  private title = make('b', {});
  private table = make('div', {});
  private kinds: Record<PickKind, HTMLButtonElement>;
  private spot: Spot | null = null;
  /** Whether the node or the element at the clicked place is shown. */
  kind: PickKind = 'node';

  /** @param changed called when another node or element is to be shown, or none. */
  constructor(private changed: () => void) {
    const choice = (kind: PickKind, text: string) => button(text, `Values of the ${kind} (n)`, () => this.show(kind));
    this.kinds = {node: choice('node', 'Node'), element: choice('element', 'Element')};
    this.element.append(make('div', {className: 'measured'}, this.title, make('span', {className: 'line'}, this.kinds.node, this.kinds.element,
                                                                              button('Close', 'Close the values', () => this.choose(null)))),
                        this.table);
  }

  show(kind: PickKind): void {
    if (kind === this.kind) return;
    this.kind = kind;
    if (this.spot) this.choose(this.spot);
  }

  choose(spot: Spot | null): void {
    if (!spot && !this.spot) return;
    this.spot = spot;
    this.element.hidden = true;  // until its values arrive
    this.rows.clear();
    this.table.replaceChildren();
    this.kinds.element.disabled = spot !== null && spot.element < 0;
    for (const [kind, choice] of Object.entries(this.kinds)) choice.classList.toggle('on', kind === this.at?.kind);
    this.changed();
  }

  /** The node or element that is shown. In a body without elements, it is always a node. */
  get at(): {body: number; kind: PickKind; number: number} | null {
    if (!this.spot) return null;
    const {body, node, element} = this.spot;
    return this.kind === 'element' && element >= 0 ? {body, kind: 'element', number: element} : {body, kind: 'node', number: node};
  }

  /** Whether the values in a frame belong to the node or element that is shown. */
  is(pick: Pick | undefined): pick is Pick {
    const {at} = this;
    return at !== null && pick !== undefined && pick.body === at.body && pick.kind === at.kind && pick.number === at.number;
  }

  private row(label: string, title: string, text: string): void {
    let value = this.rows.get(label);
    if (!value) {
      value = make('output', {'aria-label': `${label} at the ${this.at!.kind}`});
      this.rows.set(label, value);
      this.table.append(make('div', {className: 'measured', title}, make('span', {textContent: label}), value));
    }
    if (value.textContent !== text) value.textContent = text;
  }

  /** Shows the values in a frame. @param force of contacts on the node; null if it is a point of no contact. */
  update(scene: Scene, frame: Frame, force: Vector3 | null): void {
    const {pick} = frame;
    if (!this.is(pick)) return;
    const {name, materials} = scene.bodies[pick.body];
    this.element.hidden = false;
    this.title.textContent = `${name}, ${pick.kind} ${pick.number}`;
    const position = middle(pick.positions);
    if (pick.kind === 'element') {
      if (materials[pick.material]) this.row('Material', 'of the element', materials[pick.material]);
      if (Number.isFinite(pick.volume)) this.row('Volume at rest', 'of the element', told(pick.volume, 'm^3'));
    }
    this.row('Position', pick.kind === 'node' ? 'x, y, z' : 'x, y, z, mean of its nodes', vector(position, 'm'));
    this.row('Moved', 'x, y, z from the rest position', vector(position.sub(middle(pick.rest)), 'm'));
    scene.fields.forEach((field, k) => {
      const value = pick.fields[k];
      if (Number.isFinite(value)) this.row(field.label, field.description, told(value, field.unit));
    });
    if (force) this.row('Contact force', 'on the body: its size; x, y, z', `${told(force.length(), 'N')} (${vector(force, 'N')})`);
  }
}
