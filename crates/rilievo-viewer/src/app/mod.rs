//! The window: a picture in the middle, what it depends on beside it.

mod files;
mod pace;
mod pane;
mod panel;
mod picture;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use eframe::egui::{self, FontData, FontDefinitions};
use eframe::egui_wgpu::RenderState;
use rilievo::measure::picture_stats;
use rilievo::raster::TextureFilter;
use rilievo_gpu::{Gpu, Renderer};
use web_time::Instant;

use self::files::Inbox;
use self::pane::Pane;
use crate::job::{Job, Meter};
use crate::look::{Lamp, Look, Orbit, Way};
use crate::subject::{File, Recipe, Subject};

/// Seconds without a change after which two pictures are compared.
const SETTLED: f32 = 0.2;
/// Narrower than this, in points, the panel lies below the picture.
const NARROW: f32 = 720.0;

/// What draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Engine {
    Gpu,
    Cpu,
}

impl Engine {
    fn name(self) -> &'static str {
        match self {
            Self::Gpu => "GPU",
            Self::Cpu => "CPU",
        }
    }
}

/// What a drag turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Drag {
    #[default]
    Object,
    Light,
}

/// How two pictures differ.
#[derive(Debug, Clone, Copy)]
struct Difference {
    psnr_db: f64,
    max_abs: u8,
}

/// A font, as a file of TrueType or OpenType. By itself the one that a window has; a page has none of its own.
#[derive(Debug, Clone)]
pub struct Font(FontData);

impl Font {
    /// A font that was read from somewhere.
    pub fn new(bytes: Vec<u8>) -> Self {
        Self(FontData::from_owned(bytes))
    }
}

impl Default for Font {
    fn default() -> Self {
        #[cfg(not(target_arch = "wasm32"))]
        let bytes = epaint_default_fonts::UBUNTU_LIGHT;
        #[cfg(target_arch = "wasm32")]
        let bytes = &[];
        Self(FontData::from_static(bytes))
    }
}

/// What the window starts with.
#[derive(Debug, Clone, Default)]
pub struct Start {
    /// What to open; the vase without it.
    pub files: Vec<File>,
    /// What to make of it.
    pub recipe: Recipe,
    /// How to draw it.
    pub way: Way,
    /// What to compare it with.
    pub other: Option<Way>,
    /// Whether to draw by CPU though there is a GPU.
    pub by_cpu: bool,
    /// What the user should know at once.
    pub notes: Vec<String>,
    /// The font of all texts.
    pub font: Font,
    /// Where a viewer says that its graphics device is gone, and closes: only a new window has a new device.
    pub lost: Arc<AtomicBool>,
}

/// One font for every text.
fn fonts(font: FontData) -> FontDefinitions {
    let name = "the font";
    let mut fonts = FontDefinitions::empty();
    fonts.font_data.insert(name.to_owned(), Arc::new(font));
    fonts.families.values_mut().for_each(|family| family.push(name.to_owned()));
    fonts
}

/// Asks for a frame, as something has come. Asked for one at once, egui draws two; where the GPU is software, each takes long.
fn wake(context: &egui::Context) {
    context.request_repaint_after(std::time::Duration::from_millis(1));
}

/// The viewer.
pub struct Viewer {
    recipe: Recipe,
    /// What the subject was made by.
    made_by: Recipe,
    job: Option<Job>,
    subject: Option<Arc<Subject>>,
    look: Look,
    engine: Engine,
    gpu: Option<Renderer>,
    render_state: Option<RenderState>,
    panes: [Pane; 2],
    drag: Drag,
    spins: bool,
    notes: Vec<String>,
    lost: Arc<AtomicBool>,
    inbox: Inbox,
    difference: Option<Difference>,
    /// Differences that are being worked out, with the number of the change they are of.
    #[cfg(target_arch = "wasm32")]
    compared: Arc<std::sync::Mutex<Option<(Instant, Difference)>>>,
    #[cfg(target_arch = "wasm32")]
    asked: Option<Instant>,
    #[cfg(target_arch = "wasm32")]
    words: crate::web::Words,
    /// When something last changed in the picture.
    changed: Instant,
}

