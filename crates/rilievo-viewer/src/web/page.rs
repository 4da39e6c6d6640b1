//! The viewer on a canvas.

use std::cell::RefCell;
use std::sync::Arc;

use eframe::egui_wgpu::{WgpuSetup, WgpuSetupCreateNew};
use eframe::{WebOptions, WebRunner};
use rilievo_gpu::Gpu;
use wasm_bindgen::prelude::*;
use web_sys::{HtmlCanvasElement, Worker};

use crate::app::{Font, Start, Viewer};
use crate::job::Job;
use crate::look::Look;
use crate::subject::Recipe;

thread_local! {
    /// What a page shows first, in the making.
    static FIRST: RefCell<Option<(Recipe, Job)>> = const { RefCell::new(None) };
}

/// Begins to make what is shown first: a page need not wait for a device to draw with. `worker` runs the page's script for
/// workers; without one there will be one.
#[wasm_bindgen]
pub fn prepare(worker: Option<Worker>) {
    let recipe = Recipe::default().preview();
    let job = Job::begin_unheard(worker, &recipe);
    FIRST.set(Some((recipe, job)));
}

/// What was begun already, if it is this.
pub(crate) fn prepared(recipe: &Recipe) -> Option<Job> {
    FIRST.take().filter(|(first, _)| first.is_made_as(recipe)).map(|(_, job)| job)
}

/// Starts the viewer on a canvas, with a font.
///
/// # Errors
/// If the browser gives no device to draw with: the plain page needs none.
#[wasm_bindgen]
pub async fn start(canvas: HtmlCanvasElement, by_cpu: bool, webgl: bool, font: Vec<u8>) -> Result<(), JsValue> {
    let mut options = WebOptions::default();
    if let WgpuSetup::CreateNew(WgpuSetupCreateNew { device_descriptor, instance_descriptor, .. }) =
        &mut options.wgpu_options.wgpu_setup
    {
        *device_descriptor = Arc::new(Gpu::request);
        if webgl {
            instance_descriptor.backends = eframe::wgpu::Backends::GL;
        }
    }
    let start = Start { by_cpu, recipe: Recipe::default().preview(), font: Font::new(font), ..Start::default() };
    let make: eframe::AppCreator<'static> = Box::new(move |context| Ok(Box::new(Viewer::new(context, start))));
    WebRunner::new().start(canvas, options, make).await
}

thread_local! {
    /// What the viewer shows, for the plain picture that may have to take its place.
    static SHOWN: RefCell<Option<(Recipe, Look)>> = const { RefCell::new(None) };
}

/// Keeps what is shown.
pub(crate) fn remember(recipe: &Recipe, look: &Look) {
    SHOWN.set(Some((recipe.clone(), look.clone())));
}

/// What was shown last.
pub(super) fn shown() -> Option<(Recipe, Look)> {
    SHOWN.take()
}

/// Tells the page that the graphics device is gone: its script puts the plain picture in the canvas's place.
pub(crate) fn tell_lost() {
    let Some(window) = web_sys::window() else { return };
    if let Ok(event) = web_sys::Event::new("rilievo-lost") {
        // What nobody hears is shown by the next frame's error.
        let _ = window.dispatch_event(&event);
    }
}
