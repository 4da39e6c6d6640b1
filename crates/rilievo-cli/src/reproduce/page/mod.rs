//! The report as one HTML file that refers to nothing outside itself and runs no script.

mod plot;

use std::fmt::Write as _;

pub(crate) use plot::{Axis, Plot, Series};

use super::findings::{Block, Findings, Image, Shot, Shots, Table};
use crate::base64;

/// A section with what it found.
pub(crate) struct Part<'a> {
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    /// The paper the section is about.
    pub(crate) source: &'static str,
    pub(crate) findings: &'a Findings,
    pub(crate) seconds: f64,
}

const STYLE: &str = include_str!("style.css");

/// The whole page. `conditions` says on what and how everything was measured.
pub(crate) fn page(conditions: &str, parts: &[Part<'_>]) -> String {
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>rilievo: the papers' tables and figures</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n\
         <h1>The papers' tables and figures</h1>\n<p>Measured again by <i>rilievo</i> {}, from samples that are made by \
         code. {}</p>\n</header>\n<nav><ol>\n",
        env!("CARGO_PKG_VERSION"),
        escape(conditions)
    );
    for Part { name, title, .. } in parts {
        write_to(&mut out, format_args!("<li><a href=\"#{name}\">{}</a></li>\n", escape(title)));
    }
    out += "</ol></nav>\n<main>\n";
    for part in parts {
        let Part { name, title, source, findings, seconds } = part;
        let (title, source) = (escape(title), escape(source));
        write_to(
            &mut out,
            format_args!("<section id=\"{name}\">\n<h2>{title}</h2>\n<p class=\"source\">{source}</p>\n"),
        );
        for block in findings.blocks() {
            add_block(&mut out, block);
        }
        write_to(&mut out, format_args!("<p class=\"took\">This section took {seconds:.1} s.</p>\n</section>\n"));
    }
    out + "</main>\n</body>\n</html>\n"
}

fn add_block(out: &mut String, block: &Block) {
    match block {
        Block::Note { label, text } => {
            let class = label.to_lowercase().replace(' ', "-");
            write_to(out, format_args!("<p class=\"note {class}\"><b>{label}.</b> {}</p>\n", escape(text)));
        }
        Block::Table(table) => add_table(out, table),
        Block::Plot(plot) => {
            let caption = escape(plot.caption());
            write_to(
                out,
                format_args!("<figure class=\"plot\">\n{}<figcaption>{caption}</figcaption></figure>\n", plot.to_svg()),
            );
        }
        Block::Shots(shots) => add_shots(out, shots),
    }
}

fn add_table(out: &mut String, table: &Table) {
    write_to(
        out,
        format_args!("<div class=\"wide\"><table>\n<caption>{}</caption>\n<thead><tr>", escape(&table.caption)),
    );
    let class = |is_paper: bool| if is_paper { " class=\"paper\"" } else { "" };
    for column in &table.columns {
        let (class, title) = (class(column.is_paper), escape(&column.title));
        write_to(out, format_args!("<th scope=\"col\"{class}>{title}</th>"));
    }
    *out += "</tr></thead>\n<tbody>\n";
    for row in &table.rows {
        *out += "<tr>";
        for (i, (cell, column)) in row.iter().zip(&table.columns).enumerate() {
            let (class, cell) = (class(column.is_paper), escape(cell));
            if i == 0 {
                write_to(out, format_args!("<th scope=\"row\">{cell}</th>"));
            } else {
                write_to(out, format_args!("<td{class}>{cell}</td>"));
            }
        }
        *out += "</tr>\n";
    }
    *out += "</tbody>\n</table></div>\n";
}

fn add_shots(out: &mut String, shots: &Shots) {
    write_to(out, format_args!("<div class=\"shots c{}\">\n", shots.columns));
    for Shot { images, title, caption } in &shots.shots {
        *out += "<figure>";
        for image in images {
            add_image(out, image, title);
        }
        let (title, caption) = (escape(title), escape(caption));
        let gap = if caption.is_empty() { "" } else { "<br>" };
        write_to(out, format_args!("<figcaption><b>{title}</b>{gap}{caption}</figcaption></figure>\n"));
    }
    *out += "</div>\n";
}

fn add_image(out: &mut String, image: &Image, title: &str) {
    let ((width, height), title) = (image.size, escape(title));
    let class = if image.is_enlarged { " class=\"enlarged\"" } else { "" };
    let data = base64::encode(&image.png);
    write_to(
        out,
        format_args!(
            "<img{class} width=\"{width}\" height=\"{height}\" alt=\"{title}\" src=\"data:image/png;base64,{data}\">"
        ),
    );
}

/// Writing to a string cannot fail.
fn write_to(out: &mut String, text: std::fmt::Arguments<'_>) {
    let _ = out.write_fmt(text);
}

/// Text as it stands between tags or in quotes. Figures stay on a line with their units.
fn escape(text: &str) -> String {
    let text =
        [" ×", "× ", " %", " dB"].iter().fold(text.to_owned(), |t, unit| t.replace(unit, &unit.replace(' ', "\u{a0}")));
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::findings::Column;
    use rilievo::{Grid, Rgba8};

    #[test]
    fn everything_is_escaped_and_inside() {
        let mut findings = Findings::default();
        findings.paper("a < b & \"c\"");
        let mut table = Table::new("x > y", vec![Column::here("n"), Column::paper("<b>")]);
        table.row(vec!["1 & 2".into(), "3".into()]);
        findings.show(table);
        let picture = Grid::filled(2, 1, Rgba8::new(1, 2, 3, 255)).unwrap();
        let mut shots = Shots::new(3);
        shots.add(Shot::new(&picture, "t<t", "").unwrap().enlarged());
        findings.show(shots);
        let part = Part { name: "one", title: "One & all", source: "S", findings: &findings, seconds: 1.0 };
        let page = page("64-bit", &[part]);
        for text in
            ["a &lt; b &amp; &quot;c&quot;", "x &gt; y", "1 &amp; 2", "href=\"#one\"", "One &amp; all", "t&lt;t"]
        {
            assert!(page.contains(text), "{text} in {page}");
        }
        assert!(page.contains("<th scope=\"col\" class=\"paper\">&lt;b&gt;</th>"));
        assert!(page.contains("src=\"data:image/png;base64,iVBORw0KGgo"), "{page}");
        assert!(!page.contains("http") && !page.contains("<script"));
    }
}