impl Viewer {
    /// A viewer on the window's own device, if it has one.
    pub fn new(context: &eframe::CreationContext<'_>, start: Start) -> Self {
        context.egui_ctx.set_fonts(fonts(start.font.0));
        let state = context.wgpu_render_state.clone();
        let gpu = state.as_ref().map(|state| {
            let gpu = Gpu::from_device(state.device.clone(), state.queue.clone(), state.adapter.get_info());
            // A picture that nobody touches would not notice.
            let again = context.egui_ctx.clone();
            gpu.on_trouble(move || again.request_repaint());
            Renderer::new(&gpu)
        });
        let mut notes = start.notes;
        if gpu.is_none() {
            notes.push("There is no GPU to draw on: the CPU draws.".to_owned());
        }
        let look = Look {
            way: start.way,
            other: start.other.map(|way| (way, 0.5)),
            filter: TextureFilter::Trilinear,
            finishes: Vec::new(),
            orbit: Orbit::default(),
            lamp: Lamp::default(),
            colored: true,
        };
        let mut viewer = Self {
            made_by: start.recipe.clone(),
            recipe: start.recipe,
            job: None,
            subject: None,
            look,
            engine: if gpu.is_none() || start.by_cpu { Engine::Cpu } else { Engine::Gpu },
            gpu,
            render_state: state,
            panes: Default::default(),
            drag: Drag::default(),
            spins: false,
            notes,
            lost: start.lost,
            inbox: Inbox::default(),
            difference: None,
            #[cfg(target_arch = "wasm32")]
            compared: Arc::default(),
            #[cfg(target_arch = "wasm32")]
            asked: None,
            #[cfg(target_arch = "wasm32")]
            words: Default::default(),
            changed: Instant::now(),
        };
        for file in start.files {
            viewer.recipe.take_in(file);
        }
        viewer.make(&context.egui_ctx);
        viewer
    }

    /// Begins to make what the recipe says.
    fn make(&mut self, context: &egui::Context) {
        let again = context.clone();
        self.job = Some(Job::begin(&self.recipe, move || wake(&again)));
        #[cfg(target_arch = "wasm32")]
        crate::web::progress::show(self.awaited());
    }

    fn poll(&mut self, context: &egui::Context) {
        let arrived = self.inbox.take();
        if !arrived.is_empty() {
            for file in arrived {
                match file {
                    Ok(file) => self.recipe.take_in(file),
                    Err(why) => self.notes.push(why),
                }
            }
            self.make(context);
        }
        let Some(made) = self.job.as_ref().and_then(Job::take) else { return };
        self.job = None;
        #[cfg(target_arch = "wasm32")]
        crate::web::progress::show(None);
        match made {
            Ok(subject) => {
                self.made_by = self.recipe.clone();
                self.show(subject);
                if let Some(refined) = self.recipe.refined() {
                    self.recipe = refined;
                    self.make(context);
                }
            }
            Err(why) => {
                self.notes.push(why);
                // What is to be seen stays, and so does what it is made by.
                if self.subject.is_some() {
                    self.recipe = self.made_by.clone();
                }
            }
        }
    }

    /// Whether what is being made is what is seen already, in more detail.
    fn refines(&self) -> bool {
        self.job.is_some() && self.made_by.refined().is_some_and(|refined| refined.is_made_as(&self.recipe))
    }

    /// How far the work is that somebody waits for.
    fn awaited(&self) -> Option<&Meter> {
        self.job.as_ref().filter(|_| !self.refines()).map(Job::meter)
    }

    fn show(&mut self, subject: Subject) {
        self.notes.clone_from(&subject.notes);
        let same_kind = self.subject.as_ref().is_some_and(|s| s.name == subject.name);
        // What the user made of the materials stays when the same thing is made anew.
        if !same_kind || self.look.finishes.len() < subject.material_count() {
            self.look.finishes = subject.finishes();
            self.look.orbit = Orbit::default();
        }
        if subject.can(self.look.way).is_err() {
            let first = Way::ALL.into_iter().find(|&way| subject.can(way).is_ok());
            self.look.way = first.unwrap_or(Way::Exact);
        }
        if self.look.other.is_some_and(|(way, _)| subject.can(way).is_err()) {
            self.look.other = None;
        }
        self.subject = Some(Arc::new(subject));
        self.touch();
    }

