// The robot in three dimensions: surfaces, cables, effectors, targets, ground, and what the mouse does.
import {
  AmbientLight, AxesHelper, Box3, BufferAttribute, BufferGeometry, CanvasTexture, Color, DirectionalLight,
  DoubleSide, GridHelper, HemisphereLight, Line, LineBasicMaterial, Mesh, MeshBasicMaterial,
  MeshStandardMaterial, Object3D, PerspectiveCamera, Plane, Raycaster, Scene as World, SphereGeometry,
  Sprite, SpriteMaterial, Vector2, Vector3, WebGLRenderer,
} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {TransformControls} from 'three/addons/controls/TransformControls.js';
import {Line2} from 'three/addons/lines/Line2.js';
import {LineGeometry} from 'three/addons/lines/LineGeometry.js';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';
import {linearTable, paint, told} from './colours';
import {Contacts3d} from './contacts3d';
import {Joints3d} from './joints3d';
import {make} from './dom';
import type {Frame, Scene, Surface} from './protocol';

const BODY_COLOURS = [0xd9a066, 0x7fa6c9, 0x9cb380];  // told apart by lightness too
const GIZMO = 0.6;  // size of the target's arrows
const PROBE = 0x009e73;
const OPACITY = 0.82;  // of a body without colours
const SLACK = 0x8a8f98, TAUT = 0x0072b2, STRONG = 0xd55e00;  // Okabe and Ito 2008

export interface Hand {
  pull(body: number, vertices: number[], weights: number[], anchor: number[]): void;
  release(): void;
  target(effector: number, position: number[]): void;
}

/** A text that always faces the camera, of the same size on the screen however far. */
function caption(text: string): Sprite {
  const canvas = make('canvas', {width: 256, height: 64});
  const context = canvas.getContext('2d')!;
  context.font = '40px system-ui, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillStyle = '#7d8894';
  context.fillText(text, 128, 34);
  const sprite = new Sprite(new SpriteMaterial({map: new CanvasTexture(canvas), sizeAttenuation: false, transparent: true}));
  sprite.scale.set(0.1, 0.025, 1);
  return sprite;
}

interface Body {mesh: Mesh<BufferGeometry, MeshStandardMaterial>; wire: Mesh; colours: Float32Array}

export class Robot3d {
  readonly renderer: WebGLRenderer;
  private world = new World();
  private camera = new PerspectiveCamera(40, 1, 1e-4, 100);
  private orbit: OrbitControls;
  private gizmo: TransformControls;
  private handle = new Object3D();
  private robot = new Object3D();
  private bodies: Body[] = [];
  private cables: Line2[] = [];
  private cableCounts: number[] = [];
  private cableSignals: number[] = [];
  private effectors: Mesh[] = [];
  private targets: Mesh[] = [];
  private probes: {line: Line; ends: Mesh[]; marks: number}[] = [];
  readonly contacts = new Contacts3d();
  readonly joints = new Joints3d();
  private spring = new Line(new BufferGeometry(), new LineBasicMaterial({color: STRONG}));
  private size = 0.2;
  private table = linearTable('viridis');
  private grabbed: {plane: Plane; body: number; vertices: number[]; weights: number[]} | null = null;
  private dragging = false;
  private steered = -1;
  private covered = [0, 0, 0, 0];  // px; see cover()
  private chosen = -1;  // effector whose target was clicked
  private force = make('div', {id: 'force', hidden: true});
  private bounds = new Box3();
  follow = false;
  wireframe = false;
  coloured = false;
  hands = false;  // a plain drag on the robot pulls, as on a screen without keys

  constructor(private stage: HTMLElement, private hand: Hand) {
    this.renderer = new WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    stage.append(this.renderer.domElement, this.force, this.joints.label);
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute('aria-label', 'The robot; drag to turn, Shift and drag on it to pull');
    this.camera.up.set(0, 0, 1);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.enableDamping = true;
    this.orbit.dampingFactor = 0.2;
    this.gizmo = new TransformControls(this.camera, canvas);
    this.gizmo.setSize(GIZMO);
    this.gizmo.attach(this.handle);
    this.gizmo.addEventListener('dragging-changed', (event) => {
      this.dragging = event.value as boolean;
      this.orbit.enabled = !this.dragging;
    });
    this.gizmo.addEventListener('objectChange', () => {
      if (this.steered >= 0) this.hand.target(this.steered, this.handle.position.toArray());
    });
    const helper = this.gizmo.getHelper();
    helper.visible = false;
    this.world.add(this.robot, this.handle, helper, this.spring);
    this.world.add(new AmbientLight(0xffffff, 0.5), new HemisphereLight(0xffffff, 0x8090a0, 1.2));
    const sun = new DirectionalLight(0xffffff, 1.8);
    sun.position.set(1, -2, 3);
    this.world.add(sun);
    this.spring.frustumCulled = false;
    canvas.addEventListener('pointerdown', (event) => this.press(event), true);
    canvas.addEventListener('pointermove', (event) => this.move(event));
    addEventListener('pointerup', () => this.letGo());
    new ResizeObserver(() => this.resize()).observe(stage);
    this.theme();
  }

