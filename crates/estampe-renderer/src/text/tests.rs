use super::*;
use crate::canvas::blend;

fn style(outline: Option<[u8; 3]>) -> TextStyle {
    TextStyle {
        height: TextHeight::Px16,
        color: [10, 20, 30],
        outline,
    }
}

#[test]
fn characters_cover_their_cells_alone() {
    let height = TextHeight::Px16;
    let width = character_width_px(height);
    let mut image = Image::filled(3 * width, height.px(), [255; 4]);
    draw_text(&mut image, (i64::from(width), 0), "H", style(None));
    let is_white = |x, y| image.texel(x, y) == [255; 4];
    let inked: Vec<u32> = (0..3 * width)
        .filter(|&x| (0..height.px()).any(|y| !is_white(x, y)))
        .collect();
    assert!(inked.len() >= 4, "{inked:?}");
    assert!(
        inked.iter().all(|x| (width..2 * width).contains(x)),
        "{inked:?}"
    );
}

#[test]
fn coverage_is_mixed_in_linear_light_and_into_alpha() {
    let mut pixel = [255, 255, 255, 255];
    blend(&mut pixel, [0, 0, 0], 0.5);
    assert_eq!(pixel, [188, 188, 188, 255]);
    let mut clear = [9, 9, 9, 0];
    blend(&mut clear, [10, 20, 30], 0.5);
    assert_eq!(clear, [10, 20, 30, 128]);
}

#[test]
fn text_outside_of_the_image_is_left_out() {
    let blank = Image::filled(20, 20, [7, 7, 7, 255]);
    let at = [
        (-500, 0),
        (0, -16),
        (20, 0),
        (0, 20),
        (i64::MAX / 2, i64::MIN / 2),
    ];
    for place in at {
        let mut image = blank.clone();
        draw_text(&mut image, place, "outside", style(None));
        assert_eq!(image, blank, "{place:?}");
    }
    let mut cut = blank.clone();
    draw_text(&mut cut, (-4, -4), "cut", style(Some([255; 3])));
    assert_ne!(cut, blank);
}

#[test]
fn all_characters_are_equally_wide_and_unknown_ones_are_replaced() {
    for height in [
        TextHeight::Px16,
        TextHeight::Px20,
        TextHeight::Px24,
        TextHeight::Px32,
    ] {
        assert_eq!(TextHeight::at_most(height.px()), height);
        assert_eq!(text_width_px("Åß…", height), 3 * character_width_px(height));
        let drawn = |text: &str| {
            let mut image = Image::filled(character_width_px(height), height.px(), [255; 4]);
            draw_text(
                &mut image,
                (0, 0),
                text,
                TextStyle {
                    height,
                    ..style(None)
                },
            );
            image
        };
        assert_eq!(drawn("漢"), drawn("字"));
        assert_ne!(drawn("漢"), drawn(" "));
        assert_ne!(drawn("é"), drawn("e"));
    }
}
