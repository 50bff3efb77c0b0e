// The camera: perspective or parallel projection, mouse orbit, and a fit that shows the whole robot beside the panels.
import {Box3, MathUtils, OrthographicCamera, PerspectiveCamera, Vector3} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

const FIELD = 40;      // degrees, vertical field of view in perspective
const MARGIN = 1.12;   // space around the robot, as a factor
const LEAST = 0.2;     // minimum fraction of the picture's width and height that is used for the robot beside panels
const HALF = Math.tan(MathUtils.degToRad(FIELD / 2));

/** Directions from the robot to the camera. In the view from above (z), y points up in the picture. */
export const VIEWS = {
  x: new Vector3(1, 0, 0), y: new Vector3(0, -1, 0), z: new Vector3(0, -1e-4, 1), iso: new Vector3(0.9, -1.5, 0.5),
};
export type View = keyof typeof VIEWS;

export class Camera3d {
  private perspective = new PerspectiveCamera(FIELD, 1, 1e-4, 100);
  private parallel = new OrthographicCamera();
  readonly orbit: OrbitControls;
  orthographic = false;
  private width = 1;
  private height = 1;
  private covered = [0, 0, 0, 0];  // px, by panels: left, right, top, bottom
  private half = 1;                // m, half the height of a parallel picture at zoom 1

  constructor(canvas: HTMLElement) {
    for (const camera of [this.perspective, this.parallel]) camera.up.set(0, 0, 1);
    this.orbit = new OrbitControls(this.perspective, canvas);
    this.orbit.enableDamping = true;
    this.orbit.dampingFactor = 0.2;
  }

  get now(): PerspectiveCamera | OrthographicCamera { return this.orthographic ? this.parallel : this.perspective; }

  /** Half the height of the picture at the distance of the robot, m. */
  get span(): number {
    return this.orthographic ? this.half / this.parallel.zoom : HALF * this.perspective.position.distanceTo(this.orbit.target);
  }

  /** Scale of sprites with a constant size on the screen. It is 1 in perspective, where three.js scales them itself. */
  get captionScale(): number { return this.orthographic ? this.span / HALF : 1; }

  /** Sets the size of the robot, m. */
  setSize(size: number): void {
    this.perspective.near = 1e-3 * size;
    this.perspective.far = this.parallel.far = 50 * size;
    this.parallel.near = -50 * size;
    this.project();
  }

  resize(width: number, height: number): void {
    this.width = width;
    this.height = Math.max(height, 1);
    this.project();
  }

  /** Sets the widths covered by panels, px at each side. The picture is centred in the rest. Returns whether they changed. */
  cover(covered: number[]): boolean {
    if (covered.every((side, k) => side === this.covered[k])) return false;
    this.covered = covered;
    this.project();
    return true;
  }

  private project(): void {
    const [left, right, top, bottom] = this.covered;
    const {width: w, height: h} = this;
    this.perspective.aspect = w / h;
    Object.assign(this.parallel, {top: this.half, bottom: -this.half, left: -this.half * w / h, right: this.half * w / h});
    for (const camera of [this.perspective, this.parallel]) camera.setViewOffset(w, h, (right - left) / 2, (bottom - top) / 2, w, h);
  }

  /** Shows the whole box beside the panels. @param view direction; without it, the direction of the camera is kept. */
  fit(box: Box3, view?: View): void {
    const middle = box.getCenter(new Vector3());
    const back = view ? VIEWS[view].clone() : this.now.position.clone().sub(this.orbit.target);
    back.normalize();
    const right = new Vector3().crossVectors(this.now.up, back).normalize();
    const up = new Vector3().crossVectors(back, right);
    const [left, side, top, bottom] = this.covered;
    const free = [Math.max(this.width - left - side, LEAST * this.width), Math.max(this.height - top - bottom, LEAST * this.height)]
      .map((pixels) => pixels / this.height);  // in picture heights
    let distance = 0, half = 0;
    for (const x of [box.min.x, box.max.x]) {
      for (const y of [box.min.y, box.max.y]) {
        for (const z of [box.min.z, box.max.z]) {
          const corner = new Vector3(x, y, z).sub(middle);
          const needed = Math.max(Math.abs(corner.dot(right)) / free[0], Math.abs(corner.dot(up)) / free[1]);
          half = Math.max(half, needed);
          distance = Math.max(distance, needed / HALF + corner.dot(back));
        }
      }
    }
    this.half = MARGIN * half;
    this.parallel.zoom = 1;
    this.place(middle, back.multiplyScalar(MARGIN * distance));
  }

  private place(target: Vector3, offset: Vector3): void {
    this.orbit.target.copy(target);
    for (const camera of [this.perspective, this.parallel]) camera.position.copy(target).add(offset);
    this.project();
    this.orbit.update();
  }

  /** Chooses parallel projection or perspective. The robot keeps its size in the picture. */
  setOrthographic(yes: boolean): void {
    if (yes === this.orthographic) return;
    const span = this.span;
    const offset = this.now.position.clone().sub(this.orbit.target).setLength(span / HALF);
    this.orthographic = yes;
    this.half = span;
    this.parallel.zoom = 1;
    this.orbit.object = this.now;
    this.place(this.orbit.target.clone(), offset);
  }
}
