/* Take: the numbers and drawings of the plots, for people to take away: copied, as CSV, PNG or SVG. */

/** A table of what a tab shows within the window of its plots: {heads, rows}. */
function tableOf({ motion, group, window: shown }) {
  const { data, width } = motion.arrays[group.values];
  const series = group.plots.flatMap((plot) => plot.series.map((one) => ({ plot, ...one })));
  const name = ({ plot, side }) => `${side === "middle" ? "" : `${side}_`}${plot.title}`.toLowerCase().replaceAll(" ", "_");
  const heads = ["time_s", ...series.map((one) => `${name(one)} [${one.plot.unit}]`)];
  const rows = [];
  motion.time.forEach((t, i) => {
    if (t < shown.start || t > shown.end) return;
    const numbers = series.map(({ plot, column }) => data[i * width + column] * plot.factor);
    rows.push([Number(t.toFixed(5)), ...numbers.map((x) => (Number.isNaN(x) ? "" : Number(x.toPrecision(6))))]);
  });
  return { heads, rows };
}

function tableText({ heads, rows }, separator) {
  return [heads, ...rows].map((row) => row.join(separator)).join("\n") + "\n";
}

/** All plots of a tab below each other on one canvas. */
function plotsCanvas({ plots }) {
  const canvas = document.createElement("canvas");
  canvas.width = Math.max(...plots.map((plot) => plot.canvas.width));
  canvas.height = plots.reduce((sum, plot) => sum + plot.canvas.height, 0);
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  let at = 0;
  for (const plot of plots) {
    pen.drawImage(plot.canvas, 0, at);
    at += plot.canvas.height;
  }
  return canvas;
}

/** All plots of a tab as SVG: the same painting, by a pen that writes paths. */
function plotsSvg({ plots }) {
  let at = 0;
  const parts = plots.map((plot) => {
    const pen = new SvgPen();
    pen.font = 11 * plot.unit + FONT;
    new Backdrop(plot, plot.colors).paint(pen);
    const part = `<g transform="translate(0 ${at})">${pen.text}</g>`;
    at += plot.height;
    return part;
  });
  const width = Math.max(...plots.map((plot) => plot.width));
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${at}" viewBox="0 0 ${width} ${at}">` +
    `<rect width="100%" height="100%" fill="#fff"/>${parts.join("")}</svg>`;
}

function wireTaking(player) {
  const { plots, part } = player;
  const name = (ending) => fileName(`${player.header.title} ${plots.group.title}`, ending);
  part("csv").onclick = () => save(new Blob([tableText(tableOf(plots), ",")], { type: "text/csv" }), name("csv"));
  part("plots-png").onclick = () => plotsCanvas(plots).toBlob((blob) => save(blob, name("png")), "image/png");
  part("plots-svg").onclick = () => save(new Blob([plotsSvg(plots)], { type: "image/svg+xml" }), name("svg"));
  part("copy").onclick = async () => {
    const copied = await copyText(tableText(tableOf(plots), "\t"));
    part("copy").textContent = copied ? "Copied" : "Cannot copy here: use CSV";
    setTimeout(() => (part("copy").textContent = "Copy data"), 2000);
  };
}

/** Copies a text; a page opened as a file may have no clipboard of its own. */
async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = Object.assign(document.createElement("textarea"), { value: text });
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  }
}
