//! Near names for a name that does not exist.

/// The candidate that is nearest to `name`, if one is near enough: at most a third of its letters
/// differ. Ties go to the first in alphabetical order.
pub(super) fn nearest<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let length = name.chars().count();
    if length > LONGEST {
        return None;
    }
    let allowed = (length / 3).clamp(1, 3);
    candidates
        .into_iter()
        .filter(|candidate| *candidate != name)
        .filter(|candidate| candidate.chars().count().abs_diff(length) <= allowed)
        .map(|candidate| (distance(name, candidate), candidate))
        .filter(|(distance, candidate)| {
            // A single letter is near to any other.
            *distance <= allowed && (*distance < length.max(2) - 1 || same_letters(name, candidate))
        })
        .min()
        .map(|(_, candidate)| candidate)
}

/// Longer names get no suggestion.
const LONGEST: usize = 64;

fn same_letters(a: &str, b: &str) -> bool {
    a.eq_ignore_ascii_case(b)
}

/// The edit distance of Damerau and Levenshtein with adjacent transpositions; a change of case
/// alone costs nothing beyond 1 for the whole name.
fn distance(a: &str, b: &str) -> usize {
    if same_letters(a, b) {
        return 1;
    }
    let a: Vec<char> = a.chars().collect();
    let b: Vec<char> = b.chars().collect();
    let mut before: Vec<usize> = Vec::new();
    let mut above: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = above[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replaced.min(above[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(before[j - 2] + 1);
            }
            row.push(best);
        }
        before = core::mem::replace(&mut above, row);
    }
    above[b.len()]
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        let names = ["normal", "color", "view", "x", "normalize"];
        let of = |name: &str| nearest(name, names);
        assert_eq!(of("normla"), Some("normal"));
        assert_eq!(of("colour"), Some("color"));
        assert_eq!(of("VIEW"), Some("view"));
        assert_eq!(of("normalise"), Some("normalize"));
        assert_eq!(of("y"), None);
        assert_eq!(of("position"), None);
        assert_eq!(of("color"), None);
    }
}
