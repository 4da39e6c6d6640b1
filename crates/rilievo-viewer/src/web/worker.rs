//! Subjects are made in a worker, so that the page goes on.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::{Arc, Mutex, PoisonError};

use rilievo::Progress;
use wasm_bindgen::prelude::*;
use web_sys::js_sys::{Array, Function, Object, Reflect, Uint8Array};
use web_sys::{Event, MessageEvent, Worker, WorkerOptions, WorkerType};

use super::{progress, wire};
use crate::job::{Made, Meter};
use crate::subject::{Recipe, Subject, make};

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

/// A worker at work; dropped, it stops.
pub(crate) struct Work {
    worker: Worker,
    _hear: Closure<dyn FnMut(MessageEvent)>,
    _fail: Closure<dyn FnMut(Event)>,
}

impl Drop for Work {
    fn drop(&mut self) {
        self.worker.set_onmessage(None);
        self.worker.set_onerror(None);
        self.worker.terminate();
    }
}

/// Begins to work on a recipe in a worker, or in a new one. What comes of it is put into `result`, and then `done` is called.
pub(crate) fn begin(
    worker: Option<Worker>,
    recipe: &Recipe,
    (meter, result): (Arc<Meter>, Made),
    done: Box<dyn Fn()>,
) -> Option<Work> {
    match try_begin(worker, recipe, (meter, Arc::clone(&result)), done) {
        Ok(work) => Some(work),
        Err(why) => {
            put(&result, Err(format!("the browser gives no worker: {why:?}")));
            None
        }
    }
}

fn put(result: &Made, made: Result<Subject, String>) {
    *result.lock().unwrap_or_else(PoisonError::into_inner) = Some(made);
}

fn try_begin(
    worker: Option<Worker>,
    recipe: &Recipe,
    (meter, result): (Arc<Meter>, Made),
    done: Box<dyn Fn()>,
) -> Result<Work, JsValue> {
    let new = || {
        let options = WorkerOptions::new();
        options.set_type(WorkerType::Module);
        Worker::new_with_options("./worker.js", &options)
    };
    let worker = worker.map_or_else(new, Ok)?;
    let done: Rc<dyn Fn()> = done.into();
    let (failed, done_too) = (Arc::clone(&result), Rc::clone(&done));
    let hear = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
        let data = event.data();
        let part = |name: &str| Reflect::get(&data, &name.into()).unwrap_or(JsValue::UNDEFINED);
        if let Some(stage) = part("stage").as_string() {
            meter.set(&stage, part("share").as_f64().unwrap_or(0.0) as f32);
            progress::tell(&meter);
            return;
        }
        put(
            &result,
            match part("error").as_string() {
                Some(why) => Err(why),
                None => wire::subject_from_bytes(&Uint8Array::new(&part("subject")).to_vec()),
            },
        );
        done();
    });
    // A worker that was not loaded, or that ran out of memory.
    let fail = Closure::<dyn FnMut(Event)>::new(move |event: Event| {
        let why = Reflect::get(&event, &"message".into()).ok().and_then(|m| m.as_string());
        put(&failed, Err(format!("the worker failed: {}", why.as_deref().unwrap_or("it cannot be loaded"))));
        done_too();
    });
    worker.set_onmessage(Some(hear.as_ref().unchecked_ref()));
    worker.set_onerror(Some(fail.as_ref().unchecked_ref()));
    let bytes = Uint8Array::from(wire::recipe_to_bytes(recipe).as_slice());
    let message = Object::new();
    // The module as it is here: the browser need not compile it again.
    Reflect::set(&message, &"module".into(), &wasm_bindgen::module())?;
    Reflect::set(&message, &"recipe".into(), &bytes)?;
    worker.post_message_with_transfer(&message, &Array::of1(&bytes.buffer()))?;
    Ok(Work { worker, _hear: hear, _fail: fail })
}
