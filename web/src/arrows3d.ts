// Draws arrows of one colour, over everything else.
import {ConeGeometry, Group, InstancedMesh, Matrix4, MeshBasicMaterial, Quaternion, Vector3} from 'three';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';
import {LineSegments2} from 'three/addons/lines/LineSegments2.js';
import {LineSegmentsGeometry} from 'three/addons/lines/LineSegmentsGeometry.js';

const HEAD = 0.3;  // relative to the arrow
const Y = new Vector3(0, 1, 0);

export class Arrows3d {
  readonly root = new Group();
  private count = 0;

  constructor(private color: number) {}

  /** Draws arrows from (x, y, z) along (dx, dy, dz), m. */
  draw(arrows: number[][]): void {
    this.count = arrows.length;
    this.root.clear();
    if (arrows.length === 0) return;
    const heads = new InstancedMesh(new ConeGeometry(0.35, 1, 10).translate(0, -0.5, 0),
                                    new MeshBasicMaterial({color: this.color, depthTest: false, transparent: true}), arrows.length);
    const lines: number[] = [];
    const turn = new Quaternion(), matrix = new Matrix4();
    arrows.forEach(([x, y, z, dx, dy, dz], k) => {
      const at = new Vector3(x, y, z), by = new Vector3(dx, dy, dz), tip = at.clone().add(by), length = by.length();
      lines.push(...at.toArray(), ...tip.toArray());
      turn.setFromUnitVectors(Y, by.divideScalar(length));
      heads.setMatrixAt(k, matrix.compose(tip, turn, new Vector3(HEAD * length, HEAD * length, HEAD * length)));
    });
    const shafts = new LineSegments2(new LineSegmentsGeometry().setPositions(lines),
                                     new LineMaterial({color: this.color, linewidth: 2, depthTest: false, transparent: true}));
    for (const part of [heads, shafts]) {
      part.frustumCulled = false;
      part.renderOrder = 4;
      this.root.add(part);
    }
  }

  /** For tests: the number of arrows. */
  told(): number { return this.count; }
}
