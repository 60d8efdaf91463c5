//! Objects, groups and materials of the elements.

use std::collections::HashMap;
use std::sync::Arc;

/// Object, group and material of a run of elements, as indices of names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Part {
    /// Index into [`Parts::objects`]; 0 for elements before the first `o`.
    pub(super) object: u32,
    /// Index into [`Parts::groups`]; 0 for elements before the first `g`.
    pub(super) group: u32,
    /// Index into [`Parts::materials`]; 0 for elements before the first `usemtl`.
    pub(super) material: u32,
}

/// The parts of a file, numbered in the order of their first element.
#[derive(Debug)]
pub(super) struct Parts {
    pub(super) objects: Names,
    pub(super) groups: Names,
    pub(super) materials: Names,
    /// The parts by number.
    pub(super) list: Vec<Part>,
    numbers: HashMap<Part, u32>,
    current: Part,
    /// The number of `current`, once an element has requested it.
    current_number: Option<u32>,
}

/// Distinct names, numbered in the order of their first use. Number 0 is the absent name. They are
/// copies, because the text is not kept.
#[derive(Debug)]
pub(super) struct Names {
    pub(super) list: Vec<Arc<[u8]>>,
    numbers: HashMap<Arc<[u8]>, u32>,
    max_count: u64,
}

impl Names {
    fn new(max_count: u64) -> Self {
        let absent: Arc<[u8]> = Arc::default();
        Self {
            list: vec![Arc::clone(&absent)],
            numbers: HashMap::from([(absent, 0)]),
            max_count,
        }
    }

    /// The number of `name`; beyond the limit, the last number.
    fn number(&mut self, name: &[u8]) -> u32 {
        if let Some(&number) = self.numbers.get(name) {
            return number;
        }
        let count = u32::try_from(self.list.len()).unwrap_or(u32::MAX);
        if u64::from(count) > self.max_count {
            return count - 1;
        }
        let name: Arc<[u8]> = name.into();
        self.list.push(Arc::clone(&name));
        self.numbers.insert(name, count);
        count
    }
}

impl Parts {
    pub(super) fn new(max_meshes: u64, max_materials: u64) -> Self {
        Self {
            objects: Names::new(max_meshes),
            groups: Names::new(max_meshes),
            materials: Names::new(max_materials),
            list: Vec::new(),
            numbers: HashMap::new(),
            current: Part {
                object: 0,
                group: 0,
                material: 0,
            },
            current_number: None,
        }
    }

    pub(super) fn enter_object(&mut self, name: &[u8]) {
        self.current.object = self.objects.number(name);
        self.current_number = None;
    }

    pub(super) fn enter_group(&mut self, name: &[u8]) {
        self.current.group = self.groups.number(name);
        self.current_number = None;
    }

    /// Sets the material; returns true if its name is new.
    pub(super) fn use_material(&mut self, name: &[u8]) -> bool {
        let before = self.materials.list.len();
        self.current.material = self.materials.number(name);
        self.current_number = None;
        self.materials.list.len() > before
    }

    /// The number of the current part.
    #[inline]
    pub(super) fn current_number(&mut self) -> u32 {
        if let Some(number) = self.current_number {
            return number;
        }
        let next = u32::try_from(self.list.len()).expect("there are fewer parts than lines");
        let number = *self.numbers.entry(self.current).or_insert(next);
        if number == next {
            self.list.push(self.current);
        }
        self.current_number = Some(number);
        number
    }
}
