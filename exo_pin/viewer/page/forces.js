/* Forces: arrows at the points where forces act, arcs of torques around the joints, the motors' load as colour. */

const SHAFT = 0.009; // radius of an arrow [m]
const HEAD = { radius: 0.026, length: 0.07 }; // of an arrow [m]
const SHORTEST = 0.03; // a shorter arrow is not drawn [m]
const ARC = { tube: 0.0075, corners: 8, steps: 100, degrees: 300, shortest: 8 };
const LOADS = [0x2fb457, 0xe6b800, 0xc4221f]; // without torque, at half, at the limit

class Forces {
  /** spec: the header's `forces`, or null. */
  constructor(stage, spec) {
    this.spec = spec;
    if (!spec) return;
    this.arrows = spec.arrows.map((arrow) => ({ ...arrow, ...makeArrow(stage.node(arrow.path), arrow.color) }));
    this.arcs = spec.arcs.map((arc) => ({ ...arc, ...makeArc(stage.node(arc.path), arc) }));
    this.caps = spec.load ? spec.arcs.filter((arc) => arc.middle) : [];
    this.caps = this.caps.map((arc) => ({ ...arc, disc: makeCap(stage.node(arc.cap), arc) }));
  }

  hide() {
    if (!this.spec) return;
    for (const { group } of [...this.arrows, ...this.arcs]) group.visible = false;
    for (const { disc } of this.caps) disc.visible = false;
  }

  set(motion, at) {
    if (!this.spec) return;
    for (const arrow of this.arrows) this.point(arrow, motion.row(arrow.force, at), motion.row(arrow.point, at));
    const torque = motion.row(this.spec.torque, at);
    for (const arc of this.arcs) this.turn(arc, torque[arc.column]);
    const load = this.caps.length ? motion.row(this.spec.load, at) : [];
    for (const { disc, column } of this.caps) {
      disc.visible = !Number.isNaN(load[column]);
      disc.material.color.copy(loadColor(load[column]));
    }
  }

  point({ group, shaft, head }, force, point) {
    const { Vector3 } = MeshCat.THREE;
    const vector = new Vector3(...force).multiplyScalar(this.spec.length);
    const long = vector.length();
    group.visible = long > SHORTEST && point.every((x) => !Number.isNaN(x)); // false where long is not a number
    if (!group.visible) return;
    group.position.set(...point);
    group.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), vector.normalize());
    const tip = Math.min(HEAD.length, long / 2);
    shaft.scale.y = long - tip;
    head.scale.setScalar(tip / HEAD.length);
    head.position.y = long - tip;
  }

  turn({ group, ring, head, radius }, torque) {
    const degrees = Math.min(Math.abs(torque) / this.spec.scale, ARC.degrees);
    group.visible = degrees > ARC.shortest;
    if (!group.visible) return;
    const steps = Math.round((degrees / ARC.degrees) * ARC.steps);
    ring.geometry.setDrawRange(0, steps * ARC.corners * 6);
    const angle = (steps / ARC.steps) * ARC.degrees * (Math.PI / 180);
    head.position.set(radius * Math.cos(angle), radius * Math.sin(angle), 0);
    head.rotation.z = angle;
    group.children[0].rotation.x = torque < 0 ? Math.PI : 0; // seen from behind it turns the other way
  }
}

function paint(color) {
  const { Color, MeshLambertMaterial } = MeshCat.THREE;
  return new MeshLambertMaterial({ color, emissive: new Color(color).multiplyScalar(0.5) });
}

/** An arrow along y from its node's origin: {group, shaft, head}. */
function makeArrow(node, color) {
  const { ConeGeometry, CylinderGeometry, Group, Mesh } = MeshCat.THREE;
  const material = paint(color);
  const shaft = new Mesh(new CylinderGeometry(SHAFT, SHAFT, 1, 14).translate(0, 0.5, 0), material);
  const head = new Mesh(new ConeGeometry(HEAD.radius, HEAD.length, 20).translate(0, HEAD.length / 2, 0), material);
  const group = new Group();
  group.add(shaft, head);
  node.add(group);
  return { group, shaft, head };
}

/** An arc about an axis: {group, ring, head}. */
function makeArc(node, { axis, middle, radius }) {
  const { ConeGeometry, Group, Mesh, Vector3 } = MeshCat.THREE;
  const material = paint("#ff7a0a");
  const ring = new Mesh(arcGeometry(radius), material);
  const head = new Mesh(new ConeGeometry(2.6 * ARC.tube, 6 * ARC.tube, 16).translate(0, 3 * ARC.tube, 0), material);
  const [group, flip] = [new Group(), new Group()];
  flip.add(ring, head);
  group.add(flip);
  group.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), new Vector3(...axis));
  group.position.set(...axis.map((part) => part * middle));
  node.add(group);
  return { group, ring, head };
}

/** A tube along an arc in the x-y plane, its triangles in order along the arc. */
function arcGeometry(radius) {
  const { BufferGeometry, Float32BufferAttribute } = MeshCat.THREE;
  const { tube, corners, steps, degrees } = ARC;
  const [position, normal, index] = [[], [], []];
  for (let i = 0; i <= steps; i++) {
    const along = ((i / steps) * degrees * Math.PI) / 180;
    for (let k = 0; k < corners; k++) {
      const around = (2 * Math.PI * k) / corners;
      const [out, up] = [Math.cos(around), Math.sin(around)];
      position.push((radius + tube * out) * Math.cos(along), (radius + tube * out) * Math.sin(along), tube * up);
      normal.push(out * Math.cos(along), out * Math.sin(along), up);
      if (i === steps) continue;
      const [a, b] = [i * corners + k, i * corners + ((k + 1) % corners)];
      index.push(a, a + corners, b, b, a + corners, b + corners);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(position, 3));
  geometry.setAttribute("normal", new Float32BufferAttribute(normal, 3));
  geometry.setIndex(index);
  return geometry;
}

/** A disc on the face of a joint's motor. */
function makeCap(node, { axis, middle, radius }) {
  const { CylinderGeometry, Mesh, Vector3 } = MeshCat.THREE;
  const disc = new Mesh(new CylinderGeometry(radius - 0.024, radius - 0.024, 0.008, 28), paint("#2fb457"));
  disc.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), new Vector3(...axis));
  disc.position.set(...axis.map((part) => part * (middle + Math.sign(middle) * 0.003)));
  node.add(disc);
  return disc;
}

function loadColor(load) {
  const { Color } = MeshCat.THREE;
  const place = Math.min(Math.max(load, 0), 1) * 2;
  const k = Math.min(Math.floor(place), 1);
  return new Color(LOADS[k]).lerp(new Color(LOADS[k + 1]), place - k);
}
