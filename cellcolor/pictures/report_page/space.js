// The 3D view: the part in one of its modes, the arm at a moment, the path up to that moment.
"use strict";

const STATES = [rgb("#E69F00"), rgb("#00508F"), rgb("#CC3311")]; // between, in contact, not planned
const INK = rgb("#222222");

class Space {
  constructor(canvas, overlay, data) {
    const gl = canvas.getContext("webgl2", { antialias: true });
    if (!gl) throw new Error("this browser cannot draw in 3D (WebGL 2)");
    Object.assign(this, { canvas, overlay, data, gl });
    this.painter = new Painter(gl);
    this.shown = { arm: true, path: true, moves: true, around: true };
    this.dirty = true;
    this.part();
    this.surroundings();
    this.path();
    this.arm();
    this.camera = new Camera(canvas, () => (this.dirty = true));
    this.measure();
    this.look("whole");
    this.mode(0);
    new ResizeObserver(() => (this.dirty = true)).observe(canvas);
  }

  part() {
    this.vertices = unpack(this.data.mesh.vertices);
    this.faces = unpack(this.data.mesh.faces);
    const cut = cutPart(this.vertices, this.faces);
    this.owner = cut.owner;
    this.surface = this.painter.mesh(cut);
    this.modes = this.data.modes.map((mode) => {
      const labels = unpack(mode.labels), fills = mode.classes.map((own) => rgb(own.rgb));
      const colors = new Float32Array(3 * this.owner.length);
      this.owner.forEach((vertex, corner) => colors.set(fills[labels[vertex]], 3 * corner));
      return {
        colors: this.painter.buffer(colors),
        borders: this.painter.lines(this.borders(cut, labels)),
      };
    });
  }

  // Where the class changes: the sides, from a middle of an edge to a face's center, of its areas;
  // and the rim of the part.
  borders({ positions, normals }, labels) {
    const pieces = [], beside = new Map();
    let size = 0;
    for (let k = 0; k < 30 && 18 * k + 6 < positions.length; k++)
      size += Math.hypot(...minus(positions.subarray(18 * k, 18 * k + 3), positions.subarray(18 * k + 3, 18 * k + 6)));
    const lift = (0.02 * size) / 30;
    const at = (corner) =>
      [0, 1, 2].map((k) => positions[3 * corner + k] + lift * normals[3 * corner + k]);
    const add = (from, to) => pieces.push({ from: at(from), to: at(to), color: INK, moments: [0, 0] });
    for (let face = 0; face < this.faces.length / 3; face++)
      for (let k = 0; k < 3; k++) {
        const [a, b] = [this.faces[3 * face + k], this.faces[3 * face + ((k + 1) % 3)]];
        const first = 18 * face + 6 * k; // of the two small triangles of this corner
        if (labels[a] !== labels[b]) add(first + 1, first + 2);
        if (beside.has(`${b},${a}`)) beside.delete(`${b},${a}`);
        else beside.set(`${a},${b}`, [first, 18 * face + 6 * ((k + 1) % 3)]);
      }
    for (const [from, to] of beside.values()) add(from, to);
    return pieces;
  }

  surroundings() {
    this.solids = this.data.solids.map((solid) =>
      this.painter.mesh(soup(unpack(solid.points), unpack(solid.triangles)), rgb(solid.rgb)));
    this.grid = this.painter.lines([]);
    if (this.data.ground === null) return;
    const points = [...this.vertices], low = [0, 0], high = [0, 0];
    for (let k = 0; k < points.length; k += 3)
      for (const axis of [0, 1]) {
        low[axis] = Math.min(low[axis], points[k + axis]);
        high[axis] = Math.max(high[axis], points[k + axis]);
      }
    const step = 0.1, [nx, ny, nz, offset] = this.data.ground, pieces = [], color = rgb("#C9CDD4");
    const [x0, y0] = low.map((value) => step * Math.floor((value - 0.25) / step));
    const [x1, y1] = high.map((value) => step * Math.ceil((value + 0.25) / step));
    const on = (x, y) => [x, y, (offset - nx * x - ny * y) / nz];
    const add = (from, to) => pieces.push({ from, to, color, moments: [0, 0] });
    for (let x = x0; x <= x1 + 1e-9; x += step) add(on(x, y0), on(x, y1));
    for (let y = y0; y <= y1 + 1e-9; y += step) add(on(x0, y), on(x1, y));
    this.grid = this.painter.lines(pieces);
  }

  path() {
    const { trace } = this.data;
    const points = unpack(trace.points), moments = unpack(trace.times), states = unpack(trace.state);
    const whole = [[], [], []], driven = [[], [], []];
    for (let k = 0; k + 1 < moments.length; k++) {
      if (states[k] > 2) continue; // from one tool path to the next, where no motion is planned
      const piece = {
        from: points.subarray(3 * k, 3 * k + 3),
        to: points.subarray(3 * k + 3, 3 * k + 6),
        moments: [moments[k], moments[k + 1]],
      };
      const color = STATES[states[k]];
      driven[states[k]].push({ ...piece, color });
      whole[states[k]].push({ ...piece, color: states[k] === 1 ? rgb("#59616E") : color });
    }
    this.trace = whole.map((pieces) => this.painter.lines(pieces));
    this.driven = driven.map((pieces) => this.painter.lines(pieces));
  }

