/* Transports: how the walk reaches the page. Embedded: it is in the page. Live: over one WebSocket,
   which also carries the playback's state back, so that a reopened browser resumes. */

const BUNDLE = 0; // first byte of a binary message: a whole bundle follows
const POSE = 1; // base (7) and joints, float32: show exactly this, now
const RETRY = 1000; // [ms] between attempts to reach the server again
const PATIENCE = 1000; // [ms] a question waits for its answer

class Embedded {
  constructor(text) {
    this.text = text;
  }

  async start(player) {
    this.player = player;
    await player.load(fromBase64(this.text));
  }

  report() {}

  /** Where the joints go for a wish: the page finds out by itself. */
  ask(wish, tell) {
    tell(this.player.reach.answer(wish));
  }
}

class Live {
  constructor(address) {
    this.address = address;
    this.said = "";
    this.count = 0;
    this.asked = null; // the question that is on its way: {id, tell, sent}
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
    if (typeof data === "string") {
      const said = JSON.parse(data);
      return said.type === "reached" ? this.reached(said) : this.player.resume(said);
    }
    const kind = new Uint8Array(data, 0, 1)[0];
    if (kind === POSE) return this.player.pose(new Float32Array(data.slice(1)));
    if (kind === BUNDLE) await this.player.load(new Uint8Array(data, 1));
    return ready();
  }

  /** Asks Python where the joints go for a wish, one question at a time; the page itself if nobody is there. */
  ask(wish, tell) {
    this.next = { wish, tell };
    if (!this.asked) this.askNext();
  }

  askNext() {
    const { wish, tell } = this.next;
    this.next = null;
    if (!this.open) {
      tell(this.player.reach.answer(wish));
      return;
    }
    const timer = setTimeout(() => this.giveUp(), PATIENCE);
    this.asked = { id: this.count++, wish, tell, timer, sent: performance.now() };
    this.socket.send(JSON.stringify({ type: "reach", id: this.asked.id, ...wish }));
  }

  /** Nobody answers: the page finds out by itself. */
  giveUp() {
    const { wish, tell } = this.next || this.asked;
    this.asked = this.next = null;
    tell(this.player.reach.answer(wish));
  }

  reached(answer) {
    if (!this.asked || answer.id !== this.asked.id) return;
    const { tell, sent, timer } = this.asked;
    clearTimeout(timer);
    this.asked = null;
    this.latency = performance.now() - sent; // [ms]
    tell(answer);
    if (this.next) this.askNext();
  }

  get open() {
    return Boolean(this.socket) && this.socket.readyState === WebSocket.OPEN;
  }

  report(state) {
    const text = JSON.stringify({ type: "state", ...state });
    if (text === this.said || !this.open) return;
    this.said = text;
    this.socket.send(text);
  }
}
