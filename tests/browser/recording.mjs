// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from 'node:fs';

/// The messages of a recording (bench/stream/recording.h), each with the checksum of the state after it.
export function readRecording(path) {
  const file = readFileSync(path);
  const messages = [];
  for (let at = 0; at < file.length;) {
    const size = file.readUInt32LE(at);
    messages.push({
      bytes: new Uint8Array(file.subarray(at + 4, at + 4 + size)), checksum: file.readUInt32LE(at + 4 + size),
    });
    at += size + 8;
  }
  return messages;
}
