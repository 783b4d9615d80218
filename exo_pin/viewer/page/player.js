/* Player: connects clock, motion, stage, plots, handles and controls. */

const HANDLES_HINT = "The rings at the feet can be dragged, or moved by the arrow keys: the legs follow.";
const REPORT = 500; // [ms] between reports of the playback's state

class Player {
  constructor() {
    const part = (id) => document.getElementById(id);
    this.part = part;
    this.clock = new Clock(0);
    this.calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.view = "iso";
    this.stage = Stage.open(part("pane"));
    part("no-webgl").hidden = this.stage !== null;
    this.plots = new Plots(part("plots"), part("tabs"), this.stage && part("sliders"), (t) => this.seek(t));
    this.sliders = new Sliders(part("sliders"), (q) => this.poseByHand(q), () => this.apply());
    this.byHand = false; // whether the exoskeleton is posed by hand instead of by the walk
    this.controls = new Controls(this);
    wireTaking(this);
    this.transport = null;
    this.drawn = null; // time of the last picture
    this.followed = [0, 0]; // how far the cameras have followed the walk [m]
    if (this.stage) this.watchStage();
    part("show").hidden = part("cameras").hidden = !this.stage;
    part("webm").hidden = !Recorder.possible;
  }

  watchStage() {
    this.recorder = new Recorder(this.stage, (on) => {
      this.part("webm").setAttribute("aria-pressed", String(on));
      this.part("webm").textContent = on ? "Stop and save" : "Record WebM";
    });
    this.handles = new Handles(this.part("handles"), this.stage, {
      onGrab: () => this.grab(),
      onMove: (request) => this.transport.solve(request, (answer) => this.reached(answer)),
      onRelease: () => this.apply(),
    });
    new ResizeObserver(() => {
      this.stage.resize();
      if (this.view && this.header) this.look(this.view);
    }).observe(this.part("pane"));
    this.stage.viewer.controls.addEventListener("start", () => (this.view = ""));
    this.stage.renderer.domElement.addEventListener("webglcontextlost", () => {
      this.notify("The graphics card dropped the picture; reload the page to see it again.");
    });
  }

  async load(zipped) {
    const { header, commands, arrays } = await readBundle(zipped);
    if (this.header && this.header.id === header.id) return; // a reconnect: keep playing
    this.header = header;
    this.beside = false; // whether the ghost walks beside the first figure
    this.motion = new Motion(header, arrays);
    const fresh = new Clock(header.duration);
    fresh.speed = header.speed;
    fresh.play(!this.calm);
    this.clock = fresh;
    this.describe(header);
    this.plots.load(this.motion, header);
    if (this.stage) this.build(header, commands);
    this.drawn = null;
  }

  describe(header) {
    document.title = header.title;
    this.part("title").textContent = header.title;
    this.part("subtitle").textContent = header.subtitle;
    this.part("notes").replaceChildren(
      ...header.notes.map((note) => Object.assign(document.createElement("p"), {
        textContent: note,
        className: note.startsWith("Warning:") ? "warning" : "",
      })),
    );
    this.part("dotted-title").textContent = header.compared;
    this.part("contact-title").textContent = header.contact;
    this.part("com-key").hidden = !("com" in this.motion.arrays);
    this.part("keys").replaceChildren(...header.keys.map(legendEntry));
  }

  build(header, commands) {
    this.stage.resize();
    this.stage.load(header, commands);
    this.chains = header.chains.map((spec) => new Chain(this.stage.viewer.scene_tree, spec));
    this.marks = new Marks(this.stage, header.marks);
    this.bars = new Bars(this.stage, this.chains[0], header.bars);
    this.forces = new Forces(this.stage, header.forces);
    this.sliders.load(header.chains[0], header.handles.length ? HANDLES_HINT : "");
    this.reach = new Reach(this.chains[0]);
    this.handles.load(this.chains[0], header.handles);
    fillToggles(this.part("toggles"), header.groups, this.stage);
    if (header.beside) {
      this.setBeside(header.beside.shown);
      this.part("toggles").append(toggle("Ghost beside", this.beside, (on) => this.setBeside(on)));
    }
    this.followed = [0, 0];
    this.look(this.view || "iso");
  }

  /** Updates picture, plots and status to the clock's time. */
  apply() {
    const t = this.clock.time;
    const at = this.motion.at(t);
    this.byHand = false;
    this.showStatus("");
    if (this.stage) {
      for (const chain of this.chains) this.walk(chain, at);
      this.bars.set();
      this.marks.set(this.motion, t, at);
      this.forces.set(this.motion, at);
      this.follow(at);
      this.sliders.show(this.motion.row(this.chains[0].spec.q, at));
      this.stage.viewer.set_dirty();
    }
    this.plots.draw(t, at);
    this.drawn = t;
  }

  /** Puts a figure where its walk has it; a ghost beside the first figure is shifted. */
  walk(chain, at) {
    const base = this.motion.pose(chain.spec.base, at);
    const { beside } = this.header;
    if (beside && this.beside && beside.chains.includes(chain.spec.name)) base.position[1] += beside.aside;
    chain.set(this.motion.row(chain.spec.q, at), base);
  }

