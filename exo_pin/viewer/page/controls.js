/* Controls: buttons, time slider and keys. They call the player, and show its state. */

const SPEEDS = [0.1, 0.25, 0.5, 1, 1.5, 2];

class Controls {
  constructor(player) {
    this.player = player;
    this.part = (id) => document.getElementById(id);
    this.wire("play", () => player.toggle());
    this.wire("back", () => player.step(-1));
    this.wire("forward", () => player.step(1));
    this.wire("loop", () => player.setLoop(!player.clock.loop));
    this.part("seek").oninput = (event) => player.seek(Number(event.target.value) * player.clock.duration);
    SPEEDS.forEach((speed) => this.offer(speed));
    this.part("speed").onchange = (event) => player.setSpeed(Number(event.target.value));
    this.wire("png", () => savePicture(player.stage, player.header.title));
    this.wire("webm", () => player.record());
    this.wire("help", () => this.part("about").showModal());
    this.part("cameras").replaceChildren(...Object.keys(CAMERAS).map((name) => this.camera(name)));
    addEventListener("keydown", (event) => this.key(event));
  }

  /** Puts a speed into the list of speeds, at its place, if it is not there yet. */
  offer(speed) {
    const list = this.part("speed");
    const later = [...list.options].find((option) => Number(option.value) >= speed);
    if (later && Number(later.value) === speed) return;
    list.add(new Option(`${speed}\u00d7`, String(speed)), later ?? null);
  }

  wire(id, action) {
    this.part(id).onclick = action;
  }

  camera(name) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = CAMERAS[name].label;
    button.dataset.camera = name;
    button.onclick = () => this.player.look(name);
    return button;
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || this.part("about").open) return;
    const { player } = this;
    const names = Object.keys(CAMERAS);
    const actions = {
      " ": () => player.toggle(),
      ArrowLeft: () => player.step(event.shiftKey ? -10 : -1),
      ArrowRight: () => player.step(event.shiftKey ? 10 : 1),
      Home: () => player.seek(0),
      End: () => player.seek(player.clock.duration),
      PageUp: () => player.seek(player.motion.strike(player.clock.time, -1)),
      PageDown: () => player.seek(player.motion.strike(player.clock.time, 1)),
      "[": () => player.plots.zoom(1 / STEP),
      "]": () => player.plots.zoom(STEP),
      w: () => player.plots.toggleWhole(),
      l: () => player.setLoop(!player.clock.loop),
      "-": () => player.faster(-1),
      "+": () => player.faster(1),
      "=": () => player.faster(1),
      "?": () => this.part("about").showModal(),
    };
    names.forEach((name, k) => (actions[String(k + 1)] = () => player.look(name)));
    const action = actions[event.key];
    const typing = /^(SELECT|TEXTAREA)$/.test(event.target.tagName);
    const pressing = event.key === " " && /^(BUTTON|INPUT|SUMMARY|A)$/.test(event.target.tagName);
    if (!action || typing || pressing) return;
    event.preventDefault();
    action();
  }

  show({ clock, motion, view }) {
    const { time, duration, playing, loop, speed } = clock;
    const set = (id, name, value) => {
      if (this.part(id).getAttribute(name) !== value) this.part(id).setAttribute(name, value);
    };
    set("play", "aria-label", playing ? "Pause" : "Play");
    set("play", "aria-pressed", String(playing));
    set("loop", "aria-pressed", String(loop));
    this.part("seek").value = String(duration > 0 ? time / duration : 0);
    this.part("seek").style.setProperty("--share", this.part("seek").value);
    const { percent, cycle } = phaseWords(motion, time);
    set("seek", "aria-valuetext", `${time.toFixed(2)} s, ${percent} ${cycle}`);
    this.setText("percent", percent);
    this.setText("cycle", cycle);
    this.setText("seconds", `${time.toFixed(2)} / ${duration.toFixed(2)} s`);
    this.offer(speed);
    this.part("speed").value = String(speed);
    for (const button of this.part("cameras").children) {
      button.setAttribute("aria-pressed", String(button.dataset.camera === view));
    }
  }

  setText(id, text) {
    if (this.part(id).textContent !== text) this.part(id).textContent = text;
  }
}

/** Where in the gait cycle: percent and which cycle, for people. */
function phaseWords(motion, time) {
  const { side, spans, estimate } = motion.cycles;
  if (!spans.length) return { percent: "\u2013 %", cycle: "no whole cycle" };
  const phase = motion.phase(time);
  const foot = side ? `${side} ` : "";
  if (!phase) return { percent: "\u2013 %", cycle: `outside the ${foot}cycles` };
  const percent = `${(phase.share * 100).toFixed(1)} %`;
  if (estimate) return { percent, cycle: `${foot}cycle, estimated` };
  return { percent, cycle: motion.periodic ? `${foot}cycle` : `${foot}cycle ${phase.number} of ${phase.count}` };
}
