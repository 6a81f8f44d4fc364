// Drawing the arm, the part and the path with WebGL 2. Matrices are arrays of 16, row by row.
"use strict";

function unpack(packed) {
  const bytes = Uint8Array.from(atob(packed.base64), (letter) => letter.charCodeAt(0));
  const kinds = { f4: Float32Array, u4: Uint32Array, i2: Int16Array, u1: Uint8Array };
  return new kinds[packed.kind](bytes.buffer);
}

const rgb = (fill) => [1, 3, 5].map((at) => parseInt(fill.slice(at, at + 2), 16) / 255);
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
function unit(a) {
  const length = Math.hypot(a[0], a[1], a[2]) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
}

const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
function times(a, b) {
  const product = new Array(16);
  for (let row = 0; row < 4; row++)
    for (let column = 0; column < 4; column++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * row + k] * b[4 * k + column];
      product[4 * row + column] = sum;
    }
  return product;
}
function turnedAbout([x, y, z], angle) {
  const s = Math.sin(angle), c = Math.cos(angle), d = 1 - c;
  return [
    c + x * x * d, x * y * d - z * s, x * z * d + y * s, 0,
    y * x * d + z * s, c + y * y * d, y * z * d - x * s, 0,
    z * x * d - y * s, z * y * d + x * s, c + z * z * d, 0,
    0, 0, 0, 1,
  ];
}

// A joint's motion along or about its axis, a unit vector.
function movedBy(axis, slides, position) {
  if (!slides) return turnedAbout(axis, position);
  const [x, y, z] = axis.map((a) => a * position);
  return [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1];
}

// The poses of the world and of the frames behind all joints and followers, and the tool's tip last.
function armPoses(arm, joints) {
  const poses = [IDENTITY];
  for (let joint = 0; joint < arm.axis.length; joint++) {
    const fixed = times(poses[joint], arm.placement[joint]);
    poses.push(times(fixed, movedBy(arm.axis[joint], arm.slides[joint], joints[joint])));
  }
  const tip = times(poses[arm.axis.length], arm.tip);
  for (const { parent, placement, back, axis, slides, leader, multiplier, offset } of arm.followers) {
    const moved = movedBy(axis, slides, multiplier * joints[leader] + offset);
    poses.push(times(times(times(poses[parent], placement), moved), back));
  }
  return [...poses, tip];
}

// A unit normal for each corner of each face, smooth but across edges sharper than 40 degrees.
function cornerNormals(points, faces) {
  const at = (vertex) => points.subarray(3 * vertex, 3 * vertex + 3);
  const count = faces.length / 3;
  const doubled = new Array(count), facing = new Array(count), around = new Map();
  for (let face = 0; face < count; face++) {
    const [a, b, c] = [0, 1, 2].map((k) => at(faces[3 * face + k]));
    doubled[face] = cross(minus(b, a), minus(c, a));
    facing[face] = unit(doubled[face]);
    for (let k = 0; k < 3; k++) {
      const vertex = faces[3 * face + k];
      if (!around.has(vertex)) around.set(vertex, []);
      around.get(vertex).push(face);
    }
  }
  const normals = new Float32Array(9 * count), sharp = Math.cos((40 * Math.PI) / 180);
  for (let corner = 0; corner < faces.length; corner++) {
    const own = facing[Math.floor(corner / 3)], sum = [0, 0, 0];
    for (const face of around.get(faces[corner]))
      if (dot(facing[face], own) >= sharp) for (let k = 0; k < 3; k++) sum[k] += doubled[face][k];
    normals.set(unit(sum), 3 * corner);
  }
  return normals;
}

// Each triangle by itself: positions and normals of its corners.
function soup(points, faces) {
  const positions = new Float32Array(3 * faces.length);
  faces.forEach((vertex, corner) =>
    positions.set(points.subarray(3 * vertex, 3 * vertex + 3), 3 * corner));
  return { positions, normals: cornerNormals(points, faces) };
}

// The part, each face cut into the areas that its three corners own: up to the middles of its
// edges and its center. `owner` is the vertex of each corner of the small triangles.
function cutPart(vertices, faces) {
  const corners = cornerNormals(vertices, faces);
  const positions = new Float32Array(18 * faces.length);
  const normals = new Float32Array(18 * faces.length);
  const owner = new Uint32Array(6 * faces.length);
  const mean = (points) =>
    [0, 1, 2].map((k) => points.reduce((sum, point) => sum + point[k], 0) / points.length);
  for (let face = 0, next = 0; face < faces.length / 3; face++) {
    const own = [0, 1, 2].map((k) => faces[3 * face + k]);
    const p = own.map((vertex) => Array.from(vertices.subarray(3 * vertex, 3 * vertex + 3)));
    const n = [0, 1, 2].map((k) => Array.from(corners.subarray(9 * face + 3 * k, 9 * face + 3 * k + 3)));
    const center = [mean(p), unit(mean(n))];
    for (let k = 0; k < 3; k++) {
      const after = (k + 1) % 3, before = (k + 2) % 3;
      const ahead = [mean([p[k], p[after]]), unit(mean([n[k], n[after]]))];
      const behind = [mean([p[k], p[before]]), unit(mean([n[k], n[before]]))];
      for (const [place, normal] of [[p[k], n[k]], ahead, center, [p[k], n[k]], center, behind]) {
        positions.set(place, 3 * next);
        normals.set(normal, 3 * next);
        owner[next++] = own[k];
      }
    }
  }
  return { positions, normals, owner };
}

