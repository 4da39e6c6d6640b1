// Makes a subject beside the page: a compiled module and a recipe in, progress and one answer out.
import init, { work } from "./rilievo.js";

onmessage = async ({ data: { module, recipe } }) => {
  try {
    await init({ module_or_path: module });
    const subject = work(recipe, (stage, share) => postMessage({ stage, share }));
    postMessage({ subject: subject.buffer }, [subject.buffer]);
  } catch (error) {
    postMessage({ error: String(error) });
  }
};
