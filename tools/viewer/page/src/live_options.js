// The controls of the filter as its options, and those as words of the command line.
import {quoted} from './command.js';

export const short = (x) => String(Number(x.toPrecision(3)));

/// What people move, as numbers and choices.
export const kInitial = {
  preset: '',
  kind: 'bilateral',
  spatial: 4, // texels
  range: 0.1,
  range_of_noise: false, // the range is in multiples of the noise
  blur: 0, // texels over which values are blurred before they are compared
  normals: false,
  normal_width: 0.3,
  own_radius: false,
  radius: 10, // texels
  strength: 1,
  samples: 'texel',
  spacing: '2tx',
};

/// What a preset says of the controls. \param options [[name, value]] of the command line
export function controls_of_preset(options) {
  const changes = {kind: 'bilateral'};
  for (const [name, value] of options) {
    if (name === 'kind') changes.kind = value;
    if (name === 'sigma-spatial') changes.spatial = parseFloat(value);
    if (name === 'radius') Object.assign(changes, {own_radius: true, radius: parseFloat(value)});
  }
  return changes;
}

// Which part of the controls an option comes from.
const kParts = {
  range: ['range', 'range_of_noise', 'blur', 'normals', 'normal_width'],
  radius: ['own_radius', 'radius'],
  samples: ['samples', 'spacing'],
};

function compared({range, range_of_noise, blur, normals, normal_width}) {
  const width = short(range) + (range_of_noise ? 'n' : '');
  if (!(blur > 0) && !normals) return {sigma_range: width};
  const guides = [blur > 0 ? `self:blur=${short(blur)}tx:${width}` : `self:${width}`];
  if (normals) guides.push(`surface-normal:${short(normal_width)}`);
  return {guides};
}

/// \param touched names of controls that somebody has moved: with a preset only they count
/// \return the options as the server takes them
export function options_of(controls, touched) {
  const {preset, kind} = controls;
  const counts = (name) => !preset || (kParts[name] ?? [name]).some((part) => touched.has(part));
  const options = {};
  if (preset) options.preset = preset;
  if (counts('kind') && (preset || kind !== 'bilateral')) options.kind = kind;
  if (counts('spatial')) options.sigma_spatial = `${short(controls.spatial)}tx`;
  if (kind === 'bilateral' && counts('range')) Object.assign(options, compared(controls));
  if (controls.own_radius && counts('radius')) options.radius = `${short(controls.radius)}tx`;
  if (controls.strength !== 1) options.strength = short(controls.strength);
  if (controls.samples === 'poisson') {
    options.samples = 'poisson';
    if (controls.spacing) options.spacing = controls.spacing;
  }
  return options;
}

/// The line that does the same. \param command program, subcommand and what is read
export function filter_line(command, options, output) {
  const words = [...command];
  for (const [name, value] of Object.entries(options)) {
    const option = `--${name.replaceAll('_', '-')}`;
    if (name === 'guides') value.forEach((guide) => words.push('--guide', guide));
    else words.push(option, value);
  }
  return [...words, '-o', output].map(quoted).join(' ');
}
