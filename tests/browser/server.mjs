// SPDX-License-Identifier: Apache-2.0
// lambent serve, in a process of its own.
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

/// The scene and the field of all tests: small, and lit by a lamp that can be seen to move.
export const SCENE = 'cornell-spot';
export const FIELD = ['--probes', '5x5x5', '--rays', '64', '--updates', '48', '--no-corrections'];
/// What pictures of equal light are to be equal in.
export const DISPLAY = ['--exposure', '0', '--tone-map', 'linear'];

export class Server {
  constructor(program, more = [], port = 0, scene = SCENE) {
    this.said = '';
    this.process = spawn(program, ['serve', scene, '--port', String(port), ...FIELD, ...DISPLAY, ...more],
      { stdio: ['ignore', 'ignore', 'pipe'] });
    process.on('exit', () => this.process.kill('SIGKILL'));
    this.ended = new Promise((resolve) => this.process.on('exit', (code, signal) => resolve(code ?? signal)));
    this.started = new Promise((resolve, reject) => {
      this.process.stderr.on('data', (data) => {
        this.said += data;
        const port = /serving .* at https?:\/\/[^/]*:(\d+)\//.exec(this.said)?.[1];
        if (port) resolve(Number(port));
      });
      this.ended.then((how) => reject(new Error(`the server ended (${how}): ${this.said}`)));
    });
  }

  /// The address of its page, once it serves.
  async url() { return `http://localhost:${await this.started}/`; }
  async stats() { return (await fetch(`${await this.url()}stats`)).json(); }
  /// Its exit status, or the signal that it died of.
  end(signal) {
    this.started.catch(() => {});
    this.process.kill(signal);
    return this.ended;
  }
}

/// What `work` makes of a folder that is there while it works.
function inFolder(work) {
  const folder = mkdtempSync(join(tmpdir(), 'lambent-browser-'));
  try {
    return work(folder);
  } finally {
    rmSync(folder, { recursive: true });
  }
}
const run = (program, args) => execFileSync(program, args, { stdio: ['ignore', 'ignore', 'pipe'] });

/// The bytes of the .png file that a run of the program writes.
export const pngOf = (program, args) => inFolder((folder) => {
  const file = join(folder, 'picture.png');
  run(program, [...args, '-o', file]);
  return readFileSync(file);
});

/// The same of a layer of what the program renders.
export const layerOf = (program, render, layer, display) => inFolder((folder) => {
  const file = join(folder, 'layers.exr');
  run(program, [...render, '--layers', '-o', file]);
  return pngOf(program, ['picture', file, '--layer', layer, ...display]);
});
