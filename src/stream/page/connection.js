// SPDX-License-Identifier: Apache-2.0
// A connection to the page's server, which is re-established when it is lost.
import { CODE, read, TYPE } from './protocol.js';

const FIRST_WAIT_MS = 250, LONGEST_WAIT_MS = 800; // wait before the next attempt to connect

/// Shows its state in the page's elements `status`, `token-form` and `token`.
export class Connection {
  #socket;
  #wait = FIRST_WAIT_MS;
  #ended = false;
  #hello;
  #take;
  #lost;

  /// The token in the fragment of the page's address, if any.
  token = new URLSearchParams(location.hash.slice(1)).get('token') ?? '';

  /// `hello` creates the first message, `take` is called with each message of the server, `lost` is
  /// called when the connection ends.
  constructor({ hello, take, lost = () => {} }) {
    [this.#hello, this.#take, this.#lost] = [hello, take, lost];
    document.getElementById('token-form').addEventListener('submit', (event) => {
      event.preventDefault();
      this.token = document.getElementById('token').value;
      document.getElementById('token-form').hidden = true;
      this.#ended = false;
      this.open();
    });
  }

  open() {
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(`${scheme}//${location.host}/stream`);
    this.#socket = socket;
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => this.send(this.#hello(this.token));
    socket.onmessage = (event) => this.#receive(read(event.data));
    socket.onclose = () => {
      this.#lost();
      if (this.#ended) return;
      tell('The connection is lost. Trying again.');
      setTimeout(() => this.open(), this.#wait);
      this.#wait = Math.min(2 * this.#wait, LONGEST_WAIT_MS);
    };
  }

  send(bytes) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(bytes);
  }

  /// Starts again with a new connection.
  again() { this.#socket?.close(); }

  /// Ends the connection permanently, and shows the reason.
  end(why) {
    this.#ended = true;
    this.#socket?.close();
    tell(why, true);
  }

  #receive(message) {
    if (message.type === TYPE.welcome) {
      this.#wait = FIRST_WAIT_MS;
      tell(message.role === 2 ? 'Connected: you may look and change.' : 'Connected: you may look.');
    }
    if (message.type === TYPE.error) this.#refused(message);
    this.#take(message);
  }

  #refused({ code, text }) {
    if (code !== CODE.badToken) return tell(`The server says: ${text}.`, code !== CODE.refusedInput);
    this.#ended = true;
    document.getElementById('token-form').hidden = false;
    return tell(this.token ? `The token was refused: ${text}.` : 'This server asks for a token.', Boolean(this.token));
  }
}

/// Shows a status to the user.
export function tell(text, isError = false) {
  const status = document.getElementById('status');
  status.textContent = text;
  status.className = isError ? 'error' : '';
}
