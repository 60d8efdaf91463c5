//! The known name that is nearest to a misspelled one.

/// The nearest of the known names, if few letters differ: at most one of up to four letters, else
/// two. Upper and lower case are the same here. Of equally near names the first.
pub(super) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    /// Longer names are not compared, which would take time in proportion to their length.
    const MAX_COMPARED: usize = 16;
    let name: Vec<u8> = name.bytes().map(|b| b.to_ascii_lowercase()).collect();
    if name.len() > MAX_COMPARED {
        return None;
    }
    let most = if name.len() <= 4 { 1 } else { 2 };
    known
        .map(|known| (distance(&name, known.as_bytes()), known))
        .filter(|&(distance, known)| distance <= most && distance < known.len())
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, known)| known)
}

/// The number of letters to insert, remove, replace, or exchange with the next one (the restricted
/// Damerau-Levenshtein distance).
fn distance(a: &[u8], b: &[u8]) -> usize {
    // rows[i][j] is the distance of the first i letters of `a` and the first j of `b`.
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            rows[i][j] = if i == 0 || j == 0 {
                i + j
            } else {
                let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
                let changed = replaced.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
                let is_exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
                if is_exchanged {
                    changed.min(rows[i - 2][j - 2] + 1)
                } else {
                    changed
                }
            };
        }
    }
    rows[a.len()][b.len()]
}
