// Draws the robot in three dimensions (bodies, cables, effectors, targets, ground), and handles the mouse.
import {
  AmbientLight, AxesHelper, Box3, BufferAttribute, BufferGeometry, CanvasTexture, Color, DirectionalLight,
  GridHelper, HemisphereLight, Line, LineBasicMaterial, Mesh, MeshBasicMaterial,
  Object3D, Plane, Raycaster, Scene as World, SphereGeometry,
  Sprite, SpriteMaterial, Vector2, Vector3, WebGLRenderer,
} from 'three';
import {TransformControls} from 'three/addons/controls/TransformControls.js';
import {Line2} from 'three/addons/lines/Line2.js';
import {LineGeometry} from 'three/addons/lines/LineGeometry.js';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';
import {LineSegments2} from 'three/addons/lines/LineSegments2.js';
import {LineSegmentsGeometry} from 'three/addons/lines/LineSegmentsGeometry.js';
import {Bodies3d} from './bodies3d';
import {Camera3d, View} from './camera3d';
import {told} from './colours';
import {Arrows3d} from './arrows3d';
import {Contacts3d} from './contacts3d';
import {Joints3d} from './joints3d';
import {make} from './dom';
import {middle} from './picked';
import type {Spot} from './picked';
import type {Frame, Pick, Scene} from './protocol';

const GIZMO = 0.6;  // size of the target's arrows
const PROBE = 0x009e73;
const PICKED = 0xcc79a7;
const FREE = 0xaa3377;
// Edges of an element as pairs of nodes (VTK's order), by its number of nodes. Quadratic edges have two parts.
const ELEMENT_EDGES: Record<number, number[]> = {
  4: [0, 1, 1, 2, 2, 0, 0, 3, 1, 3, 2, 3],
  8: [0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4, 0, 4, 1, 5, 2, 6, 3, 7],
  10: [0, 4, 4, 1, 1, 5, 5, 2, 2, 6, 6, 0, 0, 7, 7, 3, 1, 8, 8, 3, 2, 9, 9, 3],
};
const CLICK = 4;  // px, maximum motion of a click
const SLACK = 0x8a8f98, TAUT = 0x0072b2, STRONG = 0xd55e00;  // Okabe and Ito 2008

export interface Hand {
  pull(body: number, vertices: number[], weights: number[], anchor: number[]): void;
  release(): void;
  target(effector: number, position: number[]): void;
  /** Called on a click on a body; null: beside the bodies. */
  pick(spot: Spot | null): void;
  /** Requests that frames contain the interiors of bodies, or ends it. */
  inside(on: boolean): void;
}

/** A text that faces the camera, has a constant size on the screen, and is never hidden by bodies. */
function caption(text: string): Sprite {
  const canvas = make('canvas', {width: 256, height: 64});
  const context = canvas.getContext('2d')!;
  context.font = '600 38px system-ui, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.lineWidth = 8;
  context.lineJoin = 'round';
  context.strokeStyle = '#ffffffcc';  // readable on light and dark backgrounds
  context.strokeText(text, 128, 34);
  context.fillStyle = '#1d232b';
  context.fillText(text, 128, 34);
  const sprite = new Sprite(new SpriteMaterial({map: new CanvasTexture(canvas), sizeAttenuation: false, transparent: true, depthTest: false}));
  sprite.renderOrder = 4;
  return sprite;
}