  theme(): void {
    const style = getComputedStyle(document.documentElement);
    this.world.background = new Color(style.getPropertyValue('--stage').trim() || '#ffffff');
  }

  private resize(): void {
    const {clientWidth: w, clientHeight: h} = this.stage;
    this.renderer.setSize(w, h);
    this.camera.aspect = w / Math.max(h, 1);
    this.camera.updateProjectionMatrix();
    this.makeRoom();
  }

  /** What lies over the picture, px at each side: the middle of the rest is the picture's middle. */
  cover(left: number, right: number, top: number, bottom: number): void {
    const next = [left, right, top, bottom];
    if (next.every((side, k) => side === this.covered[k])) return;
    this.covered = next;
    this.makeRoom();
    this.fit();
  }

  private makeRoom(): void {
    const {clientWidth: w, clientHeight: h} = this.stage;
    const [left, right, top, bottom] = this.covered;
    this.camera.setViewOffset(w, h, (right - left) / 2, (bottom - top) / 2, w, h);
  }

  scene(scene: Scene): void {
    this.robot.clear();
    this.bodies = [];
    const [low, high] = scene.bounds.map((p) => new Vector3(...(p as [number, number, number])));
    this.size = low.distanceTo(high);
    this.bounds.set(low, high);
    this.ground(low, high);
    this.cables = [];
    this.cableCounts = [];
    this.cableSignals = [];
    scene.actuators.forEach((actuator) => {
      if (actuator.points === 0) return;
      // Drawn after the body and through it.
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
    this.camera.near = 1e-3 * this.size;
    this.camera.far = 50 * this.size;
    this.fit();
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
      this.robot.add(text);
    });
    this.stage.dataset.cell = told(cell, 'm');
  }

