/* Bars: what reaches from the balance support in the room to the pelvis, laid anew whenever the pelvis moves. */

class Bars {
  constructor(stage, chain, specs) {
    this.pelvis = chain.links.pelvis;
    this.bars = specs.map(({ path, start, end }) => ({ node: stage.node(path), start, end }));
  }

  set() {
    if (!this.bars.length) return;
    const { Matrix4, Vector3 } = MeshCat.THREE;
    this.pelvis.updateWorldMatrix(true, false);
    for (const { node, start, end } of this.bars) {
      const room = new Matrix4().copy(node.parent.matrixWorld).invert();
      const tip = new Vector3(...end).applyMatrix4(this.pelvis.matrixWorld).applyMatrix4(room);
      const along = tip.sub(node.position.set(...start));
      node.scale.set(1, 1, along.length());
      node.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), along.normalize());
    }
  }
}
