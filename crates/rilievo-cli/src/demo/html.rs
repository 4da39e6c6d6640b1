//! The page that shows the demonstration.

use super::{Entry, Section};

const STYLE: &str = "
:root { color-scheme: light dark; --fg: #2b2320; --bg: #f4efe6; --soft: #7a6c60; --line: #d9cfc0; }
@media (prefers-color-scheme: dark) { :root { --fg: #eee4d8; --bg: #1b1715; --soft: #a8998a; --line: #3a322d; } }
body { margin: 0 auto; max-width: 70rem; padding: 2rem 1rem; background: var(--bg); color: var(--fg);
  font: 1rem/1.55 system-ui, sans-serif; }
h1 { font-size: 2rem; margin: 0; } h2 { margin: 3rem 0 .3rem; border-top: 1px solid var(--line); padding-top: 1rem; }
p { max-width: 46rem; } .soft { color: var(--soft); }
.row { display: flex; flex-wrap: wrap; gap: 1rem; }
figure { margin: 0; flex: 1 1 15rem; max-width: 30rem; min-width: 0; }
img { width: 100%; height: auto; display: block; border-radius: .3rem; }
figcaption { font-size: .85rem; color: var(--soft); margin-top: .3rem; overflow-wrap: anywhere; }
a { color: inherit; }
";

/// The whole page; pictures stand beside it as files.
pub(crate) fn page(sections: &[Section], width: u32, seconds: f64) -> String {
    let body: String = sections.iter().map(section).collect();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>rilievo: a vase from height map to relit surface</title>\n<style>{STYLE}</style>\n\
         <h1>rilievo</h1>\n<p>A vase from height map to relit surface: maps {width} texels wide, every step below in \
         {seconds:.1} s on this machine.</p>\n{body}</html>\n"
    )
}

fn section(section: &Section) -> String {
    let figures: String = section.entries.iter().map(figure).collect();
    format!(
        "<h2>{}</h2>\n<p>{}</p>\n<div class=\"row\">\n{figures}</div>\n",
        escape(section.title),
        escape(&section.text)
    )
}

fn figure(entry: &Entry) -> String {
    let (file, caption) = (escape(&entry.file), escape(&entry.caption));
    let size = format!("{:.1} kB", entry.bytes as f64 / 1000.0);
    let picture = if entry.shown {
        format!("<a href=\"{file}\"><img src=\"{file}\" alt=\"{caption}\" loading=\"lazy\"></a>")
    } else {
        String::new()
    };
    format!("<figure>{picture}<figcaption><a href=\"{file}\">{file}</a>, {size}<br>{caption}</figcaption></figure>\n")
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_unshown_files_are_only_linked() {
        let entry =
            |file: &str, shown| Entry { file: file.into(), bytes: 1500, caption: "a < b & \"c\"".into(), shown };
        let sections = [Section {
            title: "One",
            text: "x > y".into(),
            entries: vec![entry("a.png", true), entry("b.ktx2", false)],
        }];
        let page = page(&sections, 64, 1.0);
        assert!(page.contains("a &lt; b &amp; &quot;c&quot;") && page.contains("x &gt; y"));
        assert!(
            page.contains("<img src=\"a.png\"") && !page.contains("<img src=\"b.ktx2\"") && page.contains("1.5 kB")
        );
    }
}
