/* Record: the picture as PNG, the running view as WebM. Both are made and saved by the browser itself. */

function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** A file name from the page's title. */
function fileName(title, ending) {
  const plain = title.replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-+|-+$/g, "");
  return `${plain.slice(0, 60) || "walk"}.${ending}`;
}

function savePicture(stage, title) {
  stage.viewer.render(); // WebGL forgets a picture once it is shown
  stage.renderer.domElement.toBlob((blob) => save(blob, fileName(title, "png")), "image/png");
}

class Recorder {
  constructor(stage, onChange) {
    this.stage = stage;
    this.onChange = onChange;
    this.machine = null;
  }

  static get possible() {
    return Boolean(window.MediaRecorder) && MediaRecorder.isTypeSupported("video/webm");
  }

  get running() {
    return this.machine !== null;
  }

  start(title) {
    const parts = [];
    const stream = this.stage.renderer.domElement.captureStream(30);
    const machine = new MediaRecorder(stream, { mimeType: "video/webm", videoBitsPerSecond: 8_000_000 });
    machine.ondataavailable = (event) => parts.push(event.data);
    machine.onstop = () => {
      for (const track of stream.getTracks()) track.stop();
      this.machine = null;
      this.last = new Blob(parts, { type: "video/webm" });
      save(this.last, fileName(title, "webm"));
      this.onChange(false);
    };
    machine.start();
    this.machine = machine;
    this.onChange(true);
  }

  stop() {
    if (this.machine) this.machine.stop();
  }
}
