//! The groups of an HDF5 file, checked before NetCDF-4 is made of them.
//!
//! Links may give a group several names, also names inside itself, so that groups form a graph. The reader of NetCDF-4
//! unrolls it into a tree. The check visits each group once and computes the size of that tree: with S(g) the objects
//! below a group g and its own data sets d(g),
//!
//! S(g) = 1 + d(g) + sum of S over the links to groups in g.
//!
//! A group below itself has no finite tree: such a file is refused. So is a file whose tree is deeper or larger than that of
//! any measured surface.

use std::collections::HashMap;
use std::sync::Arc;

use hdf5_reader::group::Group;
use hdf5_reader::{Hdf5File, OpenOptions};

use super::{Problem, Result};

/// Most groups inside each other.
const DEEPEST: usize = 32;
/// Most objects of the tree.
const MOST: u64 = 20_000;
/// Every group knows the dimensions of those around it: most of them, summed over all groups of the tree.
const MOST_DIMENSIONS: u64 = 4_000_000;

/// Refuses groups that link to a group around them, and trees that are too large.
pub(super) fn check(bytes: Arc<[u8]>, options: OpenOptions) -> Result<()> {
    let file = Hdf5File::from_shared_bytes_with_options(bytes, options)
        .map_err(|error| broken("the file", error))?;
    let mut walk = Walk::default();
    let tree = walk.visit(&file.root_group().map_err(|error| broken("the file", error))?, 0)?;
    if tree.dimensions > MOST_DIMENSIONS {
        return Err(too_large());
    }
    Ok(())
}

/// The tree below a group.
#[derive(Clone, Copy)]
struct Tree {
    groups: u64,
    objects: u64,
    /// Data sets that could be dimensions, counted once for each group that they are visible in.
    dimensions: u64,
}

#[derive(Default)]
struct Walk {
    /// By the address of the group; `None` for one whose tree is not complete.
    trees: HashMap<u64, Option<Tree>>,
}

impl Walk {
    fn visit(&mut self, group: &Group, depth: usize) -> Result<Tree> {
        let name = if group.name().is_empty() { "/" } else { group.name() };
        match self.trees.get(&group.address()) {
            Some(Some(tree)) => return Ok(*tree),
            Some(None) => {
                let loops = format!("{name:?}, a link to a group that it lies in");
                return Err(Problem::malformed("a group of the file", loops, NO_LOOPS));
            }
            None => {}
        }
        if depth > DEEPEST {
            let deep = format!("more than {DEEPEST} groups deep");
            return Err(Problem::malformed("the tree of the groups", deep, COPY));
        }
        self.trees.insert(group.address(), None);
        let (groups, sets) = group.members().map_err(|error| broken("the file", error))?;
        let sets = sets.len() as u64;
        let mut tree = Tree { groups: 1, objects: 1 + sets, dimensions: 0 };
        for inner in &groups {
            let inner = self.visit(inner, depth + 1)?;
            tree.groups = tree.groups.saturating_add(inner.groups);
            tree.objects = tree.objects.saturating_add(inner.objects);
            tree.dimensions = tree.dimensions.saturating_add(inner.dimensions);
            if tree.objects > MOST {
                return Err(too_large());
            }
        }
        tree.dimensions = tree.dimensions.saturating_add(tree.groups.saturating_mul(sets));
        if tree.objects > MOST {
            return Err(too_large());
        }
        self.trees.insert(group.address(), Some(tree));
        Ok(tree)
    }
}

const NO_LOOPS: &str =
    "a group below the one that links to it; remove the link or copy the map into a file of its own";
const COPY: &str = "no larger than that of measured heights; copy the map into a file of its own";

fn too_large() -> Problem {
    let many = format!("of more than {MOST} groups and data sets, each counted under all of its names");
    Problem::malformed("the tree of the groups", many, COPY)
}

pub(super) fn broken(what: &str, error: impl std::fmt::Display) -> Problem {
    let error = error.to_string();
    // The library names filters and features that it does not know.
    if error.contains("unsupported") {
        return Problem::unsupported(
            format!("{what} ({error})"),
            "save it without filters or with gzip alone",
        );
    }
    Problem::malformed(what, error, "whole, undamaged NetCDF or HDF5")
}
