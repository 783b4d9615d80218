/* Quality: studio light and shadows where a graphics card is found, plain shading where software renders. */

function isSoftware(gl) {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
  return /swiftshader|llvmpipe|software|basic render/i.test(String(name));
}

/** "low" or "high"; `#quality=high` in the address overrides the guess. */
function chooseQuality(gl) {
  const chosen = new URLSearchParams(location.hash.slice(1)).get("quality");
  return chosen === "low" || chosen === "high" ? chosen : isSoftware(gl) ? "low" : "high";
}

/** A room with lamps, so that metal has something to reflect. */
function studioEnvironment(renderer) {
  const { Scene, Mesh, BoxGeometry, MeshBasicMaterial, Color, BackSide, PMREMGenerator } = MeshCat.THREE;
  const room = new Scene();
  const lamp = (color, light, place, size) => {
    const paint = new MeshBasicMaterial({ color: new Color(color).multiplyScalar(light) });
    const mesh = new Mesh(new BoxGeometry(...size), paint);
    mesh.position.set(...place);
    room.add(mesh);
  };
  room.add(new Mesh(new BoxGeometry(20, 20, 20), new MeshBasicMaterial({ color: 0x6f7780, side: BackSide })));
  lamp(0xffffff, 1.7, [0, 9.5, 0], [8, 0.1, 8]);
  lamp(0xffffff, 1.5, [9, 3, 4], [0.1, 5, 6]);
  lamp(0xffffff, 1.1, [-9, 3, -4], [0.1, 5, 6]);
  lamp(0x404850, 1, [0, -9.8, 0], [20, 0.1, 20]);
  const generator = new PMREMGenerator(renderer);
  const texture = generator.fromScene(room, 0.03).texture;
  generator.dispose();
  return texture;
}

/** Replaces every costly material by its plain counterpart, one per original. */
function plainMaterials(scene) {
  const { MeshLambertMaterial } = MeshCat.THREE;
  const plain = new Map();
  scene.traverse((node) => {
    const old = node.material;
    if (!old || !old.isMeshStandardMaterial) return;
    if (!plain.has(old)) {
      const { color, emissive, opacity, transparent, side, depthWrite, depthFunc } = old;
      const properties = { color, emissive, opacity, transparent, side, depthWrite, depthFunc };
      plain.set(old, new MeshLambertMaterial(properties));
      old.dispose();
    }
    node.material = plain.get(old);
  });
}
