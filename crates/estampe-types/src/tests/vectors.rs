//! Swizzles of vectors.

use crate::{Vec2, Vec3, Vec4};

#[test]
fn swizzles_pick_components() {
    let v = Vec4::new(1.0, 2.0, 3.0, 4.0);
    assert_eq!(
        (v.xy(), v.zw(), v.xz()),
        (
            Vec2::new(1.0, 2.0),
            Vec2::new(3.0, 4.0),
            Vec2::new(1.0, 3.0)
        )
    );
    assert_eq!(
        (v.zyx(), v.rgb(), v.xxx()),
        (Vec3::new(3.0, 2.0, 1.0), v.xyz(), Vec3::new(1.0, 1.0, 1.0))
    );
    assert_eq!(
        (v.bgra(), v.wzyx()),
        (Vec4::new(3.0, 2.0, 1.0, 4.0), Vec4::new(4.0, 3.0, 2.0, 1.0))
    );
    assert_eq!((v.r(), v.g(), v.b(), v.a()), (1.0, 2.0, 3.0, 4.0));
    assert_eq!(Vec3::new(1.0, 2.0, 9.0).yzx(), Vec3::new(2.0, 9.0, 1.0));
    assert_eq!(Vec2::new(1.0, 2.0).yxyx(), Vec4::new(2.0, 1.0, 2.0, 1.0));
}
