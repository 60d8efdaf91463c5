//! Tests of data that is not part of the project: `cargo test -- --ignored shared_data::`.

mod shared_data {
    use crate::module;
    use estampe::{Device, EntryPointDescriptor, ProgramDescriptor, ShaderSource, ShaderStage};
    use std::path::Path;

    /// The shaders of the scenes that other rasterizers draw too.
    #[test]
    #[ignore = "needs ../shared/peerbench/shaders"]
    fn shaders_of_the_scenes_of_peers_become_programs() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/peerbench/shaders");
        let device = Device::new(&Default::default()).expect("threads");
        let [mut vertex, mut others] = [0, 0];
        let mut wrong = Vec::new();
        for entry in std::fs::read_dir(root).expect("the folder of shaders") {
            let path = entry.expect("an entry").path();
            let text = std::fs::read_to_string(&path).expect("text");
            let module = module(&device, ShaderSource::Wgsl(&text));
            for entry in module.entry_points() {
                let named = EntryPointDescriptor {
                    name: Some(&entry.name),
                    ..EntryPointDescriptor::new(&module)
                };
                let made = match entry.stage {
                    ShaderStage::Compute => device.create_compute_program(&named).map(drop),
                    ShaderStage::Vertex => {
                        vertex += 1;
                        let program = ProgramDescriptor {
                            vertex: named,
                            fragment: None,
                        };
                        device.create_program(&program).map(drop)
                    }
                    // It fits one of the vertex shaders.
                    ShaderStage::Fragment => {
                        let vertices = module.entry_points();
                        let vertices = vertices.filter(|one| one.stage == ShaderStage::Vertex);
                        let mut made = vertices.map(|one| {
                            let program = ProgramDescriptor {
                                vertex: EntryPointDescriptor {
                                    name: Some(&one.name),
                                    ..EntryPointDescriptor::new(&module)
                                },
                                fragment: Some(named),
                            };
                            device.create_program(&program).map(drop)
                        });
                        made.find(Result::is_ok)
                            .unwrap_or_else(|| device.create_program(&module.program()).map(drop))
                    }
                };
                others += 1;
                if let Err(error) = made {
                    wrong.push(format!("{}: {}: {error}", path.display(), entry.name));
                }
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
        assert!(vertex >= 15 && others >= 40, "{vertex} {others}");
    }
}