  surface(surface: Surface): void {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(surface.rest.slice(), 3));
    geometry.setIndex(new BufferAttribute(surface.triangles, 1));
    const colours = new Float32Array(surface.rest.length);
    geometry.setAttribute('color', new BufferAttribute(colours, 3));
    geometry.computeVertexNormals();
    const color = BODY_COLOURS[surface.body % BODY_COLOURS.length];
    const material = new MeshStandardMaterial({color, roughness: 0.65, side: DoubleSide,
                                               transparent: true, opacity: OPACITY});
    const mesh = new Mesh(geometry, material);
    const wire = new Mesh(geometry, new MeshBasicMaterial({color: 0x222222, wireframe: true, transparent: true,
                                                           opacity: 0.25}));
    mesh.frustumCulled = wire.frustumCulled = false;
    wire.visible = this.wireframe;
    this.bodies[surface.body] = {mesh, wire, colours};
    this.robot.add(mesh, wire);
  }

  map(name: string): void { this.table = linearTable(name); }

  /** Takes a frame; field values are painted between low and high. */
  update(frame: Frame, low: number, high: number): void {
    for (const [index, positions] of frame.positions) {
      const body = this.bodies[index];
      const attribute = body?.mesh.geometry.getAttribute('position') as BufferAttribute | undefined;
      if (!body || !attribute || attribute.array.length !== positions.length) continue;
      (attribute.array as Float32Array).set(positions);
      attribute.needsUpdate = true;
      body.mesh.geometry.computeVertexNormals();
      body.mesh.geometry.boundingSphere = null;
      body.mesh.geometry.boundingBox = null;
    }
    for (const [index, {values}] of frame.fields) {
      const body = this.bodies[index];
      if (!body) continue;
      paint(values, low, high, this.table, body.colours);
      (body.mesh.geometry.getAttribute('color') as BufferAttribute).needsUpdate = true;
    }
    for (const body of this.bodies) {
      const {material} = body.mesh;
      if (material.vertexColors !== this.coloured) {
        material.vertexColors = this.coloured;
        material.transparent = !this.coloured;  // or what lies behind would change the colours
        material.opacity = this.coloured ? 1 : OPACITY;
        material.needsUpdate = true;
        const index = this.bodies.indexOf(body);
        material.color.set(this.coloured ? 0xffffff : BODY_COLOURS[index % BODY_COLOURS.length]);
      }
      body.wire.visible = this.wireframe;
    }
    if (frame.cables) this.drawCables(frame.cables, frame.signals);
    if (frame.probes) this.drawProbes(frame.probes);
    this.contacts.update(frame.contacts);
    this.joints.update(frame.joints, frame.signals);
    if (frame.effectors) this.place(this.effectors, frame.effectors);
    if (frame.targets) this.place(this.targets, frame.targets);
    this.steer();
    this.drawSpring(frame.pull);
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

  /** Puts the gizmo at the first target, or at the first effector where nothing steers. */
  private steer(): void {
    const marks = this.targets.some((t) => t.visible) ? this.targets : this.effectors;
    this.steered = marks[this.chosen]?.visible ? this.chosen : marks.findIndex((m) => m.visible);
    this.gizmo.getHelper().visible = this.steered >= 0 && this.gizmo.enabled;
    if (this.steered >= 0 && !this.dragging) this.handle.position.copy(marks[this.steered].position);
  }

  steerable(yes: boolean): void {
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

  /** Where a point is seen, CSS pixels of the stage. */
  screen(point: Vector3): [number, number] {
    const seen = point.clone().project(this.camera);
    return [(1 + seen.x) / 2 * this.stage.clientWidth, (1 - seen.y) / 2 * this.stage.clientHeight];
  }

  /** For pictures: the robot alone, without arrows and captions. */
  plain(): void {
    this.steerable(false);
    this.robot.traverse((part) => { if (part instanceof Sprite || part instanceof AxesHelper) part.visible = false; });
    this.cover(0, 0, 0, 0);
    this.fit();
  }

  /** For tests: where the arrows of the target are seen, on their middle. */
  arrows(): [number, number][] {
    const at = this.handle.position;
    const half = Math.tan(Math.PI * this.camera.fov / 360);
    const reach = 0.3 * at.distanceTo(this.camera.position) * Math.min(1.9 * half, 7) * GIZMO / 4;
    return [0, 1, 2].map((k) => this.screen(at.clone().setComponent(k, at.getComponent(k) + reach)));
  }

  fit(): void {
    const {clientWidth: w, clientHeight: h} = this.stage;
    const [left, right, top, bottom] = this.covered;
    const free = Math.min(w - left - right, h - top - bottom) / Math.max(h, 1);
    const distance = 0.6 * this.size / Math.tan(Math.PI * this.camera.fov / 360) / Math.max(free, 0.2);
    const middle = this.bounds.getCenter(new Vector3());
    this.orbit.target.copy(middle);
    this.camera.position.copy(middle).add(new Vector3(0.9, -1.5, 0.5).setLength(distance));
    this.orbit.update();
  }

  private ray(event: PointerEvent): Raycaster {
    const box = this.renderer.domElement.getBoundingClientRect();
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2(2 * (event.clientX - box.left) / box.width - 1,
                                     1 - 2 * (event.clientY - box.top) / box.height), this.camera);
    return caster;
  }

  // Shift and drag, or the right button, on the surface: a spring from there to the pointer. A click on
  // a target or an effector: its arrows. On a joint's marker: what it says.
  private press(event: PointerEvent): void {
    if (this.gizmo.axis !== null && event.button === 0 && !event.shiftKey) return;
    const caster = this.ray(event);
    for (const marks of [this.targets, this.effectors]) {
      const mark = caster.intersectObjects(marks.filter((m) => m.visible))[0]?.object;
      if (mark) this.chosen = marks.indexOf(mark as Mesh);
    }
    if (!this.hands && !event.shiftKey && event.button !== 2) {
      const box = this.renderer.domElement.getBoundingClientRect();
      return this.joints.pick(event.clientX - box.left, event.clientY - box.top, (point) => this.screen(point));
    }
    const hits = caster.intersectObjects(this.bodies.map((b) => b.mesh));
    if (hits.length === 0 || !hits[0].face) return;
    event.stopImmediatePropagation();
    const {face, point, object} = hits[0];
    const body = this.bodies.findIndex((b) => b.mesh === object);
    const positions = this.bodies[body].mesh.geometry.getAttribute('position') as BufferAttribute;
    const [a, b, c] = [face.a, face.b, face.c].map((v) => new Vector3().fromBufferAttribute(positions, v));
    const area = (p: Vector3, q: Vector3, r: Vector3) =>
      new Vector3().crossVectors(q.clone().sub(p), r.clone().sub(p)).length();
    const parts = [area(point, b, c), area(a, point, c), area(a, b, point)];
    const sum = parts[0] + parts[1] + parts[2];
    const normal = this.camera.getWorldDirection(new Vector3());
    this.grabbed = {
      plane: new Plane().setFromNormalAndCoplanarPoint(normal, point), body,
      vertices: [face.a, face.b, face.c], weights: parts.map((p) => p / sum),
    };
    this.orbit.enabled = false;
  }

  private move(event: PointerEvent): void {
    if (!this.grabbed) return;
    const anchor = this.ray(event).ray.intersectPlane(this.grabbed.plane, new Vector3());
    const {body, vertices, weights} = this.grabbed;
    if (anchor) this.hand.pull(body, vertices, weights, anchor.toArray());
  }

  private letGo(): void {
    if (!this.grabbed) return;
    this.grabbed = null;
    this.orbit.enabled = true;
    this.hand.release();
  }

  draw(): void {
    if (this.follow && this.effectors[0]?.visible) {
      this.orbit.target.lerp(this.effectors[0].position, 0.1);
    }
    this.orbit.update();
    this.joints.draw((point) => this.screen(point));
    this.renderer.render(this.world, this.camera);
  }
}
