// Cables with their sections. The vertices are constant; the shader sweeps them along the stations, whose positions,
// axes and values are in a texture of 3 texels per station: one small upload per frame.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  FloatType,
  LinearFilter,
  Mesh,
  NearestFilter,
  RGBAFormat,
  ShaderMaterial,
  Vector2,
  Vector3,
} from "three";
import { mapColours } from "./colours.js";
import { frameAt } from "./sampling.js";
import { outline, sweptVertices } from "./sections.js";
import { SHADE } from "./shading.js";

const TEXELS = 1024; // in a row of the texture
const MIN_PIXELS = 3; // smallest width on the screen
const COARSE = { corners: 6, pixels: 8 }; // corners of a circle up to this size on the screen
const FINE = 20;
const NO_VALUE = -1e30;
const MARK = 0.25; // length of a mark on the material over their spacing

const VERTEX = `
  precision highp sampler2D;
  uniform sampler2D stations;
  uniform float size;
  uniform float height;
  attribute vec2 corner;
  attribute vec2 side;
  attribute float station;
  attribute float cap;
  varying vec3 vNormal;
  varying float vValue;
  varying float vStripe;
  varying float vMark;

  vec4 texel(int k) {
    int i = 3 * int(station + 0.5) + k;
    return texelFetch(stations, ivec2(i % ${TEXELS}, i / ${TEXELS}), 0);
  }

  void main() {
    vec4 centre = texel(0);
    vec4 second = texel(1);
    vec3 y = second.xyz;
    vMark = second.w;
    vec3 tangent = texel(2).xyz;
    vec3 z = cross(tangent, y);
    float depth = projectionMatrix[3][3] == 1.0 ? 1.0 : -(modelViewMatrix * vec4(centre.xyz, 1.0)).z;
    float pixel = 2.0 * depth / (projectionMatrix[1][1] * height);
    float grow = max(1.0, ${MIN_PIXELS.toFixed(1)} * pixel / size);
    vec3 normal = cap == 0.0 ? y * side.x + z * side.y : tangent * cap;
    vNormal = normalMatrix * normal;
    vValue = centre.w;
    vStripe = grow > 1.0 ? -1.0 : (cap == 0.0 ? side.x : -1.0);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(centre.xyz + grow * (y * corner.x + z * corner.y), 1.0);
  }
`;

const FRAGMENT = `
  uniform sampler2D colours;
  uniform vec3 plain;
  uniform vec3 missing;
  uniform vec2 range;
  uniform bool coloured;
  uniform bool striped;
  uniform bool marked;
  varying vec3 vNormal;
  varying float vValue;
  varying float vStripe;
  varying float vMark;
  ${SHADE}

  void main() {
    vec3 colour = plain;
    if (coloured) {
      float at = (vValue - range.x) / max(range.y - range.x, 1e-30);
      colour = vValue < ${(NO_VALUE / 10).toExponential(1)} ? missing
        : texture2D(colours, vec2((clamp(at, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
    }
    if (striped && vStripe > 0.97) colour *= 0.45;
    if (marked && abs(fract(vMark + 0.5) - 0.5) < ${(MARK / 2).toFixed(3)}) colour *= 0.3;
    gl_FragColor = vec4(shaded(colour, vNormal), 1.0);
  }
`;

export class CableView {
  /** A cable of a clip: its `mesh`, and `centres`, the drawn points of its stations. */
  constructor(cable) {
    this.cable = cable;
    this.count = cable.s.values.length;
    const shape = outline(cable.section, FINE);
    this.size = shape.size;
    this.fine = geometry(shape, this.count);
    this.coarse = geometry(outline(cable.section, COARSE.corners), this.count);
    const rows = Math.ceil((3 * this.count) / TEXELS);
    this.texels = new Float32Array(4 * TEXELS * rows);
    this.texture = new DataTexture(
      this.texels,
      TEXELS,
      rows,
      RGBAFormat,
      FloatType,
      undefined,
      undefined,
      undefined,
      NearestFilter,
      NearestFilter,
    );
    this.colours = new DataTexture(
      mapColours("viridis"),
      256,
      1,
      RGBAFormat,
      undefined,
      undefined,
      undefined,
      undefined,
      LinearFilter,
      LinearFilter,
    );
    this.colours.needsUpdate = true;
    this.centres = new Float32Array(3 * this.count);
    this.axes = new Float32Array(3 * this.count);
    this.values = new Float32Array(this.count);
    this.marked = cable.material_s !== null && cable.spacing > 0; // marks show how the material runs
    this.material = this.marked ? new Float32Array(this.count) : null;
    this.quantity = null;
    // a round section does not show its twist
    const striped = cable.section_y !== null && cable.section.shape !== "rectangle";
    this.mesh = new Mesh(this.fine, this.shader(striped));
    this.mesh.frustumCulled = false; // the shader moves it
    this.mesh.name = cable.name;
  }

