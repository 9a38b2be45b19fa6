// Colour maps (perceptually uniform) and the colours of clips, bodies and curves.

// Every 16th colour of matplotlib's maps, and the last, for linear interpolation.
const MAPS = {
  viridis: "44015448186a472d7b4240863b528b33638d2c728e26828e21918c1fa08828ae803fbc735ec96284d44baddc30d8e219fde725",
  cividis: "00224e002e6a1a386f32436d434e6c535a6d61656f6f70737d7c788c88789b9476aba072bcae6ccdbb63dec958f0d846fee838",
};

export const MAP_NAMES = Object.keys(MAPS);

/** Return 256 colours of a map, 4 bytes each. */
export function mapColours(name) {
  const anchors = MAPS[name].match(/.{6}/g).map(channels);
  const colours = new Uint8Array(4 * 256);
  for (let i = 0; i < 256; i++) {
    const at = (i / 255) * (anchors.length - 1);
    const left = Math.min(Math.floor(at), anchors.length - 2);
    for (let c = 0; c < 3; c++) {
      colours[4 * i + c] = Math.round(anchors[left][c] + (at - left) * (anchors[left + 1][c] - anchors[left][c]));
    }
    colours[4 * i + 3] = 255;
  }
  return colours;
}

/** Return a map as a CSS gradient from left to right. */
export function gradient(name) {
  return `linear-gradient(to right, ${MAPS[name]
    .match(/.{6}/g)
    .map((hex) => "#" + hex)
    .join(", ")})`;
}

function channels(hex) {
  return [0, 2, 4].map((i) => parseInt(hex.slice(i, i + 2), 16));
}

// Distinguishable with every kind of colour vision (Okabe and Ito 2008), in tones for light and dark pages.
export const SERIES = {
  light: ["#0069a8", "#c44e00", "#00795c", "#a8407f", "#7a6300", "#4b4fb5"],
  dark: ["#56b4e9", "#f28e3c", "#2fc79a", "#e391c0", "#e0cb3c", "#a3a6ff"],
};
