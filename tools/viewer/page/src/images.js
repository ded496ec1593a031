// Images of the scene: values for the numbers, textures for the picture, differences of two.
import {
  DataTexture,
  FloatType,
  HalfFloatType,
  NearestFilter,
  RedFormat,
  RGBAFormat,
  RGFormat,
  UnsignedByteType,
} from 'three';
import {drop_block, half, read_block} from './blocks.js';
import {PageError} from './page_error.js';

const to_number = {
  u8: (code) => code / 255,
  u16: (code) => code / 65535,
  f16: half,
  f32: (value) => value,
};

// Where an image does not say which channel is alpha (-1 = none), the last of two or four is.
function alpha_channel({alpha, channels}) {
  return alpha ?? (channels === 2 || channels === 4 ? channels - 1 : -1);
}

/// An image with its decoded values; row 0 is its top.
export class DecodedImage {
  static async read(image) {
    const decoded = new DecodedImage();
    const {width, height, channels, type} = image;
    Object.assign(decoded, {width, height, channels, type});
    decoded.full_width = image.full_width ?? width;
    decoded.full_height = image.full_height ?? height;
    decoded.alpha = alpha_channel(image);
    decoded.to_number = to_number[type];
    if (!decoded.to_number) throw new PageError(`Images of type ${type} are not read`);
    decoded.codes = await read_block({...image, count: image.count ?? width * height * channels});
    if (decoded.codes.length !== width * height * channels)
      throw new PageError('An image has fewer values than texels');
    return decoded;
  }

  /// Values of all channels of a texel of the full image; 8-bit ones as codes from 0 to 255.
  values(column, row) {
    const x = Math.min(this.width - 1, Math.floor((column * this.width) / this.full_width));
    const y = Math.min(this.height - 1, Math.floor((row * this.height) / this.full_height));
    const at = (y * this.width + x) * this.channels;
    const codes = Array.from(this.codes.subarray(at, at + this.channels));
    return this.type === 'u8' ? codes : codes.map(this.to_number);
  }

  /// \return {texture, step}: step > 1 if only every so manieth texel fits the graphics card
  texture(largest) {
    const step = Math.ceil(Math.max(this.width, this.height) / largest);
    const width = Math.ceil(this.width / step);
    const height = Math.ceil(this.height / step);
    // WebGL2 has no three-channel textures that all cards draw; what has more shows three.
    const stored = this.channels > 2 ? 4 : this.channels;
    const used = Math.min(this.channels, stored);
    let codes = this.codes;
    if (stored !== this.channels || step > 1) {
      codes = new this.codes.constructor(width * height * stored);
      for (let y = 0, to = 0; y < height; ++y) {
        for (let x = 0; x < width; ++x, to += stored) {
          const from = (y * step * this.width + x * step) * this.channels;
          for (let c = 0; c < used; ++c) codes[to + c] = this.codes[from + c];
        }
      }
    }
    const type = {u8: UnsignedByteType, f16: HalfFloatType}[this.type] ?? FloatType;
    if (this.type === 'u16') codes = Float32Array.from(codes, to_number.u16);
    const format = [RedFormat, RGFormat, null, RGBAFormat][stored - 1];
    return {texture: data_texture(codes, width, height, format, type), step};
  }
}

