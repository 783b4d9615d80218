/* Marks: what moves with the walk besides the links: contact soles, centre of mass, treadmill belt. */

class Marks {
  constructor(stage, marks) {
    this.stage = stage;
    this.marks = marks;
    this.com = stage.node(marks.com);
    this.ground = stage.node(marks.ground);
    this.belts = marks.belt ? marks.belt.paths.map((path) => stage.node(path)) : [];
  }

  /** Hides all marks: for a pose by hand neither centre of mass nor contact is known. */
  hide() {
    for (const node of [this.com, this.ground]) node.visible = false;
    for (const path of Object.values(this.marks.contact)) this.stage.show(path, false);
  }

  set(motion, t, at) {
    const known = "com" in motion.arrays; // a URDF without masses has no centre of mass
    for (const node of [this.com, this.ground]) node.visible = known;
    if (known) {
      const [x, y, z] = motion.row("com", at);
      this.com.position.set(x, y, z);
      this.ground.position.set(x, y, this.marks.height);
    }
    for (const side of ["left", "right"]) this.stage.show(this.marks.contact[side], motion.inStance(side, t));
    for (const belt of this.belts) belt.position.x = -((this.marks.belt.speed * t) % this.marks.belt.pitch);
  }
}
