/* Transports: how the walk reaches the page. Embedded: it is in the page. Live: over one WebSocket, which also
   carries the playback's state back, so that a reopened browser resumes. */

const BUNDLE = 0; // first byte of a binary message: a whole bundle follows
const POSE = 1; // base (7) and joints, float32: show exactly this, now
const RETRY = 1000; // [ms] between attempts to reach the server again
const TIMEOUT = 1000; // [ms] a request waits for its answer

class Embedded {
  constructor(text) {
    this.text = text;
  }

  async start(player) {
    this.player = player;
    await player.load(fromBase64(this.text));
  }

  report() {}

  /** Joint values for the feet's targets, by the page's own inverse kinematics. */
  solve(request, onAnswer) {
    onAnswer(this.player.reach.answer(request));
  }
}

class Live {
  constructor(address) {
    this.address = address;
    this.reported = ""; // the last state that was sent
    this.count = 0;
    this.pending = null; // the request that is on its way: {id, request, onAnswer, timer, sent}
    this.next = null; // of those that wait, only the latest counts
    this.queue = Promise.resolve(); // bundles inflate asynchronously; messages keep their order
  }

  start(player) {
    this.player = player;
    return new Promise((ready) => this.connect(ready));
  }

  connect(ready) {
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.player.notify("");
    socket.onmessage = ({ data }) => {
      this.queue = this.queue.then(() => this.receive(data, ready));
    };
    socket.onclose = () => {
      this.player.notify("The program that serves this page has stopped. Playback goes on; waiting for its return.");
      setTimeout(() => this.connect(ready), RETRY);
    };
    this.socket = socket;
  }

  async receive(data, ready) {
    if (typeof data === "string") {
      const message = JSON.parse(data);
      return message.type === "reached" ? this.reached(message) : this.player.resume(message);
    }
    const kind = new Uint8Array(data, 0, 1)[0];
    if (kind === POSE) return this.player.pose(new Float32Array(data.slice(1)));
    if (kind === BUNDLE) await this.player.load(new Uint8Array(data, 1));
    return ready();
  }

  /** Joint values for the feet's targets, by Python, one request at a time; by the page if Python is gone. */
  solve(request, onAnswer) {
    this.next = { request, onAnswer };
    if (!this.pending) this.sendNext();
  }

  sendNext() {
    const { request, onAnswer } = this.next;
    this.next = null;
    if (!this.open) {
      onAnswer(this.player.reach.answer(request));
      return;
    }
    const timer = setTimeout(() => this.giveUp(), TIMEOUT);
    this.pending = { id: this.count++, request, onAnswer, timer, sent: performance.now() };
    this.socket.send(JSON.stringify({ type: "reach", id: this.pending.id, ...request }));
  }

  /** No answer in time: the page solves the latest request itself. */
  giveUp() {
    const { request, onAnswer } = this.next || this.pending;
    this.pending = this.next = null;
    onAnswer(this.player.reach.answer(request));
  }

  reached(answer) {
    if (!this.pending || answer.id !== this.pending.id) return;
    const { onAnswer, sent, timer } = this.pending;
    clearTimeout(timer);
    this.pending = null;
    this.latency = performance.now() - sent; // [ms]
    onAnswer(answer);
    if (this.next) this.sendNext();
  }

  get open() {
    return Boolean(this.socket) && this.socket.readyState === WebSocket.OPEN;
  }

  report(state) {
    const text = JSON.stringify({ type: "state", ...state });
    if (text === this.reported || !this.open) return;
    this.reported = text;
    this.socket.send(text);
  }
}
