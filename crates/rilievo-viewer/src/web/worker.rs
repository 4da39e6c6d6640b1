//! Subjects are made in a worker, so that the page goes on.

use std::cell::RefCell;
use std::sync::{Arc, Mutex, PoisonError};

use rilievo::Progress;
use wasm_bindgen::prelude::*;
use web_sys::js_sys::{Array, Function, Reflect, Uint8Array};
use web_sys::{MessageEvent, Worker, WorkerOptions, WorkerType};

use super::wire;
use crate::job::{Made, Meter};
use crate::subject::{Recipe, make};

/// Makes what a message asks for, in the worker; `tell` hears of each stage and its share.
///
/// # Errors
/// A sentence for the user.
#[wasm_bindgen]
pub fn work(message: &[u8], tell: &Function) -> Result<Vec<u8>, JsValue> {
    let recipe = wire::recipe_from_bytes(message)?;
    HEARER.set(Some(tell.clone()));
    let subject = make(&recipe, &Teller::default())?;
    Ok(wire::subject_to_bytes(&subject))
}

thread_local! {
    /// Who hears of the work of this worker. Progress may come from any thread, and scripts are of one: there is one.
    static HEARER: RefCell<Option<Function>> = const { RefCell::new(None) };
}

/// Progress as messages.
#[derive(Default)]
struct Teller {
    meter: Meter,
    last: Mutex<f32>,
}

impl Teller {
    fn say(&self, always: bool) {
        let (stage, share) = self.meter.read();
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        // A message for each hundredth is enough.
        if always || share - *last >= 0.01 {
            *last = share;
            HEARER.with_borrow(|hearer| {
                if let Some(hearer) = hearer {
                    // That nobody could be told is no reason to stop working.
                    let _ = hearer.call2(&JsValue::NULL, &stage.into(), &share.into());
                }
            });
        }
    }
}

impl Progress for Teller {
    fn begin(&self, stage: &str, total: u64) {
        self.meter.begin(stage, total);
        self.say(true);
    }

    fn advance(&self, steps: u64) {
        self.meter.advance(steps);
        self.say(false);
    }
}

/// Begins a worker with a recipe.
pub(crate) fn begin(recipe: &Recipe, meter: Arc<Meter>, result: Made, done: Box<dyn FnOnce()>) {
    if let Err(why) = try_begin(recipe, meter, Arc::clone(&result), done) {
        let why = format!("the browser gives no worker: {why:?}");
        *result.lock().unwrap_or_else(PoisonError::into_inner) = Some(Err(why));
    }
}

fn try_begin(recipe: &Recipe, meter: Arc<Meter>, result: Made, done: Box<dyn FnOnce()>) -> Result<(), JsValue> {
    let options = WorkerOptions::new();
    options.set_type(WorkerType::Module);
    let worker = Worker::new_with_options("./worker.js", &options)?;
    let message = Uint8Array::from(wire::recipe_to_bytes(recipe).as_slice());
    let (worker_again, mut done) = (worker.clone(), Some(done));
    let hear = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
        let data = event.data();
        let part = |name: &str| Reflect::get(&data, &name.into()).unwrap_or(JsValue::UNDEFINED);
        if let Some(stage) = part("stage").as_string() {
            meter.set(&stage, part("share").as_f64().unwrap_or(0.0) as f32);
            return;
        }
        let made = match part("error").as_string() {
            Some(why) => Err(why),
            None => wire::subject_from_bytes(&Uint8Array::new(&part("subject")).to_vec()),
        };
        *result.lock().unwrap_or_else(PoisonError::into_inner) = Some(made);
        worker_again.terminate();
        if let Some(done) = done.take() {
            done();
        }
    });
    worker.set_onmessage(Some(hear.as_ref().unchecked_ref()));
    // It lives as long as its worker, which ends with its one answer.
    hear.forget();
    worker.post_message_with_transfer(&message, &Array::of1(&message.buffer()))
}
