//! What the picture depends on, to be chosen.

use eframe::egui::{self, Slider, Ui};
use rilievo::Convention;
use rilievo::quantize::Effort;
use rilievo::raster::TextureFilter;

use super::{Drag, Engine, Viewer};
use crate::look::{Finish, Lamp, Model, Orbit, Way};
use crate::subject::{Sample, Surface};

/// Sizes of tables that are offered.
const ENTRIES: [u32; 8] = [16, 64, 256, 1024, 2048, 4096, 16_384, 65_536];

impl Viewer {
    pub(super) fn panel(&mut self, ui: &mut Ui) {
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.add_space(6.0);
            self.subject_part(ui);
            ui.separator();
            self.way_part(ui);
            ui.separator();
            self.light_part(ui);
            ui.separator();
            self.materials_part(ui);
            ui.separator();
            self.notes_part(ui);
            ui.collapsing("Keys", |ui| {
                ui.label(
                    "Drag: turn. Right drag, Shift or L: light. Wheel or pinch: zoom. 1 to 9: method. S: split. \
                     C: GPU or CPU. Space: let the light go round.",
                );
            });
            theme(ui);
            ui.add_space(6.0);
        });
    }

    fn subject_part(&mut self, ui: &mut Ui) {
        let mut again = false;
        ui.horizontal_wrapped(|ui| {
            for sample in Sample::ALL {
                let chosen = self.recipe.sample == Some(sample);
                if ui.selectable_label(chosen, sample.name()).clicked() {
                    (self.recipe.sample, self.recipe.map) = (Some(sample), None);
                    again = true;
                }
            }
        });
        ui.horizontal_wrapped(|ui| self.file_buttons(ui));
        let map = self.recipe.map.as_ref().map(|m| m.name.clone());
        let on_mesh = matches!(self.recipe.surface, Surface::Mesh(_));
        if let Some(name) = map {
            ui.label(format!("Map: {name}"));
            ui.horizontal_wrapped(|ui| {
                ui.label("on");
                for surface in [Surface::Plane, Surface::Sphere, Surface::Torus] {
                    let chosen = surface.name() == self.recipe.surface.name();
                    if ui.selectable_label(chosen, surface.name()).clicked() {
                        self.recipe.surface = surface;
                        again = true;
                    }
                }
                if on_mesh {
                    let _ = ui.selectable_label(true, self.recipe.surface.name());
                }
            });
            ui.horizontal(|ui| {
                ui.label("Depth").on_hover_text("Height of full white as a share of the map's width (height maps).");
                again |= done(&ui.add(Slider::new(&mut self.recipe.depth, 0.002..=0.3).logarithmic(true)));
            });
            let mut dx = self.recipe.convention == Convention::Dx;
            if ui.checkbox(&mut dx, "Green points down (DirectX)").on_hover_text("For normal maps.").changed() {
                self.recipe.convention = if dx { Convention::Dx } else { Convention::Gl };
                again = true;
            }
        }
        ui.horizontal(|ui| {
            ui.label("Entries").on_hover_text("Size of the table of normals.");
            egui::ComboBox::from_id_salt("entries").selected_text(self.recipe.entries.to_string()).show_ui(ui, |ui| {
                for entries in ENTRIES {
                    again |= ui.selectable_value(&mut self.recipe.entries, entries, entries.to_string()).changed();
                }
            });
            let efforts = [(Effort::Fast, "fast"), (Effort::Normal, "normal"), (Effort::Best, "best")];
            let shown = efforts.iter().find(|e| e.0 == self.recipe.effort).map_or("", |e| e.1);
            egui::ComboBox::from_id_salt("effort").selected_text(shown).show_ui(ui, |ui| {
                for (effort, name) in efforts {
                    again |= ui.selectable_value(&mut self.recipe.effort, effort, name).changed();
                }
            });
        });
        if again {
            self.make(&ui.ctx().clone());
        }
    }

    fn way_part(&mut self, ui: &mut Ui) {
        let mut split = self.look.other.is_some();
        let mut way = self.look.way;
        self.way_box(ui, "way", &mut way);
        self.look.way = way;
        ui.horizontal(|ui| {
            if ui.checkbox(&mut split, "Compare with").changed() {
                self.toggle_split();
            }
            if let Some((mut other, share)) = self.look.other {
                self.way_box(ui, "other", &mut other);
                self.look.other = Some((other, share));
            }
        });
        ui.horizontal(|ui| {
            ui.label("Filter");
            let filters = [
                (TextureFilter::Nearest, "nearest"),
                (TextureFilter::Bilinear, "bilinear"),
                (TextureFilter::Trilinear, "trilinear"),
            ];
            for (filter, name) in filters {
                ui.selectable_value(&mut self.look.filter, filter, name);
            }
        });
        ui.horizontal(|ui| {
            ui.label("Drawn by");
            ui.add_enabled_ui(self.gpu.is_some(), |ui| {
                ui.selectable_value(&mut self.engine, Engine::Gpu, "GPU");
            });
            ui.selectable_value(&mut self.engine, Engine::Cpu, "CPU");
        });
        ui.checkbox(&mut self.look.colored, "Base colour");
    }

    fn way_box(&self, ui: &mut Ui, id: &str, way: &mut Way) {
        egui::ComboBox::from_id_salt(id).selected_text(way.name()).show_ui(ui, |ui| {
            for choice in Way::ALL {
                let why_not = self.subject.as_ref().and_then(|s| s.can(choice).err());
                let why_not = why_not
                    .or_else(|| (!self.look.suits(choice)).then_some("only for matte and Blinn-Phong materials"));
                ui.add_enabled_ui(why_not.is_none(), |ui| {
                    let told = ui.selectable_value(way, choice, choice.name());
                    told.on_hover_text(choice.about()).on_disabled_hover_text(why_not.unwrap_or_default());
                });
            }
        });
    }

    fn light_part(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.label("A drag turns");
            ui.selectable_value(&mut self.drag, Drag::Object, "the object");
            ui.selectable_value(&mut self.drag, Drag::Light, "the light");
        });
        let lamp = &mut self.look.lamp;
        ui.horizontal(|ui| {
            ui.color_edit_button_rgb(&mut lamp.color);
            ui.label("light");
            ui.add(Slider::new(&mut lamp.ambient, 0.0..=1.0).text("ambient"));
        });
        ui.horizontal(|ui| {
            ui.checkbox(&mut self.spins, "Light goes round");
            if ui.button("Reset view").clicked() {
                (self.look.orbit, self.look.lamp) = (Orbit::default(), Lamp::default());
            }
        });
    }

    fn materials_part(&mut self, ui: &mut Ui) {
        let several = self.look.finishes.len() > 1;
        for (i, finish) in self.look.finishes.iter_mut().enumerate() {
            let title = if several { format!("Material {i}") } else { "Material".to_owned() };
            egui::CollapsingHeader::new(title).id_salt(i).default_open(!several || i == 0).show(ui, |ui| {
                material(ui, i, finish);
            });
        }
    }

    fn notes_part(&mut self, ui: &mut Ui) {
        if self.notes.is_empty() {
            return;
        }
        ui.horizontal(|ui| {
            ui.strong("Notes");
            if ui.small_button("dismiss").clicked() {
                self.notes.clear();
            }
        });
        for note in &self.notes {
            ui.label(note);
        }
        ui.separator();
    }

    /// What is to be seen, and what it takes: a phrase each.
    pub(super) fn figures(&self) -> Vec<String> {
        let shown = if self.look.other.is_some() { 2 } else { 1 };
        let engines = [Engine::Gpu, Engine::Cpu];
        let mut figures: Vec<String> =
            self.panes[..shown].iter().flat_map(|pane| engines.into_iter().filter_map(|e| pane.figures(e))).collect();
        if let Some(subject) = &self.subject {
            figures.extend(subject.indexed.as_ref().map(|map| format!("{} entries", map.table().len())));
            figures.extend(subject.error.as_ref().map(|error| {
                let (rms, max) = (error.rms_rad.to_degrees(), error.max_rad.to_degrees());
                format!("{rms:.2}° RMS, {max:.1}° at most")
            }));
        }
        figures.extend(self.difference.as_ref().map(|d| {
            let db = if d.psnr_db.is_finite() { format!("{:.1} dB", d.psnr_db) } else { "no difference".to_owned() };
            format!("{db}, {} codes at most", d.max_abs)
        }));
        figures.extend(self.refines().then(|| "refining".to_owned()));
        figures
    }

    /// The figures in a line, and what draws.
    pub(super) fn status(&self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            for figure in self.figures() {
                ui.label(figure);
                ui.separator();
            }
            ui.weak(match (self.engine, &self.gpu) {
                (Engine::Gpu, Some(gpu)) => gpu.gpu().short_name(),
                _ => "CPU",
            });
        });
    }
}

