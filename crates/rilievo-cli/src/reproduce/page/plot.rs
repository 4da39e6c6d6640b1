//! Lines over two axes, as SVG that takes its colours from the page.

use std::fmt::Write as _;

/// Width and height of the picture.
const SIZE: [f64; 2] = [760.0, 400.0];
/// Left, right, top and bottom edge of the axes.
const AREA: [f64; 4] = [66.0, 732.0, 16.0, 348.0];
/// The page has this many colours for lines.
const COLORS: usize = 8;

/// What an axis is divided by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Scale {
    Linear,
    /// Logarithmic, with marks at 1, 2 and 5 times the powers of ten.
    Decades,
    /// Logarithmic, with marks at the powers of two.
    Doublings,
}

/// An axis: what it measures and how it is divided.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axis {
    label: &'static str,
    scale: Scale,
}

impl Axis {
    /// Even steps.
    pub(crate) fn linear(label: &'static str) -> Self {
        Self { label, scale: Scale::Linear }
    }

    /// Logarithmic, in powers of ten. Values must be above zero.
    pub(crate) fn decades(label: &'static str) -> Self {
        Self { label, scale: Scale::Decades }
    }

    /// Logarithmic, in powers of two. Values must be above zero.
    pub(crate) fn doublings(label: &'static str) -> Self {
        Self { label, scale: Scale::Doublings }
    }
}

/// Points that are joined by a line.
#[derive(Debug, Clone)]
pub(crate) struct Series {
    name: String,
    points: Vec<[f64; 2]>,
    has_dots: bool,
    is_dashed: bool,
    /// Named beside its first point instead of in the legend.
    is_labelled: bool,
}

impl Series {
    /// A single measured point with its name beside it.
    pub(crate) fn point(name: impl Into<String>, point: [f64; 2]) -> Self {
        Self { is_labelled: true, ..Self::measured(name, vec![point]) }
    }

    /// Measured points: each has a dot.
    pub(crate) fn measured(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), points, has_dots: true, is_dashed: false, is_labelled: false }
    }

    /// Many points, of which only the curve counts.
    pub(crate) fn curve(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), points, has_dots: false, is_dashed: false, is_labelled: false }
    }

    /// What was not measured but computed: dashed.
    pub(crate) fn computed(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), points, has_dots: false, is_dashed: true, is_labelled: false }
    }
}

/// Lines over two axes.
#[derive(Debug, Clone)]
pub(crate) struct Plot {
    caption: String,
    x: Axis,
    y: Axis,
    series: Vec<Series>,
}

