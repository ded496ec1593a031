// Mouse, touch and keys of a pane, as orbit, pan, zoom and a place that is pointed at.

const kOrbitSpeed = 0.4; // degrees a CSS pixel
const kKeyOrbit = 5; // degrees
const kKeyPan = 0.05; // of the height
const kKeyZoom = 1.2;

/// \param handlers orbit(right, up) in degrees, pan(right, up) in heights of the pane, zoom(factor,
///   x, y), point(x, y) and, for clicks, tap(x, y) in CSS pixels of the pane, leave(), reset()
export function listen(pane, handlers) {
  const fingers = new Map();
  let travelled = 0;
  const place = (event) => {
    const box = pane.getBoundingClientRect();
    return {x: event.clientX - box.left, y: event.clientY - box.top};
  };
  const two = () => {
    const [a, b] = [...fingers.values()];
    return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y)};
  };
  const pan = (dx, dy) => handlers.pan(dx / pane.clientHeight, -dy / pane.clientHeight);

  pane.addEventListener('pointerdown', (event) => {
    if (event.target.closest('[data-own-pointer]')) return;
    pane.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, place(event));
    travelled = 0;
  });
  pane.addEventListener('pointermove', (event) => {
    const now = place(event);
    const last = fingers.get(event.pointerId);
    if (!last) {
      if (event.pointerType !== 'touch') handlers.point(now.x, now.y);
      return;
    }
    const dx = now.x - last.x;
    const dy = now.y - last.y;
    travelled += Math.abs(dx) + Math.abs(dy);
    if (fingers.size === 2) {
      const before = two();
      fingers.set(event.pointerId, now);
      const after = two();
      pan(after.x - before.x, after.y - before.y);
      if (before.apart > 0) handlers.zoom(after.apart / before.apart, after.x, after.y);
      return;
    }
    fingers.set(event.pointerId, now);
    if (event.shiftKey || event.buttons & 6) pan(dx, dy);
    else handlers.orbit(dx * kOrbitSpeed, dy * kOrbitSpeed, dx, dy);
  });
  const up = (event) => {
    const tap = fingers.size === 1 && travelled < 6 && event.type === 'pointerup';
    if (fingers.delete(event.pointerId) && tap) {
      const {x, y} = place(event);
      handlers.point(x, y);
      handlers.tap?.(x, y);
    }
  };
  pane.addEventListener('pointerup', up);
  pane.addEventListener('pointercancel', up);
  pane.addEventListener('pointerleave', (event) => {
    if (event.pointerType === 'mouse' && fingers.size === 0) handlers.leave();
  });
  pane.addEventListener('contextmenu', (event) => event.preventDefault());
  pane.addEventListener(
    'wheel',
    (event) => {
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 30 : 1;
      const {x, y} = place(event);
      handlers.zoom(Math.exp(-event.deltaY * lines * 0.0015), x, y);
    },
    {passive: false},
  );
  pane.addEventListener('keydown', (event) => on_key(event, pane, handlers));
}

function on_key(event, pane, handlers) {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
  const arrow = arrows[event.key];
  const middle = [pane.clientWidth / 2, pane.clientHeight / 2];
  if (arrow && event.shiftKey) handlers.pan(kKeyPan * arrow[0], kKeyPan * arrow[1]);
  else if (arrow) handlers.key_orbit(kKeyOrbit * arrow[0], kKeyOrbit * arrow[1]);
  else if (event.key === '+' || event.key === '=') handlers.zoom(kKeyZoom, ...middle);
  else if (event.key === '-') handlers.zoom(1 / kKeyZoom, ...middle);
  else if (event.key === '0' || event.key === 'Home') handlers.reset();
  else return;
  event.preventDefault();
}
