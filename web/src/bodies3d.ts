// Draws the bodies in three dimensions: their surfaces and, where a section cuts them open, their interiors.
import {
  Box3, BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, MeshStandardMaterial, Raycaster, Vector3,
} from 'three';
import {linearTable, paint} from './colours';
import type {Spot} from './picked';
import {NONE} from './protocol';
import type {Frame, Interior, Surface} from './protocol';
import {Section3d} from './section3d';

const BODY_COLOURS = [0xd9a066, 0x7fa6c9, 0x9cb380];  // also differ in lightness
const OPACITY = 0.82;  // of a body that is not coloured by a field
const colourOf = (body: number) => BODY_COLOURS[body % BODY_COLOURS.length];

interface Body {
  mesh: Mesh<BufferGeometry, MeshStandardMaterial>; wire: Mesh<BufferGeometry, MeshBasicMaterial>; colours: Float32Array;
  surface: Surface;
  /** The interior that a section shows, once received: positions of all vertices, and their field values if a field is chosen. */
  inside?: {interior: Interior; points: Float32Array; known: boolean; values: Float32Array; valued: boolean};
}

/** The hit of a ray: a triangle of the surface, or a face of an element that a section cuts. */
export interface Hit {body: number; point: Vector3; vertices: number[]; element: number; cut: boolean}

export class Bodies3d {
  readonly root = new Group();
  private section = new Section3d();
  private bodies: Body[] = [];
  private table = linearTable('viridis');
  private range: [number, number] = [0, 0];  // of the colour map
  private size = 0.2;
  wireframe = false;
  coloured = false;

  constructor() { this.root.add(this.section.root); }

  get count(): number { return this.bodies.length; }

  /** Starts a new scene, without bodies. @param size of the robot, m. */
  scene(size: number): void {
    for (const {mesh, wire} of this.bodies) this.root.remove(mesh, wire);
    this.section.clear();
    this.bodies = [];
    this.size = size;
  }

