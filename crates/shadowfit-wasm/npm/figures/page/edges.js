// Pixels near true shadow edges.

/** Distance within which crawl is counted, in pixels. Our PCF 5×5 has the same zone where a texel is a pixel. */
const EDGE_ZONE = 4;
/** Distance beyond which a wrong pixel is a false shadow or false light, in pixels. Few texels are wider on screen. */
const NEAR_EDGE = 16;

/**
 * Finds the judged pixels near a true shadow edge. An edge is a border between two judged pixels, side by side or one
 * above the other, with different verdicts. Distances are from the centres of the pixels at the edge.
 *
 * @param {[number, number]} size - Width and height of the picture, in pixels.
 * @param {Uint32Array} pixels - Judged pixels.
 * @param {Uint8Array} isLit - Their verdicts.
 * @returns {{ isInEdgeZone: Uint8Array, isNearEdge: Uint8Array }}
 */
export function edgeZones([width, height], pixels, isLit) {
  const verdicts = new Int8Array(width * height).fill(-1);
  pixels.forEach((pixel, index) => {
    verdicts[pixel] = isLit[index];
  });
  const differs = (pixel, there) => verdicts[there] >= 0 && verdicts[there] !== verdicts[pixel];
  const atEdge = pixels.filter((pixel) => {
    const column = pixel % width;
    return (column > 0 && differs(pixel, pixel - 1)) || (column + 1 < width && differs(pixel, pixel + 1))
      || differs(pixel, pixel - width) || differs(pixel, pixel + width);
  });
  const within = (radius) => {
    const marked = markDiscs([width, height], atEdge, radius);
    return Uint8Array.from(pixels, (pixel) => marked[pixel]);
  };
  return { isInEdgeZone: within(EDGE_ZONE), isNearEdge: within(NEAR_EDGE) };
}

/** Marks the pixels whose centres lie within a radius of the given pixels' centres. */
function markDiscs([width, height], pixels, radius) {
  const marked = new Uint8Array(width * height);
  for (const pixel of pixels) {
    const [column, row] = [pixel % width, Math.floor(pixel / width)];
    for (let y = Math.max(row - radius, 0); y <= Math.min(row + radius, height - 1); y += 1) {
      const reach = Math.floor(Math.sqrt(radius * radius - (y - row) ** 2));
      const start = y * width;
      marked.fill(1, start + Math.max(column - reach, 0), start + Math.min(column + reach, width - 1) + 1);
    }
  }
  return marked;
}
