// SPDX-License-Identifier: Apache-2.0
// usage: lookup.test.mjs LOOKUP.glsl CASES TEXELS_OF_IRRADIANCE TEXELS_OF_DISTANCE
// Runs the WebGL port of the lookup in Chromium on the queries of a file (tests/ports/cases.h, irradiance in RGB9E5) and
// holds it to the processor's answers. Exits with 77 where there is no Chromium.
import { readFileSync } from 'node:fs';
import { Checks, launch, WEBGL } from './chromium.mjs';

const [shader, cases, ...texels] = process.argv.slice(2);
const WIDTH = 2048; // of textures
const GRID_WORDS = 31, QUERY_WORDS = 9;
const OFFSET_STEP = 0.45 / 511; // kMaxProbeOffset / kOffsetSteps
// Of an answer's largest channel: root mean square, and of 99 in 100 answers. 2.2e-5 and 6.2e-5 were seen on a processor;
// devices may filter with 8 bits of a fraction, and visibility is the cube of a quotient of small differences.
const MOST_RMS = 1e-3, MOST_OF_99 = 3e-3;

const file = new Uint8Array(readFileSync(cases)).buffer;
const words = new Uint32Array(file);
const [volumes, probes, irradianceWords, distanceWords, queries] = words;
let next = 5;
const take = (count) => words.slice(next, (next += count));
const [gridWords, offsets, irradiance, distances, queryWords] =
  [volumes * GRID_WORDS, probes, irradianceWords, distanceWords, queries * QUERY_WORDS].map(take);
const expected = new Float32Array(take(queries * 3).buffer);
if (next !== words.length) throw new Error(`${cases}: not a file of cases`);

const grids = Array.from({ length: volumes }, (_, v) => {
  const own = gridWords.slice(v * GRID_WORDS, (v + 1) * GRID_WORDS).buffer;
  const [reals, whole] = [Array.from(new Float32Array(own)), Array.from(new Int32Array(own))];
  return {
    origin_ws: reals.slice(0, 3), spacing: reals.slice(3, 6), axes: reals.slice(6, 15), count: whole.slice(15, 18),
    scroll: whole.slice(18, 21), first: whole[21], fade_centre: reals.slice(22, 25), fade_half: reals.slice(25, 28),
    fade_cells: reals.slice(28, 31),
  };
});

/// Tiles that follow on each other, as an atlas.
function atlasOf(tiles, edge) {
  const inRow = Math.floor(WIDTH / edge);
  const atlas = new Uint32Array(Math.ceil(probes / inRow) * edge * WIDTH);
  tiles.forEach((word, i) => {
    const [probe, y, x] = [Math.floor(i / edge ** 2), Math.floor(i / edge) % edge, i % edge];
    atlas[(Math.floor(probe / inRow) * edge + y) * WIDTH + (probe % inRow) * edge + x] = word;
  });
  return atlas;
}

/// Where a probe is, from its place on its grid and its offset.
function placeOf(probe) {
  const { origin_ws: origin, spacing, axes, count, scroll, first } = grids.findLast((grid) => grid.first <= probe);
  const i = probe - first;
  const stored = [i % count[0], Math.floor(i / count[0]) % count[1], Math.floor(i / (count[0] * count[1]))];
  const cells = stored.map((c, axis) => ((c - scroll[axis] + count[axis]) % count[axis])
    + ((offsets[probe] << (22 - 10 * axis)) >> 22) * OFFSET_STEP);
  return [0, 1, 2].map((row) => cells.reduce((sum, c, axis) => sum + axes[3 * axis + row] * spacing[axis] * c, origin[row]));
}
const places = new Float32Array(4 * WIDTH * Math.ceil(probes / WIDTH));
for (let probe = 0; probe < probes; ++probe) places.set(placeOf(probe), 4 * probe);

