// The canvas and the two panes over it: what is drawn where, markers, and which place of a view
// a place in a pane is.
import {Color, ColorManagement, LinearSRGBColorSpace, WebGLRenderer} from 'three';
import {PageError} from './page_error.js';
import {kStates} from './surface.js';

const by_id = (id) => document.getElementById(id);

function graphics_context(canvas) {
  const context = canvas.getContext('webgl2', {antialias: true, alpha: false});
  if (!context) {
    throw new PageError(
      'This browser has no WebGL 2, so the model cannot be drawn; the numbers are below',
    );
  }
  return context;
}

// Look-ups a pixel and direction where it covers many texels: fewer if the processor draws.
function most_taps(context) {
  const names = context.getExtension('WEBGL_debug_renderer_info');
  const renderer = context.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : context.RENDERER);
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(renderer) ? 2 : 4;
}

/// Parts of a pane side by side, as shares of its width, each with the state that it shows.
export function views_of(state, flicker_after) {
  const whole = (show) => [{from: 0, to: 1, show}];
  switch (state.compare) {
    case 'after':
      return whole('after');
    case 'slider':
      return whole('split');
    case 'side':
      return [
        {from: 0, to: 0.5, show: 'before'},
        {from: 0.5, to: 1, show: 'after'},
      ];
    case 'flicker':
      return whole(flicker_after ? 'after' : 'before');
    default:
      return whole('before');
  }
}

export class Stage {
  constructor() {
    this.canvas = by_id('canvas');
    ColorManagement.enabled = false; // shaders write what is to be seen
    const context = graphics_context(this.canvas);
    this.most_taps = most_taps(context);
    this.renderer = new WebGLRenderer({canvas: this.canvas, context});
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setScissorTest(true);
    this.renderer.sortObjects = false;
    this.panes = {model: by_id('model-pane'), uv: by_id('uv-pane')};
    this.background = new Color();
  }

  largest_texture() {
    return this.renderer.capabilities.maxTextureSize;
  }

  /// \return whether the canvas has another size than before
  fit() {
    const {clientWidth, clientHeight} = this.canvas;
    const pixels = Math.min(window.devicePixelRatio || 1, 2);
    if (this.width === clientWidth && this.height === clientHeight && this.pixels === pixels)
      return false;
    Object.assign(this, {width: clientWidth, height: clientHeight, pixels});
    this.renderer.setPixelRatio(pixels);
    this.renderer.setSize(clientWidth, clientHeight, false);
    return true;
  }

  box(pane) {
    const canvas = this.canvas.getBoundingClientRect();
    const {left, top, width, height} = this.panes[pane].getBoundingClientRect();
    return {left: left - canvas.left, top: top - canvas.top, width, height};
  }

  /// Width over height of each view of a pane.
  aspect(pane, views) {
    const {width, height} = this.box(pane);
    return Math.max(1e-3, width / views.length / Math.max(1, height));
  }

  /// \return where in a view a place of a pane lies, from -1 to 1 up and right
  place(pane, views, x, y) {
    const {width, height} = this.box(pane);
    const share = (x / width) * views.length;
    return {x: (share - Math.min(views.length - 1, Math.floor(share))) * 2 - 1, y: 1 - (2 * y) / height};
  }

  /// Draw one pane. \param drawn {three, camera(aspect), set_viewport(of)}
  draw_pane(pane, views, split, drawn) {
    const {left, top, width, height} = this.box(pane);
    if (width === 0 || height === 0) return;
    const bottom = this.height - top - height;
    for (const {from, to, show} of views) {
      const x = left + from * width;
      const wide = (to - from) * width;
      this.renderer.setViewport(x, bottom, wide, height);
      this.renderer.setScissor(x, bottom, wide, height);
      const camera = drawn.camera(wide / height);
      drawn.set_viewport({
        width: wide * this.pixels,
        height: height * this.pixels,
        pixels: this.pixels,
        state: kStates[show],
        split: (left + split * width) * this.pixels,
      });
      this.renderer.render(drawn.three, camera);
    }
  }

  start_frame() {
    const style = getComputedStyle(document.documentElement);
    this.background.set(style.getPropertyValue('--stage').trim());
    this.renderer.setClearColor(this.background);
    // The gap between the panes, too.
    this.renderer.setScissor(0, 0, this.width, this.height);
    this.renderer.clear();
  }

  /// Wait until the graphics card has drawn all that was asked for.
  finish() {
    const context = this.renderer.getContext();
    context.readPixels(0, 0, 1, 1, context.RGBA, context.UNSIGNED_BYTE, new Uint8Array(4));
  }

  /// Colours from the last frame, which must just have been drawn. \return rows from the top, RGBA
  pixels_of(pane, x, y, width, height) {
    const context = this.renderer.getContext();
    const {left, top} = this.box(pane);
    const [w, h] = [width, height].map((n) => Math.round(n * this.pixels));
    const px = Math.round((left + x) * this.pixels);
    const py = this.canvas.height - Math.round((top + y) * this.pixels) - h;
    const flipped = new Uint8Array(4 * w * h);
    context.readPixels(px, py, w, h, context.RGBA, context.UNSIGNED_BYTE, flipped);
    const rows = Array.from({length: h}, (_, row) => flipped.subarray(4 * w * row, 4 * w * (row + 1)));
    return rows.reverse().flatMap((row) => Array.from(row));
  }

  /// Put the markers of a pane where its views show a place, or hide them.
  /// \param at {x, y} from -1 to 1, or null; size in CSS pixels
  mark(pane, views, at, {size = 14, behind = false, square = false} = {}) {
    const {width, height} = this.box(pane);
    this.panes[pane].querySelectorAll('.marker').forEach((marker, i) => {
      const view = views[i];
      marker.hidden = !view || !at || Math.abs(at.x) > 1 || Math.abs(at.y) > 1;
      if (marker.hidden) return;
      const x = (view.from + ((at.x + 1) / 2) * (view.to - view.from)) * width;
      const y = ((1 - at.y) / 2) * height;
      marker.style.width = marker.style.height = `${size}px`;
      marker.style.transform = `translate(${x - size / 2}px, ${y - size / 2}px)`;
      marker.classList.toggle('behind', behind);
      marker.classList.toggle('square', square);
    });
  }
}
