// The command line that renders the same view as a static picture.

const kReplaced = new Set([
  '-o',
  '--output',
  '--azimuth',
  '--elevation',
  '--zoom',
  '--target',
  '--extent',
  // Pictures have none of these.
  '--distances',
  '--samples',
  '--nodes',
]);

const digits = (x) => String(Number(x.toPrecision(6)));

/// As a shell reads it.
export function quoted(argument) {
  if (/^[\w./,:=@%+-]+$/.test(argument)) return argument;
  return `'${argument.replaceAll("'", "'\\''")}'`;
}

/// \return the arguments without those options that the view replaces, and without their values
function without_view(words) {
  const kept = [];
  for (let i = 0; i < words.length; ++i) {
    const option = words[i].split('=', 1)[0];
    if (!kReplaced.has(option)) kept.push(words[i]);
    else if (option === words[i]) ++i;
  }
  return kept;
}

/// \param camera {azimuth, elevation, target, extent}
export function command_line(scene, camera) {
  const words = scene.view_command?.length ? scene.view_command : (scene.created ?? []);
  const rest = without_view(words.slice(words[1] === 'view' ? 2 : 1));
  const view = [
    ['--azimuth', digits(camera.azimuth)],
    ['--elevation', digits(camera.elevation)],
    ['--target', camera.target.map(digits).join(',')],
    ['--extent', digits(camera.extent)],
    ['-o', 'picture.png'],
  ];
  return ['onmesh', 'view', ...rest, ...view.flat()].map(quoted).join(' ');
}