/// An axis laid over what it shows.
struct Laid {
    axis: Axis,
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Plot {
    /// Points outside of what a logarithmic axis can show are left out.
    pub(crate) fn new(caption: impl Into<String>, x: Axis, y: Axis, series: Vec<Series>) -> Self {
        Self { caption: caption.into(), x, y, series }
    }

    /// What stands under it.
    pub(crate) fn caption(&self) -> &str {
        &self.caption
    }

    /// The picture.
    pub(crate) fn to_svg(&self) -> String {
        let points = || self.series.iter().flat_map(|s| &s.points).filter(|p| self.shows(p));
        let [left, right, top, bottom] = AREA;
        let x = Laid::new(self.x, points().map(|p| p[0]), left, right, false);
        let y = Laid::new(self.y, points().map(|p| p[1]), bottom, top, true);
        let [width, height] = SIZE;
        let caption = super::escape(&self.caption);
        let mut out = format!("<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{caption}\">\n");
        let mut put = |text: std::fmt::Arguments<'_>| {
            // Writing to a string cannot fail.
            let _ = out.write_fmt(text);
        };
        for (value, at) in x.ticks() {
            put(format_args!("<path class=\"grid\" d=\"M{at:.1} {top}V{bottom}\"/>"));
            put(format_args!(
                "<text class=\"tick\" x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                bottom + 18.0,
                short(value)
            ));
        }
        for (value, at) in y.ticks() {
            put(format_args!("<path class=\"grid\" d=\"M{left} {at:.1}H{right}\"/>"));
            put(format_args!(
                "<text class=\"tick\" x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>\n",
                left - 8.0,
                at + 4.0,
                short(value)
            ));
        }
        put(format_args!("<path class=\"axis\" d=\"M{left} {top}V{bottom}H{right}\"/>\n"));
        let (middle, centre) = ((left + right) / 2.0, (top + bottom) / 2.0);
        let [x_label, y_label] = [self.x.label, self.y.label].map(super::escape);
        put(format_args!("<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{x_label}</text>\n", bottom + 40.0));
        put(format_args!(
            "<text transform=\"translate(16 {centre}) rotate(-90)\" text-anchor=\"middle\">{y_label}</text>\n"
        ));
        for (i, series) in self.series.iter().enumerate() {
            let places = series.points.iter().filter(|p| self.shows(p)).map(|p| [x.place(p[0]), y.place(p[1])]);
            let path: Vec<String> = places.clone().map(|[x, y]| format!("{x:.1} {y:.1}")).collect();
            let (color, dashed) = (i % COLORS, if series.is_dashed { " dashed" } else { "" });
            if !path.is_empty() {
                put(format_args!("<path class=\"line s{color}{dashed}\" d=\"M{}\"/>\n", path.join("L")));
            }
            if let Some([x, y]) = places.clone().next().filter(|_| series.is_labelled) {
                let name = super::escape(&series.name);
                put(format_args!("<text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\">{name}</text>\n", x + 7.0, y - 5.0));
            }
            for [x, y] in places.filter(|_| series.has_dots) {
                put(format_args!("<circle class=\"dot s{color}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.5\"/>\n"));
            }
        }
        self.add_legend(&x, &y, &mut put);
        out + "</svg>\n"
    }

    /// Names of the series, in the corner where the fewest points are.
    fn add_legend(&self, x: &Laid, y: &Laid, put: &mut impl FnMut(std::fmt::Arguments<'_>)) {
        let [left, right, top, bottom] = AREA;
        let named = || self.series.iter().enumerate().filter(|(_, s)| !s.is_labelled);
        let widest = named().map(|(_, s)| s.name.chars().count()).max().unwrap_or(0) as f64;
        let size = [widest * 7.0 + 44.0, named().count() as f64 * 19.0 + 8.0];
        let corners = [
            [right - size[0], top],
            [left + 8.0, top],
            [right - size[0], bottom - size[1]],
            [left + 8.0, bottom - size[1]],
        ];
        let hidden = |corner: &[f64; 2]| {
            let inside = |at: f64, k: usize| at > corner[k] - 8.0 && at < corner[k] + size[k] + 8.0;
            let all = self.series.iter().flat_map(|s| &s.points).filter(|p| self.shows(p));
            all.filter(|p| inside(x.place(p[0]), 0) && inside(y.place(p[1]), 1)).count()
        };
        let [at_x, at_y] = corners.into_iter().min_by_key(hidden).unwrap_or(corners[0]);
        for (row, (i, series)) in named().enumerate() {
            let (color, dashed) = (i % COLORS, if series.is_dashed { " dashed" } else { "" });
            let line = at_y + 14.0 + 19.0 * row as f64;
            put(format_args!("<path class=\"line s{color}{dashed}\" d=\"M{at_x:.1} {line:.1}h26\"/>"));
            let (x, y, name) = (at_x + 34.0, line + 4.0, super::escape(&series.name));
            put(format_args!("<text x=\"{x:.1}\" y=\"{y:.1}\">{name}</text>\n"));
        }
    }

    fn shows(&self, point: &[f64; 2]) -> bool {
        let fits = |axis: Axis, v: f64| v.is_finite() && (axis.scale == Scale::Linear || v > 0.0);
        fits(self.x, point[0]) && fits(self.y, point[1])
    }
}

impl Laid {
    /// Over all values; with `room`, out to the next marks.
    fn new(axis: Axis, values: impl Iterator<Item = f64>, from: f64, to: f64, room: bool) -> Self {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        // Nothing, or a single value, still has an axis.
        let (low, high) = match (low < high, low.is_finite()) {
            (true, _) => (low, high),
            (false, true) => (low * 0.5, low * 2.0 + f64::from(u8::from(low == 0.0))),
            (false, false) => (1.0, 2.0),
        };
        let (low, high) = match (room, axis.scale) {
            (false, _) => (low, high),
            (true, Scale::Linear) => {
                let step = step(high - low);
                ((low / step).floor() * step, (high / step).ceil() * step)
            }
            (true, _) => (low / 1.2, high * 1.2),
        };
        Self { axis, low, high, from, to }
    }

