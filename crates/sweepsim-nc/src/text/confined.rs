//! Files that must be within a folder.

use std::path::{Component, Path, PathBuf};

/// Whether a file is within a folder, or would be if it existed: neither `..` nor links lead out of it. Without a folder
/// every file is.
#[must_use]
pub fn is_within(file: &Path, folder: Option<&Path>) -> bool {
    let Some(folder) = folder else { return true };
    let (Ok(folder), Ok(here)) = (folder.canonicalize(), std::env::current_dir()) else {
        return false;
    };
    match file.canonicalize() {
        Ok(file) => file.starts_with(&folder),
        // Nothing can be read there. Whether there is something elsewhere is not told.
        Err(_) => resolved(&here.join(file)).is_some_and(|file| file.starts_with(&folder)),
    }
}

/// A path without `..`, with the links of the folders that exist followed.
fn resolved(path: &Path) -> Option<PathBuf> {
    let mut found = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                found.pop();
            }
            part => found.push(part),
        }
        // A link whose end is missing leads to a place that is not known.
        match found.canonicalize() {
            Ok(real) => found = real,
            Err(_) if found.is_symlink() => return None,
            Err(_) => {}
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_leads_out() {
        let folder = std::env::temp_dir().join(format!("sweepsim-within-{}", std::process::id()));
        let root = folder.join("root");
        std::fs::create_dir_all(root.join("in")).unwrap();
        std::fs::write(root.join("a"), "").unwrap();
        std::fs::write(folder.join("secret"), "").unwrap();
        let within = |name: &str| is_within(&root.join(name), Some(&root));
        for inside in ["a", "in/../a", "missing", "in/missing", "missing/../a", "./a"] {
            assert!(within(inside), "{inside}");
        }
        for outside in [
            "../secret",
            "../missing",
            "in/../../secret",
            "missing/../../secret",
            "/etc/passwd",
            "/missing",
        ] {
            assert!(!within(outside), "{outside}");
        }
        #[cfg(unix)]
        {
            use std::os::unix::fs::symlink;
            symlink("../secret", root.join("link")).unwrap();
            symlink("..", root.join("up")).unwrap();
            symlink("../gone", root.join("dangling")).unwrap();
            symlink("a", root.join("same")).unwrap();
            for outside in ["link", "up/secret", "up/missing", "dangling"] {
                assert!(!within(outside), "{outside}");
            }
            assert!(within("same") && within("up/root/a"));
        }
        assert!(is_within(Path::new("/etc/passwd"), None));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
