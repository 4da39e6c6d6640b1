//! One table of a scene file: keys are asked for one by one, and whatever is wrong is told with its line.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, Result};
use clap::ValueEnum;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::args::{Given, SizeArg};
use crate::exit::BadInput;

/// A scene file.
pub(super) struct Text<'t> {
    name: String,
    folder: &'t Path,
    text: &'t str,
    /// Every key that was asked for, with the kind of table: what the documentation has to describe.
    asked: RefCell<BTreeSet<(&'static str, &'static str)>>,
}

impl<'t> Text<'t> {
    pub(super) fn new(path: &'t Path, text: &'t str) -> Self {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self { name: path.display().to_string(), folder, text, asked: RefCell::default() }
    }

    /// Parses it: the table of the whole file.
    pub(super) fn parse(&self) -> Result<Spanned<DeTable<'_>>> {
        DeTable::parse(self.text).map_err(|e| {
            let place = self.place(e.span().map_or(0, |span| span.start));
            BadInput(format!("{place}: {}", e.message())).into()
        })
    }

    /// `file:line` of a byte.
    fn place(&self, byte: usize) -> String {
        let before = &self.text.as_bytes()[..byte.min(self.text.len())];
        format!("{}:{}", self.name, 1 + before.iter().filter(|&&b| b == b'\n').count())
    }

    /// The kinds of tables and keys that were asked for so far.
    #[cfg(test)]
    pub(super) fn asked(&self) -> BTreeSet<(&'static str, &'static str)> {
        self.asked.borrow().clone()
    }
}

/// A table, or the whole file.
pub(super) struct Section<'t> {
    text: &'t Text<'t>,
    table: &'t DeTable<'t>,
    /// Where it begins.
    start: usize,
    /// What it is called in messages and in the documentation: `[[objects]]`.
    kind: &'static str,
    asked: Vec<&'static str>,
}

impl<'t> Section<'t> {
    /// The whole file.
    pub(super) fn root(text: &'t Text<'t>, table: &'t DeTable<'t>) -> Self {
        Self { text, table, start: 0, kind: "the scene", asked: Vec::new() }
    }

    fn find(&mut self, key: &'static str) -> Option<(&'t Spanned<DeValue<'t>>, Range<usize>)> {
        self.asked.push(key);
        self.text.asked.borrow_mut().insert((self.kind, key));
        let (name, value) = self.table.iter().find(|(name, _)| name.get_ref() == key)?;
        Some((value, name.span()))
    }

    /// An error about a key, or about the table if the key is not there.
    pub(super) fn wrong(&self, key: &str, what: impl std::fmt::Display) -> anyhow::Error {
        BadInput(format!("{} {what}", self.called(key))).into()
    }

    /// `scene.toml:12: `depth``, or the table's place if the key is not there.
    pub(super) fn called(&self, key: &str) -> String {
        let key_start = self.table.keys().find(|name| name.get_ref() == key).map(|name| name.span().start);
        format!("{}: `{key}`", self.text.place(key_start.unwrap_or(self.start)))
    }

    /// `scene.toml:12`: where the table begins.
    pub(super) fn place(&self) -> String {
        self.text.place(self.start)
    }

    /// Whether the key is there.
    pub(super) fn has(&self, key: &str) -> bool {
        self.table.keys().any(|name| name.get_ref() == key)
    }

    /// A number within a range.
    pub(super) fn number(&mut self, key: &'static str, range: RangeInclusive<f32>) -> Result<Option<f32>> {
        let Some((value, _)) = self.find(key) else { return Ok(None) };
        self.within(key, value, &range).map(Some)
    }

    fn within(&self, key: &str, value: &Spanned<DeValue<'_>>, range: &RangeInclusive<f32>) -> Result<f32> {
        let found = number(value.get_ref()).ok_or_else(|| self.wrong(key, "must be a number"))?;
        let (low, high) = (range.start(), range.end());
        if range.contains(&found) {
            return Ok(found);
        }
        Err(self.wrong(key, format_args!("is {found}; it must be a number from {low} to {high}")))
    }

