/* Cameras: named clinical views that frame the whole scene at any aspect ratio. World is z up, x forward. */

const FIELD_OF_VIEW = 34; // vertical [deg]
const MARGIN_AROUND = 1.06;

const CAMERAS = {
  iso: { label: "Iso", from: [0.8, -0.8, 0.42], parts: ["whole", "treadmill", "stand"] },
  left: { label: "Left", from: [0, 1, 0.06] },
  right: { label: "Right", from: [0, -1, 0.06] },
  front: { label: "Front", from: [1, 0, 0.08] },
  back: { label: "Back", from: [-1, 0, 0.12] },
  top: { label: "Top", from: [-0.001, 0, 1] },
  feet: { label: "Feet", from: [0.75, -0.85, 0.3], parts: ["feet"] },
};

/** Least distance from a target from which all boxes lie in the picture: every corner bounds it. */
function fitDistance(boxes, target, [right, up, back], aspect) {
  const tan = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
  const along = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  let distance = 0;
  for (const { center, size } of boxes) {
    for (const signs of [0, 1, 2, 3, 4, 5, 6, 7]) {
      const corner = size.map((length, k) => center[k] - target[k] + ((signs >> k) & 1 ? 0.5 : -0.5) * length);
      const wide = Math.abs(along(corner, right)) / (tan * aspect);
      const high = Math.abs(along(corner, up)) / tan;
      distance = Math.max(distance, Math.max(wide, high) * MARGIN_AROUND + along(corner, back));
    }
  }
  return distance;
}

/** The middle of all boxes. */
function middleOf(boxes) {
  return [0, 1, 2].map((k) => {
    const low = Math.min(...boxes.map(({ center, size }) => center[k] - size[k] / 2));
    const high = Math.max(...boxes.map(({ center, size }) => center[k] + size[k] / 2));
    return (low + high) / 2;
  });
}

/** Right, up and back of a camera that looks from a direction, z up. */
function cameraAxes(from) {
  const long = Math.hypot(...from);
  const back = from.map((v) => v / long);
  const flat = Math.hypot(back[0], back[1]);
  const right = [-back[1] / flat, back[0] / flat, 0];
  const up = [-back[2] * right[1], back[2] * right[0], back[0] * right[1] - back[1] * right[0]];
  return [right, up, back];
}

/** Frames what a view shows; [x, y] is how far the walk has gone from where the boxes were taken. */
function aim(viewer, name, boxes, [x, y]) {
  const view = CAMERAS[name];
  const shown = (view.parts || ["whole"]).filter((part) => boxes[part]).map((part) => boxes[part]);
  const axes = cameraAxes(view.from);
  const middle = middleOf(shown);
  const distance = fitDistance(shown, middle, axes, viewer.camera.aspect);
  const target = [middle[0] + x, middle[1] + y, middle[2]];
  const eye = axes[2].map((v, k) => target[k] + v * distance);
  viewer.camera.fov = FIELD_OF_VIEW;
  viewer.camera.near = 0.05;
  Object.assign(viewer.scene.fog, { near: Math.max(4, distance), far: Math.max(4, distance) + 4.8 });
  viewer.camera.position.set(eye[0], eye[2], -eye[1]); // meshcat's camera lives in a y-up frame
  viewer.controls.target.set(target[0], target[2], -target[1]);
  viewer.controls.update();
  viewer.set_dirty();
}

/** Moves camera and target along with the walk [m]. */
function follow(viewer, x, y) {
  for (const point of [viewer.camera.position, viewer.controls.target]) {
    point.x += x;
    point.z -= y;
  }
}
