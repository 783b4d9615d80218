/* Sliders: one per joint, within its limits. Moving one halts the walk and poses the robot by hand. */

const TO_DEGREES = 180 / Math.PI;

class Sliders {
  /** onPose is called with the joint values, in the chain's order, after every change; onBack to see the walk. */
  constructor(holder, onPose, onBack) {
    Object.assign(this, { holder, onPose, onBack });
    this.rows = [];
    this.q = [];
    new ResizeObserver(() => this.show(this.q)).observe(holder); // they come into view
  }

  load(chain, hint) {
    this.joints = chain.joints;
    this.q = chain.joints.map(() => 0);
    const limited = chain.joints.map((joint, k) => ({ joint, k })).filter(({ joint }) => joint.limits);
    this.rows = limited.map(({ joint, k }) => this.row(joint, k));
    const note = Object.assign(document.createElement("p"), { textContent: hint });
    this.holder.replaceChildren(this.buttons(), ...this.rows.map((row) => row.label), note);
  }

  /** Back to the walk, and poses of all joints at once. */
  buttons() {
    const holder = Object.assign(document.createElement("div"), { id: "poses" });
    const clamped = (x, [low, high]) => Math.min(Math.max(x, low), high);
    const poses = {
      Zero: (limits) => clamped(0, limits),
      Centre: ([low, high]) => (low + high) / 2,
      Random: ([low, high]) => low + Math.random() * (high - low),
    };
    const button = (textContent, onclick) => {
      holder.append(Object.assign(document.createElement("button"), { type: "button", textContent, onclick }));
    };
    button("Back to the walk", () => this.onBack());
    for (const [name, value] of Object.entries(poses)) {
      button(name, () => {
        this.show(this.joints.map(({ limits }, k) => (limits ? value(limits) : this.q[k])));
        this.onPose(this.q);
      });
    }
    return holder;
  }

  row(joint, k) {
    const label = document.createElement("label");
    const name = document.createElement("span");
    const range = document.createElement("input");
    const value = document.createElement("output");
    name.textContent = joint.name.replaceAll("_", " ");
    Object.assign(range, { type: "range", step: "any", min: joint.limits[0], max: joint.limits[1] });
    label.className = joint.side || joint.name.split("_")[0];
    range.oninput = () => {
      this.q[k] = Number(range.value);
      this.showValue({ range, value, k });
      this.onPose(this.q);
    };
    label.append(name, range, value);
    return { label, range, value, k };
  }

  showValue({ range, value, k }) {
    const prismatic = this.joints[k].kind === "prismatic";
    value.textContent = prismatic ? `${fixed(this.q[k] * 1000, 0)} mm` : `${fixed(this.q[k] * TO_DEGREES, 0)}\u00b0`;
    range.setAttribute("aria-valuetext", value.textContent);
  }

  /** Shows joint values, in the chain's order. */
  show(q) {
    this.q = [...q];
    if (this.holder.hidden) return;
    for (const row of this.rows) {
      row.range.value = String(q[row.k]);
      this.showValue(row);
    }
  }
}
