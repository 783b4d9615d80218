/* Transports: how the walk reaches the page. Embedded: it is in the page. Live: over one WebSocket,
   which also carries the playback's state back, so that a reopened browser resumes. */

const BUNDLE = 0; // first byte of a binary message: a whole bundle follows
const POSE = 1; // base (7) and joints, float32: show exactly this, now
const RETRY = 1000; // [ms] between attempts to reach the server again

class Embedded {
  constructor(text) {
    this.text = text;
  }

  async start(player) {
    await player.load(fromBase64(this.text));
  }

  report() {}
}

class Live {
  constructor(address) {
    this.address = address;
    this.said = "";
    this.queue = Promise.resolve(); // bundles inflate asynchronously; messages keep their order
  }

  start(player) {
    this.player = player;
    return new Promise((ready) => this.connect(ready));
  }

  connect(ready) {
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.player.tell("");
    socket.onmessage = ({ data }) => {
      this.queue = this.queue.then(() => this.receive(data, ready));
    };
    socket.onclose = () => {
      this.player.tell("The program that serves this page has stopped. Playback goes on; waiting for its return.");
      setTimeout(() => this.connect(ready), RETRY);
    };
    this.socket = socket;
  }

  async receive(data, ready) {
    if (typeof data === "string") return this.player.resume(JSON.parse(data));
    const kind = new Uint8Array(data, 0, 1)[0];
    if (kind === POSE) return this.player.pose(new Float32Array(data.slice(1)));
    if (kind === BUNDLE) await this.player.load(new Uint8Array(data, 1));
    return ready();
  }

  report(state) {
    const text = JSON.stringify({ type: "state", ...state });
    if (text === this.said || !this.socket || this.socket.readyState !== WebSocket.OPEN) return;
    this.said = text;
    this.socket.send(text);
  }
}
