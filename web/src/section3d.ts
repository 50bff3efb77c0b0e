// The section: a plane that cuts bodies open, and the faces of the cut.
import {
  AlwaysStencilFunc, BackSide, BufferAttribute, BufferGeometry, Color, DecrementWrapStencilOp, DoubleSide, FrontSide, Group,
  IncrementWrapStencilOp, LineBasicMaterial, LineSegments, Material, Mesh, MeshBasicMaterial, NotEqualStencilFunc, Plane, PlaneGeometry,
  Raycaster, ReplaceStencilOp, Side, StencilOp, Vector3,
} from 'three';
import {paint} from './colours';
import {emptySlice, slice} from './slice';

export const AXES = ['x', 'y', 'z'] as const;
const SHADE = 0.7;  // factor on a body's colour on the faces of the cut

/** Counts in the stencil buffer how often the line of sight of a pixel enters or leaves a closed surface on the visible side of the plane. */
function counter(geometry: BufferGeometry, side: Side, count: StencilOp, plane: Plane, order: number): Mesh {
  const material = new MeshBasicMaterial({depthWrite: false, depthTest: false, colorWrite: false, side, clippingPlanes: [plane]});
  Object.assign(material, {stencilWrite: true, stencilFunc: AlwaysStencilFunc, stencilFail: count, stencilZFail: count, stencilZPass: count});
  const mesh = new Mesh(geometry, material);
  mesh.renderOrder = order;
  mesh.frustumCulled = false;
  return mesh;
}

/** Range and colour map of a field. */
export interface Paint {low: number; high: number; table: Float32Array}

/** The faces in which the plane cuts the elements of a body. */
export class Cut {
  readonly faces: Mesh<BufferGeometry, MeshBasicMaterial>;
  readonly outlines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({color: 0x222222, transparent: true, opacity: 0.35}));
  private shape = emptySlice();
  private colours = new Float32Array(0);

  /** @param tetrahedra (4 s,) vertices, into which the elements are split. */
  constructor(private tetrahedra: Uint32Array, private color: number) {
    this.faces = new Mesh(new BufferGeometry(), new MeshBasicMaterial({side: DoubleSide}));
    this.faces.frustumCulled = this.outlines.frustumCulled = false;
    this.faces.renderOrder = -1;  // before transparent objects
  }

  /** @param values of the vertices, coloured by `colours`; null: the faces have the body's colour. */
  update(plane: Plane, points: Float32Array, values: Float32Array | null, colours: Paint | null, outlined: boolean): void {
    const {shape} = this, {geometry, material} = this.faces;
    slice(this.tetrahedra, points, values, plane.normal.toArray(), plane.constant, shape);
    replace(geometry, 'position', shape.positions, 3 * shape.count);
    const painted = values !== null && colours !== null;
    if (painted) {
      if (this.colours.length < shape.positions.length) this.colours = new Float32Array(shape.positions.length);
      paint(shape.values.subarray(0, 3 * shape.count), colours.low, colours.high, colours.table, this.colours);
      replace(geometry, 'color', this.colours, 3 * shape.count);
    }
    if (material.vertexColors !== painted) {
      material.vertexColors = painted;
      material.needsUpdate = true;
    }
    material.color.set(painted ? 0xffffff : this.color).multiplyScalar(painted ? 1 : SHADE);
    geometry.setDrawRange(0, 3 * shape.count);
    this.outlines.visible = outlined;
    if (!outlined) return;
    replace(this.outlines.geometry, 'position', shape.lines, 2 * shape.edges);
    this.outlines.geometry.setDrawRange(0, 2 * shape.edges);
  }

  /** The tetrahedron to which a triangle of the faces belongs. */
  tetrahedron(triangle: number): number { return this.shape.tetrahedra[triangle]; }

  /** For tests: area of the faces, m^2, range of their values, and number of triangles. */
  told(): {area: number; low: number; high: number; triangles: number} {
    const {positions, values, count} = this.shape;
    let area = 0, low = Infinity, high = -Infinity;
    for (let t = 0; t < count; ++t) {
      const [a, b, c] = [0, 3, 6].map((k) => new Vector3().fromArray(positions, 9 * t + k));
      area += b.sub(a).cross(c.sub(a)).length() / 2;
      for (const value of values.subarray(3 * t, 3 * t + 3)) [low, high] = [Math.min(low, value), Math.max(high, value)];
    }
    return {area, low, high, triangles: count};
  }
}