    /// Something in the picture is another.
    fn touch(&mut self) {
        self.changed = Instant::now();
        self.difference = None;
    }

    /// Draws both panes, if they show something else now.
    fn draw(&mut self, context: &egui::Context, size: (u32, u32)) {
        let Some(subject) = self.subject.clone() else { return };
        let ways = [Some(self.look.way), self.look.other.map(|o| o.0)];
        let state = self.render_state.clone();
        let mut drawn = false;
        for (pane, way) in self.panes.iter_mut().zip(ways) {
            let Some(way) = way else { continue };
            pane.prepare(&subject, &self.look, way, size);
            let painted = match (self.engine, &self.gpu, &state) {
                (Engine::Gpu, Some(renderer), Some(state)) => pane.draw_on_gpu(renderer, state, &self.look, size),
                _ => Ok(pane.draw_on_cpu(context, &self.look, size)),
            };
            match painted {
                Ok(anew) => drawn |= anew,
                Err(error) => {
                    self.notes.push(format!("{error}. The CPU draws from now on."));
                    self.engine = Engine::Cpu;
                    // The window's own pictures are drawn by the same device.
                    self.lost.store(true, Ordering::Relaxed);
                    #[cfg(not(target_arch = "wasm32"))]
                    context.send_viewport_cmd(egui::ViewportCommand::Close);
                    #[cfg(target_arch = "wasm32")]
                    crate::web::tell_lost();
                }
            }
        }
        if drawn {
            self.touch();
            // The figures below the picture are those of the frame before, and the GPU tells its time later.
            context.request_repaint_after(std::time::Duration::from_millis(100));
        }
        self.compare(context);
    }

    /// Compares the two pictures once they stay as they are.
    #[cfg(not(target_arch = "wasm32"))]
    fn compare(&mut self, context: &egui::Context) {
        if self.look.other.is_none() || self.difference.is_some() {
            return;
        }
        let waited = self.changed.elapsed().as_secs_f32();
        if waited < SETTLED {
            context.request_repaint_after(std::time::Duration::from_secs_f32(SETTLED - waited));
            return;
        }
        let [left, right] = &self.panes;
        let pictures =
            pollster::block_on(left.picture(self.engine)).zip(pollster::block_on(right.picture(self.engine)));
        let Some((left, right)) = pictures else { return };
        if let Ok(stats) = picture_stats(&right, &left) {
            self.difference = Some(Difference { psnr_db: stats.psnr_db, max_abs: stats.max_abs });
            context.request_repaint();
        }
    }

    /// Compares the two pictures once they stay as they are; a browser reads them by and by.
    #[cfg(target_arch = "wasm32")]
    fn compare(&mut self, context: &egui::Context) {
        if let Some((of, difference)) = self.compared.lock().unwrap_or_else(std::sync::PoisonError::into_inner).take()
            && of == self.changed
        {
            self.difference = Some(difference);
        }
        if self.look.other.is_none() || self.difference.is_some() || self.asked == Some(self.changed) {
            return;
        }
        let waited = self.changed.elapsed().as_secs_f32();
        if waited < SETTLED {
            context.request_repaint_after(std::time::Duration::from_secs_f32(SETTLED - waited));
            return;
        }
        self.asked = Some(self.changed);
        let [left, right] = [0, 1].map(|i: usize| self.panes[i].parts(self.engine));
        let (compared, context, of) = (Arc::clone(&self.compared), context.clone(), self.changed);
        wasm_bindgen_futures::spawn_local(async move {
            let read = async |(target, picture): (Option<rilievo_gpu::Target>, Option<rilievo::color::Picture>)| {
                match target {
                    Some(target) => target.read().await.ok(),
                    None => picture,
                }
            };
            if let (Some(left), Some(right)) = (read(left).await, read(right).await)
                && let Ok(stats) = picture_stats(&right, &left)
            {
                let difference = Difference { psnr_db: stats.psnr_db, max_abs: stats.max_abs };
                *compared.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some((of, difference));
                context.request_repaint();
            }
        });
    }

