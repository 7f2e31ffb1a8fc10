//! A pencil that falls apart into independent ones.
//!
//! In a straight beam, stretch, twist and bending in two planes do not know
//! of each other. Each is then a problem of its own with a narrow band and no
//! pairs of equal frequencies; springs that couple them join them again.

use crate::banded::SymmetricBanded;

/// One independent part: its rows in the whole pencil, and its matrices.
pub(crate) struct Component {
    pub dofs: Vec<usize>,
    pub mass: SymmetricBanded,
    pub stiffness: SymmetricBanded,
}

/// The connected components of the graph of non-zero entries, each with its
/// rows ascending; ordered by their first row.
pub(crate) fn split(mass: &SymmetricBanded, stiffness: &SymmetricBanded) -> Vec<Component> {
    let order = mass.order();
    let mut parent: Vec<usize> = (0..order).collect();
    for matrix in [mass, stiffness] {
        for j in 0..order {
            let neighbours = matrix.column(j).iter().enumerate().skip(1);
            for (distance, _) in neighbours.filter(|(_, value)| **value != 0.0) {
                join(&mut parent, j, j + distance);
            }
        }
    }
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut group_of_root = vec![usize::MAX; order];
    for dof in 0..order {
        let root = root(&mut parent, dof);
        if group_of_root[root] == usize::MAX {
            group_of_root[root] = groups.len();
            groups.push(Vec::new());
        }
        groups[group_of_root[root]].push(dof);
    }
    let component = |dofs: Vec<usize>| Component {
        mass: mass.select(&dofs),
        stiffness: stiffness.select(&dofs),
        dofs,
    };
    groups.into_iter().map(component).collect()
}

fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}

/// The lower root wins, so that roots are first rows.
fn join(parent: &mut [usize], i: usize, j: usize) {
    let (a, b) = (root(parent, i), root(parent, j));
    parent[a.max(b)] = a.min(b);
}
