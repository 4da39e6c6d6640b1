// Makes a subject beside the page: one message in, progress and one answer out.
import init, { work } from "./rilievo.js";

const ready = init({ module_or_path: new URL("rilievo_bg.wasm", import.meta.url) });
onmessage = async ({ data }) => {
  try {
    await ready;
    const subject = work(data, (stage, share) => postMessage({ stage, share }));
    postMessage({ subject: subject.buffer }, [subject.buffer]);
  } catch (error) {
    postMessage({ error: String(error) });
  }
};
