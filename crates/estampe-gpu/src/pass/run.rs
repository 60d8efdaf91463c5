//! Running a pass: objects become plain data, the core draws, results go back into the objects.

use super::attachments::Attachments;
use super::check::{DrawCheck, check_buffer_uses, check_uses, check_vertices};
use super::draw_data::{DrawData, DrawMemory, Groups};
use super::images::Taken;
use super::layers::Layer;
use super::queries::Parts;
use super::{PassErrorKind, RenderPass, RenderPassError};
use crate::buffer::StoredBuffers;
use crate::texture::{Reservations, StoredTextures, TextureUse, check_texture_conflicts};
use crate::{Context, Device, LoadOp, Statistics};
use estampe_core::{
    Discards, DrawList, DrawNeeds, OcclusionQueries, PassControl, RenderTarget, recycled,
};
use estampe_types::shader::StoppedBatches;

/// The company in which a pass is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Company {
    /// All threads draw the pass.
    Alone,
    /// One thread does, in a group of passes whose textures are reserved.
    Beside,
}

/// Draws a pass.
pub(crate) fn render(
    device: &Device,
    pass: &RenderPass<'_>,
) -> Result<Statistics, RenderPassError> {
    run(device, pass, Company::Alone).map_err(|kind| of_pass(pass, kind))
}

/// [`render`] of a pass by the calling thread alone, while others draw passes beside it. The caller
/// has reserved its textures.
pub(super) fn render_beside(
    device: &Device,
    pass: &RenderPass<'_>,
) -> Result<Statistics, RenderPassError> {
    run(device, pass, Company::Beside).map_err(|kind| of_pass(pass, kind))
}

/// Checks all that [`render`] checks before it draws.
pub(crate) fn check(device: &Device, pass: &RenderPass<'_>) -> Result<(), RenderPassError> {
    let check = || {
        let layers = Layer::of(pass)?;
        let of_layers = passes(pass, &layers);
        let mut memory = device.take_draw_memory();
        check_objects(device, each_pass(pass, &of_layers), &mut memory.data)?;
        memory.data.needs()?;
        device.keep_draw_memory(memory);
        Ok(())
    };
    check().map_err(|kind| of_pass(pass, kind))
}

fn of_pass(pass: &RenderPass<'_>, kind: PassErrorKind) -> RenderPassError {
    RenderPassError {
        pass: pass.label.map(str::to_owned),
        kind,
    }
}

/// The pass of each layer; none if there is one layer.
fn passes<'a>(pass: &RenderPass<'a>, layers: &'a [Layer]) -> Vec<RenderPass<'a>> {
    layers.iter().map(|layer| layer.pass(pass)).collect()
}

/// The passes of several layers, or the pass itself, without a list.
fn each_pass<'s, 'a>(
    pass: &'s RenderPass<'a>,
    of_layers: &'s [RenderPass<'a>],
) -> &'s [RenderPass<'a>] {
    if of_layers.is_empty() {
        std::slice::from_ref(pass)
    } else {
        of_layers
    }
}

/// Checks the attachments of each layer, draws and bind groups, and notes what was found of draws.
fn check_objects<'a>(
    device: &Device,
    passes: &'a [RenderPass<'_>],
    data: &mut DrawData,
) -> Result<(Vec<Attachments<'a>>, Groups<'a>), PassErrorKind> {
    let limits = device.limits();
    let attachments = passes.iter().map(|pass| Attachments::check(pass, limits));
    let attachments = attachments.collect::<Result<Vec<_>, _>>()?;
    // All layers have the same draws, and attachments of the same formats.
    let pass = &passes[0];
    let check = DrawCheck {
        attachments: &attachments[0],
        limits,
    };
    let queries = pass.occlusion_queries.map_or(0, OcclusionQueries::count);
    data.survey(device.context(), pass.draws, &check, queries)?;
    let vertices = data.surveys().map(|part| part.vertices);
    if vertices.fold(0, u64::saturating_add) > limits.max_pass_vertices {
        check_vertices(pass.draws, limits)?;
    }
    if let Some(queries) = pass.range_queries {
        queries.check(pass.draws.len())?;
    }
    let groups = Groups::of(pass.draws, data.changes());
    for group in &groups.distinct {
        for layer in &attachments {
            check_uses(group, layer)?;
        }
    }
    check_buffer_uses(pass.draws, &groups.distinct)?;
    check_texture_conflicts(&groups.distinct)?;
    Ok((attachments, groups))
}

pub(crate) type Loads = (Vec<LoadOp<[f64; 4]>>, LoadOp<f32>, LoadOp<u8>);

