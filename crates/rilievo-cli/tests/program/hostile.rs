//! Damaged inputs through the program: a message and an exit code, never a panic, never a partial output.

use std::path::Path;

use crate::runner::Room;

#[test]
fn every_malformed_file_ends_in_a_message_or_a_result() {
    let Some(folder) = testkit::shared_file("malformed") else { return };
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let extension = path.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default();
        let room = Room::new();
        let said = match extension.as_str() {
            "png" | "jpg" | "hdr" => {
                room.run_with(&[Path::new("normal"), &path, "-o".as_ref(), "out.png".as_ref()], b"")
            }
            "obj" | "ply" | "glb" | "gltf" => {
                let args = ["render", "--method", "exact", "--size", "24", "-o", "out.png"].map(Path::new);
                room.run_with(&[&args[..], &[&path]].concat(), b"")
            }
            _ => continue,
        };
        seen += 1;
        assert!(!said.stderr.contains("panicked"), "{}: {}", path.display(), said.stderr);
        assert!([0, 3, 4, 5].contains(&said.code), "{}: {} {}", path.display(), said.code, said.stderr);
        if said.code != 0 {
            let name = path.file_name().unwrap().to_string_lossy();
            assert!(said.stderr.contains(&*name), "{name} is not named: {}", said.stderr);
            assert!(room.files().is_empty(), "{name} left {:?}", room.files());
        }
    }
    assert!(seen > 80, "{seen}");
}

#[test]
fn a_folder_a_closed_pipe_and_an_unwritable_place() {
    let room = Room::new();
    std::fs::create_dir(room.path("folder.png")).unwrap();
    room.run("normal folder.png").fails(3, &["folder.png"]);
    room.bump("hill.png");
    room.run("normal hill.png -o no/such/folder/n.png").fails(3, &["no/such/folder"]);
    #[cfg(target_os = "linux")]
    room.run("normal hill.png -o /dev/full").fails(3, &["/dev/full"]);
}
