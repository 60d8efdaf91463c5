//! Files of cameras: JSON, whose errors have the path of the value.

use super::matrix::{intrinsics, rotation};
use crate::failure::Failure;
use crate::input::read_file;
use crate::values::{MAX_SIDE, shown};
use estampe_assets::Limits;
use estampe_renderer::{Pinhole, RenderOptions};
use glam::DVec3;
use serde_json::{Map, Value};
use std::collections::HashMap;
use std::path::Path;

/// The keys of a camera.
const KEYS: [&str; 6] = ["name", "width", "height", "K", "R", "t"];

/// The most cameras of a file.
const MOST_CAMERAS: usize = 100_000;

/// The greatest coordinate of t, in world units.
const FURTHEST: f64 = 1e30;

/// A camera of a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NamedCamera {
    pub(crate) name: String,
    /// Width and height of its picture.
    pub(crate) size: (u32, u32),
    pub(super) pinhole: Pinhole,
}

impl NamedCamera {
    /// The options of a picture with this camera and its size.
    pub(crate) fn apply(&self, options: RenderOptions) -> RenderOptions {
        RenderOptions {
            width: self.size.0,
            height: self.size.1,
            camera: self.pinhole.into(),
            ..options
        }
    }
}

/// The place of a problem, a path as in `$[2].K[0][1]`, and the problem.
type Problem = (String, String);

/// The cameras of a file; those without a size have the default one.
pub(crate) fn read(path: &Path, default: (u32, u32)) -> Result<Vec<NamedCamera>, Failure> {
    let bytes = read_file(path, &Limits::default())?;
    let wrong = |problem: String| Failure::Usage(format!("{}: {problem}", shown(path)));
    let value: Value = { serde_json::from_slice(&bytes) }
        .map_err(|error| wrong(format!("{error}; this is no JSON")))?;
    cameras(&value, default).map_err(|(at, problem)| wrong(format!("{at}: {problem}")))
}

fn cameras(value: &Value, default: (u32, u32)) -> Result<Vec<NamedCamera>, Problem> {
    let at = |at: &str, problem: &str| (at.to_owned(), problem.to_owned());
    let list = value.as_array().ok_or_else(|| {
        at(
            "$",
            "write a list of cameras, as in [{\"K\": …, \"R\": …, \"t\": …}]",
        )
    })?;
    if list.is_empty() || list.len() > MOST_CAMERAS {
        let problem = format!("{} cameras; 1 to {MOST_CAMERAS} are possible", list.len());
        return Err(at("$", &problem));
    }
    let mut names = HashMap::new();
    let mut cameras = Vec::with_capacity(list.len());
    for (number, value) in list.iter().enumerate() {
        let place = format!("$[{number}]");
        let camera = camera(value, &place, (number, default))?;
        if let Some(other) = names.insert(camera.name.clone(), number) {
            let problem = format!(
                "{:?} is the name of $[{other}] too; names tell the pictures apart",
                camera.name
            );
            return Err((format!("{place}.name"), problem));
        }
        cameras.push(camera);
    }
    Ok(cameras)
}

fn camera(
    value: &Value,
    place: &str,
    (number, default): (usize, (u32, u32)),
) -> Result<NamedCamera, Problem> {
    let table = value.as_object().ok_or_else(|| {
        let problem = "write a camera, as in {\"K\": …, \"R\": …, \"t\": …}".to_owned();
        (place.to_owned(), problem)
    })?;
    if let Some(unknown) = table.keys().find(|key| !KEYS.contains(&key.as_str())) {
        let problem = format!("this key is unknown; there are {}", KEYS.join(", "));
        let unknown = crate::terminal::one_line(unknown);
        return Err((format!("{place}.{unknown}"), problem));
    }
    let size = match (side(table, "width", place)?, side(table, "height", place)?) {
        (Some(width), Some(height)) => (width, height),
        (None, None) => default,
        (Some(_), None) => return Err(missing(place, "height")),
        (None, Some(_)) => return Err(missing(place, "width")),
    };
    let at = |key: &str, problem: String| (format!("{place}.{key}"), problem);
    let intrinsics = intrinsics(matrix(table, "K", place)?).map_err(|problem| at("K", problem))?;
    let rotation = rotation(matrix(table, "R", place)?).map_err(|problem| at("R", problem))?;
    let t = field(table, "t", place)?;
    let t = vector(t, &format!("{place}.t"))?;
    if t.iter().any(|one| one.abs() > FURTHEST) {
        return Err(at(
            "t",
            format!("a translation over {FURTHEST:e}; check its unit"),
        ));
    }
    Ok(NamedCamera {
        name: name(table, place, number)?,
        size,
        pinhole: Pinhole {
            intrinsics,
            rotation,
            translation: DVec3::from_array(t),
        },
    })
}

fn missing(place: &str, key: &str) -> Problem {
    (place.to_owned(), format!("`{key}` is missing; add it"))
}

fn field<'v>(table: &'v Map<String, Value>, key: &str, place: &str) -> Result<&'v Value, Problem> {
    table.get(key).ok_or_else(|| missing(place, key))
}

