//! Tests of polygons.
//!
//! | file | tests |
//! |---|---|
//! | `corners` | faces of meshes: triangulation by indices, convexity |
//! | `fill` | triangulation by a fill rule, against an exact area |
//! | `spans` | fill on pixels, against triangles |
//! | `location` | simplicity, points inside, outside and on edges |
//! | `oracle` | the exact area of a polygon by its boundary; integers of any length |
//! | `rings` | random polygons with integer corners |

mod corners;
mod fill;
mod location;
mod oracle;
mod rings;
mod spans;
