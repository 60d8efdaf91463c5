//! The statement reader of OBJ.

use super::elements::{Counts, Elements, Kind, Membership};
use super::parts::Parts;
use super::plain::Run;
use super::windows::{Text, Window, Windows};
use crate::model::load::Context;
use crate::model::statements::Statements;
use crate::{AssetError, Limits, Location};
use estampe_scene::Workers;
use glam::{Vec2, Vec3};
use std::collections::HashSet;

/// The contents of an OBJ file, in file order.
#[derive(Debug)]
pub(super) struct Contents {
    pub(super) positions: Vec<Vec3>,
    /// sRGB vertex colours as written; empty, or as long as `positions`.
    pub(super) colors: Vec<Vec3>,
    /// Texture coordinates with v up, as written.
    pub(super) uvs: Vec<Vec2>,
    /// Normals as written, of any length.
    pub(super) normals: Vec<Vec3>,
    pub(super) parameter_points: Vec<Vec3>,
    pub(super) elements: Elements,
    pub(super) parts: Parts,
    /// The names given by `mtllib`.
    pub(super) libraries: Vec<(Box<[u8]>, Location)>,
    /// Location of the first use of each material name; parallel to `parts.materials`.
    pub(super) material_uses: Vec<Location>,
}

/// Bytes of a window: some hundred microseconds of work.
const WINDOW: usize = 1 << 20;

/// What is read of a file so far.
struct FileReader<'c, 'r> {
    contents: Contents,
    context: &'c mut Context<'r>,
    smoothing_group: u32,
    /// Keywords with a warning.
    reported: HashSet<Box<[u8]>>,
    knows_a_statement: bool,
    /// The number of the next line; 0 before the first window.
    line: u64,
}

/// The reader of a window.
struct Reader<'w, 'f, 'c, 'r> {
    statements: Statements<'w>,
    /// Runs of plain lines further down, the next one first.
    runs: &'w [Run],
    file: &'f mut FileReader<'c, 'r>,
}

/// Reads all statements.
pub(super) fn read(text: Text<'_>, context: &mut Context<'_>) -> Result<Contents, AssetError> {
    read_in_windows(text, WINDOW, context)
}

/// [`read`] with windows of about so many bytes, which make no difference.
pub(super) fn read_in_windows(
    text: Text<'_>,
    size: usize,
    context: &mut Context<'_>,
) -> Result<Contents, AssetError> {
    let workers = if text.is_at_most(size) {
        Workers::ONE
    } else {
        context.workers
    };
    let mut windows = Windows::new(text, size, context.limits);
    let mut file = FileReader::new(context);
    workers.in_order(
        |window| windows.next(window),
        Window::read_plain_lines,
        |window| file.read_window(window),
    )?;
    file.finish()
}

impl<'c, 'r> FileReader<'c, 'r> {
    fn new(context: &'c mut Context<'r>) -> Self {
        let (max_meshes, max_materials) = (context.limits.max_meshes, context.limits.max_materials);
        Self {
            contents: Contents {
                positions: Vec::new(),
                colors: Vec::new(),
                uvs: Vec::new(),
                normals: Vec::new(),
                parameter_points: Vec::new(),
                elements: Elements::default(),
                parts: Parts::new(max_meshes, max_materials),
                libraries: Vec::new(),
                material_uses: vec![Location::Line(0)],
            },
            context,
            smoothing_group: 0,
            reported: HashSet::new(),
            knows_a_statement: false,
            line: 0,
        }
    }

    fn read_window(&mut self, window: &Window<'_>) -> Result<(), AssetError> {
        let statements = match self.line {
            0 => Statements::new(window.bytes()),
            line => Statements::starting_at(window.bytes(), 0, line),
        };
        let mut reader = Reader {
            statements,
            runs: &window.runs,
            file: self,
        };
        reader.read_all()?;
        self.line = reader.statements.line();
        Ok(())
    }

    fn finish(mut self) -> Result<Contents, AssetError> {
        if !self.knows_a_statement {
            return Err(AssetError::malformed(
                "it contains no OBJ statement",
                "check that it is an OBJ file and not empty",
            ));
        }
        let counts = self.contents.counts();
        let Contents {
            elements,
            positions,
            ..
        } = &mut self.contents;
        elements.end_of_file(positions, counts, self.context)?;
        Ok(self.contents)
    }
}

impl Contents {
    fn counts(&self) -> Counts {
        [self.positions.len(), self.uvs.len(), self.normals.len()]
    }
}