pub(crate) fn core_pass<'a>(
    pass: &RenderPass<'a>,
    (load_colors, load_depth, load_stencil): Loads,
    draws: DrawList<'a>,
) -> estampe_core::RenderPass<'a> {
    estampe_core::RenderPass {
        load_colors,
        load_depth,
        load_stencil,
        occlusion_queries: pass.occlusion_queries,
        control: pass.control,
        draws,
        ..estampe_core::RenderPass::default()
    }
}

fn run(
    device: &Device,
    pass: &RenderPass<'_>,
    company: Company,
) -> Result<Statistics, PassErrorKind> {
    let is_alone = company == Company::Alone;
    let for_several = is_alone && tiles(pass).is_some_and(|tiles| tiles > 1);
    let _awake = for_several.then(|| device.context().awake());
    let (context, limits) = (device.context(), device.limits());
    let layers = Layer::of(pass)?;
    let of_layers = passes(pass, &layers);
    let DrawMemory { mut data, draws } = device.take_draw_memory();
    let (attachments, groups) = check_objects(device, each_pass(pass, &of_layers), &mut data)?;
    let reserved = is_alone.then(|| reserved(&attachments, &groups));
    let mut stores = StoredTextures::in_place();
    let buffers =
        StoredBuffers::in_place(&groups.distinct).map_err(PassErrorKind::StorageBuffer)?;
    let resources = groups.resources(context, (&mut stores, &buffers))?;
    data.fill(context, pass.draws, &groups, &resources);
    let mut draws: Vec<Vec<estampe_core::Draw<'_>>> = draws;
    data.draws_into(context, pass.draws, &mut draws);
    let mut core_pass = estampe_core::RenderPass {
        discards: attachments[0].discards(),
        ..core_pass(pass, attachments[0].loads(), DrawList::Parts(&draws))
    };
    // Before anything is taken, so that a pass that is refused changes nothing.
    let mut needs = data.needs()?;
    if !is_alone {
        needs = needs.by_one_thread();
    }
    let taken = take_all(context, &attachments)?;
    let layers = attachments.iter().zip(taken);
    let (mut targets, depths_newest): (Vec<_>, Vec<_>) =
        layers.map(|(layer, taken)| layer.target(taken)).unzip();
    if let ([layer], [target]) = (&attachments[..], &mut targets[..]) {
        core_pass.discards.colors |= layer.store_rows(target);
    }
    let stops = stops(pass, data.changes());
    let drawn = draw(device, &mut targets, pass, (core_pass, needs));
    let mut stopped = None;
    for stops in stops.iter().rev() {
        if stops.end_pass() {
            stopped = Some(stops.draw);
        }
    }
    let mut finished = Ok(());
    for (layer, (target, newest)) in attachments
        .iter()
        .zip(targets.into_iter().zip(depths_newest))
    {
        finished = finished.and(layer.finish(context, target, newest));
    }
    finished?;
    let draws = draws.into_iter().map(recycled).collect();
    let mut memory = DrawMemory { data, draws };
    memory.clear(context);
    device.keep_draw_memory(memory);
    // Nobody else holds the words that were stored to from now on.
    drop(resources);
    stores.finish();
    drop(buffers);
    drop(reserved);
    // The pass was checked, but it may have been cancelled, or a shader stopped.
    let drawn = drawn?;
    match stopped {
        Some(draw) => Err(PassErrorKind::Stopped {
            draw,
            limit: limits.max_shader_jumps,
        }),
        None => Ok(drawn),
    }
}

/// The tiles of the core that a pass with attachments draws, in each of its layers: one is drawn by
/// one thread.
pub(super) fn tiles(pass: &RenderPass<'_>) -> Option<u64> {
    const TILE_SIDE: u32 = 64;
    let colors = pass.color_attachments.iter().flatten();
    let depth = pass.depth_stencil_attachment.as_ref();
    let views = colors.map(|color| &color.view);
    let view = views.chain(depth.map(|depth| &depth.view)).next()?;
    let [columns, rows] = view.size().map(|side| side.div_ceil(TILE_SIDE));
    Some(u64::from(columns) * u64::from(rows))
}

/// The programs of a draw that may be stopped.
struct Stops<'a> {
    draw: usize,
    programs: Vec<(&'a StoppedBatches, u64)>,
}

impl Stops<'_> {
    /// Lets the programs run again; true if one was stopped in the pass.
    fn end_pass(&self) -> bool {
        let stopped = self.programs.iter().filter(|(stopped, before)| {
            stopped.end_pass();
            stopped.count() != *before
        });
        stopped.count() > 0
    }
}

