// Triangles in a tree of boxes: which one a ray hits, which one holds a point, and which one is
// nearest.
// Triangles are sorted along a Morton curve; eight neighbours share a box, eight boxes the next.

const kFan = 8;

function spread_bits(x) {
  x = (x | (x << 16)) & 0x030000ff;
  x = (x | (x << 8)) & 0x0300f00f;
  x = (x | (x << 4)) & 0x030c30c3;
  return (x | (x << 2)) & 0x09249249;
}

function sorted_by(codes) {
  let from = new Uint32Array(codes.length);
  for (let i = 0; i < from.length; ++i) from[i] = i;
  let to = new Uint32Array(codes.length);
  for (let shift = 0; shift < 30; shift += 10) {
    const offsets = new Uint32Array(1025);
    for (const code of codes) ++offsets[((code >>> shift) & 1023) + 1];
    for (let k = 0; k < 1024; ++k) offsets[k + 1] += offsets[k];
    for (const i of from) to[offsets[(codes[i] >>> shift) & 1023]++] = i;
    [from, to] = [to, from];
  }
  return from;
}

export class BoxTree {
  /// \param points coordinates of the vertices, `stride` (2 or 3) each
  constructor(points, stride, indices) {
    this.points = points;
    this.stride = stride;
    this.indices = indices;
    this.order = sorted_by(this.morton_codes());
    this.levels = [this.leaf_boxes()];
    while (this.levels.at(-1).length > 6 * kFan) this.levels.push(this.next_level());
  }

  morton_codes() {
    const {points, stride, indices} = this;
    const low = new Array(stride).fill(Infinity);
    const high = new Array(stride).fill(-Infinity);
    for (let i = 0; i < points.length; ++i) {
      const k = i % stride;
      if (points[i] < low[k]) low[k] = points[i];
      if (points[i] > high[k]) high[k] = points[i];
    }
    const scale = low.map((x, k) => (high[k] > x ? 1023 / (3 * (high[k] - x)) : 0));
    const codes = new Uint32Array(indices.length / 3);
    for (let t = 0; t < codes.length; ++t) {
      const a = indices[3 * t] * stride;
      const b = indices[3 * t + 1] * stride;
      const c = indices[3 * t + 2] * stride;
      for (let k = 0; k < stride; ++k) {
        const sum = points[a + k] + points[b + k] + points[c + k] - 3 * low[k];
        codes[t] |= spread_bits(sum * scale[k]) << k;
      }
    }
    return codes;
  }

  leaf_boxes() {
    const {points, stride, indices, order} = this;
    const boxes = empty_boxes(Math.ceil(order.length / kFan));
    for (let i = 0; i < order.length; ++i) {
      const box = 6 * Math.floor(i / kFan);
      for (let corner = 0; corner < 3; ++corner) {
        const at = indices[3 * order[i] + corner] * stride;
        for (let k = 0; k < 3; ++k) {
          const x = k < stride ? points[at + k] : 0;
          if (x < boxes[box + k]) boxes[box + k] = x;
          if (x > boxes[box + 3 + k]) boxes[box + 3 + k] = x;
        }
      }
    }
    return boxes;
  }

  next_level() {
    const below = this.levels.at(-1);
    const boxes = empty_boxes(Math.ceil(below.length / 6 / kFan));
    for (let i = 0; i < below.length / 6; ++i) {
      const box = 6 * Math.floor(i / kFan);
      for (let k = 0; k < 3; ++k) {
        boxes[box + k] = Math.min(boxes[box + k], below[6 * i + k]);
        boxes[box + 3 + k] = Math.max(boxes[box + 3 + k], below[6 * i + 3 + k]);
      }
    }
    return boxes;
  }

  /// Visit triangles, nearest boxes first.
  /// \param bound (boxes, offset) -> least key of what the box holds, Infinity = nothing
  /// \param visit (triangle) -> largest key that is still of interest
  search(bound, visit) {
    let limit = Infinity;
    const descend = (level, first, last) => {
      const boxes = this.levels[level];
      const found = [];
      for (let i = first; i < last; ++i) {
        const key = bound(boxes, 6 * i);
        if (key < Infinity && key <= limit) found.push([key, i]);
      }
      found.sort((a, b) => a[0] - b[0]);
      for (const [key, i] of found) {
        if (key > limit) break;
        const end = (i + 1) * kFan;
        if (level > 0) {
          descend(level - 1, i * kFan, Math.min(end, this.levels[level - 1].length / 6));
          continue;
        }
        for (let j = i * kFan; j < Math.min(end, this.order.length); ++j) {
          limit = visit(this.order[j]);
        }
      }
    };
    const top = this.levels.length - 1;
    descend(top, 0, this.levels[top].length / 6);
  }

  corner(triangle, k) {
    const at = this.indices[3 * triangle + k] * this.stride;
    return [this.points[at], this.points[at + 1], this.stride === 3 ? this.points[at + 2] : 0];
  }

