// A plane that cuts bodies open, and the faces of the cut.
import {
  AlwaysStencilFunc, BackSide, BufferGeometry, Color, DecrementWrapStencilOp, DoubleSide, FrontSide, Group, IncrementWrapStencilOp,
  Material, Mesh, MeshBasicMaterial, NotEqualStencilFunc, Plane, PlaneGeometry, ReplaceStencilOp, Side, StencilOp, Vector3,
} from 'three';

export const AXES = ['x', 'y', 'z'] as const;
const SHADE = 0.7;  // of a body's colour on the faces of the cut

/** Counts, pixel by pixel, how often the line of sight enters a closed surface, or leaves it, beyond the plane. */
function counter(geometry: BufferGeometry, side: Side, count: StencilOp, plane: Plane, order: number): Mesh {
  const material = new MeshBasicMaterial({depthWrite: false, depthTest: false, colorWrite: false, side, clippingPlanes: [plane]});
  Object.assign(material, {stencilWrite: true, stencilFunc: AlwaysStencilFunc, stencilFail: count, stencilZFail: count, stencilZPass: count});
  const mesh = new Mesh(geometry, material);
  mesh.renderOrder = order;
  mesh.frustumCulled = false;
  return mesh;
}

export class Section3d {
  readonly plane = new Plane();
  readonly root = new Group();
  on = false;
  private faces: Mesh[] = [];

  constructor() { this.root.visible = false; }

  clear(): void {
    this.root.clear();
    this.faces = [];
  }

  /** Draws the faces of the cut of one more body; `size`: m, beyond which there is nothing. */
  add(geometry: BufferGeometry, color: number, size: number): void {
    const order = -10 + 0.01 * this.faces.length;  // one body after the other, before what is transparent
    const material = new MeshBasicMaterial({color: new Color(color).multiplyScalar(SHADE), side: DoubleSide});
    Object.assign(material, {stencilWrite: true, stencilRef: 0, stencilFunc: NotEqualStencilFunc, stencilFail: ReplaceStencilOp,
                             stencilZFail: ReplaceStencilOp, stencilZPass: ReplaceStencilOp});
    const face = new Mesh(new PlaneGeometry(8 * size, 8 * size), material);
    face.renderOrder = order + 0.005;
    face.frustumCulled = false;
    face.onAfterRender = (renderer) => renderer.clearStencil();
    this.faces.push(face);
    this.root.add(counter(geometry, BackSide, IncrementWrapStencilOp, this.plane, order),
                  counter(geometry, FrontSide, DecrementWrapStencilOp, this.plane, order), face);
  }

  /** Cuts off what lies beyond `at`, m, along an axis, or before it; null: nothing. */
  set(axis: number | null, at: number, before: boolean, middle: Vector3): void {
    this.on = this.root.visible = axis !== null;
    if (axis === null) return;
    this.plane.normal.set(0, 0, 0).setComponent(axis, before ? 1 : -1);
    this.plane.constant = before ? -at : at;
    for (const face of this.faces) {
      face.position.copy(this.plane.projectPoint(middle, new Vector3()));
      face.lookAt(face.position.clone().add(this.plane.normal));
    }
  }

  cut(material: Material): void { material.clippingPlanes = this.on ? [this.plane] : null; }

  /** Whether a point is shown. */
  shows(point: Vector3): boolean { return !this.on || this.plane.distanceToPoint(point) >= 0; }
}
