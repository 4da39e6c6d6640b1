//! The picture: drags, wheel and fingers, and the line between two ways of drawing.

use eframe::egui::{
    self, Align2, Color32, CursorIcon, FontId, PointerButton, Pos2, Rect, Sense, Stroke, Ui, Vec2, pos2, vec2,
};

use super::{Drag, Viewer};
use crate::look::Way;

/// How far from the line it can be taken hold of, in points.
const GRIP: f32 = 14.0;
/// Radians a point of a drag.
const TURN: f32 = 0.008;

impl Viewer {
    pub(super) fn picture(&mut self, ui: &mut Ui) {
        let rect = ui.available_rect_before_wrap();
        let pixels = rect.size() * ui.ctx().pixels_per_point();
        let limit = self.gpu.as_ref().map_or(8192, |gpu| gpu.gpu().max_side());
        let side = |length: f32| (length.round() as u32).clamp(1, limit);
        let size = (side(pixels.x), side(pixels.y));
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        self.drags(ui, &response);
        if response.hovered() || response.dragged() {
            let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
            if scroll != 0.0 || pinch != 1.0 {
                self.look.orbit.zoom((-scroll * 0.002).exp() / pinch);
            }
        }
        let grip = self.split_line(ui, rect);
        self.draw(ui.ctx(), size);
        self.paint(ui, rect);
        if let Some(x) = grip {
            let stroke = Stroke::new(2.0, ui.visuals().strong_text_color());
            ui.painter().vline(x, rect.y_range(), stroke);
            let middle = pos2(x, rect.center().y);
            ui.painter().circle(middle, 7.0, ui.visuals().panel_fill, stroke);
        }
    }

    fn drags(&mut self, ui: &Ui, response: &egui::Response) {
        let moved = response.drag_delta();
        if moved == Vec2::ZERO {
            return;
        }
        let light = response.dragged_by(PointerButton::Secondary)
            || (response.dragged_by(PointerButton::Primary)
                && (self.drag == Drag::Light || ui.input(|i| i.modifiers.shift)));
        if light {
            self.look.lamp.turn(moved.x * TURN, -moved.y * TURN);
        } else if response.dragged() {
            self.look.orbit.turn(-moved.x * TURN, moved.y * TURN);
        }
    }

    /// The line between two pictures, and where it is now.
    fn split_line(&mut self, ui: &Ui, rect: Rect) -> Option<f32> {
        let (_, share) = self.look.other.as_mut()?;
        let x = rect.left() + rect.width() * *share;
        let grip = Rect::from_center_size(pos2(x, rect.center().y), vec2(2.0 * GRIP, rect.height()));
        let line = ui.interact(grip, ui.scope_id().with("split"), Sense::drag());
        if line.hovered() || line.dragged() {
            ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
        }
        *share = (*share + line.drag_delta().x / rect.width().max(1.0)).clamp(0.02, 0.98);
        Some(rect.left() + rect.width() * *share)
    }

    fn paint(&self, ui: &Ui, rect: Rect) {
        ui.painter().rect_filled(rect, 0.0, ground(ui));
        let share = self.look.other.map_or(1.0, |o| o.1);
        let parts = [(0.0, share, Some(self.look.way)), (share, 1.0, self.look.other.map(|o| o.0))];
        for ((from, to, way), pane) in parts.into_iter().zip(&self.panes) {
            let Some(way) = way.filter(|_| to > from) else { continue };
            let at = |s: f32| rect.left() + rect.width() * s;
            let part = Rect::from_min_max(pos2(at(from), rect.top()), pos2(at(to), rect.bottom()));
            let uv = Rect::from_min_max(pos2(from, 0.0), pos2(to, 1.0));
            if let Some(texture) = pane.texture() {
                ui.painter().image(texture, part, uv, Color32::WHITE);
            } else if let Some(why) = &pane.why_not {
                say(ui, part.center(), why, part.width());
            }
            self.caption(ui, part, way, from > 0.0);
        }
    }

    fn caption(&self, ui: &Ui, part: Rect, way: Way, right: bool) {
        let (corner, align) = if right {
            (part.right_top() + vec2(-10.0, 8.0), Align2::RIGHT_TOP)
        } else {
            (part.left_top() + vec2(10.0, 8.0), Align2::LEFT_TOP)
        };
        let painter = ui.painter().with_clip_rect(part);
        painter.text(corner, align, way.name(), FontId::proportional(15.0), ui.visuals().strong_text_color());
    }

    /// How far the making of a subject is. A page tells it beside the picture.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn waiting(&self, context: &egui::Context, stage: &str, share: f32) {
        egui::Area::new(egui::Id::unique("waiting"))
            .anchor(Align2::CENTER_CENTER, Vec2::ZERO)
            .interactable(false)
            .show(context, |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_width(240.0);
                    ui.label(if stage.is_empty() { "beginning" } else { stage });
                    ui.add(egui::ProgressBar::new(share.clamp(0.0, 1.0)));
                });
            });
        // Often enough to be seen to move.
        context.request_repaint_after(std::time::Duration::from_millis(200));
    }
}

/// What lies behind the object.
fn ground(ui: &Ui) -> Color32 {
    if ui.visuals().dark_mode { Color32::from_gray(24) } else { Color32::from_rgb(236, 230, 220) }
}

fn say(ui: &Ui, middle: Pos2, text: &str, width: f32) {
    let color = ui.visuals().text_color();
    let galley = ui.painter().layout(text.to_owned(), FontId::proportional(14.0), color, (width - 40.0).max(80.0));
    ui.painter().galley(middle - galley.size() * 0.5, galley, color);
}