  /// \return the first triangle that the ray hits from either side, {triangle, weights, distance in
  ///   units of the direction}, or null
  ray(origin, direction) {
    let best = null;
    const bound = (boxes, at) => {
      let enter = 0;
      let leave = Infinity;
      for (let k = 0; k < 3; ++k) {
        const low = boxes[at + k] - origin[k];
        const high = boxes[at + 3 + k] - origin[k];
        if (direction[k] === 0) {
          if (low > 0 || high < 0) return Infinity;
          continue;
        }
        const a = low / direction[k];
        const b = high / direction[k];
        enter = Math.max(enter, Math.min(a, b));
        leave = Math.min(leave, Math.max(a, b));
      }
      // A box may be flat, so rounding must not make the ray miss it.
      return enter <= leave * (1 + 1e-12) ? enter * (1 - 1e-12) : Infinity;
    };
    this.search(bound, (triangle) => {
      const hit = this.ray_triangle(origin, direction, triangle);
      if (hit && (!best || hit.distance < best.distance)) best = hit;
      return best ? best.distance : Infinity;
    });
    return best;
  }

  // Moeller and Trumbore 1997.
  ray_triangle(origin, direction, triangle) {
    const a = this.corner(triangle, 0);
    const ab = minus(this.corner(triangle, 1), a);
    const ac = minus(this.corner(triangle, 2), a);
    const p = cross(direction, ac);
    const determinant = dot(ab, p);
    if (determinant === 0) return null;
    const s = minus(origin, a);
    const b1 = dot(s, p) / determinant;
    if (!(b1 >= -1e-9 && b1 <= 1 + 1e-9)) return null;
    const q = cross(s, ab);
    const b2 = dot(direction, q) / determinant;
    if (!(b2 >= -1e-9 && b1 + b2 <= 1 + 1e-9)) return null;
    const distance = dot(ac, q) / determinant;
    return distance >= 0 ? {triangle, weights: [1 - b1 - b2, b1, b2], distance} : null;
  }

  /// Visit every triangle of the plane that holds the point, with its barycentric coordinates.
  holding(x, y, visit) {
    const slack = 1e-6;
    const bound = (boxes, at) => {
      const inside =
        x >= boxes[at] - slack &&
        x <= boxes[at + 3] + slack &&
        y >= boxes[at + 1] - slack &&
        y <= boxes[at + 4] + slack;
      return inside ? 0 : Infinity;
    };
    this.search(bound, (triangle) => {
      const [ax, ay] = this.corner(triangle, 0);
      const [bx, by] = this.corner(triangle, 1);
      const [cx, cy] = this.corner(triangle, 2);
      const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
      if (area !== 0) {
        const b1 = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area;
        const b2 = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area;
        const weights = [1 - b1 - b2, b1, b2];
        if (Math.min(...weights) >= -1e-6) visit(triangle, weights);
      }
      return Infinity;
    });
  }

  /// \return {triangle, weights, distance squared} of the surface's closest point
  nearest(point) {
    let best = {distance: Infinity};
    const bound = (boxes, at) => {
      let sum = 0;
      for (let k = 0; k < 3; ++k) {
        const outside = Math.max(boxes[at + k] - point[k], point[k] - boxes[at + 3 + k], 0);
        sum += outside * outside;
      }
      return sum;
    };
    this.search(bound, (triangle) => {
      const corners = [0, 1, 2].map((k) => this.corner(triangle, k));
      const weights = closest_weights(point, corners);
      const at = blend(corners, weights);
      const distance = dot(minus(at, point), minus(at, point));
      if (distance < best.distance) best = {triangle, weights, distance};
      return best.distance;
    });
    return best;
  }
}

function empty_boxes(count) {
  const boxes = new Float32Array(6 * count);
  for (let i = 0; i < boxes.length; ++i) boxes[i] = i % 6 < 3 ? Infinity : -Infinity;
  return boxes;
}

const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/// The point of a triangle that has these barycentric coordinates.
export function blend([a, b, c], [u, v, w]) {
  return [0, 1, 2].map((k) => u * a[k] + v * b[k] + w * c[k]);
}

// The foot of the perpendicular if the triangle holds it, else the closest point of the edges.
function closest_weights(point, corners) {
  const [a, b, c] = corners;
  const normal = cross(minus(b, a), minus(c, a));
  const area = dot(normal, normal);
  if (area > 0) {
    const b1 = dot(cross(minus(point, a), minus(c, a)), normal) / area;
    const b2 = dot(cross(minus(b, a), minus(point, a)), normal) / area;
    if (b1 >= 0 && b2 >= 0 && b1 + b2 <= 1) return [1 - b1 - b2, b1, b2];
  }
  let best = null;
  let least = Infinity;
  for (let k = 0; k < 3; ++k) {
    const from = corners[k];
    const edge = minus(corners[(k + 1) % 3], from);
    const along = dot(minus(point, from), edge) / (dot(edge, edge) || 1);
    const share = Math.min(1, Math.max(0, along));
    const weights = [0, 0, 0];
    weights[k] = 1 - share;
    weights[(k + 1) % 3] = share;
    const gap = minus(blend(corners, weights), point);
    if (dot(gap, gap) < least) {
      least = dot(gap, gap);
      best = weights;
    }
  }
  return best;
}