    fn place(&self, value: f64) -> f64 {
        let part = match self.axis.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Decades | Scale::Doublings => (value / self.low).ln() / (self.high / self.low).ln(),
        };
        self.from + part * (self.to - self.from)
    }

    /// Values that are marked, and where they stand.
    fn ticks(&self) -> Vec<(f64, f64)> {
        let all: Vec<f64> = match self.axis.scale {
            Scale::Linear => {
                let step = step(self.high - self.low);
                let first = (self.low / step).ceil() as i64;
                (first..first + 100).map(|i| i as f64 * step).collect()
            }
            Scale::Decades => {
                let few = self.high / self.low > 3e3;
                let factors: &[f64] = if few { &[1.0] } else { &[1.0, 2.0, 5.0] };
                (-9..13).flat_map(|p| factors.iter().map(move |f| f * 10f64.powi(p))).collect()
            }
            Scale::Doublings => (-20..40).map(|p| 2f64.powi(p)).collect(),
        };
        let slack = 1e-9 * (self.high - self.low);
        let inside = |v: &f64| (self.low - slack..=self.high + slack).contains(v);
        all.into_iter().filter(inside).map(|v| (v, self.place(v))).collect()
    }
}

/// A round step that divides `span` into five to ten parts.
fn step(span: f64) -> f64 {
    let power = 10f64.powf((span / 5.0).log10().floor());
    [5.0, 2.0].into_iter().map(|f| f * power).find(|s| span / s >= 5.0).unwrap_or(power)
}

/// A mark's number without needless zeros.
fn short(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_stand_between_the_edges_and_marks_are_round() {
        let laid = Laid::new(Axis::linear("x"), [0.13, 0.92].into_iter(), 0.0, 100.0, true);
        assert!(laid.place(0.13) >= 0.0 && laid.place(0.92) <= 100.0);
        let marks: Vec<String> = laid.ticks().iter().map(|t| short(t.0)).collect();
        assert_eq!(marks, ["0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1"]);
        let laid = Laid::new(Axis::doublings("k"), [16.0, 128.0].into_iter(), 0.0, 300.0, false);
        assert_eq!(laid.ticks().iter().map(|t| t.0).collect::<Vec<_>>(), [16.0, 32.0, 64.0, 128.0]);
        assert!((laid.place(32.0) - 100.0).abs() < 1e-9);
    }

    #[test]
    fn steps_make_five_to_ten_parts() {
        for span in [0.003, 0.9, 1.0, 4.9, 5.0, 17.0, 99.0, 12_345.0] {
            let parts = span / step(span);
            assert!((5.0..=10.1).contains(&parts), "{span}: {parts}");
        }
    }

    #[test]
    fn what_cannot_be_shown_is_left_out() {
        let series = vec![
            Series::measured("a & b", vec![[1.0, 0.0], [2.0, f64::NAN], [4.0, 3.0], [8.0, 5.0]]),
            Series::computed("none", vec![]),
        ];
        let svg = Plot::new("c", Axis::doublings("x"), Axis::decades("y"), series).to_svg();
        assert!(svg.contains("a &amp; b") && !svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert_eq!(svg.matches("<circle").count(), 2);
    }
}
