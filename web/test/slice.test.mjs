// Tests of the intersection of tetrahedra with a plane, without a browser.
import assert from 'node:assert/strict';
import {dirname, join} from 'node:path';
import {test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {build} from 'esbuild';

const source = join(dirname(fileURLToPath(import.meta.url)), '../src/slice.ts');
const {outputFiles: [{text}]} = await build({entryPoints: [source], bundle: true, format: 'esm', write: false});
const {slice, emptySlice} = await import(`data:text/javascript;base64,${Buffer.from(text).toString('base64')}`);

const CELLS = 3;
const SIDES = [[1, 2, 4], [2, 1, 4], [1, 4, 2], [4, 1, 2], [2, 4, 1], [4, 2, 1]];  // paths along the edges of a cube, as steps in bits

/** The unit cube, with each cell split into Kuhn's six tetrahedra. */
function cube() {
  const n = CELLS + 1, points = [], tetrahedra = [];
  for (let k = 0; k < n; ++k) for (let j = 0; j < n; ++j) for (let i = 0; i < n; ++i) points.push(i / CELLS, j / CELLS, k / CELLS);
  for (let k = 0; k < CELLS; ++k) for (let j = 0; j < CELLS; ++j) for (let i = 0; i < CELLS; ++i) {
    const corner = (bits) => i + (bits & 1) + n * (j + (bits >> 1 & 1) + n * (k + (bits >> 2 & 1)));
    for (const [a, b, c] of SIDES) tetrahedra.push(corner(0), corner(a), corner(a + b), corner(a + b + c));
  }
  return {points: new Float32Array(points), tetrahedra: new Uint32Array(tetrahedra)};
}
const value = (x, y, z) => 2 + 3 * x - 5 * y + 7 * z;

const {points, tetrahedra} = cube();
const values = new Float32Array(points.length / 3).map((_, i) => value(...points.subarray(3 * i, 3 * i + 3)));

function cut(normal, constant) {
  const faces = emptySlice();
  slice(tetrahedra, points, values, normal, constant, faces);
  let area = 0;
  for (let t = 0; t < faces.count; ++t) {
    const [a, b, c] = [0, 3, 6].map((k) => [...faces.positions.subarray(9 * t + k, 9 * t + k + 3)]);
    [a, b, c].forEach((p, k) => {
      assert.ok(Math.abs(normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2] + constant) < 1e-6, 'in the plane');
      assert.ok(Math.abs(faces.values[3 * t + k] - value(...p)) < 1e-5, 'linear fields are cut exactly');
    });
    const u = b.map((x, k) => x - a[k]), v = c.map((x, k) => x - a[k]);
    area += 0.5 * Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    const own = [0, 1, 2, 3].map((k) => tetrahedra[4 * faces.tetrahedra[t] + k]);
    [0, 1, 2].forEach((axis) => {
      const range = own.map((node) => points[3 * node + axis]), middle = (a[axis] + b[axis] + c[axis]) / 3;
      assert.ok(middle > Math.min(...range) - 1e-6 && middle < Math.max(...range) + 1e-6, 'of this tetrahedron');
    });
  }
  return {area, faces};
}

test('the faces of a cut have the area of the section', () => {
  assert.ok(Math.abs(cut([1, 0, 0], -0.4).area - 1) < 1e-6);
  assert.ok(Math.abs(cut([0, -1, 0], 0.9).area - 1) < 1e-6, 'the other side');
  // The plane perpendicular to the diagonal of the cube at its middle cuts a regular hexagon of side sqrt(1/2).
  const third = Math.sqrt(1 / 3);
  assert.ok(Math.abs(cut([third, third, third], -1.5 * third).area - 0.75 * Math.sqrt(3)) < 1e-6);
});

test('faces of elements that lie in the plane are drawn once', () => {
  const {area} = cut([0, 0, 1], -points[3 * (CELLS + 1) ** 2 + 2]);
  assert.ok(Math.abs(area - 1) < 1e-6, String(area));
});

test('a plane beside the body cuts nothing', () => {
  assert.equal(cut([0, 0, 1], 0.1).faces.count, 0);
  assert.equal(cut([0, 0, 1], -1.1).faces.count, 0);
});

test('outlines go round the faces of tetrahedra', () => {
  const {faces} = cut([0.6, 0, 0.8], -0.5);
  assert.ok(faces.edges >= 3 && faces.edges === [...new Set(faces.tetrahedra.subarray(0, faces.count))]
    .reduce((sum, t) => sum + (faces.tetrahedra.subarray(0, faces.count).filter((u) => u === t).length + 2), 0));
});
