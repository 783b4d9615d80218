/* Cameras: named clinical views that frame the whole scene at any aspect ratio. World is z up, x forward. */

const FIELD_OF_VIEW = 34; // vertical [deg]
const MARGIN_AROUND = 1.06;

const CAMERAS = {
  iso: { label: "Iso", from: [0.8, -0.8, 0.42] },
  left: { label: "Left", from: [0, 1, 0.06] },
  right: { label: "Right", from: [0, -1, 0.06] },
  front: { label: "Front", from: [1, 0, 0.08] },
  back: { label: "Back", from: [-1, 0, 0.12] },
  top: { label: "Top", from: [-0.001, 0, 1] },
  feet: { label: "Feet", from: [0.75, -0.85, 0.3], part: "feet" },
};

/** Least distance from which the whole box lies in the picture: every corner bounds it. */
function fitDistance({ size }, [right, up, back], aspect) {
  const tan = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  let distance = 0;
  for (const signs of [0, 1, 2, 3, 4, 5, 6, 7]) {
    const corner = size.map((length, k) => ((signs >> k) & 1 ? 0.5 : -0.5) * length);
    const wide = Math.abs(dot(corner, right)) / (tan * aspect);
    const high = Math.abs(dot(corner, up)) / tan;
    distance = Math.max(distance, Math.max(wide, high) * MARGIN_AROUND + dot(corner, back));
  }
  return distance;
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

/** Frames a box; [x, y] is how far the walk has gone from where the boxes were taken. */
function aim(viewer, name, boxes, [along, aside]) {
  const view = CAMERAS[name];
  const { size, center: start } = boxes[view.part || "whole"];
  const box = { size, center: [start[0] + along, start[1] + aside, start[2]] };
  const axes = cameraAxes(view.from);
  const distance = fitDistance(box, axes, viewer.camera.aspect);
  const eye = axes[2].map((v, k) => box.center[k] + v * distance);
  const [x, y, z] = box.center;
  viewer.camera.fov = FIELD_OF_VIEW;
  viewer.camera.near = 0.05;
  viewer.camera.position.set(eye[0], eye[2], -eye[1]); // meshcat's camera lives in a y-up frame
  viewer.controls.target.set(x, z, -y);
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
