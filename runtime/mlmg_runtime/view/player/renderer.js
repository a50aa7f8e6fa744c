// Draws figures made of tapered capsules on a floor, with WebGL 2 and nothing else.

const SHADOW_PIXELS = 1536;
const ROWS = 12;
const COLUMNS = 48;

// A capsule is the hull of two balls. Each vertex lies on one of them, at an angle above the middle; the two
// halves meet where a cone touches both balls: at the angle whose sine is (r1 - r2) / length.
const CAPSULE_POINT = `
  layout(location=0) in vec4 mesh;
  layout(location=1) in vec4 first;
  layout(location=2) in vec4 second;
  layout(location=3) in vec3 colour;
  void capsule(out vec3 place, out vec3 normal) {
    vec3 axis = second.xyz - first.xyz;
    float len = max(length(axis), 1e-5);
    axis /= len;
    float meet = asin(clamp((first.w - second.w) / len, -1.0, 1.0));
    float angle = mesh.w < 0.5 ? mix(-1.5707963, meet, mesh.z) : mix(meet, 1.5707963, mesh.z);
    vec3 side = normalize(abs(axis.y) < 0.9 ? cross(axis, vec3(0, 1, 0)) : cross(axis, vec3(1, 0, 0)));
    vec3 ring = mesh.x * side + mesh.y * cross(axis, side);
    normal = cos(angle) * ring + sin(angle) * axis;
    place = mesh.w < 0.5 ? first.xyz + first.w * normal : second.xyz + second.w * normal;
  }`;

const SHADOW = `
  uniform highp sampler2DShadow shadowMap;
  uniform mat4 shadowMatrix;
  float lit(vec3 place, float bias, float softness, float turn) {
    vec4 at = shadowMatrix * vec4(place, 1.0);
    vec3 map = 0.5 * at.xyz + 0.5;
    if (any(lessThan(map.xy, vec2(0.0))) || any(greaterThan(map.xy, vec2(1.0)))) return 1.0;
    float sum = 0.0;
    for (int i = 0; i < 16; i += 1) {
      float angle = 2.3999632 * float(i) + turn;
      vec2 step = softness * sqrt((float(i) + 0.5) / 16.0) * vec2(cos(angle), sin(angle));
      sum += texture(shadowMap, vec3(map.xy + step, map.z - bias));
    }
    return sum / 16.0;
  }`;

const SHADERS = {
  depth: [
    `${CAPSULE_POINT}
    uniform mat4 matrix;
    void main() { vec3 place, normal; capsule(place, normal); gl_Position = matrix * vec4(place, 1.0); }`,
    "void main() {}",
  ],
  body: [
    `${CAPSULE_POINT}
    uniform mat4 matrix;
    out vec3 at, up, paint;
    void main() {
      capsule(at, up);
      paint = colour;
      gl_Position = matrix * vec4(at, 1.0);
    }`,
    `${SHADOW}
    in vec3 at, up, paint;
    uniform vec3 eye, light;
    uniform float softness;
    out vec4 result;
    void main() {
      vec3 normal = normalize(up);
      float slope = dot(normal, light);
      float shade = lit(at + 0.012 * normal, 0.002, 0.6 * softness, 0.0);
      float key = clamp((slope + 0.25) / 1.25, 0.0, 1.0) * mix(0.35, 1.0, slope > 0.0 ? shade : 1.0);
      float sky = 0.5 + 0.5 * normal.y;
      float ground = mix(1.0, smoothstep(-0.05, 0.35, at.y), 0.35 * (1.0 - sky));
      float rim = pow(1.0 - clamp(dot(normal, normalize(eye - at)), 0.0, 1.0), 3.0) * (0.35 + 0.65 * sky);
      result = vec4(paint * (0.20 + 0.24 * sky + 0.62 * key) * ground + 0.13 * rim, 1.0);
    }`,
  ],
  floor: [
    `layout(location=0) in vec2 corner;
    uniform mat4 matrix;
    uniform vec3 target;
    uniform float reach;
    out vec3 at;
    void main() {
      at = vec3(target.x, 0.0, target.z) + reach * vec3(corner.x, 0.0, corner.y);
      gl_Position = matrix * vec4(at, 1.0);
    }`,
    `${SHADOW}
    in vec3 at;
    uniform vec3 target, background, bare, grid;
    uniform float reach, softness;
    out vec4 result;
    float line(float x, float width) {
      float pixel = max(fwidth(x), 1e-6);
      float wide = max(width, pixel);
      return clamp((0.5 * wide - abs(x - round(x))) / pixel + 0.5, 0.0, 1.0) * width / wide;
    }
    void main() {
      float away = min(length(at.xz - target.xz) / reach, 1.0);
      float pool = (1.0 - away) * (1.0 - away) * (1.0 + 2.0 * away);
      float lines = max(line(at.x, 0.012), line(at.z, 0.012));
      lines = max(lines, 0.25 * max(line(2.0 * at.x, 0.016), line(2.0 * at.z, 0.016)));
      float noise = fract(52.98 * fract(dot(gl_FragCoord.xy, vec2(0.0671, 0.00584))));
      float dark = 0.62 * (1.0 - lit(at, 0.001, 1.6 * softness, 6.2832 * noise));
      vec3 floorColour = mix(bare, grid, lines) * (1.0 - dark);
      result = vec4(mix(background, floorColour, pool) + (noise - 0.5) / 255.0, 1.0);
    }`,
  ],
  contact: [
    `layout(location=0) in vec2 corner;
    layout(location=1) in vec4 ball;
    uniform mat4 matrix;
    out vec2 at;
    out float strength;
    void main() {
      at = corner;
      strength = exp(-max(ball.y - ball.w, 0.0) / 0.06);
      vec3 place = vec3(ball.x + 1.9 * ball.w * corner.x, 0.002, ball.z + 1.9 * ball.w * corner.y);
      gl_Position = matrix * vec4(place, 1.0);
    }`,
    `in vec2 at;
    in float strength;
    out vec4 result;
    void main() {
      float away = clamp(1.0 - dot(at, at), 0.0, 1.0);
      result = vec4(0.0, 0.0, 0.0, 0.40 * strength * away * away);
    }`,
  ],
  path: [
    `layout(location=0) in vec3 point;
    uniform mat4 matrix;
    out float frame;
    void main() { frame = point.z; gl_Position = matrix * vec4(point.x, 0.003, point.y, 1.0); }`,
    `in float frame;
    uniform float now;
    uniform vec3 colour;
    out vec4 result;
    void main() { result = vec4(colour, frame <= now ? 0.55 : 0.16); }`,
  ],
};

