//! Numbers of locations: of what vertices bring, what stages hand on, and of the colours.

use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

use super::super::reflect::ValueType;
use super::Fault;
use super::unit::{Storage, Unit, Variable};

/// The most scalars and vectors of a variable between stages.
const MOST_LEAVES: usize = 256;

/// A scalar or vector between stages.
#[derive(Debug, Clone)]
pub(super) struct Leaf {
    /// What follows the variable's name: `.position`, `[2]`, or nothing.
    pub path: String,
    pub ty: ValueType,
    /// `None` if nothing gives it a value, and nothing reads it.
    pub location: Option<u32>,
}

/// The leaves of the variables between stages, by the variables' names.
pub(super) type Locations = HashMap<Rc<str>, Vec<Leaf>>;

/// What a stage hands on, by the names that both stages have for it, and by location.
#[derive(Debug, Default)]
pub(super) struct Outputs {
    by_name: HashMap<String, (u32, ValueType)>,
    locations: BTreeSet<u32>,
}

/// Numbers the inputs and outputs of a shader. The inputs are found among `before`, if given.
pub(super) fn locations(unit: &Unit, before: Option<&Outputs>) -> Result<Locations, Fault> {
    let mut found = Locations::new();
    number(unit, Storage::In, before, &mut found)?;
    number(unit, Storage::Out, None, &mut found)?;
    Ok(found)
}

/// What a shader hands on.
pub(super) fn outputs(unit: &Unit, locations: &Locations) -> Outputs {
    let mut outputs = Outputs::default();
    for variable in unit.variables() {
        if variable.qualifiers.storage() != Storage::Out {
            continue;
        }
        for leaf in locations.get(&variable.name).into_iter().flatten() {
            if let Some(location) = leaf.location {
                let name = format!("{}{}", variable.link_name, leaf.path);
                outputs.by_name.insert(name, (location, leaf.ty));
                outputs.locations.insert(location);
            }
        }
    }
    outputs
}

fn number(
    unit: &Unit,
    storage: Storage,
    before: Option<&Outputs>,
    found: &mut Locations,
) -> Result<(), Fault> {
    let variables = || {
        let all = unit.variables();
        all.filter(|variable| variable.qualifiers.storage() == storage)
    };
    let mut taken = BTreeSet::new();
    // `gl_FragColor` is the first colour.
    for variable in variables() {
        if let Some(first) = variable.qualifiers.value("location") {
            let leaves = leaves(unit, variable)?;
            let count = u32::try_from(leaves.len()).unwrap_or(u32::MAX);
            let is_second = variable.qualifiers.value("index") == Some(1);
            for location in first..first.saturating_add(count) {
                if !taken.insert((location, is_second)) {
                    return Err(Fault::new(
                        format!("location {location} of `{}` is taken", variable.name),
                        variable.place,
                    )
                    .help("give it another number, or leave `layout(location = …)` out"));
                }
            }
        }
    }
    let mut taken: BTreeSet<u32> = taken.into_iter().map(|(location, _)| location).collect();
    for variable in variables() {
        let mut leaves = leaves(unit, variable)?;
        let explicit = variable.qualifiers.value("location");
        match (explicit, before) {
            (Some(first), _) => give(&mut leaves, first),
            (None, None) => {
                let count = u32::try_from(leaves.len()).unwrap_or(u32::MAX);
                let mut first = 0_u32;
                while let Some(blocked) =
                    taken.range(first..first.saturating_add(count)).next_back()
                {
                    first = blocked + 1;
                }
                taken.extend(first..first.saturating_add(count));
                give(&mut leaves, first);
            }
            (None, Some(before)) => find(unit, variable, &mut leaves, before)?,
        }
        if let (Some(first), Some(before)) = (explicit, before) {
            let is_written = before.locations.contains(&first);
            if !is_written && unit.used.contains(&variable.name) {
                return Err(Fault::new(
                    format!("the vertex shader has no output at location {first}"),
                    variable.place,
                )
                .help("add an `out` with this location to it"));
            }
            if !is_written {
                leaves.iter_mut().for_each(|leaf| leaf.location = None);
            }
        }
        found.insert(variable.name.clone(), leaves);
    }
    Ok(())
}

fn give(leaves: &mut [Leaf], first: u32) {
    for (leaf, location) in leaves.iter_mut().zip(first..) {
        leaf.location = Some(location);
    }
}

/// Finds a fragment shader's input among what the vertex shader hands on.
fn find(
    unit: &Unit,
    variable: &Variable,
    leaves: &mut [Leaf],
    before: &Outputs,
) -> Result<(), Fault> {
    for leaf in leaves.iter_mut() {
        let name = format!("{}{}", variable.link_name, leaf.path);
        match before.by_name.get(&name) {
            Some((location, ty)) if *ty == leaf.ty => leaf.location = Some(*location),
            Some((_, ty)) => {
                return Err(Fault::new(
                    format!(
                        "`{name}` is `{}` here, but the vertex shader writes `{}`",
                        leaf.ty.glsl_name(),
                        ty.glsl_name()
                    ),
                    variable.place,
                )
                .help("declare it with one type in both"));
            }
            None if unit.used.contains(&variable.name) => {
                let near = super::super::suggest::nearest(
                    &name,
                    before.by_name.keys().map(String::as_str),
                );
                let fault = Fault::new(
                    format!("the vertex shader has no output `{name}`"),
                    variable.place,
                );
                return Err(match near {
                    Some(near) => fault.help(format!("it has `{near}`: use one name in both")),
                    None => fault.help("declare it there with `out`, and give it a value"),
                });
            }
            None => leaf.location = None,
        }
    }
    Ok(())
}

fn leaves(unit: &Unit, variable: &Variable) -> Result<Vec<Leaf>, Fault> {
    let leaves = unit
        .structures
        .leaves(&variable.ty, MOST_LEAVES)
        .ok_or_else(|| {
            Fault::new(
                format!("`{}` cannot be handed from stage to stage", variable.name),
                variable.place,
            )
            .help(format!(
                "use at most {MOST_LEAVES} numbers, vectors and matrices"
            ))
        })?;
    let is_bool = |ty: ValueType| {
        matches!(
            ty,
            ValueType::Scalar(super::super::Scalar::Bool)
                | ValueType::Vector(super::super::Scalar::Bool, _)
        )
    };
    if leaves.is_empty() || leaves.iter().any(|(_, ty)| is_bool(*ty)) {
        let message = format!("`{}` cannot be handed from stage to stage", variable.name);
        return Err(Fault::new(message, variable.place)
            .help("use an `int` in the place of a `bool`, and give arrays a size"));
    }
    Ok(leaves
        .into_iter()
        .map(|(path, ty)| Leaf {
            path,
            ty,
            location: None,
        })
        .collect())
}
