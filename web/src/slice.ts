// Intersects tetrahedra with a plane. Values at the vertices are interpolated linearly to the faces of the cut.

/** The faces as triangles. Arrays grow as needed; their first `count` triangles and `edges` lines are valid. */
export interface Slice {
  count: number; edges: number;
  positions: Float32Array;    // (9 count,)
  values: Float32Array;       // (3 count,), zero if there are none
  tetrahedra: Uint32Array;    // (count,) to which each triangle belongs
  lines: Float32Array;        // (6 edges,) outlines of the faces of all tetrahedra
}

export function emptySlice(): Slice {
  return {count: 0, edges: 0, positions: new Float32Array(9 * 64), values: new Float32Array(3 * 64),
          tetrahedra: new Uint32Array(64), lines: new Float32Array(6 * 128)};
}

function grown<T extends Float32Array | Uint32Array>(old: T, length: number): T {
  if (old.length >= length) return old;
  const larger = new (old.constructor as new (n: number) => T)(2 * length);
  larger.set(old);
  return larger;
}

// Corners of the face in which the plane cuts a tetrahedron, by a mask whose bit k says that vertex k is before the plane.
// Each corner lies on an edge and is given by its two local vertices. The corners go round the face, so that a
// quadrilateral consists of the triangles 0 1 2 and 0 2 3.
const EDGES: number[][] = Array.from({length: 16}, (_, mask) => {
  const before = [0, 1, 2, 3].filter((k) => mask >> k & 1), behind = [0, 1, 2, 3].filter((k) => !(mask >> k & 1));
  if (before.length === 1) return behind.flatMap((b) => [before[0], b]);
  if (behind.length === 1) return before.flatMap((a) => [a, behind[0]]);
  if (before.length !== 2) return [];
  const [a, b] = before, [c, d] = behind;
  return [a, c, a, d, b, d, b, c];
});

/** Intersects tetrahedra (4 s,) of points (3 n,) with the plane normal . x + constant = 0.
 *  Points in the plane count as before it, so that an element face in the plane is drawn once.
 *  @param values (n,) or null. @param into receives the faces. */
export function slice(tetrahedra: Uint32Array, points: Float32Array, values: Float32Array | null,
                      normal: readonly [number, number, number], constant: number, into: Slice): void {
  const [nx, ny, nz] = normal;
  const height = new Float64Array(points.length / 3);
  for (let i = 0; i < height.length; ++i) {
    height[i] = nx * points[3 * i] + ny * points[3 * i + 1] + nz * points[3 * i + 2] + constant;
  }
  const corner = new Float64Array(4 * 4);  // x, y, z and value of each
  into.count = into.edges = 0;
  for (let t = 0; 4 * t < tetrahedra.length; ++t) {
    let mask = 0;
    for (let k = 0; k < 4; ++k) if (height[tetrahedra[4 * t + k]] >= 0) mask |= 1 << k;
    const edges = EDGES[mask], corners = edges.length / 2;
    if (corners === 0) continue;
    for (let c = 0; c < corners; ++c) {
      const a = tetrahedra[4 * t + edges[2 * c]], b = tetrahedra[4 * t + edges[2 * c + 1]];
      const share = height[a] / (height[a] - height[b]);
      for (let k = 0; k < 3; ++k) corner[4 * c + k] = points[3 * a + k] + share * (points[3 * b + k] - points[3 * a + k]);
      corner[4 * c + 3] = values ? values[a] + share * (values[b] - values[a]) : 0;
    }
    into.positions = grown(into.positions, 9 * (into.count + 2));
    into.values = grown(into.values, 3 * (into.count + 2));
    into.tetrahedra = grown(into.tetrahedra, into.count + 2);
    into.lines = grown(into.lines, 6 * (into.edges + 4));
    for (let triangle = 0; triangle < corners - 2; ++triangle) {
      [0, triangle + 1, triangle + 2].forEach((c, k) => {
        for (let axis = 0; axis < 3; ++axis) into.positions[9 * into.count + 3 * k + axis] = corner[4 * c + axis];
        into.values[3 * into.count + k] = corner[4 * c + 3];
      });
      into.tetrahedra[into.count++] = t;
    }
    for (let c = 0; c < corners; ++c) {
      const next = (c + 1) % corners;
      for (let axis = 0; axis < 3; ++axis) {
        into.lines[6 * into.edges + axis] = corner[4 * c + axis];
        into.lines[6 * into.edges + 3 + axis] = corner[4 * next + axis];
      }
      ++into.edges;
    }
  }
}
