// Draws joints: markers with their axes, and the values and force of the selected joint.
import {
  BoxGeometry, BufferAttribute, BufferGeometry, ConeGeometry, CylinderGeometry, Group, Line, LineBasicMaterial, Mesh,
  MeshBasicMaterial, OctahedronGeometry, Quaternion, SphereGeometry, TorusGeometry, Vector3,
} from 'three';
import {told} from './colours';
import {make} from './dom';
import type {Joint, Scene} from './protocol';

const JOINT = 0x7a5195, CHOSEN = 0xd55e00, FORCE = 0xcc3311;
const RADIUS = 0.012;     // of a marker, relative to the robot's size
const AXIS = 3.5;         // half the length of an axis, relative to a marker's radius
const ARROW = 0.22;       // length of the largest force so far, relative to the robot's size
const NEAR = 14;          // px, within which a click selects a marker
const LEAST = 1e-9;       // N and N m; smaller values are rounding errors and shown as zero
const STRIDE = 12;        // numbers per joint in a frame
const Y = new Vector3(0, 1, 0);

const through = {depthTest: false, transparent: true, opacity: 0.9};  // visible through bodies
const norm = (v: number[]) => Math.hypot(...v);

/** One marker, modelled with its axis along y. */
class Marker {
  readonly root = new Group();
  readonly at = new Vector3();        // the point on the second body
  readonly axis = new Vector3();
  private second = new Group();       // the second axis, of a universal joint
  private rail: Line | null = null;   // between the two bodies' points, of a joint that slides
  private solid = new MeshBasicMaterial({color: JOINT, ...through});
  private thin = new LineBasicMaterial({color: JOINT, ...through});

  constructor(readonly joint: Joint, size: number) {
    const r = RADIUS * size, {type} = joint;
    const slides = type === 'slider' || type === 'cylindrical';
    const body = type === 'hinge' || type === 'cylindrical' ? new CylinderGeometry(0.6 * r, 0.6 * r, 2.4 * r, 20)
      : type === 'slider' ? new BoxGeometry(1.2 * r, 2.4 * r, 1.2 * r)
      : type === 'weld' ? new OctahedronGeometry(1.2 * r)
      : new SphereGeometry(type === 'universal' ? 0.6 * r : r, 20, 14);
    this.root.add(new Mesh(body, this.solid));
    if (type === 'cylindrical') this.root.add(new Mesh(new TorusGeometry(1.2 * r, 0.15 * r, 8, 24).rotateX(Math.PI / 2), this.solid));
    if (type !== 'ball' && type !== 'weld') this.root.add(this.line(AXIS * r));
    if (type === 'universal') this.second.add(this.line(AXIS * r));
    if (slides) {
      for (const end of [1, -1]) {
        const head = new Mesh(new ConeGeometry(0.5 * r, 1.2 * r, 12), this.solid);
        head.position.y = end * AXIS * r;
        head.rotation.x = end > 0 ? 0 : Math.PI;
        this.root.add(head);
      }
      this.rail = new Line(new BufferGeometry(), this.thin);
    }
    for (const part of this.parts()) {
      part.traverse((each) => { each.renderOrder = 4; each.frustumCulled = false; });
    }
  }

  parts() { return [this.root, this.second, ...(this.rail ? [this.rail] : [])]; }

  private line(half: number): Line {
    return new Line(new BufferGeometry().setFromPoints([new Vector3(0, -half, 0), new Vector3(0, half, 0)]), this.thin);
  }

  update(numbers: Float32Array): void {
    this.at.fromArray(numbers, 3);
    this.axis.fromArray(numbers, 6);
    for (const [part, from] of [[this.root, 6], [this.second, 9]] as [Group, number][]) {
      const axis = new Vector3().fromArray(numbers, from);
      part.position.copy(this.at);
      part.quaternion.copy(axis.lengthSq() > 0 ? new Quaternion().setFromUnitVectors(Y, axis) : new Quaternion());
    }
    this.rail?.geometry.setAttribute('position', new BufferAttribute(numbers.slice(0, 6), 3));
  }

  choose(yes: boolean): void {
    for (const material of [this.solid, this.thin]) material.color.set(yes ? CHOSEN : JOINT);
  }
}

/** Projects a point to the screen, CSS pixels. */
type Screen = (point: Vector3) => [number, number];

export class Joints3d {
  readonly root = new Group();
  readonly label = make('div', {className: 'told', hidden: true});
  private markers: Marker[] = [];
  private columns: Map<string, number>[] = [];  // of each joint's signals, by quantity (the key after the joint's name)
  private units: string[] = [];
  private signals = new Float64Array();
  private chosen = -1;
  private force = new Line(new BufferGeometry(), new LineBasicMaterial({color: FORCE, ...through}));
  private head: Mesh<ConeGeometry, MeshBasicMaterial>;
  private largest = 0;  // N, largest force so far, so that the arrow keeps its scale while the robot moves
  private size = 1;

