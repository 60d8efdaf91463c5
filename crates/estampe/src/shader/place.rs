//! Functions in the text of a shader.

/// The line and the column in characters, from 0, of a function's name after its keyword.
pub(crate) fn function(text: &str, keyword: &str, name: &str) -> Option<(usize, usize)> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    text.lines().enumerate().find_map(|(number, line)| {
        let (start, _) = line.match_indices(name).find(|(start, _)| {
            let before = line[..*start].trim_end();
            let after = line[start + name.len()..].chars().next();
            before.len() < *start && before.ends_with(keyword) && !after.is_some_and(is_name)
        })?;
        Some((number, line[..start].chars().count()))
    })
}

#[cfg(test)]
mod tests {
    use super::function;

    #[test]
    fn functions_are_found_by_keyword_and_name() {
        let text = "// main\n  fn  mains() {}\n\u{e9} fn main() {}\n";
        assert_eq!(function(text, "fn", "main"), Some((2, 5)));
        assert_eq!(function(text, "fn", "other"), None);
        assert_eq!(function("void main(){}", "void", "main"), Some((0, 5)));
    }
}
