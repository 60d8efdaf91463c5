//! A field of attributes or varyings is a number, or a vector of numbers.

estampe::attributes! {
    struct Corner<R> {
        position: estampe::Vec3<R>,
        name: String,
    }
}

fn main() {}
