//! A plot of sizes and errors as SVG, both axes logarithmic.

/// Width and height of the picture.
const SIZE: [f64; 2] = [760.0, 480.0];
/// Left, right, top and bottom edge of the axes.
const AREA: [f64; 4] = [64.0, 736.0, 20.0, 424.0];
/// One for each series; legible on white and on dark gray.
const COLORS: [&str; 6] = ["#2b7bba", "#d9731a", "#3a9a5b", "#8a9a1b", "#b5489c", "#8a8a8a"];
/// Gray that is legible on both, too.
const INK: &str = "#7d7d7d";

/// Where labels stand, seen from their points.
#[derive(Debug, Clone, Copy)]
pub(super) enum Side {
    AboveRight,
    BelowLeft,
    BelowRight,
    Right,
}

impl Side {
    fn offset(self) -> ([f64; 2], &'static str) {
        match self {
            Self::AboveRight => ([7.0, -6.0], "start"),
            Self::BelowLeft => ([-6.0, 15.0], "end"),
            Self::BelowRight => ([6.0, 15.0], "start"),
            Self::Right => ([8.0, 4.0], "start"),
        }
    }
}

/// Points that belong together: x, y, what stands beside each, and where.
pub(super) struct Series {
    pub(super) name: &'static str,
    pub(super) points: Vec<(f64, f64, String, Side)>,
}

/// Series with what their axes are.
pub(super) struct Plot {
    pub(super) x_label: &'static str,
    pub(super) y_label: &'static str,
    pub(super) series: Vec<Series>,
}

/// From values to places along an axis.
#[derive(Debug, Clone, Copy)]
struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// Holds all values, with some room.
    fn around(values: impl Iterator<Item = f64> + Clone, from: f64, to: f64) -> Self {
        let low = values.clone().fold(f64::INFINITY, f64::min) / 1.25;
        let high = values.fold(0.0, f64::max) * 1.25;
        Self { low, high, from, to }
    }

    fn place(&self, value: f64) -> f64 {
        let part = (value.max(self.low) / self.low).ln() / (self.high / self.low).ln();
        self.from + part * (self.to - self.from)
    }

    /// 1, 2 and 5 times the powers of ten.
    fn ticks(&self) -> Vec<f64> {
        let powers = (-6..9).map(|p| 10f64.powi(p));
        let all = powers.flat_map(|p| [p, 2.0 * p, 5.0 * p]);
        all.filter(|t| (self.low..=self.high).contains(t)).collect()
    }
}

impl Plot {
    /// The picture. What is not above zero stands on the lower edge.
    pub(super) fn to_svg(&self) -> String {
        let points = || self.series.iter().flat_map(|s| &s.points);
        let [left, right, top, bottom] = AREA;
        let x = Axis::around(points().map(|p| p.0), left, right);
        let y = Axis::around(points().map(|p| p.1).filter(|&y| y > 0.0), bottom, top);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"12\">\n",
            SIZE[0], SIZE[1]
        );
        for tick in x.ticks() {
            let at = x.place(tick);
            svg += &line([at, top], [at, bottom], "0.5", "0.35");
            svg += &text([at, bottom + 16.0], "middle", INK, &format!("{tick}"));
        }
        for tick in y.ticks() {
            let at = y.place(tick);
            svg += &line([left, at], [right, at], "0.5", "0.35");
            svg += &text([left - 6.0, at + 4.0], "end", INK, &format!("{tick}°"));
        }
        svg += &line([left, bottom], [right, bottom], "1", "1");
        svg += &line([left, bottom], [left, top], "1", "1");
        svg += &text([(left + right) / 2.0, bottom + 40.0], "middle", INK, self.x_label);
        let middle = (top + bottom) / 2.0;
        svg += &format!(
            "<text transform=\"translate(16 {middle}) rotate(-90)\" text-anchor=\"middle\" fill=\"{INK}\">{}</text>\n",
            self.y_label
        );
        for (series, color) in self.series.iter().zip(COLORS) {
            let places: Vec<[f64; 2]> = series.points.iter().map(|p| [x.place(p.0), y.place(p.1)]).collect();
            let path: Vec<String> = places.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
            svg += &format!(
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"/>\n",
                path.join(" ")
            );
            for ([px, py], (_, value, label, side)) in places.iter().zip(&series.points) {
                svg += &format!("<circle cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"3.5\" fill=\"{color}\"/>\n");
                let label = if *value > 0.0 { label.clone() } else { "lossless".to_owned() };
                let ([dx, dy], anchor) = side.offset();
                svg += &text([px + dx, py + dy], anchor, color, &label);
            }
        }
        for (i, (series, color)) in self.series.iter().zip(COLORS).enumerate() {
            let at = [right - 150.0, top + 14.0 + 18.0 * i as f64];
            svg += &format!("<circle cx=\"{}\" cy=\"{}\" r=\"4\" fill=\"{color}\"/>\n", at[0], at[1] - 4.0);
            svg += &text([at[0] + 10.0, at[1]], "start", color, series.name);
        }
        svg + "</svg>\n"
    }
}

fn line([x1, y1]: [f64; 2], [x2, y2]: [f64; 2], width: &str, opacity: &str) -> String {
    format!(
        "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{INK}\" stroke-width=\"{width}\" \
         opacity=\"{opacity}\"/>\n"
    )
}

fn text([x, y]: [f64; 2], anchor: &str, color: &str, text: &str) -> String {
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{color}\">{text}</text>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_ratios_are_equally_far_apart_and_zero_is_on_the_edge() {
        let axis = Axis { low: 1.0, high: 100.0, from: 50.0, to: 10.0 };
        assert_eq!([0.0, 1.0, 10.0, 100.0].map(|v| axis.place(v)), [50.0, 50.0, 30.0, 10.0]);
        assert_eq!(axis.ticks(), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]);
        let around = Axis::around([2.0, 8.0].into_iter(), 0.0, 1.0);
        assert!(around.place(2.0) > 0.0 && around.place(8.0) < 1.0);
    }
}
