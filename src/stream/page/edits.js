// SPDX-License-Identifier: Apache-2.0
// The controls that change the shared scene: its sun and its lamps.
import * as protocol from './protocol.js';

const element = (id) => document.getElementById(id);
const AXES = ['x', 'y', 'z'];

/// `send` sends a message, `nextInput` returns the next input's number.
export class Edits {
  #welcome;
  #send;
  #nextInput;

  constructor({ send, nextInput }) {
    [this.#send, this.#nextInput] = [send, nextInput];
    element('hours').addEventListener('input', () => this.#sendHours());
    element('light').addEventListener('input', () => this.#showLight());
    for (const [edits, names] of [[protocol.EDITS.position, AXES], [protocol.EDITS.intensity, ['power', 'color']]]) {
      for (const name of names) element(`light-${name}`).addEventListener('input', () => this.#sendLight(edits));
    }
    element('edits').addEventListener('submit', (event) => event.preventDefault());
  }

  /// Shows the controls for the scene's lights, if the client may change them.
  offer(welcome) {
    const first = !this.#welcome;
    this.#welcome = welcome;
    element('edits').hidden = welcome.role !== 2;
    if (!first) return;
    element('sun').hidden = !welcome.lights.some((light) => light.type === 0);
    welcome.lights.forEach((light, index) => {
      if (light.type !== 0) element('light').add(new Option(String(index), String(index)));
    });
    element('lamp').hidden = element('light').options.length === 0;
    AXES.forEach((axis, i) => {
      element(`light-${axis}`).min = welcome.min[i];
      element(`light-${axis}`).max = welcome.max[i];
    });
    this.#showLight();
  }

  #showLight() {
    const chosen = this.#welcome.lights[Number(element('light').value)];
    if (!chosen) return;
    AXES.forEach((axis, i) => { element(`light-${axis}`).value = chosen.position[i]; });
    element('light-power').value = 1;
  }

  #sendHours() {
    const hours = Number(element('hours').value);
    const minutes = Math.round(hours * 60);
    element('hours-told').textContent =
      `${String(Math.floor(minutes / 60)).padStart(2, '0')}:${String(minutes % 60).padStart(2, '0')}`;
    this.#send(protocol.timeOfDay(this.#nextInput(), hours));
  }

  /// Edits only the numbers whose sliders were moved: other positions may be between steps of the
  /// sliders.
  #sendLight(edits) {
    const index = Number(element('light').value);
    const chosen = this.#welcome.lights[index];
    const hex = element('light-color').value;
    const linear = [1, 3, 5].map((at) => (parseInt(hex.slice(at, at + 2), 16) / 255) ** 2.2);
    const power = Number(element('light-power').value);
    this.#send(protocol.light(this.#nextInput(), index, edits, {
      position: AXES.map((axis) => Number(element(`light-${axis}`).value)),
      direction: chosen.direction,
      intensity: chosen.intensity.map((value, i) => value * power * linear[i]),
    }));
  }
}