    /// A list of numbers, each within a range.
    pub(super) fn numbers<const N: usize>(
        &mut self,
        key: &'static str,
        range: RangeInclusive<f32>,
    ) -> Result<Option<[f32; N]>> {
        let Some((value, _)) = self.find(key) else { return Ok(None) };
        let list = value.get_ref().as_array().filter(|list| list.len() == N);
        let list = list.ok_or_else(|| self.wrong(key, format_args!("must be a list of {N} numbers")))?;
        let mut numbers = [0.0; N];
        for (number, value) in numbers.iter_mut().zip(list.iter()) {
            *number = self.within(key, value, &range)?;
        }
        Ok(Some(numbers))
    }

    /// A whole number within a range.
    pub(super) fn whole(&mut self, key: &'static str, range: RangeInclusive<u32>) -> Result<Option<u32>> {
        let Some((value, _)) = self.find(key) else { return Ok(None) };
        let (low, high) = (range.start(), range.end());
        let expected = format!("must be a whole number from {low} to {high}");
        let found = whole(value.get_ref()).ok_or_else(|| self.wrong(key, &expected))?;
        let fitting = u32::try_from(found).ok().filter(|n| range.contains(n));
        fitting.map(Some).ok_or_else(|| self.wrong(key, format_args!("is {found}; it {expected}")))
    }

    /// Width and height in pixels or texels.
    pub(super) fn size(&mut self, key: &'static str) -> Result<Option<SizeArg>> {
        let Some((value, _)) = self.find(key) else { return Ok(None) };
        let form = || self.wrong(key, "must be a list of two whole numbers, width and height, as in [640, 480]");
        let sides = value.get_ref().as_array().ok_or_else(form)?;
        let side = |value: &Spanned<DeValue<'_>>| whole(value.get_ref()).and_then(|n| u32::try_from(n).ok());
        let [Some(width), Some(height)] = sides.iter().map(side).collect::<Vec<_>>()[..] else { return Err(form()) };
        rilievo::grid::check_size(width.into(), height.into())
            .map_err(|e| self.wrong(key, format_args!("is too large or empty: {e}")))?;
        Ok(Some(SizeArg { width, height }))
    }

    /// `true` or `false`.
    pub(super) fn flag(&mut self, key: &'static str) -> Result<Option<bool>> {
        let Some((value, _)) = self.find(key) else { return Ok(None) };
        value.get_ref().as_bool().map(Some).ok_or_else(|| self.wrong(key, "must be true or false"))
    }

