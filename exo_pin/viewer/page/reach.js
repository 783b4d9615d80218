/* Reach: inverse kinematics in the page, for a page without Python behind it. Damped least squares within the
   joint limits on the scene's own nodes; requests and answers are those of exo_pin/viewer/live/messages.py. */

const ROTATION_WEIGHT = 0.1; // [m/rad] a rotation error of 1 rad moves the sole's points about so far
const TOLERANCE = 1e-6; // a foot this near to its target [m, rad] has reached it
const MAX_ITERATIONS = 60;
const SMALLEST_STEP = 1e-9; // the iteration ends at a smaller step [rad, m]

class Reach {
  constructor(chain) {
    this.chain = chain;
    this.free = chain.joints.map((joint, k) => ({ ...joint, k })).filter(({ limits }) => limits);
  }

  /** {feet: {link: pose in the root}, q} -> {q, misses: {link: [distance, angle]}}; leaves the chain at q. */
  answer({ feet, q }) {
    const { base } = this.chain;
    this.chain.updateMatrices();
    const targets = Object.entries(feet).map(([link, pose]) => ({ link, ...this.target(pose) }));
    const at = (angles) => {
      this.chain.set(angles, base);
      this.chain.updateMatrices();
      return this.state(targets);
    };
    let best = q.map((angle, k) => clamp(angle, this.chain.joints[k].limits));
    let now = at(best);
    for (let step = 0, factor = 1; step < MAX_ITERATIONS && now.cost > TOLERANCE ** 2 / 4; step++) {
      const x = this.step(best, now, factor * now.cost + 1e-13);
      if (Math.max(...x.map(Math.abs)) < SMALLEST_STEP) break;
      const trial = best.map((angle, k) => clamp(angle + x[k], this.chain.joints[k].limits));
      const next = at(trial);
      factor *= next.cost < now.cost ? 0.25 : 4;
      if (next.cost < now.cost) [best, now] = [trial, next];
    }
    now = at(best);
    const rounded = (miss) => (miss.every((error) => error <= TOLERANCE) ? [0, 0] : miss);
    return { q: best, misses: Object.fromEntries(now.misses.map((miss, f) => [targets[f].link, rounded(miss)])) };
  }

  target([x, y, z, ...turn]) {
    const { Matrix4, Quaternion, Vector3 } = MeshCat.THREE;
    const pose = new Matrix4().compose(new Vector3(x, y, z), new Quaternion(...turn), new Vector3(1, 1, 1));
    return split(this.chain.root.matrixWorld.clone().multiply(pose));
  }

  /** Errors e, rows of their Jacobian J by joint, their sum of squares, and the misses of each foot. */
  state(targets) {
    const { Vector3 } = MeshCat.THREE;
    const state = { e: [], J: this.free.map(() => []), misses: [] };
    for (const { link, place, turn } of targets) {
      const foot = this.chain.links[link];
      const here = split(foot.matrixWorld);
      const rotation = turned(here.turn, turn);
      const apart = place.clone().sub(here.place);
      state.e.push(...apart.toArray(), ...rotation.toArray().map((part) => ROTATION_WEIGHT * part));
      state.misses.push([apart.length(), rotation.length()]);
      this.free.forEach(({ node, kind, k, path }, row) => {
        const axis = this.chain.axes[k].clone().transformDirection(node.matrixWorld);
        const arm = here.place.clone().sub(new Vector3().setFromMatrixPosition(node.matrixWorld));
        const prismatic = kind === "prismatic";
        const moves = this.chain.spec.links[link].startsWith(`${path}/`) || this.chain.spec.links[link] === path;
        const along = prismatic ? axis : new Vector3().crossVectors(axis, arm);
        const about = axis.clone().multiplyScalar(prismatic ? 0 : ROTATION_WEIGHT);
        state.J[row].push(...[along, about].flatMap((part) => part.multiplyScalar(moves ? 1 : 0).toArray()));
      });
    }
    state.cost = dot(state.e, state.e);
    return state;
  }

  /** The damped step; joints that it would push beyond their limits are fixed, and the others solved again. */
  step(q, { e, J }, damping) {
    const descent = J.map((row) => dot(row, e));
    const inside = ({ k, limits: [low, high] }, x) => (q[k] > low || x > 0) && (q[k] < high || x < 0);
    let rows = this.free.map((_, row) => row).filter((row) => inside(this.free[row], descent[row]));
    for (;;) {
      const x = solveLinear(
        rows.map((i) => rows.map((j) => dot(J[i], J[j]) + (i === j ? damping : 0))),
        rows.map((i) => descent[i]),
      );
      const kept = rows.filter((row, n) => inside(this.free[row], x[n]));
      if (kept.length === rows.length) {
        const out = q.map(() => 0);
        rows.forEach((row, n) => (out[this.free[row].k] = x[n]));
        return out;
      }
      rows = kept;
    }
  }
}

const dot = (a, b) => a.reduce((sum, value, k) => sum + value * b[k], 0);
const clamp = (value, limits) => (limits ? Math.min(Math.max(value, limits[0]), limits[1]) : value);

function split(matrix) {
  const [place, turn, size] = [new MeshCat.THREE.Vector3(), new MeshCat.THREE.Quaternion(), new MeshCat.THREE.Vector3()];
  matrix.decompose(place, turn, size);
  return { place, turn };
}

/** The rotation vector that leads from one orientation to another, in world axes. */
function turned(from, to) {
  const { x, y, z, w } = to.clone().multiply(from.clone().invert());
  const sine = Math.hypot(x, y, z);
  const angle = 2 * Math.atan2(sine, Math.abs(w)) * (w < 0 ? -1 : 1);
  return new MeshCat.THREE.Vector3(x, y, z).multiplyScalar(sine > 1e-12 ? angle / sine : 2);
}

/** x of A x = b, by elimination; A is positive definite. */
function solveLinear(A, b) {
  const rows = A.map((row, i) => [...row, b[i]]);
  const n = rows.length;
  for (let i = 0; i < n; i++) {
    for (let r = i + 1; r < n; r++) {
      const share = rows[r][i] / rows[i][i];
      for (let c = i; c <= n; c++) rows[r][c] -= share * rows[i][c];
    }
  }
  const x = new Array(n).fill(0);
  for (let i = n - 1; i >= 0; i--) x[i] = (rows[i][n] - dot(rows[i].slice(i + 1, n), x.slice(i + 1))) / rows[i][i];
  return x;
}
