//! The window of a desktop.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use eframe::egui::ViewportBuilder;
use eframe::egui_wgpu::{WgpuSetup, WgpuSetupCreateNew};
use rilievo_gpu::Gpu;
use rilievo_io::{Limits, Source};

use crate::app::{Start, Viewer};
use crate::subject::File;

impl File {
    /// Reads a file.
    ///
    /// # Errors
    /// As [`Source::open`].
    pub fn read(path: &Path) -> rilievo_io::Result<Self> {
        let source = Source::open(path, &Limits::default())?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { name, bytes: source.bytes().into() })
    }
}

/// Opens the window, and returns when it is closed.
///
/// If the graphics device is lost, a new window takes its place, whose pictures the CPU draws.
///
/// # Errors
/// If the system has no display, or nothing that a window can be drawn with.
pub fn run(start: Start) -> Result<(), String> {
    let lost = Arc::clone(&start.lost);
    let mut again = start.clone();
    open(start)?;
    if lost.swap(false, Ordering::Relaxed) {
        again.by_cpu = true;
        again.notes.push("The graphics device was lost: this is a new window, and the CPU draws.".to_owned());
        open(again)?;
    }
    Ok(())
}

fn open(start: Start) -> Result<(), String> {
    let mut options = eframe::NativeOptions {
        viewport: ViewportBuilder::default().with_inner_size([1200.0, 800.0]).with_min_inner_size([320.0, 360.0]),
        ..eframe::NativeOptions::default()
    };
    if let WgpuSetup::CreateNew(WgpuSetupCreateNew { device_descriptor, .. }) = &mut options.wgpu_options.wgpu_setup {
        *device_descriptor = Arc::new(Gpu::request);
    }
    let make: eframe::AppCreator<'_> = Box::new(move |context| Ok(Box::new(Viewer::new(context, start))));
    eframe::run_native("rilievo", options, make).map_err(|error| error.to_string())
}
