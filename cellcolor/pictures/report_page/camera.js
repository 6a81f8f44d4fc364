// Where the eye is, and how pointers move it: drag to turn, wheel or two fingers to zoom, Shift or
// the right button to shift.
"use strict";

const LENS = Math.tan(0.3); // of half the angle that is seen from top to bottom

class Camera {
  constructor(canvas, changed) {
    this.canvas = canvas;
    this.changed = changed;
    this.pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    const lost = (event) => this.pointers.delete(event.pointerId);
    canvas.addEventListener("pointerup", lost);
    canvas.addEventListener("pointercancel", lost);
    canvas.addEventListener("pointermove", (event) => this.moved(event));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.zoom(Math.exp(0.0012 * event.deltaY));
      },
      { passive: false },
    );
  }

  // Look from a direction at points, so that all of them are just in the picture.
  look(points, direction) {
    this.turn = Math.atan2(direction[1], direction[0]);
    this.rise = Math.asin(direction[2]);
    const axes = this.axes(), { clientWidth, clientHeight } = this.canvas;
    const [low, high] = this.extent(points, axes);
    this.middle = [0, 1, 2].map((k) =>
      axes.reduce((sum, axis, n) => sum + (0.5 * (low[n] + high[n])) * axis[k], 0));
    const half = [(LENS * clientWidth) / clientHeight, LENS];
    this.fit = Math.max(
      ...points.map((point) => {
        const [x, y, z] = axes.map((axis) => dot(minus(point, this.middle), axis));
        return z + (1.06 * Math.max(Math.abs(x) / half[0], Math.abs(y) / half[1]));
      }),
    );
    this.reach = this.size(points);
    this.scale = 1;
    this.changed();
  }

  // The least and the greatest coordinates of points along three axes.
  extent(points, axes) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const point of points)
      axes.forEach((axis, n) => {
        low[n] = Math.min(low[n], dot(point, axis));
        high[n] = Math.max(high[n], dot(point, axis));
      });
    return [low, high];
  }

  // The diagonal of the box round points.
  size(points) {
    const [low, high] = this.extent(points, [[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    return Math.hypot(...minus(high, low));
  }

  zoom(factor) {
    this.scale = Math.min(6, Math.max(0.05, this.scale * factor));
    this.changed();
  }

  moved(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    if (this.pointers.size === 2) {
      const [other] = [...this.pointers.entries()].filter(([id]) => id !== event.pointerId);
      const apart = (at) => Math.hypot(at[0] - other[1][0], at[1] - other[1][1]) || 1;
      this.scale *= apart(before) / apart(now);
      this.shift(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons === 2) this.shift(dx, dy);
    else {
      this.turn -= 0.008 * dx;
      this.rise = Math.min(1.55, Math.max(-1.55, this.rise + 0.008 * dy));
    }
    this.pointers.set(event.pointerId, now);
    this.changed();
  }

  shift(dx, dy) {
    const [right, up] = this.axes(), far = (2 * this.far()) / this.canvas.clientHeight;
    const size = LENS * far;
    this.middle = this.middle.map((m, k) => m - size * dx * right[k] + size * dy * up[k]);
  }

  axes() {
    const back = [
      Math.cos(this.rise) * Math.cos(this.turn),
      Math.cos(this.rise) * Math.sin(this.turn),
      Math.sin(this.rise),
    ];
    const right = [-Math.sin(this.turn), Math.cos(this.turn), 0];
    return [right, cross(back, right), back];
  }

  // From the middle of what is seen.
  far() {
    return this.scale * this.fit;
  }

  view() {
    const [right, up, back] = this.axes(), far = this.far();
    const eye = this.middle.map((m, k) => m + far * back[k]);
    const turn = [right, up, back].flatMap((axis) => [...axis, -dot(axis, eye)]);
    const near = Math.max(0.02 * far, far - 3 * this.reach), end = far + 3 * this.reach;
    const { width, height } = this.canvas, cot = 1 / LENS;
    const lens = [
      (cot * height) / width, 0, 0, 0,
      0, cot, 0, 0,
      0, 0, (near + end) / (near - end), (2 * near * end) / (near - end),
      0, 0, -1, 0,
    ];
    const ratio = width / this.canvas.clientWidth;
    return { camera: times(lens, [...turn, 0, 0, 0, 1]), eye, width, height, ratio };
  }
}
