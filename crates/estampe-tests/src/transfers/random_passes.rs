//! Random render passes into images of the textures of a sequence.

use super::random_textures::toggled;
use super::sequence::{
    AspectUse, ColorUse, ComparedDraw, DepthUse, Draws, ImageAt, Pass, TextureShape, TexturedDraw,
};
use crate::geometry::{Style, Vertex, triangles, whole_target};
use crate::mixed_draws::Mixture;
use crate::{Case, CaseDraw, Random};
use estampe::{AddressMode, FilterMode, ResolveMode, SampleType, SamplerDescriptor};
use estampe_types::{TextureDimension, TextureFormat};

/// A pass into images of the same size and samples; `None` if the chosen texture cannot be rendered
/// to.
pub(super) fn random_pass(random: &mut Random, textures: &[TextureShape]) -> Option<Pass> {
    let anchor = random_image(random, textures, random.clone().index(textures.len()));
    let shape = &textures[anchor.texture];
    let is_depth = !shape.format.is_color();
    if !is_depth && !shape.format.is_renderable() {
        return None;
    }
    let [width, height, _] = shape.level_size(anchor.level);
    let fitting = images(textures)
        .filter(|image| {
            let other = &textures[image.texture];
            *image != anchor
                && other.samples == shape.samples
                && other.level_size(image.level)[..2] == [width, height]
        })
        .collect();
    let mut others = shuffled(random, fitting);
    let mut take = |wanted: &dyn Fn(TextureFormat) -> bool| {
        let fits = |image: &ImageAt| wanted(textures[image.texture].format);
        others.iter().position(fits).map(|at| others.remove(at))
    };
    let has_depth = is_depth || random.once_in(2);
    let depth = if is_depth {
        Some(anchor)
    } else {
        take(&|format| has_depth && !format.is_color())
    };
    let mut colors: Vec<ImageAt> = Vec::new();
    colors.extend((!is_depth).then_some(anchor));
    for _ in 0..random.pick(&[0, 1, 2]) {
        colors.extend(take(&TextureFormat::is_renderable));
    }
    let mut pass = Pass {
        size: [width, height],
        samples: shape.samples,
        colors: colors
            .into_iter()
            .map(|image| color_use(random, textures, image))
            .collect(),
        depth_stencil: depth.map(|image| depth_use(random, image)),
        draws: Draws::Cases(Vec::new()),
    };
    if pass.samples > 1 {
        add_resolves(random, textures, &mut pass);
    }
    pass.draws = bound_draw(random, textures, &pass)
        .unwrap_or_else(|| Draws::Cases(case_draws(random, textures, &pass)));
    Some(pass)
}

/// An image of a texture.
pub(super) fn random_image(
    random: &mut Random,
    textures: &[TextureShape],
    texture: usize,
) -> ImageAt {
    let shape = &textures[texture];
    let level = random.below(shape.levels);
    ImageAt {
        texture,
        level,
        slice: random.below(shape.level_size(level)[2]),
    }
}

/// All images of all textures.
fn images(textures: &[TextureShape]) -> impl Iterator<Item = ImageAt> {
    let textures = textures.iter().enumerate();
    textures.flat_map(|(texture, shape)| {
        (0..shape.levels).flat_map(move |level| {
            let slices = 0..shape.level_size(level)[2];
            slices.map(move |slice| ImageAt {
                texture,
                level,
                slice,
            })
        })
    })
}

fn shuffled(random: &mut Random, mut images: Vec<ImageAt>) -> Vec<ImageAt> {
    for last in (1..images.len()).rev() {
        images.swap(last, random.index(last + 1));
    }
    images
}

fn color_use(random: &mut Random, textures: &[TextureShape], image: ImageAt) -> ColorUse {
    let format = toggled(random, textures[image.texture].format);
    let [low, high] = match format.sample_type() {
        SampleType::Float => [-0.5, 1.5],
        _ => [-300.0, 70_000.0],
    };
    ColorUse {
        image,
        format,
        clear: random
            .once_in(3)
            .then(|| random.four(low, high).map(f64::from)),
        is_stored: !random.once_in(5),
        resolve: None,
    }
}

fn depth_use(random: &mut Random, image: ImageAt) -> DepthUse {
    let value = random.unit();
    let depth = AspectUse {
        clear: random.once_in(3).then_some(value),
        is_stored: !random.once_in(5),
    };
    let stencil = AspectUse {
        clear: random.once_in(3).then(|| random.byte()),
        is_stored: !random.once_in(5),
    };
    DepthUse {
        image,
        depth: (!random.once_in(4)).then_some(depth),
        stencil: (!random.once_in(4)).then_some(stencil),
        resolve: None,
    }
}

