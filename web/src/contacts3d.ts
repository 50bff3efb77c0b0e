// Draws contacts: the surfaces, the contact points, and the forces on them.
import {
  BufferGeometry, CapsuleGeometry, Color, ConeGeometry, DoubleSide, GridHelper, Group, InstancedMesh, Line,
  LineBasicMaterial, Matrix4, Mesh, MeshBasicMaterial, MeshStandardMaterial, Object3D, PlaneGeometry, Quaternion,
  SphereGeometry, Vector3,
} from 'three';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';
import {LineSegments2} from 'three/addons/lines/LineSegments2.js';
import {LineSegmentsGeometry} from 'three/addons/lines/LineSegmentsGeometry.js';
import type {Contact, ContactSurface, Scene} from './protocol';

/** Colours of contact points by state (Okabe and Ito 2008); they also differ in lightness. */
export const STATES: [string, number][] = [['open', 0x9aa0a8], ['stick', 0x0072b2], ['slip', 0xe69f00]];
const SURFACE = 0x8796a5, FORCE = 0xcc3311;
const POINT = 0.006;      // radius of a touching point, relative to the robot's size; half of it for open points
const ARROW = 0.22;       // length of the largest force so far, relative to the robot's size
const LEAST = 0.01;       // smallest force that is drawn, relative to the largest
const HEAD = 0.02;        // relative to the robot's size
const CELLS = 12;         // of the grid along a side of a plane's patch
const Z = new Vector3(0, 0, 1), Y = new Vector3(0, 1, 0);
const SAME = 1e-6;        // relative to the robot's size: nodes closer than this coincide
const STRIDE = 7;         // numbers per surface, and per point, in a frame

const vector = (p: number[]) => new Vector3(p[0], p[1], p[2]);

/** One contact: its surface, points and forces. The patch that is drawn of a plane follows the points. */
class Drawn {
  readonly pose = new Group();
  private latest = new Float32Array(0);
  private patch: Group | null = null;
  private cell = 0;
  private beads: InstancedMesh;
  private states: Int8Array;
  private arrows: LineSegments2;
  private heads: InstancedMesh;

  constructor(readonly contact: Contact, private size: number) {
    this.pose.add(this.shape(contact.surface));
    this.states = new Int8Array(contact.points).fill(-1);
    this.beads = new InstancedMesh(new SphereGeometry(1, 12, 8), new MeshBasicMaterial({transparent: true, opacity: 0.9, depthTest: false}),
                                   contact.points);
    this.heads = new InstancedMesh(new ConeGeometry(0.35, 1, 10).translate(0, -0.5, 0), new MeshBasicMaterial({color: FORCE, depthTest: false, transparent: true}),
                                   contact.points);
    this.arrows = new LineSegments2(new LineSegmentsGeometry(),
                                    new LineMaterial({color: FORCE, linewidth: 2.5, depthTest: false, transparent: true}));
    for (const part of [this.beads, this.heads, this.arrows]) {
      part.frustumCulled = false;
      part.renderOrder = 3;
    }
  }

  parts(): Object3D[] { return [this.pose, this.beads, this.arrows, this.heads]; }

  private shape(surface: ContactSurface): Object3D {
    const solid = new MeshStandardMaterial({color: SURFACE, roughness: 0.9, side: DoubleSide, transparent: true,
                                            opacity: surface.kind === 'plane' ? 0.25 : 0.6, depthWrite: surface.kind !== 'plane'});
    if (surface.kind === 'sphere') {
      const ball = new Mesh(new SphereGeometry(surface.radius, 40, 28), solid);
      ball.position.copy(vector(surface.centre));
      return ball;
    }
    if (surface.kind === 'capsule') {
      const [from, to] = surface.ends.map(vector);
      const axis = to.clone().sub(from);
      const rod = new Mesh(new CapsuleGeometry(surface.radius, axis.length(), 12, 32), solid);
      rod.position.copy(from).add(to).multiplyScalar(0.5);
      rod.quaternion.setFromUnitVectors(Y, axis.lengthSq() > 0 ? axis.normalize() : Y);
      return rod;
    }
    if (surface.kind === 'body') return new Group();
    // Draws a patch of the plane, which follow() keeps under the points.
    this.cell = 10 ** Math.floor(Math.log10(this.size)) / 5;
    while (this.cell * CELLS < 1.2 * this.size) this.cell *= 2;
    const side = CELLS * this.cell;
    const grid = new GridHelper(side, CELLS, SURFACE, SURFACE);
    grid.rotation.x = Math.PI / 2;
    const edge = side / 2;
    const rim = new Line(new BufferGeometry().setFromPoints(
      [[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]].map(([x, y]) => new Vector3(edge * x, edge * y, 0))),
      new LineBasicMaterial({color: SURFACE}));
    this.patch = new Group().add(new Mesh(new PlaneGeometry(side, side), solid), grid, rim);
    const whole = new Group().add(this.patch);
    whole.position.copy(vector(surface.point));
    whole.quaternion.setFromUnitVectors(Z, vector(surface.normal));
    return whole;
  }