class NoWebGL extends Error {}

class Renderer {
  // Throws NoWebGL where the browser offers none.
  constructor(canvas, colours) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (!gl) throw new NoWebGL();
    this.gl = gl;
    this.colours = colours;
    this.programs = Object.fromEntries(Object.entries(SHADERS).map(([name, pair]) => [name, this.program(...pair)]));
    this.shadow = this.shadowMap();
    this.quad = this.buffer(new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]));
    this.mesh = this.capsuleMesh();
    this.capsules = gl.createBuffer();
    this.contacts = gl.createBuffer();
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  program(vertex, fragment) {
    const { gl } = this;
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, `#version 300 es\nprecision highp float;\n${source}`);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const places = {};
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i += 1) {
      const { name } = gl.getActiveUniform(program, i);
      places[name] = gl.getUniformLocation(program, name);
    }
    return { program, places };
  }

  // Selects a program and sets its uniforms: numbers, vectors and matrices, by what they are.
  use(name, values) {
    const { gl } = this;
    const { program, places } = this.programs[name];
    gl.useProgram(program);
    for (const [key, value] of Object.entries(values)) {
      const place = places[key];
      if (!place) continue;
      if (typeof value === "number") gl.uniform1f(place, value);
      else if (value.length === 3) gl.uniform3fv(place, value);
      else gl.uniformMatrix4fv(place, false, value);
    }
  }

  buffer(array) {
    const { gl } = this;
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, array, gl.STATIC_DRAW);
    return buffer;
  }

  shadowMap() {
    const { gl } = this;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW_PIXELS, SHADOW_PIXELS);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
    for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return { texture, frame };
  }

  // Rings of vertices (cosine, sine, share of the way from the pole of its half, which half), as triangles.
  capsuleMesh() {
    const { gl } = this;
    const vertices = [];
    const indices = [];
    for (let row = 0; row < 2 * ROWS + 2; row += 1) {
      const half = row <= ROWS ? 0 : 1;
      for (let column = 0; column <= COLUMNS; column += 1) {
        const turn = (2 * Math.PI * column) / COLUMNS;
        vertices.push(Math.cos(turn), Math.sin(turn), (row - half * (ROWS + 1)) / ROWS, half);
        if (row === 0 || column === 0) continue;
        const here = row * (COLUMNS + 1) + column;
        const below = here - COLUMNS - 1;
        indices.push(below - 1, here, here - 1, below - 1, below, here);
      }
    }
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(indices), gl.STATIC_DRAW);
    return { vertices: this.buffer(new Float32Array(vertices)), indices: buffer, count: indices.length };
  }

  // A ribbon along a smooth path over the ground: x, z and frame of each vertex.
  ribbon(motion) {
    const points = [];
    for (let frame = 0; frame < motion.nFrames; frame += 1) {
      const at = [motion.focus[2 * frame], motion.focus[2 * frame + 1], frame];
      const last = points[points.length - 1];
      if (!last || Math.hypot(at[0] - last[0], at[1] - last[1]) > 0.04) points.push(at);
    }
    const vertices = [];
    points.forEach(([x, z, frame], i) => {
      const [before, after] = [points[Math.max(i - 1, 0)], points[Math.min(i + 1, points.length - 1)]];
      const way = [after[0] - before[0], after[1] - before[1]];
      const half = 0.012 / (Math.hypot(...way) || 1);
      for (const side of [1, -1]) vertices.push(x - side * half * way[1], z + side * half * way[0], frame);
    });
    return { buffer: this.buffer(new Float32Array(vertices)), count: vertices.length / 3 };
  }

  attribute(place, size, stride, offset, divisor) {
    const { gl } = this;
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, 4 * stride, 4 * offset);
    gl.vertexAttribDivisor(place, divisor);
  }

  only(...places) {
    for (let place = 0; place < 4; place += 1) if (!places.includes(place)) this.gl.disableVertexAttribArray(place);
  }

  drawCapsules(n) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.mesh.vertices);
    this.attribute(0, 4, 4, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.capsules);
    this.attribute(1, 4, 11, 0, 1);
    this.attribute(2, 4, 11, 4, 1);
    this.attribute(3, 3, 11, 8, 1);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.mesh.indices);
    gl.drawElementsInstanced(gl.TRIANGLES, this.mesh.count, gl.UNSIGNED_SHORT, 0, n);
  }

  clear(width, height) {
    const { gl } = this;
    gl.disable(gl.SCISSOR_TEST);
    gl.viewport(0, 0, width, height);
    gl.clearColor(...this.colours.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  // Draws one pane. `capsules`: 11 numbers each (ball, ball, colour); `paths`: [{ribbon, now, colour}];
  // `box`: left, bottom, width and height in pixels; `spot`: middle and radius of what throws shadows.
  pane(box, view, light, capsules, paths, spot) {
    const { gl } = this;
    const n = capsules.length / 11;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.capsules);
    gl.bufferData(gl.ARRAY_BUFFER, capsules, gl.DYNAMIC_DRAW);
    const shadowMatrix = multiply(
      orthographic(spot.radius, 2 * spot.radius),
      lookAt(add(spot.middle, light), spot.middle),
    );
    this.throwShadow(shadowMatrix, n);
    gl.enable(gl.SCISSOR_TEST);
    gl.viewport(...box);
    gl.scissor(...box);
    gl.bindTexture(gl.TEXTURE_2D, this.shadow.texture);
    const softness = 0.016 / spot.radius;
    const shared = { ...this.colours, ...view, light, shadowMatrix, softness };
    this.drawFloor(shared, paths, capsules);
    this.only(0, 1, 2, 3);
    this.use("body", shared);
    this.drawCapsules(n);
    gl.disable(gl.SCISSOR_TEST);
  }

  throwShadow(matrix, n) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadow.frame);
    gl.viewport(0, 0, SHADOW_PIXELS, SHADOW_PIXELS);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.use("depth", { matrix });
    this.drawCapsules(n);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  drawFloor(shared, paths, capsules) {
    const { gl } = this;
    this.only(0);
    gl.disable(gl.CULL_FACE);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.quad);
    this.attribute(0, 2, 2, 0, 0);
    this.use("floor", { ...shared, reach: Math.max(5.5, 1.3 * shared.distance) });
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.enable(gl.BLEND);
    gl.disable(gl.DEPTH_TEST);
    for (const { ribbon, now, colour } of paths) {
      this.use("path", { matrix: shared.matrix, now, colour });
      gl.bindBuffer(gl.ARRAY_BUFFER, ribbon.buffer);
      this.attribute(0, 3, 3, 0, 0);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, ribbon.count);
    }
    this.drawContacts(shared.matrix, capsules);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.enable(gl.CULL_FACE);
  }

  // A soft dark spot under each ball that is close to the floor.
  drawContacts(matrix, capsules) {
    const { gl } = this;
    const low = [];
    for (let i = 0; i < capsules.length; i += 11) {
      for (const ball of [i, i + 4]) if (capsules[ball + 1] - capsules[ball + 3] < 0.25) low.push(...capsules.slice(ball, ball + 4));
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.contacts);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(low), gl.DYNAMIC_DRAW);
    this.attribute(1, 4, 4, 0, 1);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.quad);
    this.attribute(0, 2, 2, 0, 0);
    this.use("contact", { matrix });
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, low.length / 4);
  }
}
