/* SvgPen: what a canvas' pen does, written as SVG: as much of it as the plots' painting uses. */

class SvgPen {
  constructor() {
    this.text = "";
    this.path = "";
    this.depth = []; // groups that each `save` has open
    Object.assign(this, { fillStyle: "#000", strokeStyle: "#000", lineWidth: 1, globalAlpha: 1, textAlign: "left" });
    this.font = "";
    this.dash = [];
  }

  save() {
    this.depth.push(0);
  }

  restore() {
    this.text += "</g>".repeat(this.depth.pop());
  }

  clip() {
    const id = `clip${SvgPen.count++}`;
    this.text += `<clipPath id="${id}"><path d="${this.path}"/></clipPath><g clip-path="url(#${id})">`;
    this.depth[this.depth.length - 1] += 1;
  }

  beginPath() {
    this.path = "";
  }

  moveTo(x, y) {
    this.path += `M${short(x)} ${short(y)}`;
  }

  lineTo(x, y) {
    this.path += `${this.path ? "L" : "M"}${short(x)} ${short(y)}`;
  }

  rect(x, y, width, height) {
    this.path += rectangle(x, y, width, height);
  }

  stroke() {
    const dash = this.dash.length ? ` stroke-dasharray="${this.dash.join(" ")}"` : "";
    this.text += `<path d="${this.path}" fill="none" stroke="${this.strokeStyle}" stroke-width="${this.lineWidth}"` +
      ` opacity="${this.globalAlpha}"${dash}/>`;
  }

  fill() {
    this.text += `<path d="${this.path}z" fill="${this.fillStyle}" opacity="${this.globalAlpha}"/>`;
  }

  fillRect(x, y, width, height) {
    this.text += `<path d="${rectangle(x, y, width, height)}" fill="${this.fillStyle}" opacity="${this.globalAlpha}"/>`;
  }

  setLineDash(dash) {
    this.dash = dash;
  }

  measureText(text) {
    return { width: 0.55 * parseFloat(this.font) * text.length };
  }

  fillText(text, x, y) {
    const anchor = { left: "start", right: "end", center: "middle" }[this.textAlign];
    const plain = text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
    this.text += `<text x="${short(x)}" y="${short(y)}" font-size="${parseFloat(this.font)}" text-anchor="${anchor}"` +
      ` font-family="system-ui, sans-serif" fill="${this.fillStyle}">${plain}</text>`;
  }
}

SvgPen.count = 0;

function rectangle(x, y, width, height) {
  return `M${short(x)} ${short(y)}h${short(width)}v${short(height)}h${short(-width)}z`;
}

function short(value) {
  return Number(value.toFixed(2));
}
