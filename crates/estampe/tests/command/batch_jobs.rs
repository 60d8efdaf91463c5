//! `estampe batch --job-file`: pictures with options of their own, mistakes, and the schema.

use super::batch::{models, pictures, report};
use crate::support::{Folder, estampe};
use std::fs;

/// The pictures of a job file are those of `estampe render` with its options.
#[test]
fn job_files_have_pictures_with_options_of_their_own() {
    let folder = models();
    let (model, other) = (folder.path("in/a/one.obj"), folder.path("in/b/two.obj"));
    let out = folder.path("out");
    let toml = format!(
        "[options]\nsize = '40x30'\nshading = 'flat'\n\
         [[jobs]]\ninput = '{0}'\noutput = '{2}/{{stem}}.png'\n\
         [[jobs]]\ninput = '{1}'\noutput = '{2}/b.png'\n\
         [jobs.options]\nsize = '20x20'\northo = true\nazimuth = -20\nlight = ['1,1,1', '0,1,0']\n",
        model.display(),
        other.display(),
        out.display()
    );
    let toml = folder.with_file("jobs.toml", toml);
    let json = serde_json::json!({
        "options": { "size": "40x30", "shading": "flat" },
        "jobs": [
            { "input": model, "output": format!("{}/{{stem}}.png", out.display()) },
            { "input": other, "output": format!("{}/b.png", out.display()), "options": {
                "size": "20x20", "ortho": true, "azimuth": -20, "light": ["1,1,1", "0,1,0"] } },
        ],
    });
    let json = folder.with_file("jobs.json", json.to_string());
    let run = estampe("batch --job-file {} --report -", &[&toml]);
    assert_eq!(run.code, 0, "{}", run.err);
    let expected = [
        (&model, "one.png", "--size 40x30 --shading flat"),
        (
            &other,
            "b.png",
            "--size 20x20 --shading flat --ortho --azimuth -20 --light 1,1,1 --light 0,1,0",
        ),
    ];
    for (model, picture, options) in expected {
        let alone = folder.path("alone.png");
        let run = estampe(&format!("render {{}} -o {{}} {options}"), &[model, &alone]);
        assert_eq!(run.code, 0, "{}", run.err);
        assert!(
            fs::read(alone).ok() == fs::read(out.join(picture)).ok(),
            "{picture}"
        );
    }
    // The same jobs in the other form are up to date.
    let run = estampe("batch --job-file {} --report -", &[&json]);
    assert_eq!(report(&run)["counts"]["up_to_date"], 2, "{}", run.err);
}

#[test]
fn mistakes_in_job_files_have_a_line() {
    let folder = Folder::new();
    let job = "[[jobs]]\ninput = 'builtin.obj'\noutput = 'x.png'\n";
    for (text, problem) in [
        (
            "[options]\n\nsiez = '4x4'\n",
            "line 3: unknown option `siez`",
        ),
        ("[options]\nsize = 'wide'\n", "line 2: invalid value 'wide'"),
        (
            "[options]\northo = 'yes'\n",
            "line 2: `ortho` is true or false",
        ),
        (
            "[options]\nsize = ['4x4']\n",
            "line 2: `size` has one value",
        ),
        (
            "[options]\nthreads = 2\n",
            "line 2: `threads` is an option of the command",
        ),
        ("\nframes = 3\n", "line 2: unknown field `frames`"),
        (
            "[options]\nview = 'iso'\nazimuth = 5\n",
            "job 1 (builtin.obj): ",
        ),
        ("[[jobs]\n", "line 1: "),
    ] {
        let file = folder.with_file("jobs.toml", format!("{text}{job}"));
        let run = estampe("batch --job-file {}", &[&file]);
        assert_eq!(run.code, 2, "{text}: {}", run.err);
        assert!(run.err.contains(problem), "{text}: {}", run.err);
    }
    let text = "{\n \"jobs\": [{ \"input\": \"a\", \"output\": \"b\",\n  \"size\": 3 }]}";
    let file = folder.with_file("jobs.json", text);
    let run = estampe("batch --job-file {}", &[&file]);
    assert!(run.err.contains("unknown field `size`"), "{}", run.err);
    assert!(run.err.contains("line 3"), "{}", run.err);
    let file = folder.with_file("right.toml", job);
    let run = estampe("batch --job-file {} --ortho", &[&file]);
    assert!(
        run.code == 2 && run.err.contains("have no effect"),
        "{}",
        run.err
    );
}

/// The schema has every option of a picture, with its kind.
#[test]
fn the_schema_of_job_files_lists_the_options() {
    let run = estampe("schema", &[]);
    let schema = report(&run);
    let options = &schema["$defs"]["options"]["properties"];
    assert_eq!(options["ortho"]["type"], "boolean");
    assert_eq!(options["light"]["anyOf"][1]["type"], "array");
    assert_eq!(
        options["size"]["type"],
        serde_json::json!(["string", "number"])
    );
    assert!(options["threads"].is_null() && options["help"].is_null());
}

#[test]
fn job_files_have_passes() {
    let folder = models();
    let text = format!(
        "[options]\nsize = '20x20'\npass = ['color', 'uv']\n[[jobs]]\ninput = '{}'\noutput = '{}'\n",
        folder.path("in/a/one.obj").display(),
        folder.path("out/{pass}.png").display()
    );
    let jobs = folder.with_file("jobs.toml", text);
    let run = estampe("batch --job-file {} --report -", &[&jobs]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(pictures(&folder, "out"), ["color.png", "uv.png"]);
    let beside = estampe("batch --job-file {} --pass depth", &[&jobs]);
    assert!(beside.err.contains("beside --job-file"), "{}", beside.err);
}