    fn keys(&mut self, context: &egui::Context) {
        use egui::Key;
        if context.egui_wants_keyboard_input() {
            return;
        }
        const NUMBERS: [Key; 9] =
            [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];
        let step = 0.06;
        context.input(|input| {
            let across = f32::from(input.key_down(Key::ArrowRight)) - f32::from(input.key_down(Key::ArrowLeft));
            let up = f32::from(input.key_down(Key::ArrowUp)) - f32::from(input.key_down(Key::ArrowDown));
            if across != 0.0 || up != 0.0 {
                match input.modifiers.shift || self.drag == Drag::Light {
                    true => self.look.lamp.turn(across * step, up * step),
                    false => self.look.orbit.turn(across * step, up * step),
                }
            }
            if input.key_pressed(Key::Plus) || input.key_pressed(Key::Equals) {
                self.look.orbit.zoom(0.9);
            }
            if input.key_pressed(Key::Minus) {
                self.look.orbit.zoom(1.0 / 0.9);
            }
            if input.key_pressed(Key::L) {
                self.drag = if self.drag == Drag::Light { Drag::Object } else { Drag::Light };
            }
            if input.key_pressed(Key::Space) {
                self.spins = !self.spins;
            }
            if input.key_pressed(Key::C) {
                let gpu = self.engine == Engine::Cpu && self.gpu.is_some();
                self.engine = if gpu { Engine::Gpu } else { Engine::Cpu };
            }
            if input.key_pressed(Key::S) {
                self.toggle_split();
            }
            for (key, way) in NUMBERS.into_iter().zip(Way::ALL) {
                let allowed = self.subject.as_ref().is_some_and(|s| s.can(way).is_ok()) && self.look.suits(way);
                if input.key_pressed(key) && allowed {
                    self.look.way = way;
                }
            }
        });
    }

    /// Tells the page what is to be seen.
    #[cfg(target_arch = "wasm32")]
    fn tell(&mut self, context: &egui::Context) {
        let Some(subject) = &self.subject else { return };
        let other = self.look.other.map_or(String::new(), |(way, _)| format!(" beside {}", way.name()));
        let notes = if self.notes.is_empty() { String::new() } else { format!("; {}", self.notes.join("; ")) };
        let shown = format!("{}: {}{other}, by {}{notes}", subject.name, self.look.way.name(), self.engine.name());
        if let Some(wait) = self.words.tell(shown, &self.figures().join("; ")) {
            context.request_repaint_after(wait);
        }
        crate::web::remember(&self.recipe, &self.look);
    }

    fn toggle_split(&mut self) {
        let other = if self.look.way == Way::Exact { Way::Table } else { Way::Exact };
        self.look.other = if self.look.other.is_some() { None } else { Some((other, 0.5)) };
    }
}

impl eframe::App for Viewer {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        self.inbox.collect(&context);
        self.poll(&context);
        self.keys(&context);
        if self.spins {
            let seconds = context.input(|i| i.stable_dt).min(0.1);
            self.look.lamp.turn(seconds * 1.2, 0.0);
            context.request_repaint();
        }
        let narrow = context.content_rect().width() < NARROW;
        egui::Panel::bottom("status").show(ui, |ui| self.status(ui));
        if narrow {
            let height = context.content_rect().height() * 0.42;
            egui::Panel::bottom("panel").default_size(height).resizable(true).show(ui, |ui| self.panel(ui));
        } else {
            egui::Panel::right("panel").default_size(300.0).resizable(true).show(ui, |ui| self.panel(ui));
        }
        egui::CentralPanel::no_frame().show(ui, |ui| self.picture(ui));
        #[cfg(target_arch = "wasm32")]
        self.tell(&context);
        #[cfg(not(target_arch = "wasm32"))]
        if let Some((stage, share)) = self.awaited().map(Meter::read) {
            self.waiting(&context, &stage, share);
        }
    }
}