/// Runs in the page: the answers, three numbers a query.
function answer({ lookup, width, edges, uniforms, textures, count }) {
  const gl = new OffscreenCanvas(1, 1).getContext('webgl2');
  if (!gl.getExtension('EXT_color_buffer_float')) throw new Error('no textures of floats');
  const compile = (type, text) => {
    const made = gl.createShader(type);
    gl.shaderSource(made, `#version 300 es\nprecision highp float;\nprecision highp int;\n${text}`);
    gl.compileShader(made);
    if (!gl.getShaderParameter(made, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(made));
    return made;
  };
  const program = gl.createProgram();
  gl.attachShader(program, compile(gl.VERTEX_SHADER,
    'void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }'));
  gl.attachShader(program, compile(gl.FRAGMENT_SHADER, `#define LAMBENT_VOLUMES ${uniforms.length}\n${lookup}
    uniform highp sampler2D queries;
    out vec4 answer;
    vec3 part(int i) {
      int at = 3 * (int(gl_FragCoord.x) + ${width} * int(gl_FragCoord.y)) + i;
      return texelFetch(queries, ivec2(at % ${width}, at / ${width}), 0).xyz;
    }
    void main() { answer = vec4(field_irradiance(part(0), part(1), part(2)), 1.0); }`));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  const place = (name) => gl.getUniformLocation(program, name);
  gl.uniform1i(place('lambent_volumes'), uniforms.length);
  gl.uniform2iv(place('lambent_texels'), edges);
  uniforms.forEach((grid, i) => {
    for (const [name, value] of Object.entries(grid)) {
      const at = place(`lambent_grids[${i}].${name}`);
      if (name === 'axes') gl.uniformMatrix3fv(at, false, value);
      else if (name === 'first') gl.uniform1i(at, value);
      else if (name === 'count' || name === 'scroll') gl.uniform3iv(at, value);
      else gl.uniform3fv(at, value);
    }
  });
  const kinds = {
    lambent_irradiance: [gl.RGB9_E5, gl.RGB, gl.UNSIGNED_INT_5_9_9_9_REV, gl.LINEAR, 1, Uint32Array],
    lambent_distances: [gl.RG16F, gl.RG, gl.HALF_FLOAT, gl.LINEAR, 2, Uint16Array],
    lambent_places: [gl.RGBA32F, gl.RGBA, gl.FLOAT, gl.NEAREST, 4, Float32Array],
    queries: [gl.RGBA32F, gl.RGBA, gl.FLOAT, gl.NEAREST, 4, Float32Array],
  };
  Object.entries(textures).forEach(([name, base64], unit) => {
    const [inside, format, type, filter, numbers, Row] = kinds[name];
    const data = new Row(Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)).buffer);
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, inside, width, data.length / numbers / width, 0, format, type, data);
    for (const which of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, which, filter);
    for (const which of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, which, gl.CLAMP_TO_EDGE);
    gl.uniform1i(place(name), unit);
  });
  const height = Math.ceil(count / width);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.activeTexture(gl.TEXTURE15);
  const target = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, target);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
  gl.viewport(0, 0, width, height);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const found = new Float32Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, found);
  if (gl.getError()) throw new Error('WebGL reports an error');
  return Array.from({ length: 3 * count }, (_, i) => found[4 * Math.floor(i / 3) + (i % 3)]);
}

const base64 = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength).toString('base64');
const rows = Math.ceil((3 * queries) / WIDTH);
const asTexels = new Float32Array(4 * WIDTH * rows);
new Float32Array(queryWords.buffer).forEach((value, i) => { asTexels[4 * Math.floor(i / 3) + (i % 3)] = value; });
const edges = texels.map(Number);

const checks = new Checks();
const browser = await launch(WEBGL);
const page = await browser.newPage();
const found = await page.evaluate(answer, {
  lookup: readFileSync(shader, 'utf8'), width: WIDTH, edges, uniforms: grids, count: queries,
  textures: {
    lambent_irradiance: base64(atlasOf(irradiance, edges[0] + 2)),
    lambent_distances: base64(atlasOf(distances, edges[1] + 2)),
    lambent_places: base64(places), queries: base64(asTexels),
  },
});
await browser.close();

const off = Array.from({ length: queries }, (_, i) => {
  const [e, f] = [expected, found].map((all) => Array.from(all.slice(3 * i, 3 * i + 3)));
  return Math.max(...e.map((value, c) => Math.abs(value - f[c]))) / Math.max(...e, 1e-6);
}).sort((a, b) => a - b);
const rms = Math.sqrt(off.reduce((sum, one) => sum + one * one, 0) / queries);
const [median, of99] = [0.5, 0.99].map((share) => off[Math.floor(share * (queries - 1))]);
checks.that(rms <= MOST_RMS && of99 <= MOST_OF_99, `${queries} queries: off by ${rms.toExponential(1)} (root mean square), `
  + `median ${median.toExponential(1)}, 99 % ${of99.toExponential(1)}, at most ${off.at(-1).toExponential(1)}`);
checks.end();
