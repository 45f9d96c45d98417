// Drawing by WebGL2.

const VERTEX = `#version 300 es
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
layout(location = 3) in float share; // of the limit
uniform mat4 model;
uniform mat4 camera;
out vec3 atWorld;
out vec3 facing;
flat out vec3 tint;
out float deviation;
void main() {
  deviation = share;
  vec4 world = model * vec4(place, 1.0);
  atWorld = world.xyz;
  facing = mat3(model) * normal;
  tint = colour;
  gl_Position = camera * world;
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec3 atWorld;
in vec3 facing;
flat in vec3 tint;
in float deviation;
uniform bool banded;     // coloured by the share of the limit, which is known up to 1e6
uniform float steps[8];
uniform vec3 bands[9];
uniform vec4 section;   // material where dot(section.xyz, p) > section.w is cut away
uniform vec3 eye;
uniform vec4 flatColour; // of lines and of one-coloured solids: alpha 0 takes the vertex's colour
uniform vec4 inside;     // of back faces, seen through the section: alpha 0 shades them like the others
uniform float alpha;
uniform bool unlit;
out vec4 pixel;
void main() {
  if (dot(section.xyz, atWorld) > section.w) discard;
  vec3 base = flatColour.a > 0.0 ? flatColour.rgb : tint;
  if (banded && deviation < 1e6) {
    base = bands[8];
    for (int k = 7; k >= 0; k--) if (deviation <= steps[k]) base = bands[k];
  }
  base = base * base; // close to linear light
  vec3 shade = base;
  if (!unlit) {
    vec3 n = normalize(facing);
    vec3 view = normalize(eye - atWorld);
    if (gl_FrontFacing || inside.a == 0.0) {
      vec3 sun = normalize(vec3(-0.45, -0.6, 0.95));
      vec3 fill = normalize(vec3(0.8, 0.25, 0.35));
      float sky = 0.5 + 0.5 * n.z;
      float shine = pow(max(dot(n, normalize(sun + view)), 0.0), 40.0);
      float rim = pow(1.0 - max(dot(n, view), 0.0), 4.0);
      shade = base * (0.22 + 0.24 * sky + 0.62 * max(dot(n, sun), 0.0) + 0.16 * max(dot(n, fill), 0.0) + 0.10 * max(dot(n, view), 0.0))
        + vec3(0.10 * shine + 0.03 * rim);
    } else {
      vec3 cut = inside.rgb * inside.rgb;
      float stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 12.0) < 2.0 ? 0.78 : 1.0;
      shade = cut * stripe;
    }
  }
  pixel = vec4(sqrt(clamp(shade, 0.0, 1.0)) * alpha, alpha);
}`;

/** A mesh on the GPU. */
class Shape {
  constructor(gl) {
    this.gl = gl;
    this.array = gl.createVertexArray();
    this.buffers = [0, 1, 2].map(() => gl.createBuffer());
    this.indices = gl.createBuffer();
    this.count = 0;
    /** The corners of its triangles, if their sides can be drawn. */
    this.corners = null;
    this.sides = null;
    gl.bindVertexArray(this.array);
    this.extra = gl.createBuffer();
    const layout = [
      [3, gl.FLOAT, false, 12],
      [3, gl.BYTE, true, 4],
      [3, gl.UNSIGNED_BYTE, true, 4],
    ];
    layout.forEach(([size, type, scaled, stride], k) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[k]);
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, size, type, scaled, stride, 0);
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bindVertexArray(null);
  }

  put(k, data) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[k]);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
  }

  /** Takes over quads; their colours follow by `colours`. */
  quads(quads) {
    const { gl } = this;
    this.put(0, quads.places.subarray(0, 12 * quads.count));
    this.put(1, quads.normals.subarray(0, 16 * quads.count));
    const indices = quads.corners();
    gl.bindVertexArray(this.array);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.DYNAMIC_DRAW);
    gl.bindVertexArray(null);
    this.count = indices.length;
    this.mode = gl.TRIANGLES;
    [this.corners, this.sides] = [indices, null];
  }

  colours(quads, colour) {
    const bytes = new Uint8Array(16 * quads.count);
    for (let q = 0; q < quads.count; q++) {
      const own = colour(quads.ends[q]);
      for (let c = 0; c < 4; c++) bytes.set(own, 16 * q + 4 * c);
    }
    this.put(2, bytes);
  }

  /** Takes over corners, of which `triangles` are made; colours and shares of limits follow by `put` and `shares`. */
  places(places, normals) {
    this.put(0, places);
    this.put(1, normals);
  }

  triangles(corners) {
    const { gl } = this;
    gl.bindVertexArray(this.array);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.DYNAMIC_DRAW);
    gl.bindVertexArray(null);
    this.count = corners.length;
    this.mode = gl.TRIANGLES;
    [this.corners, this.sides, this.coarseCount] = [corners, null, 0];
  }

  /** The sides of its triangles become known, for `draw` with `wires`. */
  trace() {
    const { gl, corners } = this;
    if (this.sides || !corners) return;
    const lines = new Uint32Array(2 * corners.length);
    // Numbers of the corners that begin and end the three sides.
    const order = [0, 1, 1, 2, 2, 0];
    for (let k = 0; k < lines.length; k++) lines[k] = corners[3 * Math.floor(k / 6) + order[k % 6]];
    this.sides = this.sideIndices ??= gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.sides);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, lines, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bindVertexArray(null);
  }

  /** Other corners of the same places, for `draw` with `coarse`. */
  coarser(corners) {
    const { gl } = this;
    this.coarseIndices ??= gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.coarseIndices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bindVertexArray(null);
    this.coarseCount = corners.length;
  }

  /** Of each corner the share of the limit. */
  shares(numbers) {
    const { gl } = this;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.extra);
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(3);
    gl.vertexAttribPointer(3, 1, gl.FLOAT, false, 4, 0);
    gl.bindVertexArray(null);
  }

  /** Takes over single triangles, or lines. */
  plain(places, normals, mode) {
    const { gl } = this;
    const count = places.length / 3;
    this.put(0, places instanceof Float32Array ? places : new Float32Array(places));
    this.put(1, normals instanceof Int8Array ? normals : new Int8Array(normals ?? 4 * count));
    this.put(2, new Uint8Array(4 * count));
    gl.bindVertexArray(this.array);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, Uint32Array.from({ length: count }, (_, k) => k), gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    this.count = count;
    this.mode = mode ?? gl.TRIANGLES;
  }
}

