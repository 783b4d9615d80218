/* Stage: meshcat's viewer in the page; the only file that calls it. */

const ROOT = "exo_pin"; // every node of ours hangs under it

class Stage {
  /** A stage, or null where the browser has no WebGL. */
  static open(pane) {
    try {
      const antialias = true;
      const renderer = new MeshCat.THREE.WebGLRenderer({ antialias, preserveDrawingBuffer: false });
      return new Stage(pane, renderer);
    } catch (error) {
      console.info("no WebGL:", error.message);
      return null;
    }
  }

  constructor(pane, renderer) {
    this.pane = pane;
    this.renderer = renderer;
    this.quality = chooseQuality(renderer.getContext());
    pane.append(renderer.domElement);
    renderer.domElement.setAttribute("aria-hidden", "true");
    this.viewer = new MeshCat.Viewer(pane, false, renderer);
    this.viewer.gui.domElement.remove(); // meshcat's own panel: ours replaces it
    this.viewer.set_3d_pane_size = () => this.resize(); // meshcat's own takes the window's height
    this.viewer.controls.maxDistance = 12;
    renderer.setPixelRatio(this.quality === "high" ? Math.min(devicePixelRatio, 2) : 1);
    renderer.shadowMap.enabled = this.quality === "high";
    renderer.shadowMap.type = MeshCat.THREE.PCFSoftShadowMap;
    if (this.quality === "high") this.viewer.scene.environment = studioEnvironment(renderer);
    this.viewer.scene.fog = new MeshCat.THREE.Fog(0xe8edf2, 4, 8.8);
  }

  /** Draws a bundle's commands, in order, in place of what was there. */
  load(header, commands) {
    if (this.viewer.scene_tree.children[ROOT]) this.viewer.delete_path([ROOT]);
    for (const command of commands) this.viewer.handle_command_bytearray(command);
    for (const [path, source] of header.twins) this.copy(path, source);
    const { type, ...paint } = header.paint;
    const ghostly = new MeshCat.THREE[type](paint);
    for (const [path, source] of header.painted) this.copy(path, source, ghostly);
    for (const path of header.shadowless) this.node(path).traverse((node) => (node.castShadow = false));
    if (this.quality === "low") this.simplify(header.lights);
  }

  simplify(lights) {
    plainMaterials(this.viewer.scene);
    for (const [name, intensity] of Object.entries(lights)) {
      this.viewer.set_property(["Lights", name, "<object>"], "intensity", intensity);
    }
  }

  /** Shows at a path what another node shows; geometry and, unless another is given, material are shared. */
  copy(path, source, material = null) {
    const names = (text) => text.split("/").filter((name) => name);
    const original = this.viewer.scene_tree.find([...names(source), "<object>"]).object;
    const twin = original.clone();
    if (material) Object.assign(twin, { material, userData: { ghost: true } });
    this.viewer.set_object(names(path), twin);
  }

  /** Sets the opacity of a ghost's surfaces; a nearly opaque one hides what is behind it. */
  fade(root, opacity) {
    root.traverse((node) => {
      if (node.userData.ghost) Object.assign(node.material, { opacity, depthWrite: opacity > 0.6 });
    });
    this.viewer.set_dirty();
  }

  node(path) {
    return this.viewer.scene_tree.find(path.split("/").filter((name) => name)).object;
  }

  show(path, visible) {
    const node = this.node(path);
    if (node.visible !== visible) this.viewer.set_dirty();
    node.visible = visible;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.pane;
    if (!width || !height) return;
    this.viewer.camera.aspect = width / height;
    this.viewer.camera.updateProjectionMatrix();
    this.renderer.setSize(width, height);
    this.viewer.set_dirty();
  }

  /** Renders if anything changed; true when it did. */
  draw() {
    if (!this.viewer.needs_render) return false;
    this.viewer.render();
    return true;
  }
}
