// SPDX-License-Identifier: Apache-2.0
// usage: lookup.test.mjs LOOKUP.wgsl CASES TEXELS_OF_IRRADIANCE TEXELS_OF_DISTANCE R11G11B10F TOLERANCE
// Runs the WGSL port of the lookup on the queries of a file (cases.h) and holds it to the answers.
// Exits with 77 where WebGPU cannot run here.
import { readFileSync } from 'node:fs';

const SKIPPED = 77;
const GROUP = 64;

function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(SKIPPED);
}

const [shader, cases, irradianceTexels, distanceTexels, r11g11b10f, tolerance] = process.argv.slice(2);

let webgpu;
try {
  webgpu = await import('webgpu');
} catch (error) {
  skip(`npm package webgpu is not installed or does not load here (npm ci in tests/ports): ${error.message}`);
}
Object.assign(globalThis, webgpu.globals);
const gpu = webgpu.create([]);
const adapter = await gpu.requestAdapter();
if (!adapter) skip('WebGPU finds no adapter');
const device = await adapter.requestDevice();
let failures = 0;
device.addEventListener('uncapturederror', (event) => {
  console.error(event.error.message);
  ++failures;
});

// Read the store, the queries and what the CPU answers
const words = new Uint32Array(new Uint8Array(readFileSync(cases)).buffer);
const [volumes, probes, irradianceWords, distanceWords, queries] = words;
let next = 5;
const take = (count) => words.subarray(next, (next += count));
const inputs = [volumes * 31, probes, irradianceWords, distanceWords, queries * 9].map(take);
const expected = new Float32Array(take(queries * 3).slice().buffer);
if (next !== words.length || !(Number(tolerance) > 0)) throw new Error(`${cases}: not a file of cases`);

const code = `${readFileSync(shader, 'utf8')}
@group(1) @binding(0) var<storage, read> queries: array<array<Float3, 3>>;
@group(1) @binding(1) var<storage, read_write> answers: array<Float3>;
@compute @workgroup_size(${GROUP}) fn answer(@builtin(global_invocation_id) id: vec3u) {
  if (id.x >= arrayLength(&queries)) { return; }
  let query = queries[id.x];
  let irradiance = field_irradiance(vec3_of(query[0]), vec3_of(query[1]), vec3_of(query[2]));
  answers[id.x] = Float3(irradiance.x, irradiance.y, irradiance.z);
}`;
const module = device.createShaderModule({ code });
for (const message of (await module.getCompilationInfo()).messages) {
  console.error(`${shader}:${message.lineNum}: ${message.type}: ${message.message}`);
  ++failures;
}
const pipeline = device.createComputePipeline({
  layout: 'auto',
  compute: {
    module,
    entryPoint: 'answer',
    constants: {
      irradiance_texels: Number(irradianceTexels),
      distance_texels: Number(distanceTexels),
      irradiance_r11g11b10f: Number(r11g11b10f),
    },
  },
});

const upload = (data) => {
  const buffer = device.createBuffer({
    size: data.byteLength,
    usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST,
  });
  device.queue.writeBuffer(buffer, 0, data);
  return buffer;
};
const buffers = inputs.map(upload);
const size = queries * 12;
const answers = device.createBuffer({ size, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC });
const readback = device.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
const bind = (group, bound) =>
  device.createBindGroup({
    layout: pipeline.getBindGroupLayout(group),
    entries: bound.map((buffer, binding) => ({ binding, resource: { buffer } })),
  });

const commands = device.createCommandEncoder();
const pass = commands.beginComputePass();
pass.setPipeline(pipeline);
pass.setBindGroup(0, bind(0, buffers.slice(0, 4)));
pass.setBindGroup(1, bind(1, [buffers[4], answers]));
pass.dispatchWorkgroups(Math.ceil(queries / GROUP));
pass.end();
commands.copyBufferToBuffer(answers, 0, readback, 0, size);
device.queue.submit([commands.finish()]);
await readback.mapAsync(GPUMapMode.READ);
const found = new Float32Array(readback.getMappedRange());

// Compare, each query by its largest channel
let worst = 0;
for (let i = 0; i < queries; ++i) {
  const e = expected.subarray(3 * i, 3 * i + 3);
  const f = found.subarray(3 * i, 3 * i + 3);
  const scale = Math.max(...e, 1e-6);
  const off = Math.max(...e.map((value, c) => Math.abs(value - f[c]))) / scale;
  if (!(off <= Number(tolerance))) {
    if (++failures <= 8) console.error(`query ${i}: ${[...f]}, the CPU says ${[...e]}`);
  }
  worst = Math.max(worst, off);
}
console.log(`${adapter.info.description}: ${queries} queries, off by at most ${worst.toExponential(2)}`);
if (failures) console.error(`${failures} failures`);
process.exit(failures ? 1 : 0);
