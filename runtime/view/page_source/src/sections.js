// Outlines of sections: corners with their normals, in the section's axes y (height) and z (width).

/** Return {corners, sides, size, inner}: corners [y, z, normal y, normal z], pairs of corners, the least dimension.
 *  `round`: the number of corners of a circle. */
export function outline(section, round) {
  if (section.shape === "rectangle") return rectangle(section.height, section.width);
  const diameter = section.diameter ?? section.size;
  const inner = section.shape === "tube" ? Math.max(0, diameter / 2 - section.thickness) : 0;
  return { ...circle(diameter / 2, round), inner: inner / (diameter / 2) };
}

function circle(radius, round) {
  const corners = Array.from({ length: round }, (_, i) => {
    const y = Math.cos((2 * Math.PI * i) / round);
    const z = Math.sin((2 * Math.PI * i) / round);
    return [radius * y, radius * z, y, z];
  });
  return { corners, sides: corners.map((_, i) => [i, (i + 1) % round]), size: 2 * radius };
}

function rectangle(height, width) {
  const [y, z] = [height / 2, width / 2];
  const faces = [
    [
      [y, -z],
      [y, z],
      [1, 0],
    ],
    [
      [y, z],
      [-y, z],
      [0, 1],
    ],
    [
      [-y, z],
      [-y, -z],
      [-1, 0],
    ],
    [
      [-y, -z],
      [y, -z],
      [0, -1],
    ],
  ];
  const corners = faces.flatMap(([a, b, normal]) => [
    [...a, ...normal],
    [...b, ...normal],
  ]);
  return { corners, sides: [0, 2, 4, 6].map((i) => [i, i + 1]), size: Math.min(height, width), inner: 0 };
}

/** Return {corner, side, station, cap, index}: the vertices of a cable with `count` stations, caps at both ends. */
export function sweptVertices({ corners, sides, inner }, count) {
  const corner = [],
    side = [],
    station = [],
    cap = [],
    index = [];
  const add = (p, [y, z, ny, nz], facing) => {
    corner.push(y, z);
    side.push(ny, nz);
    station.push(p);
    cap.push(facing);
  };
  for (let p = 0; p < count; p++) corners.forEach((c) => add(p, c, 0));
  const n = corners.length;
  for (let p = 0; p + 1 < count; p++) {
    for (const [a, b] of sides) {
      const [i, j, k, l] = [p * n + a, p * n + b, (p + 1) * n + a, (p + 1) * n + b];
      index.push(i, k, j, j, k, l);
    }
  }
  for (const [p, facing] of [
    [0, -1],
    [count - 1, 1],
  ]) {
    const first = station.length;
    corners.forEach((c) => add(p, c, facing));
    corners.forEach(([y, z, ny, nz]) => add(p, [inner * y, inner * z, ny, nz], facing)); // inner 0: the centre
    for (const [a, b] of sides)
      index.push(first + a, first + b, first + n + a, first + b, first + n + b, first + n + a);
  }
  return { corner, side, station, cap, index };
}
