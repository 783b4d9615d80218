/* Chain: forward kinematics by the scene itself. Every link is a node inside its parent's node,
   so rotating the joint nodes suffices. */

class Chain {
  constructor(tree, spec) {
    const find = (path) => tree.find(path.split("/").filter((name) => name)).object;
    this.spec = spec;
    this.root = find(spec.root);
    this.links = Object.fromEntries(Object.entries(spec.links).map(([name, path]) => [name, find(path)]));
    this.joints = spec.joints.map((joint) => ({ ...joint, node: find(joint.path) }));
    this.axes = spec.joints.map((joint) => new MeshCat.THREE.Vector3(...joint.axis));
    this.q = spec.joints.map(() => 0);
    this.base = null;
  }

  /** q in the order of spec.joints [rad, m]; base {position, turn}. */
  set(q, base) {
    Object.assign(this, { q, base });
    this.root.position.set(...base.position);
    this.root.quaternion.copy(base.turn);
    this.joints.forEach((joint, k) => {
      if (joint.kind === "prismatic") joint.node.position.copy(this.axes[k]).multiplyScalar(q[k]);
      else joint.node.quaternion.setFromAxisAngle(this.axes[k], q[k]);
    });
  }

  /** Updates the nodes' world matrices, which else happens at the next picture. */
  updateMatrices() {
    this.root.updateWorldMatrix(true, true);
  }

  /** Poses of all links in the scene's own world (z up): {name: 16 numbers, column by column}. */
  matrices() {
    const scene = this.root.parent;
    scene.updateWorldMatrix(true, true);
    const inverse = scene.matrixWorld.clone().invert();
    const pose = (node) => inverse.clone().multiply(node.matrixWorld).toArray();
    return Object.fromEntries(Object.entries(this.links).map(([name, node]) => [name, pose(node)]));
  }
}
