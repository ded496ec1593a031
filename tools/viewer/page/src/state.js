// What the page shows, as one flat record; the names are those of the controls.

const kNarrow = 800; // CSS pixels: below, the panel lies under the model

export function initial_state(scene) {
  const pictures = scene.maps.length > 0;
  const afters = pictures && scene.afters.length > 0;
  let colour = 'grey';
  if (pictures) colour = 'texture';
  else if (scene.fields) colour = 'distance';
  const wide = window.innerWidth > kNarrow;
  return {
    map: 0,
    tile: 0,
    after: 0,
    colour,
    compare: afters ? 'slider' : 'before',
    split: 0.5,
    flicker_runs: !window.matchMedia('(prefers-reduced-motion: reduce)').matches,
    flicker_speed: 1,
    filtering: 'linear',
    exposure: 0,
    light: true,
    checker_power: 3,
    difference_share: 1,
    seams: false,
    seam_errors: false,
    seam_share: 1,
    borders: true,
    wireframe: false,
    samples: false,
    nodes: false,
    layer: 0,
    isolines: true,
    step: 0, // set to the layer's own
    panes: scene.mesh.uvs && wide ? 'both' : 'model',
    follow: true,
    theme: 'auto',
  };
}

const kinds = {
  colour: ['texture', 'difference', 'checker', 'distance', 'grey'],
  compare: ['before', 'after', 'slider', 'side', 'flicker'],
  filtering: ['linear', 'nearest'],
  panes: ['both', 'model', 'uv'],
  theme: ['auto', 'light', 'dark'],
};

/// \return the changes that make sense for the scene; the others are left out
export function valid_changes(scene, state, changes) {
  const counts = {
    map: scene.maps.length,
    tile: scene.tiles.length,
    after: scene.afters.length,
    layer: scene.fields?.layers.length ?? 0,
  };
  return Object.fromEntries(
    Object.entries(changes).filter(([name, value]) => {
      if (!(name in state) || typeof value !== typeof state[name]) return false;
      if (name in counts) return Number.isInteger(value) && value >= 0 && value < counts[name];
      if (name === 'colour' && value === 'distance') return Boolean(scene.fields);
      if (name in kinds) return kinds[name].includes(value);
      return typeof value !== 'number' || Number.isFinite(value);
    }),
  );
}
