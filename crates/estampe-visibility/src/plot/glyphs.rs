//! Letters as strokes, for images without a font.
//!
//! Points are two digits, x and y + 2: letters without ascender are 0..=4 high, digits and
//! ascenders 6, descenders reach to −2. A space ends a stroke.

/// The height of digits in the units of the glyphs.
pub(super) const HEIGHT: f32 = 6.0;

/// The space between letters.
const GAP: f32 = 1.8;

/// The strokes of characters.
const GLYPHS: &[(char, &str)] = &[
    ('a', "4642 4536160503123243"),
    ('b', "0802 0516364543321203"),
    ('c', "4536160503123243"),
    ('d', "4842 4536160503123243"),
    ('e', "04444536160503123243"),
    ('f', "38281712 0636"),
    ('g', "4641301001 4536160503123243"),
    ('h', "0802 0516364542"),
    ('i', "0602 0708"),
    ('j', "161100 1718"),
    ('k', "0802 0346 1442"),
    ('l', "0802"),
    ('m', "0602 0516263532 3546566562"),
    ('n', "0602 0516364542"),
    ('o', "160503123243453616"),
    ('p', "0600 0516364543321203"),
    ('q', "4640 4536160503123243"),
    ('r', "0602 042636"),
    ('s', "45361605143443321203"),
    ('t', "18132232 0636"),
    ('u', "0603123243 4642"),
    ('v', "062246"),
    ('w', "0612243246"),
    ('x', "0642 0246"),
    ('y', "0622 4610"),
    ('z', "06460242"),
    ('0', "180703123243473818"),
    ('1', "072822"),
    ('2', "07183847460242"),
    ('3', "07183847463515 354443321203"),
    ('4', "32380444"),
    ('5', "480805354443321203"),
    ('6', "3818070312324344351504"),
    ('7', "084812"),
    ('8', "180706153546473818 1504031232434435"),
    ('9', "4635150607183847433212"),
    ('.', "0203"),
    (',', "1301"),
    (':', "0203 0506"),
    ('%', "0248 0708181707 3233434232"),
    ('-', "0535"),
    ('+', "0545 2327"),
    ('/', "0248"),
    ('=', "0444 0646"),
    ('<', "470542"),
    ('>', "074502"),
    ('(', "18060412"),
    (')', "08161402"),
    (' ', ""),
];

/// The shape of characters without a glyph.
const BOX: &str = "0208484202";

/// The strokes of a character.
fn glyph(character: char) -> &'static str {
    let character = character.to_ascii_lowercase();
    let found = GLYPHS.iter().find(|(of, _)| *of == character);
    found.map_or(BOX, |(_, strokes)| strokes)
}

/// The points of a stroke.
fn points(stroke: &str) -> impl Iterator<Item = [f32; 2]> {
    let (pairs, _) = stroke.as_bytes().as_chunks::<2>();
    pairs.iter().map(|pair| {
        let [x, y] = pair.map(|digit| f32::from(digit - b'0'));
        [x, y - 2.0]
    })
}

/// The distance from a character to the next.
fn advance(character: char) -> f32 {
    let xs = glyph(character).split(' ').flat_map(points).map(|p| p[0]);
    xs.fold(if character == ' ' { 1.5 } else { 0.0 }, f32::max) + GAP
}

/// The width of a text in the units of the glyphs.
pub(super) fn width(text: &str) -> f32 {
    (text.chars().map(advance).sum::<f32>() - GAP).max(0.0)
}

/// The strokes of a text from (0, 0) on, y up.
pub(super) fn lines(text: &str) -> Vec<Vec<[f32; 2]>> {
    let mut left = 0.0;
    let mut lines = Vec::new();
    for character in text.chars() {
        for stroke in glyph(character)
            .split(' ')
            .filter(|stroke| !stroke.is_empty())
        {
            lines.push(points(stroke).map(|[x, y]| [x + left, y]).collect());
        }
        left += advance(character);
    }
    lines
}
