// The edges of triangles, each once, apart those with a triangle on one side only: they border
// charts, because vertices are apart at seams.

/// \param first, count triangles. \return {inner, border}: pairs of vertices
export function find_edges(indices, vertices, first, count) {
  // Per vertex a list of the edges to vertices of higher number.
  const offsets = new Uint32Array(vertices + 1);
  const others = new Uint32Array(3 * count);
  const each_edge = (visit) => {
    for (let i = 3 * first; i < 3 * (first + count); i += 3) {
      for (let k = 0; k < 3; ++k) {
        const a = indices[i + k];
        const b = indices[i + (k + 1) % 3];
        if (a < b) visit(a, b);
        else visit(b, a);
      }
    }
  };
  each_edge((a) => ++offsets[a + 1]);
  for (let v = 0; v < vertices; ++v) offsets[v + 1] += offsets[v];
  const next = offsets.slice();
  each_edge((a, b) => {
    others[next[a]++] = b;
  });
  const inner = new Uint32Array(6 * count);
  const border = new Uint32Array(6 * count);
  let inners = 0;
  let borders = 0;
  for (let v = 0; v < vertices; ++v) {
    const end = offsets[v + 1];
    insertion_sort(others, offsets[v], end);
    for (let i = offsets[v]; i < end; ) {
      let j = i + 1;
      while (j < end && others[j] === others[i]) ++j;
      if (j - i === 1) {
        border[borders++] = v;
        border[borders++] = others[i];
      } else {
        inner[inners++] = v;
        inner[inners++] = others[i];
      }
      i = j;
    }
  }
  return {inner: inner.slice(0, inners), border: border.slice(0, borders)};
}

// The lists are short: a vertex has about six edges.
function insertion_sort(list, first, last) {
  for (let i = first + 1; i < last; ++i) {
    const x = list[i];
    let j = i;
    for (; j > first && list[j - 1] > x; --j) list[j] = list[j - 1];
    list[j] = x;
  }
}