export class Robot3d {
  readonly renderer: WebGLRenderer;
  private world = new World();
  private camera: Camera3d;
  private captions: Sprite[] = [];
  private gizmo: TransformControls;
  private handle = new Object3D();
  private robot = new Object3D();
  readonly bodies = new Bodies3d();
  private cables: Line2[] = [];
  private cableCounts: number[] = [];
  private cableSignals: number[] = [];
  private effectors: Mesh[] = [];
  private targets: Mesh[] = [];
  private probes: {line: Line; ends: Mesh[]; marks: number}[] = [];
  readonly contacts = new Contacts3d();
  readonly joints = new Joints3d();
  readonly free = new Arrows3d(FREE);  // of a motion that nothing resists
  private spring = new Line(new BufferGeometry(), new LineBasicMaterial({color: STRONG}));
  private size = 0.2;
  private grabbed: {plane: Plane; body: number; vertices: number[]; weights: number[]} | null = null;
  private dragging = false;
  private steered = -1;
  private chosen = -1;  // effector that was clicked, or whose target was
  private force = make('div', {id: 'force', hidden: true});
  private bounds = new Box3();
  private picked = new Mesh(new SphereGeometry(1, 20, 14), new MeshBasicMaterial({color: PICKED, depthTest: false, transparent: true}));
  private outline = new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({color: PICKED, linewidth: 3, depthTest: false, transparent: true}));
  private stale = true;  // see touch()
  private drawnFrom = new Vector3();  // position of the camera in the last picture
  private pressed: [number, number] | null = null;  // px, where the button went down, if this may become a click
  follow = false;
  hands = false;  // dragging the robot pulls it without Shift, for touch screens

  constructor(private stage: HTMLElement, private hand: Hand) {
    this.renderer = new WebGLRenderer({antialias: true, preserveDrawingBuffer: true, stencil: true});
    this.renderer.localClippingEnabled = true;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    stage.append(this.renderer.domElement, this.force, this.joints.label);
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute('aria-label', 'The robot; drag to turn, Shift and drag on it to pull, click for the values of a node or an element');
    this.camera = new Camera3d(canvas);
    this.gizmo = new TransformControls(this.camera.now, canvas);
    this.gizmo.setSize(GIZMO);
    this.gizmo.attach(this.handle);
    this.gizmo.addEventListener('dragging-changed', (event) => {
      this.dragging = event.value as boolean;
      this.camera.orbit.enabled = !this.dragging;
    });
    this.gizmo.addEventListener('objectChange', () => {
      if (this.steered >= 0) this.hand.target(this.steered, this.handle.position.toArray());
    });
    const helper = this.gizmo.getHelper();
    helper.visible = false;
    for (const mark of [this.picked, this.outline]) {
      mark.renderOrder = 4;
      mark.visible = mark.frustumCulled = false;
    }
    this.world.add(this.robot, this.bodies.root, this.handle, helper, this.spring, this.picked, this.outline, this.free.root);
    this.world.add(new AmbientLight(0xffffff, 0.5), new HemisphereLight(0xffffff, 0x8090a0, 1.2));
    const sun = new DirectionalLight(0xffffff, 1.8);
    sun.position.set(1, -2, 3);
    this.world.add(sun);
    this.spring.frustumCulled = false;
    canvas.addEventListener('pointerdown', (event) => this.press(event), true);
    canvas.addEventListener('pointermove', (event) => this.move(event));
    addEventListener('pointerup', (event) => this.letGo(event));
    // Any input may change the picture, even a move of the pointer.
    for (const what of ['pointerdown', 'pointermove', 'pointerup', 'wheel', 'keydown', 'keyup', 'input', 'change', 'click']) {
      addEventListener(what, () => {
        this.touch();
        requestAnimationFrame(() => this.touch());  // its effects may follow the event
      }, {passive: true, capture: true});
    }
    canvas.addEventListener('webglcontextrestored', () => this.touch());
    new ResizeObserver(() => this.resize()).observe(stage);
    this.theme();
  }

  theme(): void {
    this.touch();
    const style = getComputedStyle(document.documentElement);
    this.world.background = new Color(style.getPropertyValue('--stage').trim() || '#ffffff');
  }

  private resize(): void {
    this.touch();
    const {clientWidth: w, clientHeight: h} = this.stage;
    this.renderer.setSize(w, h);
    this.camera.resize(w, h);
  }

  /** Sets the widths covered by panels, px at each side; the robot is shown beside them. */
  cover(left: number, right: number, top: number, bottom: number): void {
    if (this.camera.cover([left, right, top, bottom])) this.fit();
  }

  scene(scene: Scene): void {
    this.touch();
    this.robot.clear();
    this.captions = [];
    this.mark(null);
    const [low, high] = scene.bounds.map((p) => new Vector3(...(p as [number, number, number])));
    this.size = low.distanceTo(high);
    this.bodies.scene(this.size);
    this.bounds.set(low, high);
    this.ground(low, high);
    this.cables = [];
    this.cableCounts = [];
    this.cableSignals = [];
    scene.actuators.forEach((actuator) => {
      if (actuator.points === 0) return;
      // Cables are drawn after the body and visible through it.
      const material = new LineMaterial({color: TAUT, linewidth: 3, depthTest: false, transparent: true, opacity: 0.85,
                                         dashSize: 0.012 * this.size, gapSize: 0.012 * this.size});
      const line = new Line2(new LineGeometry(), material);
      line.frustumCulled = false;
      line.renderOrder = 1;
      this.cables.push(line);
      this.cableCounts.push(actuator.points);
      this.cableSignals.push(scene.signals.findIndex((s) => s.key === `${actuator.name}.tension`));
      this.robot.add(line);
    });
    const ball = new SphereGeometry(0.014 * this.size, 20, 14);
    const marks = (color: number, opacity: number) => scene.effectors.map(() => {
      const mesh = new Mesh(ball, new MeshBasicMaterial({color, transparent: true, opacity, depthTest: false}));
      mesh.renderOrder = 2;
      mesh.visible = false;
      this.robot.add(mesh);
      return mesh;
    });
    this.effectors = marks(0x000000, 0.7);
    this.targets = marks(STRONG, 0.8);
    const bead = new SphereGeometry(0.008 * this.size, 14, 10);
    this.probes = scene.probes.map(({kind, marks}) => {
      const line = new Line(new BufferGeometry(), new LineBasicMaterial({color: PROBE, depthTest: false, transparent: true}));
      line.frustumCulled = false;
      line.visible = kind === 'line' || kind === 'distance';
      const ends = Array.from({length: Math.min(marks, 2)}, () =>
        new Mesh(bead, new MeshBasicMaterial({color: PROBE, depthTest: false, transparent: true, opacity: 0.9})));
      [line, ...ends].forEach((part) => { part.renderOrder = 2; });
      this.robot.add(line, ...ends);
      return {line, ends, marks};
    });
    this.contacts.scene(scene, this.size);
    this.robot.add(this.contacts.root);
    this.joints.scene(scene, this.size);
    this.robot.add(this.joints.root);
    this.chosen = -1;
    this.effectors.concat(this.targets).forEach((mark) => { mark.visible = false; });
    this.camera.setSize(this.size);
    this.picked.scale.setScalar(0.006 * this.size);
    this.look('iso');
  }

  private ground(low: Vector3, high: Vector3): void {
    const span = 4 * Math.max(high.x - low.x, high.y - low.y, 0.3 * this.size);
    const cell = 10 ** Math.floor(Math.log10(span / 4));
    const cells = 2 * Math.ceil(span / cell / 2);
    const grid = new GridHelper(cells * cell, cells, 0x888888, 0x888888);
    grid.rotation.x = Math.PI / 2;
    grid.position.set((low.x + high.x) / 2, (low.y + high.y) / 2, low.z);
    grid.position.x = Math.round(grid.position.x / cell) * cell;
    grid.position.y = Math.round(grid.position.y / cell) * cell;
    const material = grid.material as LineBasicMaterial;
    material.transparent = true;
    material.opacity = 0.25;
    const length = Math.max(1, Math.round(0.2 * this.size / cell)) * cell;
    this.robot.add(grid, new AxesHelper(length));
    ['x', 'y', 'z'].forEach((axis, k) => {
      const text = caption(`${axis} ${told(length, 'm')}`);
      text.position.setComponent(k, 1.15 * length);
      this.captions.push(text);
      this.robot.add(text);
    });
    this.stage.dataset.cell = told(cell, 'm');
  }

  /** Updates the robot from a frame. The colour map extends from low to high. */
  update(frame: Frame, low: number, high: number): void {
    this.touch();
    this.bodies.update(frame, low, high);
    if (frame.cables) this.drawCables(frame.cables, frame.signals);
    if (frame.probes) this.drawProbes(frame.probes);
    this.contacts.update(frame.contacts);
    this.joints.update(frame.joints, frame.signals);
    if (frame.effectors) this.place(this.effectors, frame.effectors);
    if (frame.targets) this.place(this.targets, frame.targets);
    this.steer();
    this.drawSpring(frame.pull);
  }

  /** Shows a motion that nothing resists: (x, y, z, dx, dy, dz) of nodes, m. */
  showFree(arrows: number[][]): void {
    this.touch();
    this.free.draw(arrows);
  }

  /** Marks the picked node or element; null: none. */
  mark(pick: Pick | null): void {
    this.touch();
    this.picked.visible = pick?.kind === 'node';
    this.outline.visible = pick?.kind === 'element';
    if (!pick) return;
    if (pick.kind === 'node') {
      this.picked.position.copy(middle(pick.positions));
      return;
    }
    const ends = ELEMENT_EDGES[pick.positions.length / 3].flatMap((node) => [...pick.positions.subarray(3 * node, 3 * node + 3)]);
    this.outline.geometry.dispose();  // else three.js keeps the old buffer and its number of lines
    this.outline.geometry.setPositions(ends);
  }

  /** The contact force on a picked node; null if it is a point of no contact. */
  pressingOn(pick: Pick): Vector3 | null {
    return pick.kind === 'node' ? this.contacts.force(pick.body, middle(pick.positions)) : null;
  }

  /** The contact force on a vertex of a body; null if it is a point of no contact. */
  pressing(body: number, vertex: number): Vector3 | null { return this.contacts.force(body, this.bodies.vertex(body, vertex)); }

  /** Cuts bodies open, see Section3d.set(). */
  cut(axis: number | null, at: number, before: boolean): void {
    this.touch();
    if (this.bodies.cut(axis, at, before, this.bounds.getCenter(new Vector3()))) this.hand.inside(this.bodies.isCut);
  }

  /** For tests: whether the target of each effector is drawn. */
  targetsShown(): boolean[] { return this.targets.map((mark) => mark.visible); }

  setOrthographic(yes: boolean): void {
    this.touch();
    this.camera.setOrthographic(yes);
    this.gizmo.camera = this.camera.now;
  }

  private drawCables(points: Float32Array, signals: Float64Array): void {
    let at = 0;
    this.cables.forEach((line, k) => {
      const count = 3 * this.cableCounts[k];
      line.geometry.setPositions(points.subarray(at, at + count));
      at += count;
      const slack = !(signals[this.cableSignals[k]] > 0);
      if (slack !== line.material.dashed) {
        line.material.dashed = slack;
        line.material.color.set(slack ? SLACK : TAUT);
      }
      if (slack) line.computeLineDistances();
    });
  }

  private drawProbes(points: Float32Array): void {
    let at = 0;
    for (const {line, ends, marks} of this.probes) {
      const own = points.subarray(at, at + 3 * marks);
      at += 3 * marks;
      line.geometry.setAttribute('position', new BufferAttribute(own.slice(), 3));
      this.place(ends, marks > 1 ? new Float32Array([...own.subarray(0, 3), ...own.subarray(-3)]) : own);
    }
  }

  private place(marks: Mesh[], points: Float32Array): void {
    marks.forEach((mark, k) => {
      mark.visible = Number.isFinite(points[3 * k]);
      if (mark.visible) mark.position.fromArray(points, 3 * k);
    });
  }

  /** Places the gizmo at the chosen target, else at the first one; without targets, at an effector. */
  private steer(): void {
    const marks = this.targets.some((t) => t.visible) ? this.targets : this.effectors;
    this.steered = marks[this.chosen]?.visible ? this.chosen : marks.findIndex((m) => m.visible);
    this.gizmo.getHelper().visible = this.steered >= 0 && this.gizmo.enabled;
    if (this.steered >= 0 && !this.dragging) this.handle.position.copy(marks[this.steered].position);
  }

  steerable(yes: boolean): void {
    this.touch();
    this.gizmo.enabled = yes;
    if (!yes) this.gizmo.getHelper().visible = false;
  }

  private drawSpring(pull: Float32Array | undefined): void {
    this.spring.visible = pull !== undefined;
    this.force.hidden = pull === undefined;
    if (!pull) return;
    this.spring.geometry.setAttribute('position', new BufferAttribute(pull.slice(0, 6), 3));
    const [x, y] = this.screen(new Vector3().fromArray(pull, 3));
    this.force.textContent = told(pull[6], 'N');
    this.force.style.transform = `translate(${x + 12}px, ${y - 12}px)`;
  }

  /** Projects a point to the stage, CSS pixels. */
  screen(point: Vector3): [number, number] {
    const seen = point.clone().project(this.camera.now);
    return [(1 + seen.x) / 2 * this.stage.clientWidth, (1 - seen.y) / 2 * this.stage.clientHeight];
  }

  /** For pictures: shows the robot without arrows and captions. */
  plain(): void {
    this.steerable(false);
    this.robot.traverse((part) => { if (part instanceof Sprite || part instanceof AxesHelper) part.visible = false; });
    this.cover(0, 0, 0, 0);
    this.fit();
  }

  /** For tests: the middles of the target's arrows on the stage, CSS pixels. */
  arrows(): [number, number][] {
    const at = this.handle.position;
    const {now} = this.camera;
    const factor = 'fov' in now ? at.distanceTo(now.position) * Math.min(1.9 * Math.tan(Math.PI * now.fov / 360), 7)
      : (now.top - now.bottom) / now.zoom;  // the formula of TransformControls
    const reach = 0.3 * factor * GIZMO / 4;
    return [0, 1, 2].map((k) => this.screen(at.clone().setComponent(k, at.getComponent(k) + reach)));
  }

  /** The bounding box of bodies, visible effectors and targets. */
  box(): Box3 {
    if (this.bodies.count === 0) return this.bounds.clone();
    const box = this.bodies.box();
    for (const mark of [...this.effectors, ...this.targets]) if (mark.visible) box.expandByPoint(mark.position);
    return box;
  }

  /** Shows the whole robot beside the panels. */
  fit(): void {
    this.touch();
    this.camera.fit(this.box());
  }

  /** Shows the whole robot from one side. */
  look(view: View): void {
    this.touch();
    this.camera.fit(this.box(), view);
  }

  private ray(event: PointerEvent): Raycaster {
    const box = this.renderer.domElement.getBoundingClientRect();
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2(2 * (event.clientX - box.left) / box.width - 1,
                                     1 - 2 * (event.clientY - box.top) / box.height), this.camera.now);
    return caster;
  }

  // Shift and drag, or a drag with the right button, attaches a spring from the surface to the pointer. A click on a target
  // or an effector moves the arrows there; on a joint's marker, it selects the joint; on a body, it picks a node or element.
  private press(event: PointerEvent): void {
    this.pressed = null;
    if (this.gizmo.axis !== null && event.button === 0 && !event.shiftKey) return;
    const caster = this.ray(event);
    let marked = false;
    for (const marks of [this.targets, this.effectors]) {
      const mark = caster.intersectObjects(marks.filter((m) => m.visible))[0]?.object;
      if (mark) this.chosen = marks.indexOf(mark as Mesh);
      marked ||= mark !== undefined;
    }
    if (!this.hands && !event.shiftKey && event.button !== 2) {
      const box = this.renderer.domElement.getBoundingClientRect();
      marked ||= this.joints.pick(event.clientX - box.left, event.clientY - box.top, (point) => this.screen(point));
      if (!marked && event.button === 0) this.pressed = [event.clientX, event.clientY];
      return;
    }
    const found = this.bodies.hit(caster);
    if (!found || found.cut) return;
    event.stopImmediatePropagation();
    const {body, point, vertices} = found;
    const [a, b, c] = vertices.map((v) => this.bodies.vertex(body, v));
    const area = (p: Vector3, q: Vector3, r: Vector3) =>
      new Vector3().crossVectors(q.clone().sub(p), r.clone().sub(p)).length();
    const parts = [area(point, b, c), area(a, point, c), area(a, b, point)];
    const sum = parts[0] + parts[1] + parts[2];
    const normal = this.camera.now.getWorldDirection(new Vector3());
    this.grabbed = {
      plane: new Plane().setFromNormalAndCoplanarPoint(normal, point), body,
      vertices, weights: parts.map((p) => p / sum),
    };
    this.camera.orbit.enabled = false;
  }

  private move(event: PointerEvent): void {
    if (!this.grabbed) return;
    const anchor = this.ray(event).ray.intersectPlane(this.grabbed.plane, new Vector3());
    const {body, vertices, weights} = this.grabbed;
    if (anchor) this.hand.pull(body, vertices, weights, anchor.toArray());
  }

  private letGo(event: PointerEvent): void {
    const from = this.pressed;
    this.pressed = null;
    if (from && Math.hypot(event.clientX - from[0], event.clientY - from[1]) <= CLICK) this.click(event);
    if (!this.grabbed) return;
    this.grabbed = null;
    this.camera.orbit.enabled = true;
    this.hand.release();
  }

  private click(event: PointerEvent): void {
    const found = this.bodies.hit(this.ray(event));
    this.hand.pick(found && this.bodies.spot(found));
  }

  /** Marks the picture as outdated, so that draw() renders it again. */
  touch(): void { this.stale = true; }

  /** Renders the picture if it is outdated or the camera has moved. */
  draw(): void {
    if (this.follow && this.effectors[0]?.visible) {
      this.camera.orbit.target.lerp(this.effectors[0].position, 0.1);
    }
    // OrbitControls reports only moves of more than a millimetre.
    const moved = this.camera.orbit.update() || this.camera.now.position.distanceTo(this.drawnFrom) > 1e-4 * this.camera.span;
    if (moved) this.stale = true;
    if (!this.stale) return;
    this.stale = false;
    this.drawnFrom.copy(this.camera.now.position);
    this.joints.draw((point) => this.screen(point));
    for (const text of this.captions) text.scale.set(0.1, 0.025, 1).multiplyScalar(this.camera.captionScale);
    this.renderer.render(this.world, this.camera.now);
  }
}
