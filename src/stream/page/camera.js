// SPDX-License-Identifier: Apache-2.0
// A camera that is turned and moved by mouse, touch and keys over an element.

const TURN = 0.005; // per dragged pixel [rad]
const KEY_TURN = 1.2; // [rad/s]
const KEYS_TO_CROSS = 4; // seconds to cross the scene
const WHEEL_STEP = 0.02; // as a share of the scene's size
const STEEPEST = 1.5; // [rad]

export class CameraControls {
  position = [0, 0, 0];
  fov = 0.8;
  size = 0; // size of the scene [m]; 0: not known yet, so nothing moves
  onmove = () => {}; // called when mouse or touch have moved the camera
  #yaw = 0;
  #pitch = 0;
  #pressed = new Set();
  #moved = false;

  constructor(element) {
    element.addEventListener('keydown', (event) => {
      const name = event.key.toLowerCase();
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (!/^([wasdqe]|arrow(left|right|up|down))$/.test(name)) return;
      this.#pressed.add(name);
      event.preventDefault();
    });
    element.addEventListener('keyup', (event) => this.#pressed.delete(event.key.toLowerCase()));
    element.addEventListener('blur', () => this.#pressed.clear());
    element.addEventListener('pointerdown', (event) => element.setPointerCapture(event.pointerId));
    element.addEventListener('pointermove', (event) => {
      if (!event.buttons) return;
      this.#turn(event.movementX * TURN, event.movementY * TURN);
      this.onmove();
    });
    element.addEventListener('wheel', (event) => {
      this.#move(-Math.sign(event.deltaY) * WHEEL_STEP, 0, 0);
      this.onmove();
      event.preventDefault();
    }, { passive: false });
  }

  /// Starts at the server's initial camera, in a scene with these bounds.
  take({ camera, min, max }) {
    const [x, y, z, w] = camera.rotation;
    this.position = camera.position;
    this.fov = camera.fov;
    // The direction of the camera's -Z
    const forward = [-2 * (x * z + w * y), -2 * (y * z - w * x), -(1 - 2 * (x * x + y * y))];
    this.#yaw = Math.atan2(-forward[0], -forward[2]);
    this.#pitch = Math.asin(Math.max(-1, Math.min(1, forward[1])));
    this.size = Math.hypot(...max.map((value, i) => value - min[i]));
  }

  /// Rotation by yaw about +Y, then pitch about +X, as a quaternion x, y, z, w.
  get rotation() {
    const [sy, cy] = [Math.sin(this.#yaw / 2), Math.cos(this.#yaw / 2)];
    const [sp, cp] = [Math.sin(this.#pitch / 2), Math.cos(this.#pitch / 2)];
    return [cy * sp, sy * cp, -sy * sp, cy * cp];
  }

  /// Moves by pressed keys for a time.
  step(seconds) {
    const key = (name) => (this.#pressed.has(name) ? 1 : 0);
    const step = seconds / KEYS_TO_CROSS;
    const [ahead, right, up] = [key('w') - key('s'), key('d') - key('a'), key('e') - key('q')];
    const [yaw, pitch] = [key('arrowleft') - key('arrowright'), key('arrowup') - key('arrowdown')];
    if (ahead || right || up) this.#move(ahead * step, right * step, up * step);
    if (yaw || pitch) this.#turn(yaw * KEY_TURN * seconds, pitch * KEY_TURN * seconds);
  }

  /// Whether it has moved since the last call.
  takeMoved() {
    const moved = this.#moved;
    this.#moved = false;
    return moved;
  }

  #turn(yaw, pitch) {
    if (!this.size) return;
    this.#yaw += yaw;
    this.#pitch = Math.max(-STEEPEST, Math.min(STEEPEST, this.#pitch + pitch));
    this.#moved = true;
  }

  /// Moves along the view, to its right, and up, in shares of the scene's size.
  #move(ahead, right, up) {
    if (!this.size) return;
    const [sin, cos] = [Math.sin(this.#yaw), Math.cos(this.#yaw)];
    const level = Math.cos(this.#pitch);
    this.position[0] += this.size * (-sin * level * ahead + cos * right);
    this.position[1] += this.size * (Math.sin(this.#pitch) * ahead + up);
    this.position[2] += this.size * (-cos * level * ahead - sin * right);
    this.#moved = true;
  }
}
