// The 3D view of a page: a part with classes, solids and lines, the arm and its path at a moment.
"use strict";

const CREASE = (40 * Math.PI) / 180; // sharper edges are seen as edges
const LENS = 34; // degrees from top to bottom
const GREY = "#8A94A3";
const PATHS = [
  { name: "moves between strokes", rgb: "#E69F00" },
  { name: "path in contact", rgb: "#00508F" },
  { name: "not planned", rgb: "#CC3311" },
];

function unpack({ kind, base64 }) {
  const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const kinds = { f4: Float32Array, u4: Uint32Array, i2: Int16Array, u1: Uint8Array };
  return new kinds[kind](bytes.buffer);
}

const matrix = (rows) => new THREE.Matrix4().set(...rows);

// The poses of the world and of the frames behind all joints, and the tool's tip last.
function armPoses(arm, joints) {
  const poses = [new THREE.Matrix4()];
  arm.axis.forEach((axis, joint) => {
    const along = new THREE.Vector3(...axis), own = new THREE.Matrix4();
    if (arm.slides[joint]) own.makeTranslation(along.multiplyScalar(joints[joint]));
    else own.makeRotationAxis(along, joints[joint]);
    poses.push(poses[joint].clone().multiply(matrix(arm.placement[joint])).multiply(own));
  });
  return [...poses, poses.at(-1).clone().multiply(matrix(arm.tip))];
}

// Triangles by themselves, with normals that are smooth but across sharp edges.
function geometryOf({ points, triangles }) {
  const indexed = new THREE.BufferGeometry();
  indexed.setAttribute("position", new THREE.BufferAttribute(unpack(points), 3));
  indexed.setIndex(new THREE.BufferAttribute(unpack(triangles), 1));
  // Corners within a hundredth of a unit count as one: a unit of a millimeter makes this small.
  return THREE.toCreasedNormals(indexed.scale(1e3, 1e3, 1e3), CREASE).scale(1e-3, 1e-3, 1e-3);
}

// Each vertex's class fills the points of a triangle that are nearest to it in barycentric
// coordinates: its dual. Lines run where two coordinates are equal and the third is the smallest.
function classMaterial(uniforms) {
  const material = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide });
  Object.assign(material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2 });
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = `attribute vec3 labels, sides;
      flat varying vec3 vLabels, vSides; varying vec3 vCorner;
      ${shader.vertexShader}`.replace("#include <begin_vertex>", `#include <begin_vertex>
      int at = gl_VertexID % 3;
      vCorner = vec3(at == 0, at == 1, at == 2); vLabels = labels; vSides = sides;`);
    shader.fragmentShader = `uniform sampler2D paints; uniform vec4 lines[4];
      flat varying vec3 vLabels, vSides; varying vec3 vCorner;
      ${shader.fragmentShader}`.replace("#include <color_fragment>", `
      vec3 apart = vCorner - vCorner.yzx, pixel = fwidth(apart);
      int own = vCorner.x >= max(vCorner.y, vCorner.z) ? 0 : vCorner.y >= vCorner.z ? 1 : 2;
      vec4 paint = texelFetch(paints, ivec2(int(vLabels[own] + 0.5), 0), 0);
      if (paint.a < 0.5) discard;
      diffuseColor.rgb = paint.rgb * (gl_FrontFacing ? 1.0 : 0.72);
      for (int k = 0; k < 3; k++) {
        vec4 line = lines[int(vSides[k] + 0.5)];
        if (vCorner[(k + 2) % 3] > min(vCorner[k], vCorner[(k + 1) % 3])) continue;
        float off = abs(apart[k]) / pixel[k];
        float inked = min(line.a, 1.0) * (1.0 - smoothstep(line.a - 0.5, line.a + 0.5, off));
        diffuseColor.rgb = mix(diffuseColor.rgb, line.rgb, inked);
      }`);
  };
  return material;
}