class Gpu {
  /** Throws if there is no WebGL2. */
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("no WebGL2");
    this.gl = gl;
    const compiled = (type, source) => {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      return shader;
    };
    this.program = gl.createProgram();
    gl.attachShader(this.program, compiled(gl.VERTEX_SHADER, VERTEX));
    gl.attachShader(this.program, compiled(gl.FRAGMENT_SHADER, FRAGMENT));
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.program));
    this.at = (name) => gl.getUniformLocation(this.program, name);
    this.places = Object.fromEntries(["model", "camera", "section", "eye", "flatColour", "inside", "alpha", "unlit", "banded", "steps", "bands"].map((n) => [n, this.at(n)]));
    gl.useProgram(this.program);
    gl.uniform1fv(this.places.steps, STEPS);
    gl.uniform3fv(this.places.bands, DEVIATIONS.flat().map((c) => c / 255));
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  /** Begins a picture. `section` is a plane [normal, offset] or null. */
  begin(width, height, camera, eye, section) {
    const { gl, places } = this;
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.program);
    gl.uniformMatrix4fv(places.camera, false, camera);
    gl.uniform3fv(places.eye, eye);
    gl.uniform4fv(places.inside, [...SECTION.map((c) => c / 255), section ? 1 : 0]);
    this.section = section;
  }

  /** Draws a shape. Options: model, colour, alpha, unlit, uncut; banded: by the share of the limit; behind: a little farther away than it is; coarse: by its coarser corners; wires: only the sides of its triangles. */
  draw(shape, { model = IDENTITY, colour = null, alpha = 1, unlit = false, uncut = false, banded = false, behind = false, coarse = false, wires = false } = {}) {
    if (!shape.count) return;
    const { gl, places, section } = this;
    gl.uniformMatrix4fv(places.model, false, model);
    gl.uniform4fv(places.flatColour, colour ? [...colour.map((c) => c / 255), 1] : [0, 0, 0, 0]);
    gl.uniform4fv(places.section, section && !uncut ? [...section[0], section[1]] : [0, 0, 0, 1]);
    gl.uniform1f(places.alpha, alpha);
    gl.uniform1i(places.unlit, unlit ? 1 : 0);
    gl.uniform1i(places.banded, banded ? 1 : 0);
    const clear = alpha < 1;
    if (behind) {
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(1, 1);
    }
    if (clear) {
      gl.enable(gl.BLEND);
      gl.depthMask(false);
      gl.enable(gl.CULL_FACE);
    }
    if (wires) shape.trace();
    const [mode, indices, count] = wires
      ? [gl.LINES, shape.sides, 2 * shape.count]
      : [shape.mode, coarse ? shape.coarseIndices : shape.indices, coarse ? shape.coarseCount : shape.count];
    gl.bindVertexArray(shape.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
    gl.drawElements(mode, count, gl.UNSIGNED_INT, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, shape.indices);
    gl.bindVertexArray(null);
    if (clear) {
      gl.disable(gl.CULL_FACE);
      gl.depthMask(true);
      gl.disable(gl.BLEND);
    }
    if (behind) gl.disable(gl.POLYGON_OFFSET_FILL);
  }
}
