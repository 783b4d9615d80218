/* Main: inflates meshcat, makes the player, and starts the transport that the page was built for. */

async function main() {
  const text = (id) => document.getElementById(id).textContent;
  const engine = document.createElement("script");
  engine.textContent = new TextDecoder().decode(await inflate(fromBase64(text("engine"))));
  document.head.append(engine);
  const player = new Player();
  const live = location.protocol.startsWith("http") && !text("bundle").trim();
  player.transport = live ? new Live(`ws://${location.host}/live${location.search}`) : new Embedded(text("bundle"));
  await player.transport.start(player);
  document.getElementById("loading").hidden = true;
  player.apply();
  player.controls.show(player);
  if (player.stage) player.stage.draw();
  player.clock.play(player.clock.playing); // time counts from the first picture on
  requestAnimationFrame((now) => player.frame(now));
  window.exo = player; // the page's own API: pictures, films and tests drive it
  window.exo.firstPicture = performance.now();
}

function fail(reason) {
  const notice = document.getElementById("notice");
  notice.textContent = `The player stopped: ${reason}`;
  notice.hidden = false;
}

addEventListener("error", (event) => fail(event.message));
addEventListener("unhandledrejection", (event) => fail(event.reason && event.reason.message));
main();