  arm() {
    this.bodies = this.data.arm.bodies.map((body) => ({
      joint: body.joint,
      mesh: this.painter.mesh(soup(unpack(body.points), unpack(body.triangles)), rgb(body.rgb)),
    }));
    const ring = [], ball = [];
    for (let k = 0; k < 12; k++) ring.push([Math.cos((k * Math.PI) / 6), Math.sin((k * Math.PI) / 6), 0]);
    for (let level = -3; level <= 3; level++)
      for (const [x, y] of ring) {
        const angle = (level * Math.PI) / 6;
        ball.push(x * Math.cos(angle), y * Math.cos(angle), Math.sin(angle));
      }
    const triangles = [];
    for (let level = 0; level < 6; level++)
      for (let k = 0; k < 12; k++) {
        const [a, b] = [12 * level + k, 12 * level + ((k + 1) % 12)];
        triangles.push(a, b, a + 12, b, b + 12, a + 12);
      }
    this.ball = this.painter.mesh(soup(new Float32Array(ball), new Uint32Array(triangles)), INK);
  }

  // What is to be seen of the part alone, and of part and arm together.
  measure() {
    const points = [];
    for (let k = 0; k < this.vertices.length; k += 3)
      points.push(Array.from(this.vertices.subarray(k, k + 3)));
    const joints = unpack(this.data.frames.joints), count = this.data.arm.axis.length;
    const all = [...points], trace = unpack(this.data.trace.points);
    for (let k = 0; k < trace.length; k += 3) all.push(Array.from(trace.subarray(k, k + 3)));
    for (let frame = 0; frame * count < joints.length; frame += 10) {
      for (const pose of armPoses(this.data.arm, joints.subarray(frame * count, frame * count + count)))
        for (const axis of [3, 7, 11])
          for (const thick of [-0.09, 0.09]) {
            const place = [pose[3], pose[7], pose[11]];
            place[(axis - 3) / 4] += thick; // bodies are thicker than the frames' origins
            all.push(place);
          }
    }
    this.sights = { part: points, whole: all };
    this.ballSize = 0.011 * this.camera.size(points);
  }

  look(name) {
    this.camera.look(this.sights[name], this.data.eye);
  }

  mode(number) {
    this.surface.colors = this.modes[number].colors;
    this.borderLines = this.modes[number].borders;
    this.overlay.replaceChildren();
    this.labels = [];
    const label = (kind, text, place, outward, time) => {
      const span = document.createElement("span");
      span.className = kind;
      span.textContent = text;
      if (time !== undefined) span.dataset.time = time;
      this.overlay.append(span);
      this.labels.push({ span, place, outward });
    };
    for (const { text, at, outward } of this.data.modes[number].texts) label("number", text, at, outward);
    for (const { kind, text, place, outward, time } of this.data.places)
      label(kind, text, place, outward, time);
    this.dirty = true;
  }

  // Draw the arm in a configuration, the path as driven up to a moment, the tip in a state.
  draw(joints, now, state) {
    const { gl, canvas, painter, shown } = this;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((n) => Math.round(n * ratio));
    if (!width || !height) return;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.975, 0.98, 0.985, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const view = this.camera.view(), poses = armPoses(this.data.arm, joints), tip = poses.at(-1);
    if (shown.around) {
      painter.drawLines(this.grid, view, 1, Infinity, 0);
      for (const solid of this.solids) painter.drawMesh(solid, view);
    }
    painter.drawMesh(this.surface, view);
    painter.drawLines(this.borderLines, view, 1.6);
    if (shown.arm) for (const body of this.bodies) painter.drawMesh(body.mesh, view, poses[body.joint]);
    if (shown.path) {
      painter.drawLines(this.trace[1], view, 1);
      painter.drawLines(this.driven[1], view, 2.6, now, 7e-4);
    }
    if (shown.moves)
      for (const kind of [0, 2]) {
        painter.drawLines(this.trace[kind], view, 1.2);
        painter.drawLines(this.driven[kind], view, 3, now, 7e-4);
      }
    const r = this.ballSize;
    gl.disable(gl.DEPTH_TEST); // the tip is to be seen through everything
    gl.enable(gl.CULL_FACE);
    const place = [r, 0, 0, tip[3], 0, r, 0, tip[7], 0, 0, r, tip[11], 0, 0, 0, 1];
    painter.drawMesh(this.ball, view, place, STATES[state]);
    gl.disable(gl.CULL_FACE);
    gl.enable(gl.DEPTH_TEST);
    for (const { span, place: at, outward } of this.labels) {
      const seen = [0, 1, 3].map((row) => {
        const part = view.camera.slice(4 * row, 4 * row + 4);
        return part[0] * at[0] + part[1] * at[1] + part[2] * at[2] + part[3];
      });
      span.hidden = dot(minus(view.eye, at), outward) <= 0;
      span.style.left = `${50 + (50 * seen[0]) / seen[2]}%`;
      span.style.top = `${50 - (50 * seen[1]) / seen[2]}%`;
    }
    this.dirty = false;
  }
}
