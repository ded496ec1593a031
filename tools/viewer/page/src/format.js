/// A number with up to six significant digits.
export function plain(x) {
  if (x === null || x === undefined) return '–';
  if (Number.isNaN(x)) return 'not a number';
  if (!Number.isFinite(x)) return x > 0 ? 'infinite' : '−infinite';
  return String(Number(Number(x).toPrecision(6)));
}

/// Shorter, for legends.
export function brief(x) {
  return Number.isFinite(x) ? String(Number(x.toPrecision(3))) : plain(x);
}

export const grouped = (count) => Number(count).toLocaleString('en');
