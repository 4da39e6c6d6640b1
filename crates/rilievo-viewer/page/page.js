// Chooses between the viewer, which needs WebGPU or WebGL2, and the plain page, which needs neither.
//
// ?webgl: not WebGPU; ?cpu: the viewer, drawn by the CPU; ?plain: the plain page.
import init, { prepare, start, Plain } from "./rilievo.js";

const wishes = new URLSearchParams(location.search);
const element = (id) => document.getElementById(id);
const message = (text) => {
  element("message").textContent = text;
  element("message").hidden = !text;
};

async function hasGpu() {
  if (!wishes.has("webgl") && (await navigator.gpu?.requestAdapter().catch(() => null))) return true;
  // The context that the viewer will have, with the attributes it will ask for: making one takes long without a real GPU.
  return !!element("viewer").getContext("webgl2", { antialias: false });
}

async function viewer() {
  const canvas = element("viewer");
  const lost = (why) => plain(`${why}: the CPU draws now. Loading the page again gives a new one.`);
  canvas.addEventListener("webglcontextlost", () => lost("The graphics context was lost"));
  addEventListener("rilievo-lost", () => lost("The graphics device was lost"));
  await start(canvas, wishes.has("cpu"), wishes.has("webgl"), new Uint8Array(await font));
  message("");
}

let running = false;

function plain(why) {
  if (running) return;
  running = true;
  element("viewer").remove();
  element("state").remove();
  element("wait").remove();
  element("plain").hidden = false;
  message(why);
  const picture = element("picture");
  const ways = element("way");
  const context = picture.getContext("2d");
  const page = new Plain();
  let working = false;
  let wanted = false;

  const make = () => {
    working = true;
    page.make();
  };

  // Whether the work is over; what went wrong is told, and what was there before stays.
  const made = () => {
    const wrong = page.take();
    element("work").hidden = wrong !== undefined;
    if (wrong === undefined) {
      element("told").value = page.stage();
      element("work").value = page.share();
      return false;
    }
    if (wrong) message(wrong);
    ways.replaceChildren(...page.ways().map((name) => new Option(name)));
    ways.value = page.chosen();
    if (ways.selectedIndex < 0) ways.selectedIndex = 0;
    page.way(ways.value);
    return true;
  };

  const frame = () => {
    requestAnimationFrame(frame);
    if (working) {
      if (!made()) return;
      working = false;
      wanted = true;
    } else if (page.refines() && page.take() !== undefined) {
      wanted = true;
    }
    if (!ways.length) return;
    const ratio = Math.min(devicePixelRatio, 1.5);
    const [width, height] = [picture.clientWidth, picture.clientHeight].map((side) => Math.max(1, Math.round(side * ratio)));
    if (!wanted && picture.width === width && picture.height === height) return;
    wanted = false;
    try {
      const bytes = page.draw(width, height);
      [picture.width, picture.height] = [width, height];
      context.putImageData(new ImageData(new Uint8ClampedArray(bytes.buffer), width, height), 0, 0);
      element("told").value = `drawn by the CPU in ${page.milliseconds().toFixed(1)} ms${page.refines() ? ", refining" : ""}`;
    } catch (error) {
      // Once, not at every frame.
      [picture.width, picture.height] = [width, height];
      message(String(error));
    }
  };

  const moved = (across, up, light) => {
    if (light) page.light(across, -up);
    else page.turn(-across, up);
    wanted = true;
  };
  picture.addEventListener("pointerdown", (event) => picture.setPointerCapture(event.pointerId));
  picture.addEventListener("contextmenu", (event) => event.preventDefault());
  picture.addEventListener("pointermove", (event) => {
    if (!event.buttons) return;
    const light = element("light").checked || event.shiftKey || (event.buttons & 2) !== 0;
    moved(event.movementX * 0.008, event.movementY * 0.008, light);
  });
  picture.addEventListener("wheel", (event) => {
    event.preventDefault();
    page.zoom(Math.exp(event.deltaY * 0.001));
    wanted = true;
  }, { passive: false });
  picture.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-0.06, 0], ArrowRight: [0.06, 0], ArrowUp: [0, -0.06], ArrowDown: [0, 0.06] }[event.key];
    if (step) moved(...step, element("light").checked || event.shiftKey);
  });
  ways.addEventListener("change", (event) => {
    page.way(event.target.value);
    wanted = true;
  });
  const open = async (file) => {
    message("");
    page.open(file.name, new Uint8Array(await file.arrayBuffer()));
    make();
  };
  element("file").addEventListener("change", (event) => event.target.files[0] && open(event.target.files[0]));
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    if (event.dataTransfer.files[0]) open(event.dataTransfer.files[0]);
  });
  make();
  frame();
}

element("message").addEventListener("click", () => message(""));

// All of these come while the module does. A GPU is asked for later: the browser may stop the page until it has one.
const module = fetch(new URL("rilievo_bg.wasm", import.meta.url));
let worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
worker.onerror = () => (worker = undefined);
const font = fetch(new URL("font.ttf", import.meta.url)).then((answer) => answer.arrayBuffer());
font.catch(() => {});

async function begin() {
  try {
    await init({ module_or_path: module });
  } catch (error) {
    // Old browsers, mostly: they do not know the instructions.
    return message(`This page needs a browser that runs WebAssembly with SIMD (${error})`);
  }
  prepare(worker);
  if (wishes.has("plain")) return plain("");
  if (!(await hasGpu())) return plain("This browser has no GPU to draw with: the CPU draws.");
  try {
    await viewer();
  } catch (error) {
    plain(`The viewer does not start (${error}): the CPU draws.`);
  }
}

begin();