const SOLID = [
  `#version 300 es
  in vec3 position; in vec3 normal; in vec3 color;
  uniform mat4 camera, pose; uniform vec3 eye;
  out vec3 v_color, v_normal, v_way;
  void main() {
    vec4 place = pose * vec4(position, 1.0);
    v_normal = mat3(pose) * normal; v_way = eye - place.xyz; v_color = color;
    gl_Position = camera * place;
  }`,
  `#version 300 es
  precision highp float;
  in vec3 v_color, v_normal, v_way; uniform float alpha; out vec4 color;
  void main() {
    vec3 way = normalize(v_way); float facing = dot(normalize(v_normal), way);
    float light = 0.62 + 0.38 * abs(facing) + 0.06 * v_normal.z;
    vec3 shaded = v_color * light * (facing < 0.0 ? 0.72 : 1.0);
    color = vec4(shaded, alpha);
  }`,
];
const LINE = [
  `#version 300 es
  in vec2 corner; in vec3 from, to, color; in vec2 moments;
  uniform mat4 camera; uniform vec2 size; uniform float width, bias;
  out vec3 v_color; out float v_moment;
  void main() {
    vec4 a = camera * vec4(from, 1.0), b = camera * vec4(to, 1.0);
    vec2 way = (b.xy / b.w - a.xy / a.w) * size;
    vec2 across = length(way) > 0.0 ? normalize(vec2(-way.y, way.x)) : vec2(0.0);
    vec4 place = mix(a, b, corner.x);
    place.xy += across * corner.y * width / size * place.w;
    place.z -= bias * place.w;
    v_color = color; v_moment = mix(moments.x, moments.y, corner.x);
    gl_Position = place;
  }`,
  `#version 300 es
  precision highp float;
  in vec3 v_color; in float v_moment; uniform float now; out vec4 color;
  void main() { if (v_moment > now) discard; color = vec4(v_color, 1.0); }`,
];

class Painter {
  // Shaders and buffers.
  constructor(gl) {
    this.gl = gl;
    this.solid = this.program(SOLID);
    this.line = this.program(LINE);
    this.corners = this.buffer(new Float32Array([0, -1, 1, -1, 0, 1, 1, 1]));
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  program(sources) {
    const gl = this.gl, made = gl.createProgram();
    [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER].forEach((kind, number) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, sources[number].trim());
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(made, shader);
    });
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
    const found = { program: made, at: {}, of: {} };
    for (let k = 0; k < gl.getProgramParameter(made, gl.ACTIVE_ATTRIBUTES); k++) {
      const { name } = gl.getActiveAttrib(made, k);
      found.at[name] = gl.getAttribLocation(made, name);
    }
    for (let k = 0; k < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); k++) {
      const { name } = gl.getActiveUniform(made, k);
      found.of[name] = gl.getUniformLocation(made, name);
    }
    return found;
  }

  buffer(content) {
    const made = this.gl.createBuffer();
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, made);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, content, this.gl.STATIC_DRAW);
    return made;
  }

  attribute(program, name, buffer, size, divisor = 0) {
    const gl = this.gl, at = program.at[name];
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
    gl.vertexAttribDivisor(at, divisor);
  }

  // A mesh to be drawn: its corners, and one fill or one for each corner.
  mesh({ positions, normals }, fill = null) {
    return {
      count: positions.length / 3,
      positions: this.buffer(positions),
      normals: this.buffer(normals),
      colors: null,
      fill,
    };
  }

  // Straight pieces to be drawn: {from, to, color, moments} for each.
  lines(pieces) {
    const flat = (name, size) => {
      const content = new Float32Array(size * pieces.length);
      pieces.forEach((piece, number) => content.set(piece[name], size * number));
      return this.buffer(content);
    };
    return {
      count: pieces.length,
      from: flat("from", 3),
      to: flat("to", 3),
      color: flat("color", 3),
      moments: flat("moments", 2),
    };
  }

  drawMesh(mesh, view, pose = IDENTITY, fill = mesh.fill) {
    const gl = this.gl, { program, at, of } = this.solid;
    gl.useProgram(program);
    gl.uniformMatrix4fv(of.camera, true, view.camera);
    gl.uniformMatrix4fv(of.pose, true, pose);
    gl.uniform3fv(of.eye, view.eye);
    gl.uniform1f(of.alpha, 1);
    this.attribute(this.solid, "position", mesh.positions, 3);
    this.attribute(this.solid, "normal", mesh.normals, 3);
    if (mesh.colors) this.attribute(this.solid, "color", mesh.colors, 3);
    else {
      gl.disableVertexAttribArray(at.color);
      gl.vertexAttrib3fv(at.color, fill);
    }
    gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
  }

  drawLines(lines, view, width, now = Infinity, bias = 4e-4) {
    if (!lines.count) return;
    const gl = this.gl, { program, of } = this.line;
    gl.useProgram(program);
    gl.uniformMatrix4fv(of.camera, true, view.camera);
    gl.uniform2f(of.size, view.width, view.height);
    gl.uniform1f(of.width, width * view.ratio);
    gl.uniform1f(of.bias, bias);
    gl.uniform1f(of.now, Math.min(now, 1e30));
    this.attribute(this.line, "corner", this.corners, 2);
    for (const [name, size] of [["from", 3], ["to", 3], ["color", 3], ["moments", 2]])
      this.attribute(this.line, name, lines[name], size, 1);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.count);
    for (const at of Object.values(this.line.at)) gl.vertexAttribDivisor(at, 0);
  }
}