// Sets an attribute. A reallocated array needs a new one; otherwise only the used part of the array is uploaded.
function replace(geometry: BufferGeometry, name: string, array: Float32Array, used: number): void {
  let attribute = geometry.getAttribute(name) as BufferAttribute | undefined;
  if (attribute?.array !== array) {
    attribute = new BufferAttribute(array, 3);
    geometry.setAttribute(name, attribute);
  }
  attribute.clearUpdateRanges();
  attribute.addUpdateRange(0, 3 * used);
  attribute.needsUpdate = true;
  geometry.boundingSphere = null;
}

export class Section3d {
  readonly plane = new Plane();
  readonly root = new Group();
  on = false;
  private caps: Mesh[] = [];
  private cuts = new Map<number, Cut>();

  constructor() { this.root.visible = false; }

  clear(): void {
    this.root.clear();
    this.caps = [];
    this.cuts.clear();
  }

  /** Caps a closed surface without elements where the plane cuts it. @param size of the robot, m. */
  fill(geometry: BufferGeometry, color: number, size: number): void {
    const order = -10 + 0.01 * this.caps.length;  // one body after the other, before transparent objects
    const material = new MeshBasicMaterial({color: new Color(color).multiplyScalar(SHADE), side: DoubleSide});
    Object.assign(material, {stencilWrite: true, stencilRef: 0, stencilFunc: NotEqualStencilFunc, stencilFail: ReplaceStencilOp,
                             stencilZFail: ReplaceStencilOp, stencilZPass: ReplaceStencilOp});
    const face = new Mesh(new PlaneGeometry(8 * size, 8 * size), material);
    face.renderOrder = order + 0.005;
    face.frustumCulled = false;
    face.onAfterRender = (renderer) => renderer.clearStencil();
    this.caps.push(face);
    this.root.add(counter(geometry, BackSide, IncrementWrapStencilOp, this.plane, order),
                  counter(geometry, FrontSide, DecrementWrapStencilOp, this.plane, order), face);
  }

  /** Adds the elements of a body to those that are cut, or replaces them. */
  open(body: number, tetrahedra: Uint32Array, color: number): void {
    const before = this.cuts.get(body);
    if (before) this.root.remove(before.faces, before.outlines);
    const cut = new Cut(tetrahedra, color);
    this.cuts.set(body, cut);
    this.root.add(cut.faces, cut.outlines);
  }

  /** Removes the cuts of all bodies with elements, until open() adds them again. */
  close(): void {
    for (const {faces, outlines} of this.cuts.values()) {
      this.root.remove(faces, outlines);
      faces.geometry.dispose();
      outlines.geometry.dispose();
    }
    this.cuts.clear();
  }

  of(body: number): Cut | undefined { return this.cuts.get(body); }

  /** Hides the part of the bodies beyond the coordinate `at`, m, of an axis, or the part before it. @param axis null: no section.
   *  @param middle of the robot, near which caps are placed. */
  set(axis: number | null, at: number, before: boolean, middle: Vector3): void {
    this.on = this.root.visible = axis !== null;
    if (axis === null) return;
    this.plane.normal.set(0, 0, 0).setComponent(axis, before ? 1 : -1);
    this.plane.constant = before ? -at : at;
    for (const face of this.caps) {
      face.position.copy(this.plane.projectPoint(middle, new Vector3()));
      face.lookAt(face.position.clone().add(this.plane.normal));
    }
  }

  cut(material: Material): void { material.clippingPlanes = this.on ? [this.plane] : null; }

  /** Whether a point is on the visible side of the section. */
  shows(point: Vector3): boolean { return !this.on || this.plane.distanceToPoint(point) >= 0; }

  /** The first hit of a ray on a face of cut elements, with the body and its tetrahedron. */
  hit(caster: Raycaster): {body: number; tetrahedron: number; point: Vector3; distance: number} | null {
    if (!this.on) return null;
    let first = null;
    for (const [body, cut] of this.cuts) {
      for (const {faceIndex, point, distance} of caster.intersectObject(cut.faces)) {
        if (first && first.distance <= distance) continue;
        first = {body, tetrahedron: cut.tetrahedron(faceIndex!), point, distance};
      }
    }
    return first;
  }
}
