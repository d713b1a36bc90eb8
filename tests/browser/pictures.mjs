// SPDX-License-Identifier: Apache-2.0
// Pictures as means of blocks, of which noise and the codec change little.

export const BLOCKS = { x: 16, y: 9 };

/// Runs in a page: red, green and blue of each block, 0 to 255, of something that can be drawn.
/// A picture is an element's, or a PNG file in base64.
const blockMeans = async ({ selector, png, blocks }) => {
  const image = selector
    ? document.querySelector(selector)
    : await createImageBitmap(new Blob([Uint8Array.from(atob(png), (c) => c.charCodeAt(0))]));
  const canvas = new OffscreenCanvas(image.width, image.height);
  const paint = canvas.getContext('2d');
  paint.drawImage(image, 0, 0);
  const { data } = paint.getImageData(0, 0, image.width, image.height);
  const sums = new Float64Array(3 * blocks.x * blocks.y), counts = new Float64Array(blocks.x * blocks.y);
  for (let y = 0; y < image.height; ++y) {
    for (let x = 0; x < image.width; ++x) {
      const block = Math.floor((x * blocks.x) / image.width)
        + blocks.x * Math.floor((y * blocks.y) / image.height);
      counts[block] += 1;
      for (let c = 0; c < 3; ++c) sums[3 * block + c] += data[4 * (x + image.width * y) + c];
    }
  }
  return Array.from(sums, (sum, i) => sum / counts[Math.floor(i / 3)]);
};

export const meansOfElement = (page, selector) => page.evaluate(blockMeans, { selector, blocks: BLOCKS });
/// `page` is any page, `png` the bytes of a file.
export const meansOfPng = (page, png) => page.evaluate(blockMeans, { png: png.toString('base64'), blocks: BLOCKS });
export const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;

/// How far two pictures are from each other: in the mean of all blocks, and in the worst.
export function difference(a, b) {
  const off = a.map((value, i) => Math.abs(value - b[i]));
  return { mean: mean(off), worst: Math.max(...off) };
}
