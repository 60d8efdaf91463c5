//! Splitting of vertices: one source vertex (a position) becomes a vertex for each set of
//! attributes.

/// For each source, the list of the vertices that were made from it.
#[derive(Debug, Default)]
pub(super) struct VertexCopies {
    /// The newest vertex of each source.
    newest: Vec<u32>,
    /// The vertex made before this one from the same source.
    before: Vec<u32>,
    /// The source of each vertex.
    sources: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl VertexCopies {
    /// Longer lists are not searched to their end. A vertex may then exist twice, which is
    /// harmless, but a hostile file with all attributes at one position takes linear time.
    const MAX_STEPS: usize = 64;

    /// No vertices, of `source_count` sources.
    pub(super) fn new(source_count: usize) -> Self {
        Self {
            newest: vec![NONE; source_count],
            before: Vec::new(),
            sources: Vec::new(),
        }
    }

    /// Each source is the vertex of its own number.
    pub(super) fn identity(source_count: u32) -> Self {
        let sources: Vec<u32> = (0..source_count).collect();
        Self {
            newest: sources.clone(),
            before: vec![NONE; sources.len()],
            sources,
        }
    }

    /// The source of each vertex.
    pub(super) fn sources(&self) -> &[u32] {
        &self.sources
    }

    /// The vertex of `source` that satisfies `is_same`, or a new one; also returns true if it is
    /// new.
    #[inline]
    pub(super) fn find_or_add(
        &mut self,
        source: u32,
        is_same: impl Fn(usize) -> bool,
    ) -> (u32, bool) {
        let newest = self.newest[source as usize];
        let mut vertex = newest;
        for _ in 0..Self::MAX_STEPS {
            if vertex == NONE {
                break;
            }
            if is_same(vertex as usize) {
                return (vertex, false);
            }
            vertex = self.before[vertex as usize];
        }
        let added = u32::try_from(self.sources.len()).expect("limits keep vertices below 2^32");
        self.newest[source as usize] = added;
        self.before.push(newest);
        self.sources.push(source);
        (added, true)
    }

    /// Removes all vertices, in time that depends on their number only.
    pub(super) fn clear(&mut self) {
        for &source in &self.sources {
            self.newest[source as usize] = NONE;
        }
        self.before.clear();
        self.sources.clear();
    }
}
