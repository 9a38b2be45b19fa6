// Bodies: a shape with dark edges in a moving frame.

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  Color,
  CylinderGeometry,
  DoubleSide,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  Quaternion,
  ShaderMaterial,
  SphereGeometry,
  Vector3,
} from "three";
import { pointAt, valueAt } from "./sampling.js";
import { SHADE } from "./shading.js";

const MIN_PIXELS = 9; // smallest size of a body on the screen

const VERTEX = `
  varying vec3 vNormal;
  void main() {
    vNormal = normalMatrix * normal;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;
const FRAGMENT = `
  uniform vec3 colour;
  varying vec3 vNormal;
  ${SHADE}
  void main() { gl_FragColor = vec4(shaded(colour, vNormal), 1.0); }
`;

export class BodyView {
  /** A body of a clip: `group` is its frame with its shape. */
  constructor(body) {
    this.body = body;
    this.group = new Group();
    this.group.name = body.name;
    const geometry = shapeGeometry(body.shape);
    geometry.computeBoundingSphere();
    this.radius = geometry.boundingSphere.radius;
    this.offset = new Vector3(...(body.shape.offset ?? [0, 0, 0])).add(geometry.boundingSphere.center);
    this.sheet = body.shape.sheet ?? null; // its edges are seen from the side, too
    this.material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: DoubleSide,
      uniforms: { colour: { value: new Color() }, rim: { value: 0 } },
    });
    this.edgeMaterial = new LineBasicMaterial();
    const mesh = new Mesh(geometry, this.material);
    const edges = new LineSegments(new EdgesGeometry(geometry, 30), this.edgeMaterial);
    this.shape = new Group().add(mesh, edges);
    this.mesh = mesh;
    const offset = new Vector3(...(body.shape.offset ?? [0, 0, 0]));
    mesh.position.copy(offset);
    edges.position.copy(offset);
    this.group.add(this.shape);
    this.point = [0, 0, 0];
  }

  /** Move the body to a sample of time. Its displacement is exaggerated, its rotation is not. */
  update(sample, factor) {
    const { body, group } = this;
    group.position.fromArray(pointAt(body.position, body.reference, sample, factor, this.point));
    const [w, x, y, z] = [0, 1, 2, 3].map((k) => shortest(body.orientation, sample, k));
    group.quaternion.set(x, y, z, w).normalize();
  }

  colour(colour, edge, rim) {
    this.material.uniforms.rim.value = rim;
    this.material.uniforms.colour.value.set(colour);
    this.edgeMaterial.color.set(edge);
  }

  /** Enlarge the shape about the body's origin to the smallest visible size. */
  enlarge(pixel) {
    const least = (MIN_PIXELS / 2) * pixel;
    this.shape.scale.setScalar(this.radius > 0 ? Math.max(1, least / this.radius) : 1);
  }

  dispose() {
    for (const child of this.shape.children) child.geometry.dispose();
    this.material.dispose();
    this.edgeMaterial.dispose();
  }
}

/** A component of the orientation. Quaternions of opposite sign are equal: the nearer one is interpolated. */
function shortest(array, sample, k) {
  if (sample.w === 0 || array.shape[0] === 1) return valueAt(array, sample, k);
  const { values } = array;
  let dot = 0;
  for (let c = 0; c < 4; c++) dot += values[4 * sample.i + c] * values[4 * sample.j + c];
  const sign = dot < 0 ? -1 : 1;
  return (1 - sample.w) * values[4 * sample.i + k] + sample.w * sign * values[4 * sample.j + k];
}

function shapeGeometry(shape) {
  if (shape.kind === "box") return new BoxGeometry(...shape.size);
  if (shape.kind === "sphere") return new SphereGeometry(shape.radius, 32, 20);
  if (shape.kind === "cylinder") {
    const axis = new Vector3(...shape.axis).normalize();
    return new CylinderGeometry(shape.radius, shape.radius, shape.length, 32).applyQuaternion(
      new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), axis),
    );
  }
  const smooth = new BufferGeometry();
  smooth.setAttribute("position", new BufferAttribute(new Float32Array(shape.vertices.values), 3));
  smooth.setIndex(new BufferAttribute(new Uint32Array(shape.triangles.values), 1));
  const flat = smooth.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}
