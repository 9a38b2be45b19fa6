// The surface of a fluid, with its waves: the graphics card sums them at the corners of a grid.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  FloatType,
  Group,
  LineSegments,
  Mesh,
  NearestFilter,
  RGBAFormat,
  ShaderMaterial,
  Vector3,
} from "three";
import { pointAt } from "./sampling.js";
import { SHADE } from "./shading.js";

const OPACITY = { surface: 0.3, edge: 1 };
const RELIEF = 0.1; // change of the opacity by slopes of the root mean square

// A column of the texture is a wave: its vector and amplitude, and below them its phase at the time.
const RAISED = `
  uniform highp sampler2D waves;
  uniform vec3 up;
  uniform float factor;
  vec3 raised(vec3 point, out vec3 slope) {
    float eta = 0.0;
    slope = vec3(0.0);
    for (int w = 0; w < textureSize(waves, 0).x; w++) {
      vec4 wave = texelFetch(waves, ivec2(w, 0), 0);
      float theta = dot(wave.xyz, point) + texelFetch(waves, ivec2(w, 1), 0).x;
      eta += wave.w * cos(theta);
      slope -= wave.w * sin(theta) * wave.xyz;
    }
    slope *= factor;
    return point + factor * eta * up;
  }
`;
const VERTEX = `
  uniform vec3 relief;
  varying vec3 vNormal;
  varying float vRelief;
  ${RAISED}
  void main() {
    vec3 slope;
    vec3 point = raised(position, slope);
    vNormal = normalMatrix * (up - slope);
    vRelief = clamp(dot(relief, slope) / factor, -2.0, 2.0);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(point, 1.0);
  }
`;
const FRAGMENT = `
  uniform vec3 colour;
  uniform float opacity;
  varying vec3 vNormal;
  varying float vRelief;
  ${SHADE}
  void main() {
    gl_FragColor = vec4(shaded(colour, vNormal) * (1.0 - 0.1 * vRelief), opacity + ${RELIEF} * vRelief);
  }
`;
const EDGE_FRAGMENT = `
  uniform vec3 colour;
  uniform float opacity;
  void main() { gl_FragColor = vec4(colour, opacity); }
`;

export class WaterView {
  /** The surface of a fluid in a clip, as a body: its group is where it is level. */
  constructor(body) {
    this.body = body;
    this.sheet = "water";
    this.isWater = true;
    this.group = new Group();
    this.group.name = body.name;
    this.radius = Math.SQRT2 * body.shape.size;
    this.offset = new Vector3();
    this.texture = waveTexture(body.shape.waves);
    const shared = {
      waves: { value: this.texture },
      up: { value: new Vector3(...body.shape.up) },
      factor: { value: 1 },
      relief: { value: reliefOf(body.shape.waves) },
    };
    this.material = this.materialOf(FRAGMENT, OPACITY.surface, shared);
    this.edgeMaterial = this.materialOf(EDGE_FRAGMENT, OPACITY.edge, shared);
    this.factor = shared.factor;
    const corners = cornersOf(body.shape);
    this.mesh = new Mesh(gridGeometry(body.shape, corners), this.material);
    this.edges = new LineSegments(borderGeometry(body.shape, corners), this.edgeMaterial);
    for (const drawn of [this.mesh, this.edges]) drawn.frustumCulled = false; // waves rise above the level surface
    this.group.add(this.mesh, this.edges);
    this.point = [0, 0, 0];
  }

  materialOf(fragmentShader, opacity, shared) {
    return new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader,
      side: DoubleSide,
      transparent: opacity < 1,
      depthWrite: opacity === 1,
      uniforms: { colour: { value: new Color() }, opacity: { value: opacity }, rim: { value: 0 }, ...shared },
    });
  }

  /** Move the surface to a sample of time. Its elevation is exaggerated as displacements are. */
  update(sample, factor) {
    const { body, texture } = this;
    this.group.position.fromArray(pointAt(body.position, body.reference, sample, factor, this.point));
    this.factor.value = factor;
    const { waves } = body.shape;
    const phases = texture.image.data.subarray(4 * Math.max(1, waves.length));
    waves.forEach(([, frequency, phase], w) => (phases[4 * w] = (phase - frequency * sample.time) % (2 * Math.PI)));
    texture.needsUpdate = true;
  }

  colour(colour, edge, rim) {
    this.material.uniforms.rim.value = rim;
    this.material.uniforms.colour.value.set(colour);
    this.edgeMaterial.uniforms.colour.value.set(edge);
  }

  enlarge() {} // as large as the scene

  dispose() {
    for (const drawn of [this.mesh, this.edges]) {
      drawn.geometry.dispose();
      drawn.material.dispose();
    }
    this.texture.dispose();
  }
}

/** The direction of the waves over the root mean square of the slopes, by which slopes towards them are darker. */
function reliefOf(waves) {
  const sum = new Vector3();
  let square = 0;
  for (const [amplitude, , , ...vector] of waves) {
    const k = new Vector3(...vector);
    square += (amplitude * k.length()) ** 2 / 2;
    sum.addScaledVector(k, amplitude ** 2 * k.length());
  }
  return square > 0 && sum.lengthSq() > 0 ? sum.normalize().divideScalar(-Math.sqrt(square)) : sum.set(0, 0, 0);
}

function waveTexture(waves) {
  const columns = Math.max(1, waves.length); // a level surface: one wave without amplitude
  const data = new Float32Array(8 * columns);
  waves.forEach(([amplitude, , , ...vector], w) => data.set([...vector, amplitude], 4 * w));
  const texture = new DataTexture(data, columns, 2, RGBAFormat, FloatType);
  texture.minFilter = texture.magFilter = NearestFilter;
  return texture;
}

/** Corners of the cells, row by row. */
function cornersOf({ size, cells, along, across }) {
  const [n, m] = cells;
  const corners = new Float32Array(3 * (n + 1) * (m + 1));
  let at = 0;
  for (let i = 0; i <= n; i++) {
    for (let j = 0; j <= m; j++) {
      const [u, v] = [size * ((2 * i) / n - 1), size * ((2 * j) / m - 1)];
      for (let k = 0; k < 3; k++) corners[at++] = u * along[k] + v * across[k];
    }
  }
  return corners;
}

function geometryOf(corners, numbers) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(corners, 3));
  geometry.setIndex(numbers);
  return geometry;
}

function gridGeometry({ cells: [n, m] }, corners) {
  const numbers = [];
  for (let i = 0; i < n; i++) {
    for (let j = 0; j < m; j++) {
      const k = i * (m + 1) + j;
      numbers.push(k, k + 1, k + m + 1, k + 1, k + m + 2, k + m + 1);
    }
  }
  return geometryOf(corners, numbers);
}

function borderGeometry({ cells: [n, m] }, corners) {
  const numbers = [];
  const last = n * (m + 1);
  for (let j = 0; j < m; j++) numbers.push(j, j + 1, last + j, last + j + 1);
  for (let i = 0; i < n; i++) {
    const [here, next] = [i * (m + 1), (i + 1) * (m + 1)];
    numbers.push(here, next, here + m, next + m);
  }
  return geometryOf(corners, numbers);
}
