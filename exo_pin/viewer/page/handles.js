/* Handles: one at each foot, to be dragged, or focused and moved by the arrow keys. The legs follow by inverse
   kinematics; a foot that cannot reach its target goes as near as it can, and a line shows what is missing. */

const NUDGE = 0.01; // [m] per arrow key
const FARTHEST = 3; // a target is at most so far from the hips [m]
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

class Handles {
  /** onGrab() is called when a drag begins, onMove({feet, q}) while it lasts, onRelease() when the walk resumes. */
  constructor(holder, stage, { onGrab, onMove, onRelease }) {
    Object.assign(this, { holder, stage, onGrab, onMove, onRelease });
    this.handles = [];
    this.held = null; // the handle that is being dragged
    this.last = null; // the one that was dragged last
  }

  load(chain, specs) {
    this.chain = chain;
    this.held = null;
    this.handles = specs.map((spec) => this.handle(spec));
    this.holder.replaceChildren(...this.handles.flatMap(({ tether, button }) => [tether, button]));
  }

  handle({ link, side }) {
    const button = document.createElement("button");
    const tether = document.createElement("div");
    const handle = { link, side, button, tether, node: this.chain.links[link], target: null };
    Object.assign(button, { type: "button", className: side, title: "Drag the foot (shift: along the ground)" });
    button.setAttribute("aria-label", `${side} foot: drag, or arrow keys; shift: along the ground; escape: let go`);
    button.setAttribute("aria-describedby", "reach");
    tether.className = side;
    button.onpointerdown = (event) => this.take(event, handle);
    button.onpointermove = (event) => this.drag(event, handle);
    button.onpointerup = button.onpointercancel = () => this.drop(handle);
    button.onkeydown = (event) => this.key(event, handle);
    button.onblur = () => this.drop(handle);
    return handle;
  }

  take(event, handle) {
    event.preventDefault();
    handle.button.focus({ preventScroll: true });
    handle.button.setPointerCapture(event.pointerId);
    this.hold(handle);
    handle.start = handle.target.place.clone();
    handle.from = [event.clientX, event.clientY];
    handle.dragged = true;
  }

  /** From here on both feet have a target: the dragged one moves, the other stays. */
  hold(handle) {
    if (this.held === handle) return;
    this.onGrab();
    this.chain.updateMatrices();
    this.held = this.last = handle;
    for (const each of this.handles) each.target = split(each.node.matrixWorld);
  }

  drag(event, handle) {
    if (!handle.dragged) return;
    const from = this.onPlane(handle.from, handle.start, event.shiftKey);
    const to = this.onPlane([event.clientX, event.clientY], handle.start, event.shiftKey);
    if (from && to) this.move(handle, handle.start.clone().add(to).sub(from));
  }

  drop(handle) {
    if (this.held !== handle) return;
    handle.dragged = false;
    this.held = null;
    this.show();
  }

  key(event, handle) {
    const arrow = ARROWS[event.key];
    if (event.key === "Escape") {
      this.drop(handle);
      this.onRelease();
    }
    if (!arrow || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation(); // elsewhere arrows step through the walk
    this.hold(handle);
    const [right, up] = this.axes(event.shiftKey);
    const step = right.multiplyScalar(arrow[0]).add(up.multiplyScalar(arrow[1])).multiplyScalar(NUDGE);
    this.move(handle, handle.target.place.clone().add(step));
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

  move(handle, place) {
    const hips = new MeshCat.THREE.Vector3().setFromMatrixPosition(this.chain.root.matrixWorld);
    handle.target.place = place.sub(hips).clampLength(0, FARTHEST).add(hips);
    const feet = Object.fromEntries(this.handles.map(({ link, target }) => [link, this.inRoot(target)]));
    this.onMove({ feet, q: this.chain.q });
    this.show();
  }

  inRoot({ place, turn }) {
    const { Matrix4, Vector3 } = MeshCat.THREE;
    const pose = new Matrix4().compose(place, turn, new Vector3(1, 1, 1));
    const local = split(this.chain.root.matrixWorld.clone().invert().multiply(pose));
    return [...local.place.toArray(), ...local.turn.toArray()];
  }

  /** Puts the handles where the feet are; the dragged one, where its foot shall go. */
  show(misses = null) {
    for (const handle of this.handles) {
      const foot = this.pixel(new MeshCat.THREE.Vector3().setFromMatrixPosition(handle.node.matrixWorld));
      const held = this.held === handle;
      const spot = held ? this.pixel(handle.target.place) : foot;
      handle.button.hidden = !spot;
      handle.tether.hidden = !held || !spot || !foot;
      if (!spot) continue;
      handle.button.style.transform = `translate(${spot.x}px, ${spot.y}px)`;
      handle.button.style.zIndex = String(Math.round(1e4 * (1 - spot.depth)));
      if (misses) handle.button.classList.toggle("short", held && misses[handle.link][0] + misses[handle.link][1] > 0);
      if (!handle.tether.hidden) connect(handle.tether, foot, spot);
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