/// The name, which is part of a file's name; without one the number.
fn name(table: &Map<String, Value>, place: &str, number: usize) -> Result<String, Problem> {
    let Some(value) = table.get("name") else {
        return Ok(format!("{number:04}"));
    };
    let is_plain = |name: &&str| {
        let is_part = |c: char| !(c.is_control() || "/\\:*?\"<>|{}".contains(c));
        !name.is_empty() && name.len() <= 200 && !name.starts_with('.') && name.chars().all(is_part)
    };
    let name = value.as_str().filter(is_plain).ok_or_else(|| {
        let problem = "write a text that may be part of a file's name: without / \\ : * ? \" < > | { } and no \
                       point at the beginning";
        (format!("{place}.name"), problem.to_owned())
    })?;
    Ok(name.to_owned())
}

fn side(table: &Map<String, Value>, key: &str, place: &str) -> Result<Option<u32>, Problem> {
    let Some(value) = table.get(key) else {
        return Ok(None);
    };
    let side = value.as_u64().and_then(|side| u32::try_from(side).ok());
    let side = side.filter(|side| (1..=MAX_SIDE).contains(side));
    side.map(Some).ok_or_else(|| {
        let problem = format!("write whole pixels, 1 to {MAX_SIDE}");
        (format!("{place}.{key}"), problem)
    })
}

fn matrix(table: &Map<String, Value>, key: &str, place: &str) -> Result<[[f64; 3]; 3], Problem> {
    let place_of = format!("{place}.{key}");
    let rows = three(
        field(table, key, place)?,
        &place_of,
        "three rows of three numbers",
    )?;
    let mut matrix = [[0.0; 3]; 3];
    for ((at, row), of) in rows.iter().enumerate().zip(&mut matrix) {
        *of = vector(row, &format!("{place_of}[{at}]"))?;
    }
    Ok(matrix)
}

fn vector(value: &Value, place: &str) -> Result<[f64; 3], Problem> {
    let values = three(value, place, "three numbers")?;
    let mut vector = [0.0; 3];
    for ((at, one), of) in values.iter().enumerate().zip(&mut vector) {
        let number = one.as_f64().filter(|number| number.is_finite());
        *of = number.ok_or_else(|| {
            let problem = "write a finite number".to_owned();
            (format!("{place}[{at}]"), problem)
        })?;
    }
    Ok(vector)
}

fn three<'v>(value: &'v Value, place: &str, what: &str) -> Result<&'v [Value], Problem> {
    let list = value.as_array().filter(|list| list.len() == 3);
    let list = list.ok_or_else(|| (place.to_owned(), format!("write {what}")))?;
    Ok(list)
}

#[cfg(test)]
mod tests {
    use super::cameras;
    use serde_json::{Value, json};

    fn camera() -> Value {
        json!({
            "K": [[800, 0, 320], [0, 800, 240], [0, 0, 1]],
            "R": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
            "t": [0, 0, 4],
        })
    }

    #[test]
    fn cameras_have_names_and_sizes() {
        let mut named = camera();
        named["name"] = json!("links");
        named["width"] = json!(64);
        named["height"] = json!(48);
        let list = cameras(&json!([camera(), named]), (9, 7)).expect("right");
        assert_eq!((list[0].name.as_str(), list[0].size), ("0000", (9, 7)));
        assert_eq!((list[1].name.as_str(), list[1].size), ("links", (64, 48)));
    }

    #[test]
    fn mistakes_have_a_path() {
        let with = |key: &str, value: Value| {
            let mut camera = camera();
            camera[key] = value;
            camera
        };
        let without = |key: &str| {
            let mut camera = camera();
            camera.as_object_mut().expect("a table").remove(key);
            camera
        };
        for (second, place, problem) in [
            (without("K"), "$[1]", "`K` is missing"),
            (without("t"), "$[1]", "`t` is missing"),
            (with("width", json!(64)), "$[1]", "`height` is missing"),
            (with("width", json!(0)), "$[1].width", "1 to 16384"),
            (with("width", json!(1.5)), "$[1].width", "whole pixels"),
            (with("t", json!([1, 2])), "$[1].t", "three numbers"),
            (with("t", json!([1, "2", 3])), "$[1].t[1]", "finite number"),
            (
                with("R", json!([[1, 0, 0], [0, 1], [0, 0, 1]])),
                "$[1].R[1]",
                "three numbers",
            ),
            (
                with("R", json!([[1, 0, 0], [0, 1, 0], [0, 0, 2]])),
                "$[1].R",
                "no rotation",
            ),
            (
                with("K", json!([[1, 1, 0], [0, 1, 0], [0, 0, 1]])),
                "$[1].K",
                "skew",
            ),
            (with("k", json!(1)), "$[1].k", "unknown"),
            (
                with("name", json!("../x")),
                "$[1].name",
                "part of a file's name",
            ),
            (
                with("name", json!("0000")),
                "$[1].name",
                "is the name of $[0] too",
            ),
            (json!(7), "$[1]", "write a camera"),
        ] {
            let error = cameras(&json!([camera(), second]), (9, 7)).expect_err("wrong");
            assert_eq!(error.0, place);
            assert!(error.1.contains(problem), "{}", error.1);
        }
        for wrong in [json!({}), json!([]), json!("x")] {
            assert_eq!(cameras(&wrong, (9, 7)).expect_err("wrong").0, "$");
        }
    }
}