/// Dark or light: the words, as not every font has the signs.
fn theme(ui: &mut Ui) {
    let mut chosen = ui.ctx().options(|o| o.theme_preference);
    ui.horizontal(|ui| {
        ui.label("Theme");
        for (theme, name) in [
            (egui::ThemePreference::System, "system"),
            (egui::ThemePreference::Dark, "dark"),
            (egui::ThemePreference::Light, "light"),
        ] {
            ui.selectable_value(&mut chosen, theme, name);
        }
    });
    ui.ctx().set_theme(chosen);
}

/// The rows of one material.
fn material(ui: &mut Ui, i: usize, finish: &mut Finish) {
    egui::ComboBox::from_id_salt(("model", i)).selected_text(finish.model.name()).show_ui(ui, |ui| {
        for model in Model::ALL {
            ui.selectable_value(&mut finish.model, model, model.name());
        }
    });
    ui.horizontal(|ui| {
        ui.color_edit_button_rgb(&mut finish.color);
        ui.label("colour");
        if matches!(finish.model, Model::BlinnPhong | Model::Phong | Model::DoubledAngle) {
            ui.color_edit_button_rgb(&mut finish.specular);
            ui.label("highlight");
        }
    });
    match finish.model {
        Model::BlinnPhong | Model::Phong | Model::DoubledAngle => {
            ui.add(Slider::new(&mut finish.shininess, 1.0..=500.0).logarithmic(true).text("shininess"));
        }
        Model::Steps => {
            ui.add(Slider::new(&mut finish.steps, 1..=16).text("steps"));
        }
        Model::Environment => {
            ui.add(Slider::new(&mut finish.roughness, 0.0..=1.0).text("roughness"));
        }
        Model::MetallicRoughness => {
            ui.add(Slider::new(&mut finish.metallic, 0.0..=1.0).text("metallic"));
            ui.add(Slider::new(&mut finish.roughness, 0.0..=1.0).text("roughness"));
        }
        Model::Matte | Model::Cartoon | Model::Chrome => {}
    }
}

/// Whether a slider was let go, or a value typed.
fn done(response: &egui::Response) -> bool {
    response.drag_stopped() || (response.changed() && !response.dragged())
}
