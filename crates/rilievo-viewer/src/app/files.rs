//! Files that come in and go out.

use std::sync::{Arc, Mutex, PoisonError};

#[cfg(not(target_arch = "wasm32"))]
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

impl Viewer {
    /// The index map as a file, and the file's name.
    fn encoded_map(&self) -> Option<(Result<Vec<u8>, String>, &'static str)> {
        let map = self.subject.as_ref().and_then(|s| s.indexed.as_ref())?;
        let convention = self.recipe.convention;
        let (written, name) = if map.table().len() <= 256 {
            (rilievo_io::encode_indexed_png(map, convention), "map.png")
        } else {
            (rilievo_io::encode_ktx2(map, convention), "map.ktx2")
        };
        Some((written.map_err(|e| e.to_string()), name))
    }
}

/// What can be opened.
const OPEN_HINT: &str =
    "A height map, a normal map, an indexed PNG or KTX2, or a mesh: OBJ, PLY, GLB. Or drop it here.";

#[cfg(not(target_arch = "wasm32"))]
impl Viewer {
    pub(super) fn file_buttons(&mut self, ui: &mut Ui) {
        if ui.button("Open…").on_hover_text(OPEN_HINT).clicked()
            && let Some(path) = rfd::FileDialog::new().set_title("Open a map or a mesh").pick_file()
        {
            self.inbox.put(File::read(&path).map_err(|e| e.to_string()));
        }
        if ui.button("Save picture…").clicked() {
            self.save_picture();
        }
        let has_map = self.subject.as_ref().is_some_and(|s| s.indexed.is_some());
        let button = ui.add_enabled(has_map, egui::Button::new("Save map…"));
        if button.on_hover_text("PNG up to 256 entries, KTX2.").clicked()
            && let Some((bytes, name)) = self.encoded_map()
        {
            self.save(bytes, name);
        }
    }

    fn save_picture(&mut self) {
        let Some(picture) = pollster::block_on(self.panes[0].picture(self.engine)) else { return };
        let written = rilievo_io::encode_picture_png(&picture).map_err(|e| e.to_string());
        self.save(written, "picture.png");
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

#[cfg(target_arch = "wasm32")]
mod in_browser {
    //! A page has a file input for a dialog, and a link to save by.

    use eframe::egui::{self, Ui};
    use rilievo_io::encode_picture_png;
    use wasm_bindgen::prelude::*;
    use wasm_bindgen_futures::{JsFuture, spawn_local};
    use web_sys::js_sys::{Array, Uint8Array};
    use web_sys::{Blob, HtmlAnchorElement, HtmlInputElement, Url};

    use super::{Inbox, OPEN_HINT};
    use crate::app::{Viewer, wake};
    use crate::subject::File;

    impl Inbox {
        /// Takes what was dropped on the page, when the browser has read it.
        pub(in crate::app) fn collect(&self, context: &egui::Context) {
            for dropped in context.input(|i| i.raw.dropped_files.clone()) {
                let (inbox, context) = (self.clone(), context.clone());
                spawn_local(async move {
                    let name = dropped.path().to_string_lossy().into_owned();
                    let read = dropped.bytes_async().await.map_err(|why| format!("{name}: {why}"));
                    inbox.put(read.map(|bytes| File { name, bytes: bytes.into() }));
                    wake(&context);
                });
            }
        }
    }

    impl Viewer {
        pub(in crate::app) fn file_buttons(&mut self, ui: &mut Ui) {
            if ui.button("Open…").on_hover_text(OPEN_HINT).clicked()
                && let Err(why) = choose(&self.inbox, ui.ctx())
            {
                self.notes.push(format!("the browser opens no dialog: {why:?}"));
            }
            if ui.button("Save picture…").clicked() {
                let (target, picture) = self.panes[0].parts(self.engine);
                spawn_local(async move {
                    let picture = match target {
                        Some(target) => target.read().await.ok(),
                        None => picture,
                    };
                    if let Some(bytes) = picture.and_then(|p| encode_picture_png(&p).ok()) {
                        // A browser that does not save has told its user why.
                        let _ = save(&bytes, "picture.png");
                    }
                });
            }
            let has_map = self.subject.as_ref().is_some_and(|s| s.indexed.is_some());
            if ui.add_enabled(has_map, egui::Button::new("Save map…")).clicked()
                && let Some((bytes, name)) = self.encoded_map()
            {
                match bytes {
                    Ok(bytes) => {
                        let _ = save(&bytes, name);
                    }
                    Err(why) => self.notes.push(why),
                }
            }
        }
    }

    /// Opens the browser's dialog.
    fn choose(inbox: &Inbox, context: &egui::Context) -> Result<(), JsValue> {
        let document = web_sys::window().and_then(|w| w.document()).ok_or("no document")?;
        let input: HtmlInputElement = document.create_element("input")?.dyn_into()?;
        input.set_type("file");
        let (inbox, context, chosen) = (inbox.clone(), context.clone(), input.clone());
        let change = Closure::once_into_js(move || {
            let Some(file) = chosen.files().and_then(|files| files.get(0)) else { return };
            spawn_local(async move {
                let name = file.name();
                let read = JsFuture::from(file.array_buffer()).await;
                let read = read.map(|buffer| Uint8Array::new(&buffer).to_vec());
                let read = read.map_err(|why| format!("{name}: {why:?}"));
                inbox.put(read.map(|bytes| File { name, bytes: bytes.into() }));
                wake(&context);
            });
        });
        input.set_onchange(Some(change.unchecked_ref()));
        input.click();
        Ok(())
    }

    /// Lets the browser save some bytes.
    fn save(bytes: &[u8], name: &str) -> Result<(), JsValue> {
        let document = web_sys::window().and_then(|w| w.document()).ok_or("no document")?;
        let blob = Blob::new_with_u8_array_sequence(&Array::of1(&Uint8Array::from(bytes)))?;
        let address = Url::create_object_url_with_blob(&blob)?;
        let link: HtmlAnchorElement = document.create_element("a")?.dyn_into()?;
        link.set_href(&address);
        link.set_download(name);
        link.click();
        Url::revoke_object_url(&address)
    }
}