    /// A text.
    pub(super) fn text(&mut self, key: &'static str) -> Result<Option<&'t str>> {
        let Some((value, _)) = self.find(key) else { return Ok(None) };
        value.get_ref().as_str().map(Some).ok_or_else(|| self.wrong(key, "must be a text in quotes"))
    }

    /// A text that is read as on the command line.
    pub(super) fn parsed<T: FromStr<Err = String>>(&mut self, key: &'static str) -> Result<Option<T>> {
        let Some(text) = self.text(key)? else { return Ok(None) };
        text.parse().map(Some).map_err(|e| self.wrong(key, format_args!("is wrong: {e}")))
    }

    /// One of some names, spelled as on the command line.
    pub(super) fn choice<T: ValueEnum>(&mut self, key: &'static str) -> Result<Option<T>> {
        let Some(text) = self.text(key)? else { return Ok(None) };
        T::from_str(text, false).map(Some).map_err(|_| {
            let values = T::value_variants().iter().filter_map(ValueEnum::to_possible_value);
            let names: Vec<String> = values.map(|v| v.get_name().to_owned()).collect();
            self.wrong(key, format_args!("is '{text}'; it must be one of {}", names.join(", ")))
        })
    }

    /// A file beside the scene file, or under a path of its own, that is there.
    pub(super) fn file(&mut self, key: &'static str) -> Result<Option<PathBuf>> {
        let Some(text) = self.text(key)? else { return Ok(None) };
        let path = self.text.folder.join(text);
        let found = std::fs::metadata(&path);
        found.with_context(|| format!("{}: {} cannot be read", self.called(key), path.display()))?;
        Ok(Some(path))
    }

    /// A path relative to the scene file, whether or not there is something.
    pub(super) fn path(&mut self, key: &'static str) -> Result<Option<PathBuf>> {
        Ok(self.text(key)?.map(|text| self.text.folder.join(text)))
    }

    /// A table of its own.
    pub(super) fn section(&mut self, key: &'static str, kind: &'static str) -> Result<Option<Self>> {
        let Some((value, name)) = self.find(key) else { return Ok(None) };
        let table = value.get_ref().as_table().ok_or_else(|| self.wrong(key, "must be a table"))?;
        Ok(Some(Self { text: self.text, table, start: name.start, kind, asked: Vec::new() }))
    }

    /// A list of tables.
    pub(super) fn sections(&mut self, key: &'static str, kind: &'static str) -> Result<Option<Vec<Self>>> {
        let Some(items) = self.items(key)? else { return Ok(None) };
        let table = |item: Item<'t>| item.section(kind).ok_or_else(|| self.wrong(key, "must be a list of tables"));
        items.into_iter().map(table).collect::<Result<_>>().map(Some)
    }

    /// A list of anything.
    pub(super) fn items(&mut self, key: &'static str) -> Result<Option<Vec<Item<'t>>>> {
        let Some((value, _)) = self.find(key) else { return Ok(None) };
        let list = value.get_ref().as_array().ok_or_else(|| self.wrong(key, "must be a list"))?;
        Ok(Some(list.iter().map(|value| Item { text: self.text, value }).collect()))
    }

    /// Tables by names that are the user's.
    pub(super) fn named(&mut self, key: &'static str, kind: &'static str) -> Result<Vec<(&'t str, Self)>> {
        let Some(parent) = self.section(key, kind)? else { return Ok(Vec::new()) };
        let entries = parent.table.iter().map(|(name, value)| {
            let table = value.get_ref().as_table();
            let table = table.ok_or_else(|| parent.wrong(name.get_ref(), "must be a table"))?;
            let start = name.span().start;
            Ok((name.get_ref().as_ref(), Self { text: self.text, table, start, kind, asked: Vec::new() }))
        });
        entries.collect()
    }

    /// Keys that are there, by the names that flags have, for messages about what plays no part.
    pub(super) fn given(&self, names: &[(&str, &str)]) -> Given {
        let mut given = Given::default();
        for (key, flag) in names.iter().filter(|(key, _)| self.has(key)) {
            given.add(flag, self.called(key));
        }
        given
    }

    /// Fails if there is a key that nobody asked for.
    pub(super) fn finish(self) -> Result<()> {
        let unknown = self.table.keys().filter(|name| !self.asked.contains(&name.get_ref().as_ref()));
        let Some(first) = unknown.min_by_key(|name| name.span().start) else { return Ok(()) };
        let kind = self.kind;
        Err(self.wrong(first.get_ref(), format_args!("is not a key of {kind}; there are {}", self.asked.join(", "))))
    }
}

/// One value of a list.
pub(super) struct Item<'t> {
    text: &'t Text<'t>,
    value: &'t Spanned<DeValue<'t>>,
}

impl<'t> Item<'t> {
    /// As a text.
    pub(super) fn text(&self) -> Option<&'t str> {
        self.value.get_ref().as_str()
    }

    /// As numbers and texts of a list.
    pub(super) fn list(&self) -> Option<Vec<Self>> {
        let list = self.value.get_ref().as_array()?;
        Some(list.iter().map(|value| Self { text: self.text, value }).collect())
    }

    /// As a number.
    pub(super) fn number(&self) -> Option<f32> {
        number(self.value.get_ref())
    }

    /// As a table.
    pub(super) fn section(&self, kind: &'static str) -> Option<Section<'t>> {
        let table = self.value.get_ref().as_table()?;
        Some(Section { text: self.text, table, start: self.value.span().start, kind, asked: Vec::new() })
    }

    /// An error about it.
    pub(super) fn wrong(&self, what: impl std::fmt::Display) -> anyhow::Error {
        BadInput(format!("{}: {what}", self.text.place(self.value.span().start))).into()
    }
}

/// A finite number, with or without a decimal point.
fn number(value: &DeValue<'_>) -> Option<f32> {
    let found = match value {
        DeValue::Float(float) => float.as_str().parse().ok()?,
        _ => whole(value)? as f32,
    };
    Some(found).filter(|v: &f32| v.is_finite())
}

/// A whole number.
fn whole(value: &DeValue<'_>) -> Option<i64> {
    value.as_integer().and_then(|integer| i64::from_str_radix(integer.as_str(), integer.radix()).ok())
}