impl<'w> Reader<'w, '_, '_, '_> {
    fn read_all(&mut self) -> Result<(), AssetError> {
        while self.statements.find_word() {
            if self.take_run() {
                continue;
            }
            let Some(keyword) = self.statements.word() else {
                continue;
            };
            if !self.read_statement(keyword)? {
                self.report_keyword(keyword);
                self.statements.skip_statement();
                continue;
            }
            self.file.knows_a_statement = true;
            if !self.statements.is_at_end() {
                self.warn(|| "the rest of the line is ignored".to_owned());
            }
            self.statements.skip_statement();
        }
        Ok(())
    }

    /// Takes the run of plain lines that starts here, if there is one and it fits.
    #[inline]
    fn take_run(&mut self) -> bool {
        let at = self.statements.at();
        // A skipped start of a run was not the start of a statement, or the run did not fit.
        while let Some((run, later)) = self.runs.split_first()
            && run.start <= at
        {
            self.runs = later;
            if run.start == at {
                return self.append_run(run);
            }
        }
        false
    }

    fn append_run(&mut self, run: &Run) -> bool {
        let limits = self.file.context.limits;
        let most = (limits.max_vertices, limits.max_triangles);
        let triangles = self.file.contents.elements.triangles.len();
        if !run.fits(self.counts(), triangles, most) || limits.max_polygon_corners < 3 {
            return false;
        }
        self.file.contents.append_vertices(run);
        if !run.triangles.is_empty() {
            let part = self.file.contents.parts.current_number();
            let group = self.file.smoothing_group;
            self.file.contents.elements.append(run, part, group);
        }
        self.statements.jump(run.end, run.line_ends);
        self.file.knows_a_statement = true;
        true
    }

    /// Reads the statement after `keyword`; `false` if the keyword is not known.
    #[inline]
    fn read_statement(&mut self, keyword: &'w [u8]) -> Result<bool, AssetError> {
        match keyword {
            b"v" => self.read_position()?,
            b"vt" => self.read_uv()?,
            b"vn" => {
                let normal = self.read_vec3();
                self.file.contents.normals.push(normal);
                self.check_vertices("normals", self.file.contents.normals.len())?;
            }
            b"vp" => {
                let [u, v, w] = self.read_numbers([0.0, 0.0, 1.0]);
                self.file.contents.parameter_points.push(Vec3::new(u, v, w));
                self.check_vertices("points", self.file.contents.parameter_points.len())?;
            }
            b"f" | b"fo" => self.read_element(Kind::Face)?,
            b"l" => self.read_element(Kind::Line)?,
            b"p" => self.read_element(Kind::Points)?,
            b"o" => {
                let name = self.statements.rest();
                self.file.contents.parts.enter_object(if name.is_empty() {
                    b"object"
                } else {
                    name
                });
            }
            b"g" => {
                let name = self.statements.rest();
                self.file.contents.parts.enter_group(if name.is_empty() {
                    b"default"
                } else {
                    name
                });
            }
            b"s" => self.read_smoothing_group(),
            b"usemtl" => {
                let location = self.statements.location();
                let name = self.statements.rest();
                if self.file.contents.parts.use_material(name) {
                    self.file.contents.material_uses.push(location);
                }
            }
            b"mtllib" => {
                let location = self.statements.location();
                let names = self.statements.rest();
                self.file.contents.libraries.push((names.into(), location));
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// `v x y z [w] [r g b]`: w is a weight of rational curves, which meshes do not use.
    #[inline]
    fn read_position(&mut self) -> Result<(), AssetError> {
        let mut numbers = [f32::NAN; 7];
        let mut count = 0;
        let mut is_sound = true;
        while count < numbers.len()
            && let Some(number) = self.statements.number()
        {
            is_sound &= number.is_some();
            numbers[count] = number.unwrap_or(f32::NAN);
            count += 1;
        }
        let position = Vec3::new(numbers[0], numbers[1], numbers[2]);
        if !is_sound || !position.is_finite() {
            self.warn(|| {
                "the vertex does not have three finite coordinates; elements that use it are omitted".to_owned()
            });
        }
        let before = self.file.contents.positions.len();
        self.file.contents.positions.push(position);
        if count >= 6 || !self.file.contents.colors.is_empty() {
            let color = match count {
                6 => Vec3::new(numbers[3], numbers[4], numbers[5]),
                7 => Vec3::new(numbers[4], numbers[5], numbers[6]),
                _ => Vec3::ONE,
            };
            self.file.contents.colors.resize(before, Vec3::ONE);
            self.file.contents.colors.push(color);
        }
        self.check_vertices("vertices", before + 1)
    }

    /// `vt u [v [w]]`: w is for solid textures.
    #[inline]
    fn read_uv(&mut self) -> Result<(), AssetError> {
        let [u, v, _] = self.read_numbers([0.0; 3]);
        self.file.contents.uvs.push(Vec2::new(u, v));
        self.check_vertices("texture coordinates", self.file.contents.uvs.len())
    }

    #[inline]
    fn read_vec3(&mut self) -> Vec3 {
        Vec3::from_array(self.read_numbers([0.0; 3]))
    }

    /// Up to three numbers; missing or invalid ones keep their default.
    #[inline]
    fn read_numbers(&mut self, mut numbers: [f32; 3]) -> [f32; 3] {
        for slot in &mut numbers {
            match self.statements.number() {
                None => break,
                Some(Some(number)) => *slot = number,
                Some(None) => {
                    self.warn(|| "a number was expected; the default is used".to_owned());
                }
            }
        }
        numbers
    }

    #[inline]
    fn read_element(&mut self, kind: Kind) -> Result<(), AssetError> {
        let location = self.statements.location();
        let counts = self.counts();
        let max_corners = self.file.context.limits.max_polygon_corners;
        self.file.contents.elements.begin();
        while !self.statements.is_at_end() {
            let text = self.statements.remaining();
            let Some(length) = self.file.contents.elements.add_corner(text, counts) else {
                self.statements.skip_statement();
                return self.leave_out(location, "a corner is not one of v, v/vt, v//vn, v/vt/vn");
            };
            self.statements.advance(length);
            let count = self.file.contents.elements.corner_count() as u64;
            if kind == Kind::Face && count > max_corners {
                self.statements.skip_statement();
                return self.leave_out(location, "the polygon has more corners than the limit");
            }
        }
        let (fewest, fault) = match kind {
            Kind::Face => (3, "a face needs three corners"),
            Kind::Line => (2, "a line needs two vertices"),
            Kind::Points => (1, "a point needs a vertex"),
        };
        if self.file.contents.elements.corner_count() < fewest {
            return self.leave_out(location, fault);
        }
        let membership = Membership {
            part: self.file.contents.parts.current_number(),
            smoothing_group: self.file.smoothing_group,
            location,
        };
        let Contents {
            elements,
            positions,
            ..
        } = &mut self.file.contents;
        elements.end(kind, membership, positions, counts, self.file.context)
    }

    #[cold]
    fn leave_out(&mut self, location: Location, fault: &str) -> Result<(), AssetError> {
        let message = || format!("{fault}; the element is omitted");
        self.file
            .context
            .warnings
            .add(self.file.context.name, location, message);
        Ok(())
    }

    /// `s off` and `s 0` end smoothing.
    fn read_smoothing_group(&mut self) {
        let word = self.statements.word().unwrap_or(b"off");
        let number = crate::model::number::parse_i64(word).map(|(number, _)| number);
        // Exporters also write `on`; a group's number has no meaning beyond equality.
        self.file.smoothing_group = match number {
            Some(number) => u32::try_from(number).unwrap_or(u32::MAX),
            None => u32::from(word.eq_ignore_ascii_case(b"on")),
        };
    }

    fn counts(&self) -> Counts {
        self.file.contents.counts()
    }

    #[inline]
    fn check_vertices(&self, what: &str, count: usize) -> Result<(), AssetError> {
        Limits::check(what, count as u64, self.file.context.limits.max_vertices)
            .map_err(|error| error.at(self.statements.location()))
    }

    #[cold]
    fn warn(&mut self, message: impl FnOnce() -> String) {
        self.file
            .context
            .warnings
            .add(self.file.context.name, self.statements.location(), message);
    }

    /// Reports each unsupported keyword once, for the first thousand keywords.
    #[cold]
    fn report_keyword(&mut self, keyword: &'w [u8]) {
        const MAX_REPORTED: usize = 1000;
        // Attributes without effect on a mesh of triangles.
        const SILENT: [&[u8]; 10] = [
            b"bevel",
            b"c_interp",
            b"d_interp",
            b"lod",
            b"shadow_obj",
            b"trace_obj",
            b"mg",
            b"end",
            b"vw",
            b"maplib",
        ];
        const FREE_FORM: [&[u8]; 13] = [
            b"cstype", b"deg", b"bmat", b"step", b"curv", b"curv2", b"surf", b"parm", b"trim",
            b"hole", b"scrv", b"sp", b"con",
        ];
        let is_free_form = FREE_FORM.contains(&keyword);
        if is_free_form || SILENT.contains(&keyword) {
            self.file.knows_a_statement = true;
        }
        if SILENT.contains(&keyword) || self.file.reported.len() >= MAX_REPORTED {
            return;
        }
        if self.file.reported.insert(keyword.into()) {
            let shown = String::from_utf8_lossy(&keyword[..keyword.len().min(32)]).into_owned();
            self.warn(|| {
                if is_free_form {
                    format!("`{shown}`: free-form curves and surfaces are not drawn")
                } else {
                    format!("`{shown}` is not an OBJ statement; such lines are skipped")
                }
            });
        }
    }
}
