/* Toggles: what to show. A group is a title and the nodes that belong to it. */

/** A labelled check box; onChange is called with its state. */
function toggle(title, on, onChange) {
  const label = document.createElement("label");
  const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: on });
  box.onchange = () => onChange(box.checked);
  label.append(box, title);
  return label;
}

function fillToggles(holder, groups, stage) {
  const rows = groups.map(({ title, paths, shown }) => {
    const apply = (on) => paths.forEach((path) => stage.show(path, on));
    apply(shown);
    return toggle(title, shown, apply);
  });
  holder.replaceChildren(...rows);
}
