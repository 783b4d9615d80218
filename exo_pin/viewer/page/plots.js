/* Plots: the column of synchronised plots with tabs; click or drag in one seeks in all. A long recording is
   shown through a window that follows the cursor. */

const STEP = 1.5; // by how much a key or a button widens or narrows the window

class Plots {
  /** `other` is an element that takes the plots' place under a last tab, or null. */
  constructor(holder, tabs, other, seek) {
    this.holder = holder;
    this.tabs = tabs;
    this.other = other;
    this.seek = seek;
    this.plots = [];
    this.last = [0, { i: 0, j: 0, a: 0 }]; // time and place that are shown
    this.calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(holder);
    this.stretch = document.getElementById("stretch");
    document.getElementById("narrower").onclick = () => this.zoom(1 / STEP);
    document.getElementById("wider").onclick = () => this.zoom(STEP);
    this.band = document.getElementById("band");
    this.band.onchange = () => {
      this.showBand();
      this.moved();
    };
    document.getElementById("whole").onclick = () => this.toggleWhole();
  }

  load(motion, { plots: groups, reference }) {
    this.motion = motion;
    this.groups = groups;
    this.reference = reference;
    this.window = new TimeWindow(motion.duration, this.calm);
    const titles = [...groups.map((group) => group.title), ...(this.other ? ["Pose"] : [])];
    this.tabs.replaceChildren(...titles.map((title, k) => this.tab(title, k)));
    this.tabs.hidden = titles.length < 2;
    this.choose(0);
  }

  tab(title, k) {
    const button = document.createElement("button");
    button.type = "button";
    button.setAttribute("role", "tab");
    button.textContent = title;
    button.onclick = () => this.choose(k);
    return button;
  }

  choose(k) {
    [...this.tabs.children].forEach((button, i) => button.setAttribute("aria-selected", String(i === k)));
    const group = this.groups[k];
    this.holder.hidden = !group;
    if (this.other) this.other.hidden = Boolean(group);
    document.body.classList.toggle("posing", !group); // the rings at the feet are then seen all the time
    document.getElementById("take").hidden = !group;
    this.showWindow();
    if (!group) return;
    document.getElementById("dashed").hidden = !group.reference;
    document.getElementById("dashed-title").textContent = group.dashes || this.reference;
    document.getElementById("dotted").hidden = !group.compared;
    this.holder.replaceChildren();
    document.getElementById("banded").hidden = !group.low;
    this.group = group;
    this.plots = group.plots.map((spec) => new Plot(spec, this.motion, group, this.window, this.holder));
    this.showBand();
    for (const plot of this.plots) this.listen(plot);
    this.resize();
  }

  /** Tells the plots whether the normal band is wanted. */
  showBand() {
    for (const plot of this.plots) plot.showsBand = this.band.checked;
  }

  listen(plot) {
    const time = (event) => plot.x.at(event.clientX - plot.canvas.getBoundingClientRect().left);
    const go = (event) => this.seek(time(event));
    plot.canvas.onpointerdown = (event) => {
      plot.canvas.setPointerCapture(event.pointerId);
      plot.canvas.onpointermove = go;
      go(event);
    };
    plot.canvas.onpointerup = plot.canvas.onpointercancel = () => (plot.canvas.onpointermove = null);
    const wheel = (event) => {
      if (!event.ctrlKey) return; // without it, and without two fingers, the wheel scrolls the page
      event.preventDefault();
      this.zoom(event.deltaY > 0 ? STEP : 1 / STEP, time(event));
    };
    plot.canvas.addEventListener("wheel", wheel, { passive: false });
  }

  /** Widens (above 1) or narrows the window about a time, the cursor's if none is given. */
  zoom(factor, about = this.last[0]) {
    this.window.zoom(factor, about);
    this.moved();
  }

  toggleWhole() {
    this.window.toggle(this.last[0]);
    this.moved();
  }

  /** Paints everything again after the window has moved. */
  moved() {
    this.showWindow();
    for (const plot of this.plots) plot.paint();
    this.draw(...this.last);
  }

  showWindow() {
    const { window: shown, motion } = this;
    const useless = motion.periodic || (shown.whole && motion.duration <= AT_FIRST); // the keys work all the same
    document.getElementById("window").hidden = useless || this.holder.hidden;
    document.getElementById("whole").setAttribute("aria-pressed", String(shown.whole));
    this.stretch.textContent = shown.whole ? "all" : `${plain(Number(shown.span.toPrecision(2)))} s`;
  }

  resize() {
    for (const plot of this.plots) plot.resize();
    this.draw(...this.last);
  }

  draw(t, at) {
    this.last = [t, at];
    if (!this.window) return;
    if (this.window.follow(t)) for (const plot of this.plots) plot.paint();
    for (const plot of this.plots) plot.draw(t, at);
  }
}