  surface(surface: Surface): void {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(surface.rest.slice(), 3));
    geometry.setIndex(new BufferAttribute(surface.triangles, 1));
    const colours = new Float32Array(surface.rest.length);
    geometry.setAttribute('color', new BufferAttribute(colours, 3));
    geometry.computeVertexNormals();
    const color = colourOf(surface.body);
    const material = new MeshStandardMaterial({color, roughness: 0.65, side: DoubleSide,
                                               transparent: true, opacity: OPACITY});
    const mesh = new Mesh(geometry, material);
    if (surface.elements.every((element) => element === NONE)) this.section.fill(geometry, color, this.size);
    const wire = new Mesh(geometry, new MeshBasicMaterial({color: 0x222222, wireframe: true, transparent: true,
                                                           opacity: 0.25}));
    mesh.frustumCulled = wire.frustumCulled = false;
    wire.visible = this.wireframe;
    this.bodies[surface.body] = {mesh, wire, colours, surface};
    this.root.add(mesh, wire);
  }

  interior(interior: Interior): void {
    const body = this.bodies[interior.body];
    if (!body || interior.elements.length === 0) return;
    const count = body.surface.nodes.length + interior.nodes.length;
    body.inside = {interior, points: new Float32Array(3 * count), known: false, values: new Float32Array(count), valued: false};
    this.section.open(interior.body, interior.tetrahedra, colourOf(interior.body));
  }

  map(name: string): void { this.table = linearTable(name); }

  /** Updates the bodies from a frame. The colour map extends from low to high. */
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
        material.transparent = !this.coloured;  // else objects behind would change the colours
        material.opacity = this.coloured ? 1 : OPACITY;
        material.needsUpdate = true;
        material.color.set(this.coloured ? 0xffffff : colourOf(body.surface.body));
      }
      body.wire.visible = this.wireframe;
    }
    this.range = [low, high];
    this.fillInside(frame);
    this.drawCuts();
  }

  // Concatenates positions and values of the surface's vertices and of the inner ones.
  private fillInside(frame: Frame): void {
    this.bodies.forEach(({inside, mesh, surface}, index) => {
      if (!inside) return;
      const outer = surface.nodes.length, {points, values} = inside;
      const inner = frame.inner.get(index), field = frame.fields.get(index)?.values, innerField = frame.innerFields.get(index);
      if (inner?.length === points.length - 3 * outer) {
        points.set((mesh.geometry.getAttribute('position') as BufferAttribute).array as Float32Array);
        points.set(inner, 3 * outer);
        inside.known = true;
      }
      inside.valued = this.coloured && field !== undefined && innerField?.length === values.length - outer;
      if (!inside.valued) return;
      values.set(field!);
      values.set(innerField!, outer);
    });
  }

  private drawCuts(): void {
    if (!this.section.on) return;
    const [low, high] = this.range;
    this.bodies.forEach(({inside}, index) => {
      if (!inside?.known) return;
      this.section.of(index)!.update(this.section.plane, inside.points, inside.valued ? inside.values : null,
                                     {low, high, table: this.table}, this.wireframe);
    });
  }

  /** Cuts bodies open, see Section3d.set(). Returns true when a section begins or ends, so that interiors are needed or no longer. */
  cut(axis: number | null, at: number, before: boolean, middle: Vector3): boolean {
    const was = this.section.on;
    this.section.set(axis, at, before, middle);
    for (const {mesh, wire} of this.bodies) for (const {material} of [mesh, wire]) this.section.cut(material);
    if (was !== this.section.on) {
      for (const body of this.bodies) body.inside = undefined;  // it is sent again
      this.section.close();
    }
    this.drawCuts();
    return was !== this.section.on;
  }

  /** For tests: describes the faces of a body's cut; null if there is none. */
  cutTold(body: number) { return this.section.of(body)?.told() ?? null; }

  get isCut(): boolean { return this.section.on; }

  /** The position of a vertex of a surface. */
  vertex(body: number, vertex: number): Vector3 {
    return new Vector3().fromBufferAttribute(this.bodies[body].mesh.geometry.getAttribute('position') as BufferAttribute, vertex);
  }

  /** The bounding box of all surfaces. */
  box(): Box3 {
    const box = new Box3();
    for (const {mesh} of this.bodies) {
      box.union(new Box3().setFromBufferAttribute(mesh.geometry.getAttribute('position') as BufferAttribute));
    }
    return box;
  }

  /** The first hit of a ray on the visible part of the bodies. */
  hit(caster: Raycaster): Hit | null {
    const first = caster.intersectObjects(this.bodies.map((b) => b.mesh)).find(({face, point}) => face && this.section.shows(point));
    const cut = this.section.hit(caster);
    if (cut && !(first && first.distance < cut.distance)) {
      const {tetrahedra, elements} = this.bodies[cut.body].inside!.interior;
      return {body: cut.body, point: cut.point, vertices: [...tetrahedra.subarray(4 * cut.tetrahedron, 4 * cut.tetrahedron + 4)],
              element: elements[cut.tetrahedron], cut: true};
    }
    if (!first?.face) return null;
    const body = this.bodies.findIndex((b) => b.mesh === first.object);
    return {body, point: first.point, vertices: [first.face.a, first.face.b, first.face.c],
            element: this.bodies[body].surface.elements[first.faceIndex!], cut: false};
  }

  /** The element at a hit, and the node of the face that is nearest to it. */
  spot(found: Hit): Spot {
    const {surface: {nodes}, inside} = this.bodies[found.body];
    const place = (vertex: number) => vertex < nodes.length ? this.vertex(found.body, vertex)
      : new Vector3().fromArray(inside!.points, 3 * vertex);
    const node = (vertex: number) => vertex < nodes.length ? nodes[vertex] : inside!.interior.nodes[vertex - nodes.length];
    const [nearest] = found.vertices.filter((vertex) => node(vertex) !== NONE)
      .sort((a, b) => place(a).distanceTo(found.point) - place(b).distanceTo(found.point));
    return {body: found.body, node: node(nearest), element: found.element === NONE ? -1 : found.element};
  }
}
