/* Toggles: what to show. A group is a title and the nodes that belong to it. */

function fillToggles(holder, groups, stage) {
  const rows = groups.map((group) => {
    const label = document.createElement("label");
    const box = document.createElement("input");
    box.type = "checkbox";
    box.checked = group.shown;
    const apply = () => {
      for (const path of group.paths) stage.show(path, box.checked);
    };
    box.onchange = apply;
    apply();
    label.append(box, document.createTextNode(group.title));
    return label;
  });
  holder.replaceChildren(...rows);
}