  /** Lets the ghost walk beside the first figure, or inside it. */
  setBeside(on) {
    const { beside } = this.header;
    this.beside = on;
    if (beside.path) this.stage.show(beside.path, on);
    const ghost = this.chains.find(({ spec }) => spec.name === beside.chains[0]);
    this.stage.fade(ghost.root, on ? 0.85 : this.header.paint.opacity);
    if (this.drawn !== null) this.apply();
    if (this.view) this.look(this.view);
  }

  /** The boxes for the cameras, widened to a ghost beside the first figure. */
  boxes() {
    const { boxes, beside } = this.header;
    if (!beside || !this.beside) return boxes;
    const widened = ({ center: [x, y, z], size: [long, wide, high] }) => ({
      center: [x, y + beside.aside / 2, z],
      size: [long, wide + Math.abs(beside.aside), high],
    });
    return Object.fromEntries(Object.entries(boxes).map(([name, box]) => [name, widened(box)]));
  }

  /** Cameras go along with a walk through the room. */
  follow(at) {
    if (!this.header.follow) return;
    const [x, y] = this.motion.row("base", at);
    const moved = [x - this.motion.arrays.base.data[0], y - this.motion.arrays.base.data[1]];
    follow(this.stage.viewer, moved[0] - this.followed[0], moved[1] - this.followed[1]);
    this.followed = moved;
  }

  frame(now) {
    if (this.motion) {
      this.clock.tick(now);
      if (this.clock.time !== this.drawn) this.apply();
      this.controls.show(this);
      if (this.stage && this.stage.draw()) this.handles.show();
      if (now - (this.reported || 0) > REPORT) this.report(now);
    }
    requestAnimationFrame((next) => this.frame(next));
  }

  report(now) {
    this.reported = now;
    const { time, playing, speed, loop } = this.clock;
    this.transport.report({ time: playing ? Number(time.toFixed(2)) : time, playing, speed, loop, view: this.view });
  }

  resume({ type, time, playing, speed, loop, view }) {
    if (type !== "state" || !this.motion) return;
    this.clock.seek(time);
    this.setSpeed(speed);
    this.clock.loop = loop;
    this.clock.play(playing && !this.calm);
    if (CAMERAS[view]) this.look(view);
  }

  /** Shows one pose that Python sent: base (7), then the joints. */
  pose(values) {
    if (!this.stage || !this.chains) return;
    this.clock.play(false);
    const turn = new MeshCat.THREE.Quaternion().fromArray(values, 3);
    this.chains[0].set(values.slice(7), { position: values.slice(0, 3), turn });
    this.stage.viewer.set_dirty();
  }

  /** Poses the exoskeleton by the sliders; the pelvis stays where the walk has it. */
  poseByHand(q) {
    this.clock.play(false);
    this.byHand = true;
    const { base } = this.chains[0].spec;
    this.chains[0].set([...q], this.motion.pose(base, this.motion.at(this.clock.time)));
    this.marks.hide();
    this.forces.hide();
    this.showStatus("posed by hand; the curves are the walk's");
    this.stage.viewer.set_dirty();
  }

  /** Shows the result of posing by hand, or nothing; the curves fade while the walk is not what is shown. */
  showStatus(text, short = false) {
    const status = this.part("reach");
    status.textContent = text;
    status.hidden = !text;
    status.classList.toggle("short", short);
    this.part("plots").classList.toggle("aside", Boolean(text));
  }

  /** A drag of a foot begins: from here on, what is shown is no longer the walk. */
  grab() {
    this.clock.play(false);
    if (this.drawn !== this.clock.time) this.apply();
    this.byHand = true;
  }

  /** Inverse kinematics has answered; an answer that comes after the walk went on is ignored. */
  reached({ q, misses }) {
    if (!this.byHand) return;
    this.poseByHand(q);
    this.sliders.show(q);
    this.handles.show(misses);
    const { last } = this.handles;
    const result = missing(misses[last.link]);
    this.showStatus(`${last.side} foot ${result}`, result !== "reached");
  }

  toggle() {
    this.clock.play(!this.clock.playing);
  }

  seek(t) {
    this.clock.play(false);
    this.clock.seek(t);
  }

  step(count) {
    let t = this.clock.time;
    for (let k = 0; k < Math.abs(count); k++) t = this.motion.neighbour(t, Math.sign(count));
    this.seek(t);
  }

  record() {
    if (this.recorder.running) return this.recorder.stop();
    this.clock.play();
    return this.recorder.start(this.header.title);
  }

  setLoop(on) {
    this.clock.loop = on;
  }

  setSpeed(speed) {
    this.clock.speed = speed;
  }

  faster(by) {
    const { speed } = this.clock;
    const next = by > 0 ? SPEEDS.find((s) => s > speed) : SPEEDS.findLast((s) => s < speed);
    this.setSpeed(next ?? speed);
  }

  look(name) {
    this.view = name;
    if (this.stage && this.header) aim(this.stage.viewer, name, this.boxes(), this.followed);
  }

  notify(text) {
    this.part("notice").textContent = text;
    this.part("notice").hidden = !text;
  }
}

/** An entry of the legend: its colour, its name, and what it means when the mouse rests on it. */
function legendEntry({ title, color, hint }) {
  const entry = Object.assign(document.createElement("span"), { title: hint });
  const patch = document.createElement("i");
  patch.style.background = color;
  entry.append(patch, title);
  return entry;
}