  constructor() {
    this.head = new Mesh(new ConeGeometry(0.35, 1, 10).translate(0, -0.5, 0), new MeshBasicMaterial({color: FORCE, ...through}));
    for (const part of [this.force, this.head]) {
      part.frustumCulled = false;
      part.renderOrder = 5;
    }
  }

  scene(scene: Scene, size: number): void {
    this.size = size;
    this.largest = 0;
    this.root.clear();
    this.markers = scene.joints.map((joint) => new Marker(joint, size));
    this.columns = scene.joints.map((joint) => new Map(joint.signals.map((key) =>
      [key.slice(joint.name.length + 1), scene.signals.findIndex((s) => s.key === key)])));
    this.units = scene.signals.map((s) => s.unit);
    for (const marker of this.markers) this.root.add(...marker.parts());
    this.root.add(this.force, this.head);
    this.choose(-1);
  }

  get visible(): boolean { return this.root.visible; }
  set visible(yes: boolean) { this.root.visible = yes; }

  /** Selects a joint. -1, or the joint that is selected already, clears the selection. */
  choose(index: number): void {
    this.chosen = index === this.chosen ? -1 : index;
    this.markers.forEach((marker, k) => marker.choose(k === this.chosen));
    this.point();
  }

  /** Selects the joint whose marker is at a click, CSS pixels. Returns whether there is one. */
  pick(x: number, y: number, screen: Screen): boolean {
    if (!this.visible) return false;
    let nearest = NEAR, found = -1;
    this.markers.forEach(({at}, k) => {
      const [u, v] = screen(at);
      const distance = Math.hypot(u - x, v - y);
      if (distance < nearest) [nearest, found] = [distance, k];
    });
    if (found >= 0) this.choose(found);
    return found >= 0;
  }

  update(marks: Float32Array | undefined, signals: Float64Array): void {
    this.signals = signals;
    this.markers.forEach((marker, k) => {
      if (marks) marker.update(marks.subarray(STRIDE * k, STRIDE * (k + 1)));
      this.largest = Math.max(this.largest, norm(this.vector(k, 'force')));
    });
    this.point();
  }

  private number(index: number, quantity: string): number | undefined {
    const column = this.columns[index].get(quantity);
    return column === undefined ? undefined : this.signals[column];
  }

  private vector(index: number, quantity: string): number[] {
    return ['x', 'y', 'z'].map((axis) => this.number(index, `${quantity}_${axis}`) ?? NaN);
  }

  /** Describes a joint: angle and displacement, if it has them, and the magnitudes of force and moment. */
  text(index: number): string {
    const moved = ['angle', 'displacement'].flatMap((quantity) => {
      const column = this.columns[index].get(quantity);
      return column === undefined ? [] : [told(this.signals[column], this.units[column])];
    });
    const carried = [['force', 'N'], ['moment', 'N m']].map(([quantity, unit]) => {
      const size = norm(this.vector(index, quantity));
      return told(size < LEAST ? 0 : size, unit);
    });
    return [...moved, ...carried].join(', ');
  }

  // Draws the force of the selected joint on its second body as an arrow.
  private point(): void {
    const marker = this.markers[this.chosen];
    const force = marker ? new Vector3(...this.vector(this.chosen, 'force')) : new Vector3();
    const length = this.largest > 0 ? ARROW * this.size * force.length() / this.largest : 0;
    this.force.visible = this.head.visible = length > 0;
    if (!(length > 0)) return;
    const along = force.normalize(), tip = marker.at.clone().addScaledVector(along, length);
    this.force.geometry.setFromPoints([marker.at, tip]);
    this.head.position.copy(tip);
    this.head.scale.setScalar(Math.min(1.5 * RADIUS * this.size, 0.5 * length));
    this.head.quaternion.setFromUnitVectors(Y, along);
  }

  /** Places the label beside the selected joint. */
  draw(screen: Screen): void {
    const marker = this.visible ? this.markers[this.chosen] : undefined;
    this.label.hidden = marker === undefined;
    if (!marker) return;
    const [x, y] = screen(marker.at);
    const text = `${marker.joint.name} (${marker.joint.type}): ${this.text(this.chosen)}`;
    if (this.label.textContent !== text) this.label.textContent = text;
    this.label.style.transform = `translate(${x + 14}px, ${y - 14}px)`;
  }

  /** For tests: position, axis and displayed state of each joint. */
  told() {
    return this.markers.map(({at, axis}, k) => ({position: at.toArray(), axis: axis.toArray(), drawn: this.visible,
                                                 chosen: k === this.chosen, text: this.text(k), arrow: k === this.chosen && this.force.visible}));
  }
}
