/* Grips: a handle at each foot, to be dragged, or focused and moved by the arrow keys. The legs follow by inverse
   kinematics; a foot that cannot get there goes as near as it can, and its handle says how much is missing. */

const NUDGE = 0.01; // [m] per arrow key
const FAREST = 3; // a target is at most so far from the hips [m]
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

class Grips {
  /** ask(wish) is called with {feet, q} while a foot is held; let() when the walk shall go on as it was. */
  constructor(holder, stage, { grab, ask, release }) {
    Object.assign(this, { holder, stage, grab, ask, release });
    this.grips = [];
    this.held = null; // the grip in the hand
    this.last = null; // the one that was last in it
  }

  load(chain, specs) {
    this.chain = chain;
    this.held = null;
    this.grips = specs.map((spec) => this.grip(spec));
    this.holder.replaceChildren(...this.grips.flatMap(({ tether, button }) => [tether, button]));
  }

  grip({ link, side }) {
    const button = document.createElement("button");
    const tether = document.createElement("div");
    const grip = { link, side, button, tether, node: this.chain.links[link], target: null };
    Object.assign(button, { type: "button", className: side, title: "Drag the foot (shift: along the ground)" });
    button.setAttribute("aria-label", `${side} foot: drag, or arrow keys; shift: along the ground; escape: let go`);
    button.setAttribute("aria-describedby", "reach");
    tether.className = side;
    button.onpointerdown = (event) => this.take(event, grip);
    button.onpointermove = (event) => this.drag(event, grip);
    button.onpointerup = button.onpointercancel = () => this.drop(grip);
    button.onkeydown = (event) => this.key(event, grip);
    button.onblur = () => this.drop(grip);
    return grip;
  }

  take(event, grip) {
    event.preventDefault();
    grip.button.focus({ preventScroll: true });
    grip.button.setPointerCapture(event.pointerId);
    this.hold(grip);
    grip.start = grip.target.place.clone();
    grip.from = [event.clientX, event.clientY];
    grip.dragged = true;
  }

  /** From here on both feet have a target: the one in the hand moves, the other stays. */
  hold(grip) {
    if (this.held === grip) return;
    this.grab();
    this.chain.settle();
    this.held = this.last = grip;
    for (const each of this.grips) each.target = split(each.node.matrixWorld);
  }

  drag(event, grip) {
    if (!grip.dragged) return;
    const from = this.onPlane(grip.from, grip.start, event.shiftKey);
    const to = this.onPlane([event.clientX, event.clientY], grip.start, event.shiftKey);
    if (from && to) this.move(grip, grip.start.clone().add(to).sub(from));
  }

  drop(grip) {
    if (this.held !== grip) return;
    grip.dragged = false;
    this.held = null;
    this.show();
  }

  key(event, grip) {
    const arrow = ARROWS[event.key];
    if (event.key === "Escape") {
      this.drop(grip);
      this.release();
    }
    if (!arrow || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation(); // elsewhere arrows step through the walk
    this.hold(grip);
    const [right, up] = this.axes(event.shiftKey);
    const step = right.multiplyScalar(arrow[0]).add(up.multiplyScalar(arrow[1])).multiplyScalar(NUDGE);
    this.move(grip, grip.target.place.clone().add(step));
  }

  /** Two directions: of the picture's plane, or along the ground. */
  axes(ground) {
    const { camera } = this.stage.viewer;
    const { Vector3 } = MeshCat.THREE;
    const [right, up, back] = [0, 1, 2].map((k) => new Vector3().setFromMatrixColumn(camera.matrixWorld, k));
    if (!ground) return [right, up];
    const away = Math.abs(back.y) > 0.99 ? up : back.negate(); // from above, away is up in the picture
    return [right.setY(0).normalize(), away.setY(0).normalize()];
  }

  /** Where the ray through a pixel meets the picture's plane (or the level plane) through a point, or null. */
  onPlane([x, y], point, ground) {
    const { Plane, Raycaster, Vector2, Vector3 } = MeshCat.THREE;
    const { camera } = this.stage.viewer;
    const pane = this.holder.getBoundingClientRect();
    const ray = new Raycaster();
    const pixel = new Vector2(((x - pane.x) / pane.width) * 2 - 1, 1 - ((y - pane.y) / pane.height) * 2);
    ray.setFromCamera(pixel, camera);
    const normal = ground ? new Vector3(0, 1, 0) : camera.getWorldDirection(new Vector3());
    return ray.ray.intersectPlane(new Plane().setFromNormalAndCoplanarPoint(normal, point), new Vector3());
  }

  move(grip, place) {
    const hips = new MeshCat.THREE.Vector3().setFromMatrixPosition(this.chain.root.matrixWorld);
    grip.target.place = place.sub(hips).clampLength(0, FAREST).add(hips);
    const feet = Object.fromEntries(this.grips.map(({ link, target }) => [link, this.inRoot(target)]));
    this.ask({ feet, q: this.chain.q });
    this.show();
  }

  inRoot({ place, turn }) {
    const { Matrix4, Vector3 } = MeshCat.THREE;
    const pose = new Matrix4().compose(place, turn, new Vector3(1, 1, 1));
    const local = split(this.chain.root.matrixWorld.clone().invert().multiply(pose));
    return [...local.place.toArray(), ...local.turn.toArray()];
  }

  /** Puts the handles where the feet are, or, in the hand, where the foot shall go. */
  show(misses = null) {
    for (const grip of this.grips) {
      const foot = this.pixel(new MeshCat.THREE.Vector3().setFromMatrixPosition(grip.node.matrixWorld));
      const held = this.held === grip;
      const spot = held ? this.pixel(grip.target.place) : foot;
      grip.button.hidden = !spot;
      grip.tether.hidden = !held || !spot || !foot;
      if (!spot) continue;
      grip.button.style.transform = `translate(${spot.x}px, ${spot.y}px)`;
      grip.button.style.zIndex = String(Math.round(1e4 * (1 - spot.depth)));
      if (misses) grip.button.classList.toggle("short", held && misses[grip.link][0] + misses[grip.link][1] > 0);
      if (!grip.tether.hidden) connect(grip.tether, foot, spot);
    }
  }

  pixel(point) {
    const { x, y, z } = point.clone().project(this.stage.viewer.camera);
    const { clientWidth: width, clientHeight: height } = this.holder;
    return Math.abs(z) > 1 ? null : { x: ((x + 1) / 2) * width, y: ((1 - y) / 2) * height, depth: z };
  }
}

/** Lays a thin line between two pixels. */
function connect(line, a, b) {
  line.style.width = `${Math.hypot(b.x - a.x, b.y - a.y)}px`;
  line.style.transform = `translate(${a.x}px, ${a.y}px) rotate(${Math.atan2(b.y - a.y, b.x - a.x)}rad)`;
}

/** What is missing, in words. */
function missing([distance, angle]) {
  if (distance + angle === 0) return "reached";
  const parts = [];
  if (distance >= 5e-5) parts.push(`${fixed(1000 * distance, distance < 0.01 ? 1 : 0)} mm`);
  if (angle >= 1e-3) parts.push(`${fixed((angle * 180) / Math.PI, 1)}\u00b0`);
  return `out of reach: ${parts.join(" and ") || "less than 0.1 mm"} short`;
}
