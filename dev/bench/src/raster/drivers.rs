//! Where software Vulkan drivers lie.

use std::path::{Path, PathBuf};

/// A software GPU.
pub(super) struct Driver {
    pub(super) name: &'static str,
    /// How it is had on Debian and Ubuntu.
    pub(super) install: &'static str,
    folders: &'static [&'static str],
    /// How the name of its manifest begins.
    manifest: &'static str,
}

pub(super) const DRIVERS: [Driver; 2] = [
    Driver {
        name: "lavapipe",
        install: "apt-get install --no-install-recommends mesa-vulkan-drivers libvulkan1",
        folders: &["/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d"],
        manifest: "lvp_icd",
    },
    Driver {
        name: "swiftshader",
        install: "apt-get install --no-install-recommends chromium libvulkan1",
        folders: &["/usr/lib/chromium", "/usr/lib/chromium-browser", "/opt/google/chrome"],
        manifest: "vk_swiftshader_icd",
    },
];

impl Driver {
    /// Its manifest, if it is installed.
    pub(super) fn find(&self) -> Option<PathBuf> {
        self.folders.iter().find_map(|folder| {
            let entries = Path::new(folder).read_dir().ok()?;
            let mut paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
            paths.find(|path| {
                let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
                name.starts_with(self.manifest) && name.ends_with(".json")
            })
        })
    }

    /// The environment that makes a process find this driver and no other, with one worker thread.
    pub(super) fn environment(manifest: &Path) -> [(&'static str, String); 3] {
        let manifest = manifest.display().to_string();
        // The second name is the older loaders'.
        [("VK_DRIVER_FILES", manifest.clone()), ("VK_ICD_FILENAMES", manifest), ("LP_NUM_THREADS", "1".to_owned())]
    }
}
