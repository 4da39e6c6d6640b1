use crate::runner::Room;
use rilievo_io::{Limits, Source, decode_picture};

fn picture(room: &Room, name: &str) -> rilievo::color::Picture {
    decode_picture(&Source::open(&room.path(name), &Limits::default()).unwrap(), &Limits::default()).unwrap()
}

#[test]
fn light_from_the_left_lights_left_slopes() {
    let room = Room::new();
    room.bump_normals("n.png");
    room.run("quantize n.png -n 256 -o q.png").ok();
    for (light, brighter) in [("-60,20", 12), ("60,20", 28)] {
        room.run(&format!("relight q.png --light {light} -o lit.png")).ok();
        let lit = picture(&room, "lit.png");
        assert!(lit[(brighter, 20)].r > lit[(40 - brighter, 20)].r + 40, "{light}");
    }
    room.run("relight q.png --light 0,70 -o top.png").ok();
    let lit = picture(&room, "top.png");
    assert!(lit[(20, 12)].r > lit[(20, 28)].r + 40, "light from above lights upper slopes");
}

#[test]
fn palette_relight_equals_relighting_the_decoded_picture() {
    let room = Room::new();
    room.bump_normals("n.png");
    room.run("quantize n.png -n 100 -o q.png").ok();
    room.run("quantize n.png -n 100 -o q.ktx2").ok();
    let light = "--light -30,40,ffcc99 --light 100,10,3060ff*0.7 --ambient 101010";
    room.run(&format!("relight q.png {light} -o by_palette.png")).ok();
    room.run(&format!("relight q.ktx2 {light} -o by_pixel.png")).ok();
    assert_eq!(picture(&room, "by_palette.png"), picture(&room, "by_pixel.png"));
    // Only the palette and its checksum differ.
    let (before, after) = (room.read("q.png"), room.read("by_palette.png"));
    assert_eq!(before.len(), after.len());
    let differing: Vec<usize> = (0..before.len()).filter(|&i| before[i] != after[i]).collect();
    let palette = before.windows(4).position(|w| w == b"PLTE").unwrap() + 4;
    let end = palette + 3 * 100 + 4;
    assert!(differing.iter().all(|i| (palette..end).contains(i)) && differing.len() > 50);
}

#[test]
fn frames_turn_the_light() {
    let room = Room::new();
    room.bump_normals("n.png");
    room.run("quantize n.png -n 16 -o q.png").ok();
    room.run("relight q.png --frames 4 -o turning.png").ok();
    let bytes = room.read("turning.png");
    assert_eq!(bytes.windows(4).filter(|w| w == b"fcTL").count(), 4);
}

#[test]
fn other_files_are_refused_by_name() {
    let room = Room::new();
    room.bump("height.png");
    room.run("relight height.png").fails(4, &["height.png"]);
    room.write("empty.png", b"");
    room.run("relight empty.png").fails(4, &["empty.png"]);
    room.run("relight nothing.png").fails(3, &["nothing.png"]);
}