/// The first draw of each pipeline in a row; draws with some numbers are among them all.
fn stops<'a>(pass: &RenderPass<'a>, changes: impl Iterator<Item = usize>) -> Vec<Stops<'a>> {
    let draws = changes.map(|number| (number, &pass.draws[number]));
    let firsts = draws.filter(|(draw, of)| {
        let before = draw
            .checked_sub(1)
            .map(|before| pass.draws[before].pipeline);
        before.is_none_or(|before| !std::ptr::eq(before, of.pipeline))
    });
    let stops = firsts.map(|(draw, of)| Stops {
        draw,
        programs: of
            .pipeline
            .stopped_batches()
            .map(|one| (one, one.count()))
            .collect(),
    });
    stops.filter(|stops| !stops.programs.is_empty()).collect()
}

/// Lets `use_data` read the attachments of each layer and the plain data of a pass's draws as they
/// are; nothing is drawn, and what shaders store is dropped.
pub(crate) fn prepared<T>(
    device: &Device,
    pass: &RenderPass<'_>,
    use_data: impl FnOnce(&[Attachments<'_>], &DrawData) -> T,
) -> Result<T, PassErrorKind> {
    let layers = Layer::of(pass)?;
    let of_layers = passes(pass, &layers);
    let mut data = DrawData::default();
    let (attachments, groups) = check_objects(device, each_pass(pass, &of_layers), &mut data)?;
    let reserved = reserved(&attachments, &groups);
    let buffers = StoredBuffers::copies(&groups.distinct).map_err(PassErrorKind::StorageBuffer)?;
    let stores = (&mut StoredTextures::copies(), &buffers);
    let resources = groups.resources(device.context(), stores)?;
    data.fill(device.context(), pass.draws, &groups, &resources);
    let used = use_data(&attachments, &data);
    drop(reserved);
    Ok(used)
}

/// Takes the images of all layers out of their textures; none if memory is short for one of them.
fn take_all(
    context: &Context,
    attachments: &[Attachments<'_>],
) -> Result<Vec<Taken>, PassErrorKind> {
    let mut all = Vec::with_capacity(attachments.len());
    for layer in attachments {
        match layer.take(context) {
            Ok(taken) => all.push(taken),
            Err(mut error) => {
                for (layer, taken) in attachments.iter().zip(all) {
                    error = layer.put_back(taken, error);
                }
                return Err(error);
            }
        }
    }
    Ok(all)
}

/// Draws the parts between the ends of the queries' ranges one after the other: all draws at once
/// without queries.
fn draw(
    device: &Device,
    layers: &mut [RenderTarget],
    pass: &RenderPass<'_>,
    (core_pass, needs): (estampe_core::RenderPass<'_>, DrawNeeds),
) -> Result<Statistics, estampe_core::RenderPassError> {
    let Some(queries) = pass.range_queries else {
        return device.context().render_layers(layers, &core_pass, needs);
    };
    let draws: Vec<_> = core_pass.draws.iter().cloned().collect();
    queries.reset();
    let mut parts = Parts::new(queries, pass.draws.len());
    let mut statistics = Statistics::default();
    for (number, cut) in parts.cuts.windows(2).enumerate() {
        let begun = |draws: usize, _: usize| {
            if let Some(progress) = core_pass.control.progress {
                progress(cut[0] + draws, core_pass.draws.len());
            }
        };
        let part = estampe_core::RenderPass {
            control: PassControl {
                progress: Some(&begun),
                ..core_pass.control
            },
            draws: DrawList::from(&draws[cut[0]..cut[1]]),
            // The next part goes on with the same images.
            discards: Discards::default(),
            ..if number == 0 {
                core_pass.clone()
            } else {
                // Nothing is cleared again.
                estampe_core::RenderPass {
                    load_colors: vec![LoadOp::Load; core_pass.load_colors.len()],
                    load_depth: LoadOp::Load,
                    load_stencil: LoadOp::Load,
                    ..core_pass.clone()
                }
            }
        };
        parts.times.push(device.age());
        let part = device.context().render_layers(layers, &part, needs)?;
        statistics += part;
        parts.statistics.push(part);
    }
    parts.times.push(device.age());
    queries.set(&parts);
    Ok(statistics)
}

/// Reserves all textures of a pass.
fn reserved<'a>(attachments: &[Attachments<'a>], groups: &Groups<'a>) -> Reservations<'a> {
    let bound = groups
        .distinct
        .iter()
        .flat_map(|group| group.texture_uses());
    let attached = attachments.iter().flat_map(Attachments::textures);
    let attached = attached.map(|texture| TextureUse {
        texture,
        writes: true,
    });
    Reservations::new(attached.chain(bound))
}
