//! Files of tests: JSON with one buffer, as GLB or with a data URI.

use estampe_assets::model::{ModelOptions, NoResources, ResourceError, Resources};
use estampe_assets::{
    AssetError, Limits, Loaded, ModelFormat, ModelInput, parse_model, parse_model_with,
};
use estampe_scene::Mesh;
use serde_json::{Value, json};
use std::collections::{BTreeSet, HashMap};

/// Codes of component types.
pub(crate) const U8: u32 = 5121;
pub(super) const U16: u32 = 5123;
pub(super) const U32: u32 = 5125;
pub(super) const I8: u32 = 5120;
pub(super) const I16: u32 = 5122;
pub(crate) const F32: u32 = 5126;

/// A file that is being made.
#[derive(Debug, Clone)]
pub(crate) struct Builder {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

impl Builder {
    /// A file with an empty node 0 in its scene.
    pub(super) fn new() -> Self {
        Self {
            json: json!({
                "asset": { "version": "2.0" },
                "scene": 0,
                "scenes": [{ "nodes": [0] }],
                "nodes": [{}],
                "meshes": [],
                "accessors": [],
                "bufferViews": [],
            }),
            bin: Vec::new(),
        }
    }

    /// A node with a mesh of one primitive.
    pub(super) fn with_mesh(primitive: Value) -> Self {
        let mut file = Self::new();
        file.json["meshes"] = json!([{ "primitives": [primitive] }]);
        file.json["nodes"][0]["mesh"] = json!(0);
        file
    }

    /// A node with the triangle (0,0,0), (1,0,0), (0,1,0); the positions are accessor 0.
    pub(crate) fn triangle() -> Self {
        let mut file = Self::with_mesh(json!({ "attributes": { "POSITION": 0 } }));
        file.vec3s(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        file
    }

    /// Sets the value at a JSON Pointer, whose parent must exist.
    pub(crate) fn set(&mut self, pointer: &str, value: Value) -> &mut Self {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        match self.json.pointer_mut(parent) {
            Some(Value::Array(list)) => {
                let at: usize = key.parse().expect("an index");
                if at == list.len() {
                    list.push(value);
                } else {
                    list[at] = value;
                }
            }
            Some(Value::Object(map)) => {
                map.insert(key.to_owned(), value);
            }
            _ => panic!("{parent} is not a list or an object"),
        }
        self
    }

    /// [`Self::set`], by value.
    pub(super) fn with(mut self, pointer: &str, value: Value) -> Self {
        self.set(pointer, value);
        self
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    /// Appends a buffer view; returns its index.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        let length = bytes.len();
        self.push(
            "bufferViews",
            json!({ "buffer": 0, "byteOffset": offset, "byteLength": length }),
        )
    }

    /// Appends an accessor with a buffer view of its own; returns its index.
    pub(crate) fn accessor(
        &mut self,
        kind: &str,
        component: u32,
        count: usize,
        bytes: &[u8],
    ) -> usize {
        let view = self.view(bytes);
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }),
        )
    }

    /// Appends an accessor of floats.
    pub(crate) fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let kind = match N {
            1 => "SCALAR",
            2 => "VEC2",
            3 => "VEC3",
            4 => "VEC4",
            _ => "MAT4",
        };
        self.accessor(kind, F32, values.len(), &bytes_of(values.as_flattened()))
    }

    pub(crate) fn vec3s(&mut self, values: &[[f32; 3]]) -> usize {
        self.floats(values)
    }

    pub(crate) fn scalars(&mut self, values: &[f32]) -> usize {
        let values: Vec<[f32; 1]> = values.iter().map(|&value| [value]).collect();
        self.floats(&values)
    }

    /// Appends an accessor of indices.
    pub(crate) fn indices(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        self.accessor("SCALAR", U16, indices.len(), &bytes)
    }

    /// The JSON, which declares the extensions of its objects unless it declares some itself.
    fn declared(&self) -> Value {
        fn collect(value: &Value, names: &mut BTreeSet<String>) {
            match value {
                Value::Array(list) => list.iter().for_each(|value| collect(value, names)),
                Value::Object(map) => {
                    if let Some(Value::Object(own)) = map.get("extensions") {
                        names.extend(own.keys().cloned());
                    }
                    map.values().for_each(|value| collect(value, names));
                }
                _ => {}
            }
        }
        let mut json = self.json.clone();
        let mut names = BTreeSet::new();
        collect(&json, &mut names);
        if let Some(Value::Array(required)) = json.get("extensionsRequired") {
            names.extend(required.iter().filter_map(Value::as_str).map(str::to_owned));
        }
        if json.get("extensionsUsed").is_none() && !names.is_empty() {
            json["extensionsUsed"] = json!(names);
        }
        json
    }

    /// The file as GLB.
    pub(crate) fn glb(&self) -> Vec<u8> {
        glb(&self.json_of_glb(), &self.bin)
    }

    /// The JSON chunk of the file as GLB.
    pub(crate) fn json_of_glb(&self) -> Vec<u8> {
        let mut json = self.declared();
        if json.get("buffers").is_none() {
            json["buffers"] = json!([{ "byteLength": self.bin.len() }]);
        }
        json.to_string().into_bytes()
    }

    /// The file as JSON with a data URI.
    pub(crate) fn gltf(&self) -> Vec<u8> {
        let mut json = self.declared();
        let uri = format!("data:application/octet-stream;base64,{}", base64(&self.bin));
        json["buffers"] = json!([{ "byteLength": self.bin.len(), "uri": uri }]);
        json.to_string().into_bytes()
    }

    /// Reads the file as GLB with options.
    pub(super) fn load_with(&self, options: &ModelOptions) -> Loaded {
        let result = self.try_load_with(options);
        result.unwrap_or_else(|error| panic!("{error}"))
    }

    /// [`Self::load_with`], or the error.
    pub(super) fn try_load_with(&self, options: &ModelOptions) -> Result<Loaded, AssetError> {
        let bytes = self.glb();
        let input = ModelInput {
            bytes: &bytes,
            format: ModelFormat::Gltf,
            name: "a.glb",
            resources: &NoResources,
        };
        parse_model_with(&input, options, &Limits::default())
    }
}

