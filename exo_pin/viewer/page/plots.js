/* Plots: the column of synchronised plots with tabs; click or drag in one seeks in all. */

class Plots {
  /** `other` is an element that takes the plots' place under a last tab, or null. */
  constructor(holder, tabs, other, seek) {
    this.holder = holder;
    this.tabs = tabs;
    this.other = other;
    this.seek = seek;
    this.plots = [];
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(holder);
  }

  load(motion, groups) {
    this.motion = motion;
    this.groups = groups;
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
    if (!group) return;
    this.holder.replaceChildren();
    this.plots = group.plots.map((spec) => new Plot(spec, this.motion, group, this.holder));
    for (const plot of this.plots) this.listen(plot);
    this.resize();
  }

  listen(plot) {
    const go = (event) => this.seek(plot.x.at(event.clientX - plot.canvas.getBoundingClientRect().left));
    plot.canvas.onpointerdown = (event) => {
      plot.canvas.setPointerCapture(event.pointerId);
      plot.canvas.onpointermove = go;
      go(event);
    };
    plot.canvas.onpointerup = plot.canvas.onpointercancel = () => (plot.canvas.onpointermove = null);
  }

  resize() {
    for (const plot of this.plots) plot.resize();
    if (this.last) this.draw(...this.last);
  }

  draw(t, at) {
    this.last = [t, at];
    for (const plot of this.plots) plot.draw(t, at);
  }
}
