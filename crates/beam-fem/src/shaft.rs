//! Shafts of several spans, uniform or tapered.

use crate::error::positive;
use crate::mesh::check_elements;
use crate::{BeamError, CrossSection, Material, Mesh, SectionShape};

/// Section along a span or an element.
#[derive(Clone, Debug, PartialEq)]
enum Profile {
    Uniform(CrossSection),
    Tapered {
        from: SectionShape,
        to: SectionShape,
    },
}

/// A piece of shaft of one material, cut into equal elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    length: f64,
    elements: usize,
    profile: Profile,
    material: Material,
}

impl Span {
    /// A span of `length` metres and one section, in `elements` equal elements.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] for a length that is not finite and above zero,
    /// [`BeamError::Elements`] for none or over [`Mesh::MAX_ELEMENTS`].
    pub fn uniform(
        length: f64,
        elements: usize,
        section: CrossSection,
        material: Material,
    ) -> Result<Self, BeamError> {
        positive("length", length)?;
        check_elements(elements, 1)?;
        Ok(Self {
            length,
            elements,
            profile: Profile::Uniform(section),
            material,
        })
    }

    /// A span of `length` metres whose dimensions run linearly between the two
    /// shapes of `ends`. Each element has the exact static displacements of the
    /// taper, so deflections of nodes under forces at nodes are exact on any mesh.
    ///
    /// # Errors
    /// As [`Span::uniform`] and [`SectionShape::section`]; [`BeamError::Taper`] for ends
    /// of different kinds.
    pub fn tapered(
        length: f64,
        elements: usize,
        ends: [SectionShape; 2],
        material: Material,
    ) -> Result<Self, BeamError> {
        let [from, to] = ends;
        let start = from.section(&material)?;
        to.section(&material)?;
        from.between(&to, 0.5)?.section(&material)?;
        let span = Self::uniform(length, elements, start, material)?;
        Ok(Self {
            profile: Profile::Tapered { from, to },
            ..span
        })
    }
}

/// One element of a shaft.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ShaftElement {
    pub length: f64,
    pub material: Material,
    profile: Profile,
}

impl ShaftElement {
    /// The section, if the element has a single one.
    pub fn uniform(&self) -> Option<&CrossSection> {
        match &self.profile {
            Profile::Uniform(section) => Some(section),
            Profile::Tapered { .. } => None,
        }
    }

    /// The section at `share` (0 to 1) of the length.
    pub fn section_at(&self, share: f64) -> Result<CrossSection, BeamError> {
        match &self.profile {
            Profile::Uniform(section) => Ok(section.clone()),
            Profile::Tapered { from, to } => from.between(to, share)?.section(&self.material),
        }
    }
}

/// A straight shaft: spans from x = 0 on, one after the other, the last node of
/// each the first of the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Shaft {
    mesh: Mesh,
    elements: Vec<ShaftElement>,
}

impl Shaft {
    /// Joins spans.
    ///
    /// # Errors
    /// [`BeamError::Empty`] for no span, [`BeamError::Elements`] for more elements
    /// than [`Mesh::MAX_ELEMENTS`], [`BeamError::Spacing`] and [`BeamError::Node`]
    /// for lengths so different that nodes fall together.
    pub fn new(spans: &[Span]) -> Result<Self, BeamError> {
        if spans.is_empty() {
            return Err(BeamError::Empty { field: "spans" });
        }
        let count = spans.iter().map(|s| s.elements);
        check_elements(count.fold(0, usize::saturating_add), 1)?;
        let (mut nodes, mut elements) = (vec![0.0], Vec::new());
        let mut start = 0.0;
        for span in spans {
            for index in 0..span.elements {
                let share = |i: usize| i as f64 / span.elements as f64;
                let (low, high) = (share(index), share(index + 1));
                let profile = match &span.profile {
                    Profile::Uniform(section) => Profile::Uniform(section.clone()),
                    Profile::Tapered { from, to } => Profile::Tapered {
                        from: from.between(to, low)?,
                        to: from.between(to, high)?,
                    },
                };
                elements.push(ShaftElement {
                    length: span.length / span.elements as f64,
                    material: span.material.clone(),
                    profile,
                });
                nodes.push(start + span.length * high);
            }
            start += span.length;
        }
        let mesh = Mesh::from_nodes(nodes)?;
        Ok(Self { mesh, elements })
    }

    /// A shaft of one section on any mesh.
    pub fn on_mesh(section: &CrossSection, material: &Material, mesh: Mesh) -> Self {
        let element = |length| ShaftElement {
            length,
            material: material.clone(),
            profile: Profile::Uniform(section.clone()),
        };
        let elements = mesh.lengths().map(element).collect();
        Self { mesh, elements }
    }

    /// Nodes and lengths.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    pub(crate) fn elements(&self) -> &[ShaftElement] {
        &self.elements
    }
}