  shader(striped) {
    return new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: DoubleSide,
      uniforms: {
        stations: { value: this.texture },
        colours: { value: this.colours },
        size: { value: this.size },
        height: { value: 1 },
        plain: { value: new Color() },
        missing: { value: new Color("#8a8a8a") },
        range: { value: new Vector2(0, 1) },
        rim: { value: 0 },
        coloured: { value: false },
        striped: { value: striped },
        marked: { value: this.marked },
      },
    });
  }

  /** Colour the cable by a quantity (its key, the range of its values, a map), or plainly (key null).
   *  `rim`: see shading.js. */
  colour({ key, range, map, plain, rim }) {
    const uniforms = this.mesh.material.uniforms;
    uniforms.rim.value = rim;
    this.quantity = this.cable.quantities.find((quantity) => quantity.key === key) ?? null;
    uniforms.coloured.value = this.quantity !== null;
    uniforms.plain.value.set(plain);
    if (range) uniforms.range.value.set(...range);
    if (map) {
      this.colours.image.data.set(mapColours(map));
      this.colours.needsUpdate = true;
    }
  }

  /** Move the cable to a sample of time, displacements drawn `factor` times as large. */
  update(sample, factor, up) {
    const { centres, axes, cable, count, texels, values, material } = this;
    frameAt(cable.position, sample, centres);
    if (factor !== 1) {
      const from = cable.reference.values;
      for (let k = 0; k < 3 * count; k++) centres[k] = from[k] + factor * (centres[k] - from[k]);
    }
    if (cable.section_y) frameAt(cable.section_y, sample, axes);
    if (this.quantity) frameAt(this.quantity.values, sample, values);
    if (material) frameAt(cable.material_s, sample, material);
    const tangent = [0, 0, 0];
    const y = [...up];
    for (let p = 0; p < count; p++) {
      direction(centres, p, count, tangent);
      if (cable.section_y) for (let k = 0; k < 3; k++) y[k] = axes[3 * p + k];
      across(y, tangent);
      const at = 12 * p;
      for (let k = 0; k < 3; k++) {
        texels[at + k] = centres[3 * p + k];
        texels[at + 4 + k] = y[k];
        texels[at + 8 + k] = tangent[k];
      }
      if (material) texels[at + 7] = material[p] / cable.spacing;
      texels[at + 3] = Number.isNaN(values[p]) ? NO_VALUE : values[p];
    }
    this.texture.needsUpdate = true;
  }

  /** Set the height of the picture in pixels, for the smallest width of cables. */
  resize(height) {
    this.mesh.material.uniforms.height.value = height;
  }

  /** Draw fewer corners of small sections; `pixelAt(point)`: size of a pixel in m there. */
  simplify(pixelAt) {
    const point = new Vector3();
    let least = Infinity;
    const stride = Math.max(1, Math.floor(this.count / 50));
    for (let p = 0; p < this.count; p += stride) least = Math.min(least, pixelAt(point.fromArray(this.centres, 3 * p)));
    this.mesh.geometry = this.size / least < COARSE.pixels ? this.coarse : this.fine;
  }

  dispose() {
    this.fine.dispose();
    this.coarse.dispose();
    this.mesh.material.dispose();
    this.texture.dispose();
    this.colours.dispose();
  }
}

function geometry(shape, count) {
  const { corner, side, station, cap, index } = sweptVertices(shape, count);
  const made = new BufferGeometry();
  const set = (name, numbers, size) => made.setAttribute(name, new BufferAttribute(new Float32Array(numbers), size));
  set("corner", corner, 2);
  set("side", side, 2);
  set("station", station, 1);
  set("cap", cap, 1);
  made.setIndex(index);
  return made;
}

/** Write the unit tangent at a station, from the previous to the next station, without coincident points. */
function direction(centres, p, count, out) {
  let before = Math.max(0, p - 1);
  let after = Math.min(count - 1, p + 1);
  for (;;) {
    let square = 0;
    for (let k = 0; k < 3; k++) {
      out[k] = centres[3 * after + k] - centres[3 * before + k];
      square += out[k] * out[k];
    }
    if (square > 0) {
      const length = Math.sqrt(square);
      for (let k = 0; k < 3; k++) out[k] /= length;
      return;
    }
    if (before === 0 && after === count - 1) break;
    before = Math.max(0, before - 1);
    after = Math.min(count - 1, after + 1);
  }
  out[0] = 1;
  out[1] = out[2] = 0;
}

/** Make y a unit vector normal to the tangent. */
function across(y, tangent) {
  const along = y[0] * tangent[0] + y[1] * tangent[1] + y[2] * tangent[2];
  let length = Math.hypot(y[0] - along * tangent[0], y[1] - along * tangent[1], y[2] - along * tangent[2]);
  if (!(length > 1e-6)) {
    const least = tangent.map(Math.abs).reduce((best, value, k, all) => (value < all[best] ? k : best), 0);
    for (let k = 0; k < 3; k++) y[k] = (k === least ? 1 : 0) - tangent[least] * tangent[k];
    length = Math.hypot(...y);
    for (let k = 0; k < 3; k++) y[k] /= length;
    return;
  }
  for (let k = 0; k < 3; k++) y[k] = (y[k] - along * tangent[k]) / length;
}
