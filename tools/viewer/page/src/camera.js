// The camera: it looks from azimuth and elevation at a target, with an extent as the height of the
// view there. Same convention as the program's --azimuth, --elevation, --target and --extent.
import {Matrix4, PerspectiveCamera, Vector3} from 'three';

export const kFieldOfView = 30; // degrees, vertical
const kTangent = Math.tan(((kFieldOfView / 2) * Math.PI) / 180);
const kFill = 0.92; // share of the view that the model takes at first

const ups = {
  x: [1, 0, 0],
  y: [0, 1, 0],
  z: [0, 0, 1],
  '-x': [-1, 0, 0],
  '-y': [0, -1, 0],
  '-z': [0, 0, -1],
};

export class OrbitCamera {
  /// \param box the mesh's bounding box
  constructor(description, box) {
    this.box = box;
    this.up = new Vector3(...(ups[description.up] ?? ups.y));
    // A frame with `up` and a direction at azimuth 0 that is not parallel to it.
    const front = Math.abs(this.up.z) < 0.9 ? new Vector3(0, 0, 1) : new Vector3(0, -1, 0);
    this.zero = front.addScaledVector(this.up, -front.dot(this.up)).normalize();
    this.side = this.up.clone().cross(this.zero);
    this.home = description;
    // Drawn in units of the box's diagonal around its centre, whatever the units of the mesh.
    this.three = new PerspectiveCamera(kFieldOfView, 1, 0.1, 10);
    this.three.matrixAutoUpdate = false;
    this.azimuth = description.azimuth;
    this.elevation = description.elevation;
    this.target = [...(description.target ?? box.centre)];
    this.extent = description.extent ?? box.diagonal;
    this.moved = false;
  }

  /// Back to the first view. \param positions vertices to frame, aspect width over height
  reset(positions, aspect) {
    this.azimuth = this.home.azimuth;
    this.elevation = this.home.elevation;
    this.frame(positions, aspect);
  }

  /// Show all vertices from where the camera looks, unless the scene says what to show.
  frame(positions, aspect) {
    this.target = [...(this.home.target ?? this.box.centre)];
    this.moved = false;
    if (this.home.extent) {
      this.extent = this.home.extent;
      return;
    }
    const {right, up, back} = this.axes();
    const [cx, cy, cz] = this.target;
    let distance = 1e-6 * this.box.diagonal;
    for (let i = 0; i < positions.length; i += 3) {
      const x = positions[i] - cx;
      const y = positions[i + 1] - cy;
      const z = positions[i + 2] - cz;
      const across = Math.abs(right.x * x + right.y * y + right.z * z) / aspect;
      const high = Math.abs(up.x * x + up.y * y + up.z * z);
      const near = back.x * x + back.y * y + back.z * z;
      distance = Math.max(distance, near + Math.max(across, high) / kTangent / kFill);
    }
    this.extent = (2 * kTangent * distance) / (this.home.zoom || 1);
  }

  axes() {
    const azimuth = (this.azimuth * Math.PI) / 180;
    const elevation = (this.elevation * Math.PI) / 180;
    const around = this.zero
      .clone()
      .multiplyScalar(Math.cos(azimuth))
      .addScaledVector(this.side, Math.sin(azimuth));
    const back = around
      .multiplyScalar(Math.cos(elevation))
      .addScaledVector(this.up, Math.sin(elevation));
    const right = this.side
      .clone()
      .multiplyScalar(Math.cos(azimuth))
      .addScaledVector(this.zero, -Math.sin(azimuth));
    return {right, up: back.clone().cross(right), back};
  }

  distance() {
    return this.extent / 2 / kTangent;
  }

  eye() {
    const {back} = this.axes();
    const distance = this.distance();
    return this.target.map((x, k) => x + distance * back.getComponent(k));
  }

  orbit(degrees_right, degrees_up) {
    this.azimuth = ((((this.azimuth - degrees_right + 180) % 360) + 360) % 360) - 180;
    this.elevation = Math.min(90, Math.max(-90, this.elevation + degrees_up));
    this.moved = true;
  }

  /// \param x, y shares of the view's height by which the model moves right and up
  pan(x, y) {
    const {right, up} = this.axes();
    this.target = this.target.map(
      (at, k) => at - this.extent * (x * right.getComponent(k) + y * up.getComponent(k)),
    );
    this.moved = true;
  }

  /// \param x, y the point of the view that stays, shares of its height from the centre
  zoom(factor, x = 0, y = 0) {
    const {diagonal} = this.box;
    const extent = Math.min(50 * diagonal, Math.max(1e-5 * diagonal, this.extent / factor));
    const change = extent / this.extent - 1;
    this.pan(x * change, y * change);
    this.extent = extent;
  }

  /// Ready the three.js camera for a view of this aspect.
  apply(aspect) {
    const {centre, diagonal} = this.box;
    const {right, up, back} = this.axes();
    const eye = this.eye().map((x, k) => (x - centre[k]) / diagonal);
    const distance = Math.hypot(...eye);
    this.three.matrix.copy(new Matrix4().makeBasis(right, up, back)).setPosition(...eye);
    this.three.aspect = aspect;
    this.three.near = Math.max(distance - 0.6, this.distance() / diagonal / 500);
    this.three.far = Math.max(distance + 0.6, 2 * this.three.near);
    this.three.updateProjectionMatrix();
    this.three.updateMatrixWorld(true);
  }

  /// \param x, y from -1 to 1 in the view. \return {origin, direction} in mesh units
  ray(x, y, aspect) {
    const {right, up, back} = this.axes();
    const direction = [0, 1, 2].map(
      (k) =>
        kTangent * (x * aspect * right.getComponent(k) + y * up.getComponent(k)) -
        back.getComponent(k),
    );
    return {origin: this.eye(), direction};
  }

  /// \return {x, y} from -1 to 1 where a point is seen, and its distance along the ray
  project(point, aspect) {
    const {right, up, back} = this.axes();
    const eye = this.eye();
    const d = new Vector3(...point.map((x, k) => x - eye[k]));
    const depth = -d.dot(back);
    return {x: d.dot(right) / depth / kTangent / aspect, y: d.dot(up) / depth / kTangent, depth};
  }
}