class View {
  constructor(data) {
    const find = (id) => document.getElementById(id);
    Object.assign(this, { data, canvas: find("space"), overlay: find("overlay"), find, hidden: new Set() });
    try {
      this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true });
    } catch {
      throw new Error("this browser cannot draw in 3D (WebGL 2)");
    }
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(LENS);
    this.camera.up.set(0, 0, 1);
    const light = new THREE.DirectionalLight("#FFFFFF", 1.7);
    light.position.set(-0.4, 0.6, 1);
    this.camera.add(light);
    this.scene.add(this.camera, new THREE.HemisphereLight("#FFFFFF", "#C9C5BC", 1.7));
    this.things = []; // {name, rgb, object}
    if (data.mesh) this.part();
    this.bodies = data.layers.map((layer) => this.solid(layer));
    for (const { name, rgb, ends } of data.lines) this.add(name, rgb, this.segments(unpack(ends), rgb, 1.4));
    if (data.motion) this.path(data.motion);
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener("change", () => this.redraw());
    this.controls.addEventListener("start", () => (this.home = null));
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.resized()).observe(this.canvas.parentElement);
  }

  // Once the arm has a pose.
  start() {
    this.buttons("modes", this.data.modes.slice(0, this.data.buttons).map(({ name }) => name), (n) => this.mode(n));
    const sights = this.data.motion ? ["Whole arm", "Part"] : ["Reset view"];
    this.buttons("eyes", sights, (number) => this.look(number === 1));
    this.mode(0);
    this.resized();
    this.look(false);
  }

  buttons(id, names, pressed) {
    const made = names.map((name, number) => {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", textContent: name });
      button.addEventListener("click", () => pressed(number));
      return button;
    });
    this.find(id).replaceChildren(...(id === "modes" && names.length < 2 ? [] : made));
  }

  add(name, rgb, object) {
    this.things.push({ name, rgb, object });
    this.scene.add(object);
    return object;
  }

  part() {
    const { mesh } = this.data, geometry = geometryOf(mesh);
    this.faces = unpack(mesh.triangles);
    const lines = Array.from({ length: 4 }, () => new THREE.Vector4(0, 0, 0, 0));
    this.uniforms = { paints: { value: null }, lines: { value: lines } };
    this.surface = new THREE.Mesh(geometry, classMaterial(this.uniforms));
    this.surface.frustumCulled = false;
    this.scene.add(this.surface);
  }

  solid({ name, rgb, points, triangles, joint }) {
    const look = { color: rgb, side: THREE.DoubleSide };
    const mesh = new THREE.Mesh(geometryOf({ points, triangles }), new THREE.MeshLambertMaterial(look));
    mesh.matrixAutoUpdate = false;
    this.add(name, rgb, mesh);
    return { joint, mesh };
  }

  segments(ends, rgb, linewidth) {
    const geometry = new THREE.LineSegmentsGeometry().setPositions(ends);
    return new THREE.LineSegments2(geometry, new THREE.LineMaterial({ color: rgb, linewidth }));
  }

  // The tip's path: thin as a whole, and thick as far as it is driven.
  path({ trace, states }) {
    const points = unpack(trace), kinds = unpack(states);
    this.driven = PATHS.flatMap(({ name, rgb }, kind) => {
      const before = [0], ends = []; // how many pieces there are before each frame
      for (let k = 0; k + 1 < kinds.length; k++) {
        if (kinds[k] === kind) ends.push(...points.subarray(3 * k, 3 * k + 6));
        before.push(ends.length / 6);
      }
      if (!ends.length) return [];
      const whole = this.segments(ends, kind === 1 ? GREY : rgb, 1), driven = this.segments(ends, rgb, 3);
      driven.frustumCulled = whole.frustumCulled = false;
      const both = new THREE.Group();
      both.add(whole, driven);
      this.add(name, rgb, both);
      return [{ before, geometry: driven.geometry }];
    });
    const look = new THREE.MeshBasicMaterial({ depthTest: false, transparent: true });
    this.tip = new THREE.Mesh(new THREE.SphereGeometry(1, 24, 12), look);
    this.tip.renderOrder = 1; // to be seen through everything
    this.scene.add(this.tip);
  }

  // The arm in a configuration, the path as driven up to a frame, the tip in a state.
  pose(joints, frame, state) {
    const poses = armPoses(this.data.motion.arm, joints), tip = poses.at(-1);
    for (const { joint, mesh } of this.bodies)
      if (joint !== null) {
        mesh.matrix.copy(poses[joint]);
        mesh.matrixWorldNeedsUpdate = true;
      }
    for (const { before, geometry } of this.driven) geometry.instanceCount = before[frame];
    this.tip.position.setFromMatrixPosition(tip);
    this.tip.material.color.set(PATHS[state].rgb);
    this.redraw();
  }

  mode(number) {
    const mode = this.data.modes[number];
    [...this.find("modes").children].forEach((button, k) =>
      button.setAttribute("aria-pressed", String(k === number)));
    this.hidden.clear();
    this.shown = mode;
    if (mode) {
      const labels = unpack(mode.labels), sides = unpack(mode.sides), { faces } = this;
      const own = new Float32Array(3 * faces.length), beside = new Float32Array(3 * faces.length);
      for (let corner = 0; corner < faces.length; corner++) {
        const first = corner - (corner % 3);
        for (let k = 0; k < 3; k++) {
          own[3 * corner + k] = labels[faces[first + k]];
          beside[3 * corner + k] = sides[first + k];
        }
      }
      this.surface.geometry.setAttribute("labels", new THREE.BufferAttribute(own, 3));
      this.surface.geometry.setAttribute("sides", new THREE.BufferAttribute(beside, 3));
    }
    this.label([...(mode?.texts ?? []), ...this.data.marks]);
    this.legend();
    this.repaint();
  }

  // Texts and marks lie over the canvas; those with a time lead to it.
  label(texts) {
    this.labels = texts.map(({ text, at, outward, kind, time, label, name }) => {
      const span = document.createElement(time === undefined ? "span" : "button");
      Object.assign(span, { className: kind, textContent: text });
      if (time !== undefined) Object.assign(span.dataset, { time });
      this.overlay.append(span);
      return { span, label, name, at: new THREE.Vector3(...at), outward: new THREE.Vector3(...outward) };
    });
    this.overlay.replaceChildren(...this.labels.map(({ span }) => span));
  }

  // What there is to see, each entry a switch.
  legend() {
    const entries = new Map((this.shown?.legend ?? []).map(({ name, rgb, line }) => [name, { rgb, line }]));
    for (const { name, rgb } of this.things) if (!entries.has(name)) entries.set(name, { rgb, line: false });
    for (const { name } of this.labels) if (name) entries.set(name, { ring: true });
    this.find("legend").replaceChildren(...[...entries].map(([name, { rgb, line, ring }]) => {
      const entry = document.createElement("button"), mark = document.createElement("i");
      Object.assign(entry, { type: "button", title: "hide or show" });
      entry.setAttribute("aria-pressed", "true");
      mark.style.background = rgb ?? "";
      mark.className = ring ? "dot" : line || PATHS.some((path) => path.name === name) ? "line" : "";
      entry.append(mark, name.replaceAll(" %", "\u00a0%"));
      entry.addEventListener("click", () => {
        const hide = entry.getAttribute("aria-pressed") === "true";
        entry.setAttribute("aria-pressed", String(!hide));
        hide ? this.hidden.add(name) : this.hidden.delete(name);
        this.repaint();
      });
      return entry;
    }));
  }

  // After something was hidden or shown.
  repaint() {
    for (const { name, object } of this.things) object.visible = !this.hidden.has(name);
    if (this.shown) {
      const { classes, legend } = this.shown, bytes = new Uint8Array(4 * classes.length), color = new THREE.Color();
      classes.forEach(({ name, rgb }, number) => {
        const value = color.set(rgb).getHex();
        bytes.set([value >> 16, (value >> 8) & 255, value & 255, this.hidden.has(name) ? 0 : 255], 4 * number);
      });
      const paints = new THREE.DataTexture(bytes, classes.length, 1);
      Object.assign(paints, { colorSpace: THREE.SRGBColorSpace, needsUpdate: true });
      this.uniforms.paints.value?.dispose();
      this.uniforms.paints.value = paints;
      for (const { name, rgb, line } of legend.filter((entry) => entry.line)) {
        color.set(rgb);
        const half = this.hidden.has(name) ? 0 : line === 3 ? 2 : 0.9;
        this.uniforms.lines.value[line].set(color.r, color.g, color.b, half);
      }
    }
    this.redraw();
  }

  // Points that are to be in the picture: of the part alone, or of all there is and of the arm all
  // the way.
  sight(alone) {
    const points = [], place = (object) => {
      const at = object.geometry.getAttribute("position"), step = Math.ceil(at.count / 2000);
      for (let k = 0; k < at.count; k += step)
        points.push(new THREE.Vector3().fromBufferAttribute(at, k).applyMatrix4(object.matrix));
    };
    if (this.surface) place(this.surface);
    if (alone) return points;
    for (const { joint, mesh } of this.bodies) if (joint === null) place(mesh);
    if (!this.data.motion) return points;
    const { arm, joints } = this.data.motion, all = unpack(joints), count = arm.axis.length;
    const step = Math.ceil(all.length / count / 60) * count;
    for (let start = 0; start < all.length; start += step) {
      const poses = armPoses(arm, all.subarray(start, start + count));
      for (const { joint, mesh } of this.bodies.filter((body) => body.joint !== null)) {
        const at = mesh.geometry.getAttribute("position"), every = Math.ceil(at.count / 40);
        for (let k = 0; k < at.count; k += every)
          points.push(new THREE.Vector3().fromBufferAttribute(at, k).applyMatrix4(poses[joint]));
      }
    }
    return points;
  }

  // From the picture's direction, as near as leaves all points in view.
  look(alone) {
    const back = new THREE.Vector3(...this.data.towards), points = this.sight(alone);
    const right = new THREE.Vector3(-back.y, back.x, 0);
    if (right.length() < 1e-6) right.set(1, 0, 0);
    const axes = [right.normalize(), new THREE.Vector3().crossVectors(back, right), back];
    const middle = new THREE.Vector3(), size = [];
    for (const axis of axes) {
      const along = points.map((point) => point.dot(axis));
      const low = Math.min(...along), high = Math.max(...along);
      middle.addScaledVector(axis, (low + high) / 2);
      size.push(high - low);
    }
    // An arm that reaches out of the picture for a moment does not keep all the rest small.
    const margin = this.data.motion && !alone ? 0.92 : 1.06;
    const up = Math.tan((LENS * Math.PI) / 360), half = [up * this.camera.aspect, up];
    const far = Math.max(...points.map((point) => {
      const [x, y, z] = axes.map((axis) => point.dot(axis) - middle.dot(axis));
      return z + margin * Math.max(Math.abs(x) / half[0], Math.abs(y) / half[1]);
    }));
    this.size = Math.hypot(...size);
    this.tip?.scale.setScalar(0.006 * this.size);
    this.home = { alone, aspect: this.camera.aspect };
    this.camera.position.copy(middle).addScaledVector(back, far);
    this.controls.target.copy(middle);
    this.controls.update();
    this.redraw();
  }

  key(event) {
    const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const nearer = { "+": 0.9, "-": 1.1 }[event.key] ?? 1, [across, up] = turns[event.key] ?? [0, 0];
    if (nearer === 1 && !across && !up) return;
    event.preventDefault();
    this.home = null;
    const { target } = this.controls, way = this.camera.position.clone().sub(target);
    const side = new THREE.Vector3().crossVectors(this.camera.up, way).normalize();
    way.applyAxisAngle(this.camera.up, 0.1 * across);
    const rise = Math.asin(way.z / way.length());
    if (Math.abs(rise + 0.1 * up) < 1.5) way.applyAxisAngle(side, -0.1 * up);
    this.camera.position.copy(target).addScaledVector(way, nearer);
    this.controls.update();
  }

  resized() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    // Nobody has turned it yet: the whole part is to be seen in the new shape of the picture.
    if (this.home && this.home.aspect !== this.camera.aspect) this.look(this.home.alone);
    else this.redraw();
  }

  redraw() {
    this.asked ??= requestAnimationFrame(() => {
      this.asked = null;
      this.draw();
    });
  }

  draw() {
    const { camera, controls } = this, far = camera.position.distanceTo(controls.target);
    camera.near = Math.max(0.02 * far, far - 3 * this.size);
    camera.far = far + 3 * this.size;
    camera.updateProjectionMatrix();
    this.renderer.render(this.scene, camera);
    for (const { span, at, outward, label, name } of this.labels) {
      const seen = at.clone().project(camera), entry = name ?? this.shown?.classes[label]?.name;
      span.hidden = camera.position.clone().sub(at).dot(outward) <= 0 || this.hidden.has(entry);
      span.style.left = `${50 + 50 * seen.x}%`;
      span.style.top = `${50 - 50 * seen.y}%`;
    }
  }
}
