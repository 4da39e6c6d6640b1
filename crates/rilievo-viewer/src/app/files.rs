//! Files that come in and go out.

use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui::{self, Ui};

use super::Viewer;
use crate::subject::File;

/// Files on their way in: dropped, or chosen in a dialog.
#[derive(Default, Clone)]
pub(super) struct Inbox(Arc<Mutex<Vec<Result<File, String>>>>);

impl Inbox {
    fn put(&self, file: Result<File, String>) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(file);
    }

    /// What has arrived.
    pub(super) fn take(&self) -> Vec<Result<File, String>> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Takes what was dropped on the window.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn collect(&self, context: &egui::Context) {
        for dropped in context.input(|i| i.raw.dropped_files.clone()) {
            let name = dropped.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
            let read = dropped.bytes().map_err(|why| format!("{name}: {why}"));
            self.put(read.map(|bytes| File { name, bytes: bytes.into() }));
        }
    }
}

#[cfg(not(target_arch = "wasm32"))]
impl Viewer {
    pub(super) fn file_buttons(&mut self, ui: &mut Ui) {
        let hint = "A height map, a normal map, an indexed PNG or KTX2, or a mesh: OBJ, PLY, GLB. Or drop it here.";
        if ui.button("Open…").on_hover_text(hint).clicked()
            && let Some(path) = rfd::FileDialog::new().set_title("Open a map or a mesh").pick_file()
        {
            self.inbox.put(File::read(&path).map_err(|e| e.to_string()));
        }
        if ui.button("Save picture…").clicked() {
            self.save_picture();
        }
        let has_map = self.subject.as_ref().is_some_and(|s| s.indexed.is_some());
        if ui
            .add_enabled(has_map, egui::Button::new("Save map…"))
            .on_hover_text("PNG up to 256 entries, KTX2.")
            .clicked()
        {
            self.save_map();
        }
    }

    fn save_picture(&mut self) {
        let Some(picture) = pollster::block_on(self.panes[0].picture(self.engine)) else { return };
        let written = rilievo_io::encode_picture_png(&picture).map_err(|e| e.to_string());
        self.save(written, "picture.png");
    }

    fn save_map(&mut self) {
        let Some(map) = self.subject.as_ref().and_then(|s| s.indexed.as_ref()) else { return };
        let convention = self.recipe.convention;
        let (written, name) = if map.table().len() <= 256 {
            (rilievo_io::encode_indexed_png(map, convention), "map.png")
        } else {
            (rilievo_io::encode_ktx2(map, convention), "map.ktx2")
        };
        self.save(written.map_err(|e| e.to_string()), name);
    }

    fn save(&mut self, bytes: Result<Vec<u8>, String>, name: &str) {
        let written = bytes.and_then(|bytes| {
            let Some(path) = rfd::FileDialog::new().set_file_name(name).save_file() else { return Ok(None) };
            rilievo_io::write_atomic(&path, &bytes).map_err(|e| e.to_string())?;
            Ok(Some(path))
        });
        match written {
            Ok(Some(path)) => self.notes.push(format!("Written: {}", path.display())),
            Ok(None) => {}
            Err(why) => self.notes.push(why),
        }
    }
}