  /** Updates the contact from a frame. @param scale of the arrows, m/N. */
  update(values: Float32Array, scale: number): void {
    this.latest = values;
    this.pose.position.fromArray(values, 0);
    this.pose.quaternion.fromArray(values, 3);
    this.pose.updateMatrixWorld();
    const count = Math.min(values.length / STRIDE - 1, this.states.length);
    const at = new Vector3(), force = new Vector3(), middle = new Vector3(), matrix = new Matrix4();
    const turn = new Quaternion(), upright = new Quaternion(), color = new Color();
    const lines: number[] = [];
    let heads = 0, measured = 0, recoloured = false;
    for (let k = 0; k < count; ++k) {
      const from = STRIDE * (k + 1), found = Number.isFinite(values[from]), state = found ? values[from + 6] : -1;
      if (!found) {  // no place to draw it at
        this.states[k] = state;
        this.beads.setMatrixAt(k, matrix.makeScale(0, 0, 0));
        continue;
      }
      at.fromArray(values, from);
      middle.add(at);
      measured += 1;
      const radius = POINT * this.size * (state > 0 ? 1 : 0.5);
      this.beads.setMatrixAt(k, matrix.compose(at, upright, new Vector3(radius, radius, radius)));
      if (this.states[k] !== state) {
        this.states[k] = state;
        this.beads.setColorAt(k, color.set(STATES[state]?.[1] ?? STATES[0][1]));
        recoloured = true;
      }
      force.fromArray(values, from + 3).multiplyScalar(scale);
      const length = force.length();
      if (length < LEAST * ARROW * this.size) continue;
      const tip = at.clone().add(force);
      lines.push(...at.toArray(), ...tip.toArray());
      const head = Math.min(HEAD * this.size, 0.5 * length);
      turn.setFromUnitVectors(Y, force.divideScalar(length));
      this.heads.setMatrixAt(heads++, matrix.compose(tip, turn, new Vector3(head, head, head)));
    }
    this.beads.instanceMatrix.needsUpdate = this.heads.instanceMatrix.needsUpdate = true;
    if (recoloured && this.beads.instanceColor) this.beads.instanceColor.needsUpdate = true;
    this.heads.count = heads;
    this.arrows.visible = lines.length > 0;
    if (lines.length > 0) {
      this.arrows.geometry.dispose();
      this.arrows.geometry = new LineSegmentsGeometry().setPositions(lines);
    }
    if (this.patch && measured > 0) this.follow(middle.divideScalar(measured));
  }

  /** Whether this is a plane where another contact has the same one. */
  repeats(other: Drawn): boolean {
    const same = (a: ArrayLike<number>, b: ArrayLike<number>, n: number) =>
      Array.from({length: n}, (_, k) => k).every((k) => Math.abs(a[k] - b[k]) <= SAME * (1 + Math.abs(b[k])));
    const mine = this.contact.surface, its = other.contact.surface;
    return mine.kind === 'plane' && its.kind === 'plane' && same(mine.point, its.point, 3) && same(mine.normal, its.normal, 3)
      && same(this.latest, other.latest, STRIDE);
  }

  showSurface(on: boolean): void { this.pose.visible = on; }

  /** The force on the body at a position; null if no contact point is there. */
  force(at: Vector3): Vector3 | null {
    const point = new Vector3();
    for (let from = STRIDE; from < this.latest.length; from += STRIDE) {
      if (point.fromArray(this.latest, from).distanceTo(at) <= SAME * this.size) return new Vector3().fromArray(this.latest, from + 3);
    }
    return null;
  }

  told(): {position: number[]; arrows: number; points: number[]} {
    return {position: this.pose.position.toArray(), arrows: this.heads.count,
            points: STATES.map((_, state) => this.states.filter((s) => s === state).length)};
  }

  // Moves the patch by whole cells, so that the grid seems to stand still.
  private follow(middle: Vector3): void {
    const local = this.patch!.parent!.worldToLocal(middle);
    const whole = (x: number) => Math.round(x / this.cell) * this.cell;
    this.patch!.position.set(whole(local.x), whole(local.y), 0);
  }
}

export class Contacts3d {
  readonly root = new Group();
  private drawn: Drawn[] = [];
  private bodies: string[] = [];
  private size = 1;
  private largest = 0;  // N, largest force so far, so that arrows keep their scale while the robot moves

  scene(scene: Scene, size: number): void {
    this.root.clear();
    this.size = size;
    this.largest = 0;
    this.bodies = scene.bodies.map((body) => body.name);
    this.drawn = scene.contacts.map((contact) => new Drawn(contact, size));
    for (const one of this.drawn) this.root.add(...one.parts());
  }

  update(contacts: Map<number, Float32Array>): void {
    for (const values of contacts.values()) {
      for (let k = STRIDE; k < values.length; k += STRIDE) {
        this.largest = Math.max(this.largest, Math.hypot(values[k + 3], values[k + 4], values[k + 5]));
      }
    }
    const scale = this.largest > 0 ? ARROW * this.size / this.largest : 0;
    for (const [index, values] of contacts) this.drawn[index]?.update(values, scale);
    // Many bodies may touch one floor, which is drawn once.
    this.drawn.forEach((one, k) => one.showSurface(!this.drawn.slice(0, k).some((earlier) => one.repeats(earlier))));
  }

  /** The sum of the contact forces on a node; null if it is a point of no contact. */
  force(body: number, at: Vector3): Vector3 | null {
    const forces = this.drawn.filter((one) => one.contact.body === this.bodies[body]).map((one) => one.force(at));
    return forces.reduce((sum, force) => sum && force ? sum.add(force) : sum ?? force, null);
  }

  /** For tests: the position of the surface, the number of arrows, and the number of points per state, of each contact. */
  told() { return this.drawn.map((one) => one.told()); }
}
