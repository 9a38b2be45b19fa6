// Light from the observer's upper left, in the shader of cables and bodies. Colours are not converted to another colour
// space, so that a cable has the colours of the legend.

export const SHADE = `
  uniform float rim; // brighter (dark pages) or darker (light ones) towards the outline, so that it stands out
  vec3 shaded(vec3 colour, vec3 normal) {
    vec3 n = normalize(normal);
    if (n.z < 0.0) n = -n; // the inside of a tube, or a mesh whose triangles turn the other way
    float key = max(0.0, dot(n, normalize(vec3(-0.35, 0.6, 0.75))));
    float shine = pow(max(0.0, dot(n, normalize(vec3(-0.2, 0.35, 0.95)))), 40.0);
    return colour * (0.5 + 0.55 * key) + 0.14 * shine + rim * pow(1.0 - n.z, 3.0);
  }
`;