/// A GLB file of two chunks.
pub(crate) fn glb(json: &[u8], bin: &[u8]) -> Vec<u8> {
    let mut json = json.to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let word = |value: usize| u32::try_from(value).expect("a small file").to_le_bytes();
    let mut bytes = b"glTF".to_vec();
    bytes.extend(word(2));
    bytes.extend(word(12 + 8 + json.len() + 8 + bin.len()));
    bytes.extend(word(json.len()));
    bytes.extend(b"JSON");
    bytes.extend(&json);
    bytes.extend(word(bin.len()));
    bytes.extend(b"BIN\0");
    bytes.extend(&bin);
    bytes
}

pub(super) fn bytes_of(values: &[f32]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

pub(super) fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for chunk in bytes.chunks(3) {
        let word = (0..3).fold(0, |word, i| {
            word << 8 | u32::from(chunk.get(i).copied().unwrap_or(0))
        });
        for i in 0..4 {
            let value = (word >> (18 - 6 * i)) & 63;
            let is_padding = i > chunk.len();
            let character = char::from(ALPHABET[value as usize]);
            text.push(if is_padding { '=' } else { character });
        }
    }
    text
}

/// Reads a file, which must succeed.
pub(crate) fn load(bytes: &[u8]) -> Loaded {
    parse_model(
        bytes,
        ModelFormat::Gltf,
        "a.glb",
        &NoResources,
        &Limits::default(),
    )
    .unwrap_or_else(|error| panic!("{error}"))
}

/// The only mesh of a file.
pub(super) fn mesh(file: &Builder) -> Mesh {
    let mut loaded = load(&file.glb());
    // Tests of formats use all of them in places where the specification has others.
    let is_of_format = |text: &str| {
        text.contains("no such format") || text.starts_with("vertices do not begin at")
    };
    loaded
        .warnings
        .retain(|warning| !is_of_format(&warning.message));
    assert_eq!(loaded.warnings, []);
    let [mesh] = <[Mesh; 1]>::try_from(loaded.scene.meshes).expect("one mesh");
    mesh
}

/// The message of a file that must not be read.
pub(super) fn error(file: &Builder) -> String {
    let result = parse_model(
        &file.glb(),
        ModelFormat::Gltf,
        "a.glb",
        &NoResources,
        &Limits::default(),
    );
    result.expect_err("the file is wrong").to_string()
}

/// Reads a file that has side files.
pub(super) fn with_files(
    bytes: &[u8],
    files: &[(&str, Vec<u8>)],
    limits: &Limits,
) -> Result<Loaded, AssetError> {
    let files = files
        .iter()
        .map(|(name, bytes)| ((*name).to_owned(), bytes.clone()));
    let files = Files(files.collect());
    parse_model(bytes, ModelFormat::Gltf, "a.glb", &files, limits)
}

/// Side files by name.
struct Files(HashMap<String, Vec<u8>>);

impl Resources for Files {
    fn resolve(&self, name: &str) -> Result<String, ResourceError> {
        let found = self.0.get_key_value(name).map(|(name, _)| name.clone());
        found.ok_or(ResourceError::NotFound)
    }

    fn read(&self, resolved: &str, max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        let bytes = &self.0[resolved];
        if bytes.len() as u64 > max_bytes {
            return Err(ResourceError::TooLarge(max_bytes));
        }
        Ok(bytes.clone())
    }
}
