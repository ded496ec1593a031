// The colours of scalars, the same as in the program's static pictures.
import {ClampToEdgeWrapping, DataTexture, LinearFilter, RGBAFormat, UnsignedByteType} from 'three';

const kSteps = 256;

/// The colour of a scalar from 0 to 1, as three sRGB values from 0 to 1: a straight rise of
/// lightness from dark violet over teal to yellow in the OKLab space (Ottosson 2020), which
/// colour-blind people can read, too.
export function colour_map(scalar) {
  const t = Math.min(1, Math.max(0, scalar));
  const lightness = 0.3 + 0.63 * t;
  const hue = ((300 - 195 * t) * Math.PI) / 180;
  const chroma = 0.1 + 0.04 * t;
  const a = chroma * Math.cos(hue);
  const b = chroma * Math.sin(hue);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s,
  ].map((linear) => {
    const x = Math.min(1, Math.max(0, linear));
    return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
  });
}

/// The colour map as a texture of one row, for shaders.
export function colour_map_texture() {
  const texels = new Uint8Array(4 * kSteps);
  for (let i = 0; i < kSteps; ++i) {
    const [r, g, b] = colour_map(i / (kSteps - 1));
    texels.set([Math.round(255 * r), Math.round(255 * g), Math.round(255 * b), 255], 4 * i);
  }
  const texture = new DataTexture(texels, kSteps, 1, RGBAFormat, UnsignedByteType);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.wrapS = texture.wrapT = ClampToEdgeWrapping;
  texture.needsUpdate = true;
  return texture;
}

/// The colour map as a CSS gradient from left to right, for legends.
export function colour_map_gradient() {
  const stops = Array.from({length: 17}, (_, i) => {
    const codes = colour_map(i / 16).map((x) => Math.round(255 * x));
    return `rgb(${codes.join(',')})`;
  });
  return `linear-gradient(to right, ${stops.join(',')})`;
}