function data_texture(values, width, height, format, type) {
  const texture = new DataTexture(values, width, height, format, type);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/// How two images differ, texel by texel and in all.
export class Difference {
  constructor(before, after) {
    this.width = before.width;
    this.height = before.height;
    this.texels = new Float32Array(this.width * this.height);
    this.squares = 0;
    this.values = 0;
    this.max = 0;
    const {channels, alpha} = before;
    const colours = alpha < 0 || channels === 1 ? channels : channels - 1;
    const [a, b] = [before.to_number, after.to_number];
    for (let i = 0, at = 0; i < this.texels.length; ++i, at += channels) {
      let sum = 0;
      for (let c = 0; c < channels; ++c) {
        const va = a(before.codes[at + c]);
        const vb = b(after.codes[at + c]);
        if (va === vb || (Number.isNaN(va) && Number.isNaN(vb))) continue;
        const d = Math.abs(va - vb);
        if (c !== alpha || channels === 1) sum += d * d;
        if (!Number.isFinite(d)) continue;
        this.squares += d * d;
        this.max = Math.max(this.max, d);
      }
      this.texels[i] = Math.sqrt(sum / colours);
    }
    this.values = this.texels.length * channels;
  }

  static comparable(a, b) {
    return a && b && a.width === b.width && a.height === b.height && a.channels === b.channels;
  }

  texture(largest) {
    const {width, height} = this;
    const image = Object.assign(new DecodedImage(), {width, height, channels: 1, type: 'f32'});
    image.codes = this.texels;
    return image.texture(largest).texture;
  }
}

/// All images of a scene, each decoded and uploaded when it is first asked for.
export class Images {
  constructor(scene, largest_texture) {
    this.scene = scene;
    this.largest = largest_texture;
    this.kept = new Map();
    this.notes = new Set();
  }

  once(key, make) {
    if (!this.kept.has(key)) this.kept.set(key, make());
    return this.kept.get(key);
  }

  /// State 0 is before, 1 the first after, and so on. \return the scene's image or null
  source(map, state, tile) {
    const of = this.scene.maps[map];
    return (state === 0 ? of?.before : of?.after?.[state - 1])?.[tile] ?? null;
  }

  /// What a state is compared with: where that has fewer texels, the state before has, too.
  source_before(map, after, tile) {
    return this.scene.afters[after]?.reduced?.[tile] ?? this.source(map, 0, tile);
  }

  decoded(map, state, tile) {
    return this.decode(this.source(map, state, tile));
  }

  texture(map, state, tile) {
    return this.upload(this.source(map, state, tile));
  }

  texture_before(map, after, tile) {
    return this.upload(this.source_before(map, after, tile));
  }

  async decode(source) {
    if (!source) return null;
    return this.once(`image ${source.block}`, () => DecodedImage.read(source));
  }

  async upload(source) {
    const image = await this.decode(source);
    if (!image) return null;
    return this.once(`texture ${source.block}`, () => {
      const {texture, step} = image.texture(this.largest);
      if (step > 1) {
        this.notes.add(
          `The graphics card takes textures up to ${this.largest} texels wide: ` +
            `every ${step}th texel of a larger one is drawn`,
        );
      }
      return texture;
    });
  }

  async difference(map, after, tile) {
    const sources = [this.source_before(map, after, tile), this.source(map, after + 1, tile)];
    const [a, b] = await Promise.all(sources.map((source) => this.decode(source)));
    if (!Difference.comparable(a, b)) return null;
    return this.once(`difference ${map} ${after} ${tile}`, () => new Difference(a, b));
  }

  async difference_texture(map, after, tile) {
    const difference = await this.difference(map, after, tile);
    if (!difference) return null;
    const key = `difference texture ${map} ${after} ${tile}`;
    return this.once(key, () => difference.texture(this.largest));
  }

  forget(key) {
    const made = this.kept.get(key);
    this.kept.delete(key);
    Promise.resolve(made).then(
      (value) => value?.dispose?.(),
      () => {},
    );
  }

  /// Other images of a state after. \param images per tile
  replace(map, after, images) {
    (this.scene.maps[map].after[after] ?? []).forEach((old, tile) => {
      if (old) {
        drop_block(old);
        this.forget(`texture ${old.block}`);
        this.forget(`image ${old.block}`);
      }
      this.forget(`difference texture ${map} ${after} ${tile}`);
      this.forget(`difference ${map} ${after} ${tile}`);
    });
    this.forget(`numbers ${map} ${after}`);
    this.scene.maps[map].after[after] = images;
  }

  /// Over all tiles. \return {max, rms, psnr_db, largest_texel} or null if no two images compare
  async difference_numbers(map, after) {
    return this.once(`numbers ${map} ${after}`, async () => {
      const tiles = await Promise.all(
        this.scene.tiles.map((_, tile) => this.difference(map, after, tile)),
      );
      const found = tiles.filter((tile) => tile !== null);
      if (found.length === 0) return null;
      const sum = (of) => found.reduce((total, tile) => total + of(tile), 0);
      const rms = Math.sqrt(sum((tile) => tile.squares) / sum((tile) => tile.values));
      const max = Math.max(...found.map((tile) => tile.max));
      const largest_texel = found.reduce((most, {texels}) => {
        for (const x of texels) if (x > most && x < Infinity) most = x;
        return most;
      }, 0);
      return {max, rms, psnr_db: rms > 0 ? 20 * Math.log10(1 / rms) : Infinity, largest_texel};
    });
  }
}