/// Resolves attachments into images of one sample, the same size and format that the pass does not
/// use.
fn add_resolves(random: &mut Random, textures: &[TextureShape], pass: &mut Pass) {
    let fitting = images(textures)
        .filter(|image| {
            let shape = &textures[image.texture];
            shape.samples == 1
                && shape.dimension == TextureDimension::D2
                && shape.level_size(image.level)[..2] == pass.size
        })
        .collect();
    let mut targets = shuffled(random, fitting);
    let mut take = |format: TextureFormat| {
        let is_same = |image: &ImageAt| {
            textures[image.texture].format.with_srgb(false) == format.with_srgb(false)
        };
        let found = targets.iter().position(is_same);
        found.map(|at| targets.remove(at))
    };
    for color in &mut pass.colors {
        color.resolve = take(color.format);
    }
    if let Some(depth) = &mut pass.depth_stencil {
        let target = take(textures[depth.image.texture].format);
        let modes = [ResolveMode::SampleZero, ResolveMode::Min, ResolveMode::Max];
        let mut mode = || (!random.once_in(4)).then(|| random.pick(&modes));
        let (of_depth, stencil) = (mode(), mode());
        let of_depth = of_depth.map(|mode| random.pick(&[mode, ResolveMode::Average]));
        depth.resolve = target.map(|image| (image, [of_depth, stencil]));
    }
}

/// Up to three draws of test shaders.
fn case_draws(random: &mut Random, textures: &[TextureShape], pass: &Pass) -> Vec<CaseDraw> {
    let format = |depth: DepthUse| textures[depth.image.texture].format;
    let depth_stencil = pass.depth_stencil.map(format);
    let formats = pass.formats();
    let mixture = Mixture::new(&formats, depth_stencil, pass.samples);
    let case = Case::new(pass.size, pass.samples);
    let count = random.pick(&[0, 1, 1, 2, 3]);
    let draw = |_| {
        let style = random.pick(&[Style::Large, Style::Large, Style::Small, Style::OnGrid]);
        let triangle_count = 1 + random.below(3);
        let vertices = triangles(random, style, pass.size, triangle_count);
        let mut draw = mixture.draw(random, &case, &vertices);
        draw.is_counted = false;
        if let Some(attachment) = &pass.depth_stencil {
            if attachment.depth.is_none()
                && let Some(depth) = &mut draw.depth
            {
                depth.write_enabled = false;
            }
            if attachment.stencil.is_none() {
                draw.stencil = None;
            }
        }
        draw
    };
    (0..count).map(draw).collect()
}

/// A draw over the whole target that samples or compares a texture which the pass does not write,
/// if the target is one colour attachment of numbers and there is such a texture.
fn bound_draw(random: &mut Random, textures: &[TextureShape], pass: &Pass) -> Option<Draws> {
    let [color] = pass.colors[..] else {
        return None;
    };
    let has_depth = pass.depth_stencil.is_some();
    if has_depth || color.format.sample_type() != SampleType::Float || random.once_in(4) {
        return None;
    }
    if random.once_in(2)
        && let Some(draw) = compared_draw(random, textures, pass)
    {
        return Some(Draws::Compared(draw));
    }
    textured_draw(random, textures, pass).map(Draws::Textured)
}

fn compared_draw(
    random: &mut Random,
    textures: &[TextureShape],
    pass: &Pass,
) -> Option<ComparedDraw> {
    let maps = images(textures)
        .filter(|image| {
            let shape = &textures[image.texture];
            shape.format.has_depth() && shape.samples == 1
        })
        .collect();
    let image = *shuffled(random, maps).first()?;
    Some(ComparedDraw {
        vertices: textured_vertices(random, pass.size),
        image,
        reference: random.unit(),
    })
}

/// Two triangles over the target, with (u, v) from just outside of the texture to any size of it.
fn textured_vertices(random: &mut Random, size: [u32; 2]) -> Vec<Vertex> {
    let scale = random.pick(&[0.5, 1.0, 1.3, 3.0]);
    whole_target(size, |[x, y]| [x * scale - 0.1, y * scale - 0.1, 0.0, 1.0])
}

fn textured_draw(
    random: &mut Random,
    textures: &[TextureShape],
    pass: &Pass,
) -> Option<TexturedDraw> {
    let texture = random.index(textures.len());
    let shape = &textures[texture];
    let sample_type = shape.format.sample_type();
    let can_be_sampled = matches!(sample_type, SampleType::Float | SampleType::Depth)
        && shape.dimension == TextureDimension::D2
        && shape.samples == 1;
    let first = random.below(shape.levels);
    let levels = [first, 1 + random.below(shape.levels - first)];
    let layer = random.below(shape.size[2]);
    let shows = |image: ImageAt| {
        image.texture == texture
            && image.slice == layer
            && (first..first + levels[1]).contains(&image.level)
    };
    if !can_be_sampled || pass.images().any(shows) {
        return None;
    }
    let modes = [
        AddressMode::ClampToEdge,
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
    ];
    let mut filter = || random.pick(&[FilterMode::Nearest, FilterMode::Linear]);
    let [mag_filter, min_filter, mipmap_filter] = [filter(), filter(), filter()];
    let sampler = SamplerDescriptor {
        address_mode_u: random.pick(&modes),
        address_mode_v: random.pick(&modes),
        mag_filter,
        min_filter,
        mipmap_filter,
        ..SamplerDescriptor::default()
    };
    Some(TexturedDraw {
        vertices: textured_vertices(random, pass.size),
        texture,
        format: toggled(random, shape.format),
        levels,
        layer,
        sampler,
    })
}
