//! Figure 3 of Tarini et al.: the same object with ever more normals in its table.

use anyhow::Result;
use rilievo::Progress;
use rilievo::light::Material;
use rilievo::measure::{DEFAULT_PIXELS_PER_DEGREE, flip_mean};
use rilievo::quantize::{Dither, fejes_toth_rms_rad};
use rilievo::raster::{Detail, Method};

use crate::reproduce::Kit;
use crate::reproduce::findings::{Column, Findings, Shot, Shots, Table};
use crate::reproduce::page::{Axis, Plot, Series};
use crate::reproduce::subjects::{Cover, Vase, psnr_of_covered, shoot};

/// The paper's eight sizes.
const ENTRIES: [u32; 8] = [16, 32, 64, 128, 256, 512, 1024, 2048];

pub(crate) fn run(kit: &Kit<'_>) -> Result<Findings> {
    let vase = kit.vase()?;
    let materials = [Material::MATTE_WHITE];
    let size = Vase::picture_size(kit.size);
    let take = |detail: Detail<'_>, method| {
        shoot(&vase.scene(detail, &materials, Cover::None, Vase::one_light(), 0.75)?, method, size)
    };
    kit.bars.begin("tables of 16 to 2048 normals", ENTRIES.len() as u64 + 1);
    let exact = take(vase.exact(), Method::Exact)?;
    let unquantized = vase.shoot_unquantized(&materials, &Vase::one_light(), size)?;
    let limit = psnr_of_covered(&exact, &unquantized)?;
    let limit_flip = flip_mean(&exact.picture, &unquantized.picture, DEFAULT_PIXELS_PER_DEGREE)?;
    kit.bars.advance(1);

    let mut found = Findings::default();
    found.paper(
        "The bunny with 16, 32, 64 … 2048 normals under ambient and Lambert light: 256 are told to be the least that will do, 2048 to \
         be excellent. There are pictures and no figures.",
    );
    found.here(
        "The vase in white, its two materials taken for one, under the same kind of light. Angles are those between the normals of \
         all texels and their entries. Pictures are compared with per-pixel shading of the normals as they are, over the pixels the vase covers \
         (PSNR) and all over (FLIP, 0 is the same).",
    );
    let mut table = Table::new(
        "Error over the number of entries. The bound is that of normals spread evenly over the sphere; the estimate is what Zador's \
         theorem expects of the best table for the vase's own.",
        ["entries", "RMS, °", "largest, °", "bound, °", "estimate, °", "PSNR, dB", "FLIP"].map(Column::here).to_vec(),
    );
    let mut shots = Shots::new(3);
    let [mut measured, mut bounds, mut estimates] = [const { Vec::new() }; 3];
    for entries in ENTRIES {
        let quantized = vase.quantized(entries, Dither::None)?;
        let shown = take(Detail::Indexed(&quantized.map), Method::Table)?;
        let rms = quantized.error.rms_rad.to_degrees();
        let (bound, estimate) = (fejes_toth_rms_rad(entries).to_degrees(), quantized.zador_rms_rad.to_degrees());
        let psnr = psnr_of_covered(&exact, &shown)?;
        let flip = flip_mean(&exact.picture, &shown.picture, DEFAULT_PIXELS_PER_DEGREE)?;
        found.figure(format!("{entries}_rms_deg"), rms);
        found.figure(format!("{entries}_psnr_db"), psnr);
        found.figure(format!("{entries}_flip_mean"), flip);
        table.row(vec![
            entries.to_string(),
            format!("{rms:.2}"),
            format!("{:.1}", quantized.error.max_rad.to_degrees()),
            format!("{bound:.2}"),
            format!("{estimate:.2}"),
            format!("{psnr:.1}"),
            format!("{flip:.3}"),
        ]);
        let x = f64::from(entries);
        measured.push([x, rms]);
        bounds.push([x, bound]);
        estimates.push([x, estimate]);
        shots.add(Shot::new(&shown.picture, format!("{entries} normals"), format!("{rms:.2}° RMS, {psnr:.1} dB"))?);
        kit.bars.advance(1);
    }
    shots.add(Shot::new(&exact.picture, "exact", "per-pixel shading, not quantised")?);
    found.figure("unquantised_psnr_db", limit);
    found.figure("unquantised_flip_mean", limit_flip);
    let mut last = vec!["one for each texel".to_owned(), "0.00".to_owned(), "0.0".to_owned()];
    last.extend(["–".to_owned(), "–".to_owned(), format!("{limit:.1}"), format!("{limit_flip:.3}")]);
    table.row(last);
    let is_under = measured.iter().zip(&bounds).all(|(m, b): (&[f64; 2], &[f64; 2])| m[1] < b[1]);
    let under = if is_under {
        " The vase's normals do not go evenly around the sphere, so that its error lies under the bound of those that do."
    } else {
        ""
    };
    let halved = measured[0][1] / measured[ENTRIES.len() - 1][1];
    let first_good = ENTRIES.iter().zip(&measured).find(|(_, m)| m[1] < 3.0).map_or(0, |(&k, _)| k);
    found.show(table);
    found.show(shots);
    let series = vec![
        Series::measured("measured", measured),
        Series::computed("bound, even over the sphere", bounds),
        Series::computed("Zador's estimate for this map", estimates),
    ];
    let caption = "RMS angle between normals and their entries, in degrees. It falls with the root of the number of entries, as in the plane.";
    found.show(Plot::new(caption, Axis::doublings("entries"), Axis::decades("degrees"), series));
    found.remark(format!(
        "The series looks as the paper's does: facets up to 128, faint ones at 256, none that one sees from 1024 on. From 16 to 2048 entries the \
         error falls to 1/{halved:.1}; the root of 128 is 11.3. It is below 3° from {first_good} entries on.{under}"
    ));
    found.remark(format!(
        "The picture does not come as near as the normals do: a table with an entry for each texel would stop at {limit:.1} dB. That rest is not \
         the quantiser's: the method mixes lit colours, per-pixel shading mixes normals and lights their mean, and where the relief is fine the two \
         differ."
    ));
    Ok(found)
}
