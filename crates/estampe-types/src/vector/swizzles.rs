//! Swizzles: vectors of chosen components in any order, as methods: `v.xz()`, `color.bgra()`.
//!
//! Every choice of two, three or four components exists, by the names x, y, z, w, and r, g, b, a.

use crate::{Vec2, Vec3, Vec4};

/// Implements swizzles of one vector type: the type of the result, then each method's name and the
/// fields that it returns.
macro_rules! swizzles {
    ($from:ident -> $to:ident: $($name:ident($($field:ident)+))+) => {
        impl<R: Copy> $from<R> {
            $(
                #[doc = concat!("The components ", $(stringify!($field), " ",)+ "in this order.")]
                #[inline(always)]
                #[must_use]
                pub const fn $name(self) -> $to<R> {
                    $to::new($(self.$field),+)
                }
            )+
        }
    };
}

/// Implements the names of colours for single components.
macro_rules! channels {
    ($from:ident: $($name:ident($field:ident))+) => {
        impl<R: Copy> $from<R> {
            $(
                #[doc = concat!("Component ", stringify!($field), ", as a colour's channel.")]
                #[inline(always)]
                #[must_use]
                pub const fn $name(self) -> R {
                    self.$field
                }
            )+
        }
    };
}
channels! { Vec2: r(x) g(y) }
channels! { Vec3: r(x) g(y) b(z) }
channels! { Vec4: r(x) g(y) b(z) a(w) }

swizzles! { Vec2 -> Vec2:
    xx(x x) xy(x y) yx(y x) yy(y y)
}

swizzles! { Vec2 -> Vec2:
    rr(x x) rg(x y) gr(y x) gg(y y)
}

swizzles! { Vec2 -> Vec3:
    xxx(x x x) xxy(x x y) xyx(x y x) xyy(x y y) yxx(y x x) yxy(y x y) yyx(y y x) yyy(y y y)
}

swizzles! { Vec2 -> Vec3:
    rrr(x x x) rrg(x x y) rgr(x y x) rgg(x y y) grr(y x x) grg(y x y) ggr(y y x) ggg(y y y)
}

swizzles! { Vec2 -> Vec4:
    xxxx(x x x x) xxxy(x x x y) xxyx(x x y x) xxyy(x x y y) xyxx(x y x x) xyxy(x y x y)
    xyyx(x y y x) xyyy(x y y y) yxxx(y x x x) yxxy(y x x y) yxyx(y x y x) yxyy(y x y y)
    yyxx(y y x x) yyxy(y y x y) yyyx(y y y x) yyyy(y y y y)
}

swizzles! { Vec2 -> Vec4:
    rrrr(x x x x) rrrg(x x x y) rrgr(x x y x) rrgg(x x y y) rgrr(x y x x) rgrg(x y x y)
    rggr(x y y x) rggg(x y y y) grrr(y x x x) grrg(y x x y) grgr(y x y x) grgg(y x y y)
    ggrr(y y x x) ggrg(y y x y) gggr(y y y x) gggg(y y y y)
}

swizzles! { Vec3 -> Vec2:
    xx(x x) xy(x y) xz(x z) yx(y x) yy(y y) yz(y z) zx(z x) zy(z y) zz(z z)
}

swizzles! { Vec3 -> Vec2:
    rr(x x) rg(x y) rb(x z) gr(y x) gg(y y) gb(y z) br(z x) bg(z y) bb(z z)
}

swizzles! { Vec3 -> Vec3:
    xxx(x x x) xxy(x x y) xxz(x x z) xyx(x y x) xyy(x y y) xyz(x y z) xzx(x z x) xzy(x z y)
    xzz(x z z) yxx(y x x) yxy(y x y) yxz(y x z) yyx(y y x) yyy(y y y) yyz(y y z) yzx(y z x)
    yzy(y z y) yzz(y z z) zxx(z x x) zxy(z x y) zxz(z x z) zyx(z y x) zyy(z y y) zyz(z y z)
    zzx(z z x) zzy(z z y) zzz(z z z)
}

swizzles! { Vec3 -> Vec3:
    rrr(x x x) rrg(x x y) rrb(x x z) rgr(x y x) rgg(x y y) rgb(x y z) rbr(x z x) rbg(x z y)
    rbb(x z z) grr(y x x) grg(y x y) grb(y x z) ggr(y y x) ggg(y y y) ggb(y y z) gbr(y z x)
    gbg(y z y) gbb(y z z) brr(z x x) brg(z x y) brb(z x z) bgr(z y x) bgg(z y y) bgb(z y z)
    bbr(z z x) bbg(z z y) bbb(z z z)
}

swizzles! { Vec3 -> Vec4:
    xxxx(x x x x) xxxy(x x x y) xxxz(x x x z) xxyx(x x y x) xxyy(x x y y) xxyz(x x y z)
    xxzx(x x z x) xxzy(x x z y) xxzz(x x z z) xyxx(x y x x) xyxy(x y x y) xyxz(x y x z)
    xyyx(x y y x) xyyy(x y y y) xyyz(x y y z) xyzx(x y z x) xyzy(x y z y) xyzz(x y z z)
    xzxx(x z x x) xzxy(x z x y) xzxz(x z x z) xzyx(x z y x) xzyy(x z y y) xzyz(x z y z)
    xzzx(x z z x) xzzy(x z z y) xzzz(x z z z) yxxx(y x x x) yxxy(y x x y) yxxz(y x x z)
    yxyx(y x y x) yxyy(y x y y) yxyz(y x y z) yxzx(y x z x) yxzy(y x z y) yxzz(y x z z)
    yyxx(y y x x) yyxy(y y x y) yyxz(y y x z) yyyx(y y y x) yyyy(y y y y) yyyz(y y y z)
    yyzx(y y z x) yyzy(y y z y) yyzz(y y z z) yzxx(y z x x) yzxy(y z x y) yzxz(y z x z)
    yzyx(y z y x) yzyy(y z y y) yzyz(y z y z) yzzx(y z z x) yzzy(y z z y) yzzz(y z z z)
    zxxx(z x x x) zxxy(z x x y) zxxz(z x x z) zxyx(z x y x) zxyy(z x y y) zxyz(z x y z)
    zxzx(z x z x) zxzy(z x z y) zxzz(z x z z) zyxx(z y x x) zyxy(z y x y) zyxz(z y x z)
    zyyx(z y y x) zyyy(z y y y) zyyz(z y y z) zyzx(z y z x) zyzy(z y z y) zyzz(z y z z)
    zzxx(z z x x) zzxy(z z x y) zzxz(z z x z) zzyx(z z y x) zzyy(z z y y) zzyz(z z y z)
    zzzx(z z z x) zzzy(z z z y) zzzz(z z z z)
}

swizzles! { Vec3 -> Vec4:
    rrrr(x x x x) rrrg(x x x y) rrrb(x x x z) rrgr(x x y x) rrgg(x x y y) rrgb(x x y z)
    rrbr(x x z x) rrbg(x x z y) rrbb(x x z z) rgrr(x y x x) rgrg(x y x y) rgrb(x y x z)
    rggr(x y y x) rggg(x y y y) rggb(x y y z) rgbr(x y z x) rgbg(x y z y) rgbb(x y z z)
    rbrr(x z x x) rbrg(x z x y) rbrb(x z x z) rbgr(x z y x) rbgg(x z y y) rbgb(x z y z)
    rbbr(x z z x) rbbg(x z z y) rbbb(x z z z) grrr(y x x x) grrg(y x x y) grrb(y x x z)
    grgr(y x y x) grgg(y x y y) grgb(y x y z) grbr(y x z x) grbg(y x z y) grbb(y x z z)
    ggrr(y y x x) ggrg(y y x y) ggrb(y y x z) gggr(y y y x) gggg(y y y y) gggb(y y y z)
    ggbr(y y z x) ggbg(y y z y) ggbb(y y z z) gbrr(y z x x) gbrg(y z x y) gbrb(y z x z)
    gbgr(y z y x) gbgg(y z y y) gbgb(y z y z) gbbr(y z z x) gbbg(y z z y) gbbb(y z z z)
    brrr(z x x x) brrg(z x x y) brrb(z x x z) brgr(z x y x) brgg(z x y y) brgb(z x y z)
    brbr(z x z x) brbg(z x z y) brbb(z x z z) bgrr(z y x x) bgrg(z y x y) bgrb(z y x z)
    bggr(z y y x) bggg(z y y y) bggb(z y y z) bgbr(z y z x) bgbg(z y z y) bgbb(z y z z)
    bbrr(z z x x) bbrg(z z x y) bbrb(z z x z) bbgr(z z y x) bbgg(z z y y) bbgb(z z y z)
    bbbr(z z z x) bbbg(z z z y) bbbb(z z z z)
}

swizzles! { Vec4 -> Vec2:
    xx(x x) xy(x y) xz(x z) xw(x w) yx(y x) yy(y y) yz(y z) yw(y w) zx(z x) zy(z y) zz(z z) zw(z w)
    wx(w x) wy(w y) wz(w z) ww(w w)
}

swizzles! { Vec4 -> Vec2:
    rr(x x) rg(x y) rb(x z) ra(x w) gr(y x) gg(y y) gb(y z) ga(y w) br(z x) bg(z y) bb(z z) ba(z w)
    ar(w x) ag(w y) ab(w z) aa(w w)
}

swizzles! { Vec4 -> Vec3:
    xxx(x x x) xxy(x x y) xxz(x x z) xxw(x x w) xyx(x y x) xyy(x y y) xyz(x y z) xyw(x y w)
    xzx(x z x) xzy(x z y) xzz(x z z) xzw(x z w) xwx(x w x) xwy(x w y) xwz(x w z) xww(x w w)
    yxx(y x x) yxy(y x y) yxz(y x z) yxw(y x w) yyx(y y x) yyy(y y y) yyz(y y z) yyw(y y w)
    yzx(y z x) yzy(y z y) yzz(y z z) yzw(y z w) ywx(y w x) ywy(y w y) ywz(y w z) yww(y w w)
    zxx(z x x) zxy(z x y) zxz(z x z) zxw(z x w) zyx(z y x) zyy(z y y) zyz(z y z) zyw(z y w)
    zzx(z z x) zzy(z z y) zzz(z z z) zzw(z z w) zwx(z w x) zwy(z w y) zwz(z w z) zww(z w w)
    wxx(w x x) wxy(w x y) wxz(w x z) wxw(w x w) wyx(w y x) wyy(w y y) wyz(w y z) wyw(w y w)
    wzx(w z x) wzy(w z y) wzz(w z z) wzw(w z w) wwx(w w x) wwy(w w y) wwz(w w z) www(w w w)
}

swizzles! { Vec4 -> Vec3:
    rrr(x x x) rrg(x x y) rrb(x x z) rra(x x w) rgr(x y x) rgg(x y y) rgb(x y z) rga(x y w)
    rbr(x z x) rbg(x z y) rbb(x z z) rba(x z w) rar(x w x) rag(x w y) rab(x w z) raa(x w w)
    grr(y x x) grg(y x y) grb(y x z) gra(y x w) ggr(y y x) ggg(y y y) ggb(y y z) gga(y y w)
    gbr(y z x) gbg(y z y) gbb(y z z) gba(y z w) gar(y w x) gag(y w y) gab(y w z) gaa(y w w)
    brr(z x x) brg(z x y) brb(z x z) bra(z x w) bgr(z y x) bgg(z y y) bgb(z y z) bga(z y w)
    bbr(z z x) bbg(z z y) bbb(z z z) bba(z z w) bar(z w x) bag(z w y) bab(z w z) baa(z w w)
    arr(w x x) arg(w x y) arb(w x z) ara(w x w) agr(w y x) agg(w y y) agb(w y z) aga(w y w)
    abr(w z x) abg(w z y) abb(w z z) aba(w z w) aar(w w x) aag(w w y) aab(w w z) aaa(w w w)
}

swizzles! { Vec4 -> Vec4:
    xxxx(x x x x) xxxy(x x x y) xxxz(x x x z) xxxw(x x x w) xxyx(x x y x) xxyy(x x y y)
    xxyz(x x y z) xxyw(x x y w) xxzx(x x z x) xxzy(x x z y) xxzz(x x z z) xxzw(x x z w)
    xxwx(x x w x) xxwy(x x w y) xxwz(x x w z) xxww(x x w w) xyxx(x y x x) xyxy(x y x y)
    xyxz(x y x z) xyxw(x y x w) xyyx(x y y x) xyyy(x y y y) xyyz(x y y z) xyyw(x y y w)
    xyzx(x y z x) xyzy(x y z y) xyzz(x y z z) xyzw(x y z w) xywx(x y w x) xywy(x y w y)
    xywz(x y w z) xyww(x y w w) xzxx(x z x x) xzxy(x z x y) xzxz(x z x z) xzxw(x z x w)
    xzyx(x z y x) xzyy(x z y y) xzyz(x z y z) xzyw(x z y w) xzzx(x z z x) xzzy(x z z y)
    xzzz(x z z z) xzzw(x z z w) xzwx(x z w x) xzwy(x z w y) xzwz(x z w z) xzww(x z w w)
    xwxx(x w x x) xwxy(x w x y) xwxz(x w x z) xwxw(x w x w) xwyx(x w y x) xwyy(x w y y)
    xwyz(x w y z) xwyw(x w y w) xwzx(x w z x) xwzy(x w z y) xwzz(x w z z) xwzw(x w z w)
    xwwx(x w w x) xwwy(x w w y) xwwz(x w w z) xwww(x w w w) yxxx(y x x x) yxxy(y x x y)
    yxxz(y x x z) yxxw(y x x w) yxyx(y x y x) yxyy(y x y y) yxyz(y x y z) yxyw(y x y w)
    yxzx(y x z x) yxzy(y x z y) yxzz(y x z z) yxzw(y x z w) yxwx(y x w x) yxwy(y x w y)
    yxwz(y x w z) yxww(y x w w) yyxx(y y x x) yyxy(y y x y) yyxz(y y x z) yyxw(y y x w)
    yyyx(y y y x) yyyy(y y y y) yyyz(y y y z) yyyw(y y y w) yyzx(y y z x) yyzy(y y z y)
    yyzz(y y z z) yyzw(y y z w) yywx(y y w x) yywy(y y w y) yywz(y y w z) yyww(y y w w)
    yzxx(y z x x) yzxy(y z x y) yzxz(y z x z) yzxw(y z x w) yzyx(y z y x) yzyy(y z y y)
    yzyz(y z y z) yzyw(y z y w) yzzx(y z z x) yzzy(y z z y) yzzz(y z z z) yzzw(y z z w)
    yzwx(y z w x) yzwy(y z w y) yzwz(y z w z) yzww(y z w w) ywxx(y w x x) ywxy(y w x y)
    ywxz(y w x z) ywxw(y w x w) ywyx(y w y x) ywyy(y w y y) ywyz(y w y z) ywyw(y w y w)
    ywzx(y w z x) ywzy(y w z y) ywzz(y w z z) ywzw(y w z w) ywwx(y w w x) ywwy(y w w y)
    ywwz(y w w z) ywww(y w w w) zxxx(z x x x) zxxy(z x x y) zxxz(z x x z) zxxw(z x x w)
    zxyx(z x y x) zxyy(z x y y) zxyz(z x y z) zxyw(z x y w) zxzx(z x z x) zxzy(z x z y)
    zxzz(z x z z) zxzw(z x z w) zxwx(z x w x) zxwy(z x w y) zxwz(z x w z) zxww(z x w w)
    zyxx(z y x x) zyxy(z y x y) zyxz(z y x z) zyxw(z y x w) zyyx(z y y x) zyyy(z y y y)
    zyyz(z y y z) zyyw(z y y w) zyzx(z y z x) zyzy(z y z y) zyzz(z y z z) zyzw(z y z w)
    zywx(z y w x) zywy(z y w y) zywz(z y w z) zyww(z y w w) zzxx(z z x x) zzxy(z z x y)
    zzxz(z z x z) zzxw(z z x w) zzyx(z z y x) zzyy(z z y y) zzyz(z z y z) zzyw(z z y w)
    zzzx(z z z x) zzzy(z z z y) zzzz(z z z z) zzzw(z z z w) zzwx(z z w x) zzwy(z z w y)
    zzwz(z z w z) zzww(z z w w) zwxx(z w x x) zwxy(z w x y) zwxz(z w x z) zwxw(z w x w)
    zwyx(z w y x) zwyy(z w y y) zwyz(z w y z) zwyw(z w y w) zwzx(z w z x) zwzy(z w z y)
    zwzz(z w z z) zwzw(z w z w) zwwx(z w w x) zwwy(z w w y) zwwz(z w w z) zwww(z w w w)
    wxxx(w x x x) wxxy(w x x y) wxxz(w x x z) wxxw(w x x w) wxyx(w x y x) wxyy(w x y y)
    wxyz(w x y z) wxyw(w x y w) wxzx(w x z x) wxzy(w x z y) wxzz(w x z z) wxzw(w x z w)
    wxwx(w x w x) wxwy(w x w y) wxwz(w x w z) wxww(w x w w) wyxx(w y x x) wyxy(w y x y)
    wyxz(w y x z) wyxw(w y x w) wyyx(w y y x) wyyy(w y y y) wyyz(w y y z) wyyw(w y y w)
    wyzx(w y z x) wyzy(w y z y) wyzz(w y z z) wyzw(w y z w) wywx(w y w x) wywy(w y w y)
    wywz(w y w z) wyww(w y w w) wzxx(w z x x) wzxy(w z x y) wzxz(w z x z) wzxw(w z x w)
    wzyx(w z y x) wzyy(w z y y) wzyz(w z y z) wzyw(w z y w) wzzx(w z z x) wzzy(w z z y)
    wzzz(w z z z) wzzw(w z z w) wzwx(w z w x) wzwy(w z w y) wzwz(w z w z) wzww(w z w w)
    wwxx(w w x x) wwxy(w w x y) wwxz(w w x z) wwxw(w w x w) wwyx(w w y x) wwyy(w w y y)
    wwyz(w w y z) wwyw(w w y w) wwzx(w w z x) wwzy(w w z y) wwzz(w w z z) wwzw(w w z w)
    wwwx(w w w x) wwwy(w w w y) wwwz(w w w z) wwww(w w w w)
}

swizzles! { Vec4 -> Vec4:
    rrrr(x x x x) rrrg(x x x y) rrrb(x x x z) rrra(x x x w) rrgr(x x y x) rrgg(x x y y)
    rrgb(x x y z) rrga(x x y w) rrbr(x x z x) rrbg(x x z y) rrbb(x x z z) rrba(x x z w)
    rrar(x x w x) rrag(x x w y) rrab(x x w z) rraa(x x w w) rgrr(x y x x) rgrg(x y x y)
    rgrb(x y x z) rgra(x y x w) rggr(x y y x) rggg(x y y y) rggb(x y y z) rgga(x y y w)
    rgbr(x y z x) rgbg(x y z y) rgbb(x y z z) rgba(x y z w) rgar(x y w x) rgag(x y w y)
    rgab(x y w z) rgaa(x y w w) rbrr(x z x x) rbrg(x z x y) rbrb(x z x z) rbra(x z x w)
    rbgr(x z y x) rbgg(x z y y) rbgb(x z y z) rbga(x z y w) rbbr(x z z x) rbbg(x z z y)
    rbbb(x z z z) rbba(x z z w) rbar(x z w x) rbag(x z w y) rbab(x z w z) rbaa(x z w w)
    rarr(x w x x) rarg(x w x y) rarb(x w x z) rara(x w x w) ragr(x w y x) ragg(x w y y)
    ragb(x w y z) raga(x w y w) rabr(x w z x) rabg(x w z y) rabb(x w z z) raba(x w z w)
    raar(x w w x) raag(x w w y) raab(x w w z) raaa(x w w w) grrr(y x x x) grrg(y x x y)
    grrb(y x x z) grra(y x x w) grgr(y x y x) grgg(y x y y) grgb(y x y z) grga(y x y w)
    grbr(y x z x) grbg(y x z y) grbb(y x z z) grba(y x z w) grar(y x w x) grag(y x w y)
    grab(y x w z) graa(y x w w) ggrr(y y x x) ggrg(y y x y) ggrb(y y x z) ggra(y y x w)
    gggr(y y y x) gggg(y y y y) gggb(y y y z) ggga(y y y w) ggbr(y y z x) ggbg(y y z y)
    ggbb(y y z z) ggba(y y z w) ggar(y y w x) ggag(y y w y) ggab(y y w z) ggaa(y y w w)
    gbrr(y z x x) gbrg(y z x y) gbrb(y z x z) gbra(y z x w) gbgr(y z y x) gbgg(y z y y)
    gbgb(y z y z) gbga(y z y w) gbbr(y z z x) gbbg(y z z y) gbbb(y z z z) gbba(y z z w)
    gbar(y z w x) gbag(y z w y) gbab(y z w z) gbaa(y z w w) garr(y w x x) garg(y w x y)
    garb(y w x z) gara(y w x w) gagr(y w y x) gagg(y w y y) gagb(y w y z) gaga(y w y w)
    gabr(y w z x) gabg(y w z y) gabb(y w z z) gaba(y w z w) gaar(y w w x) gaag(y w w y)
    gaab(y w w z) gaaa(y w w w) brrr(z x x x) brrg(z x x y) brrb(z x x z) brra(z x x w)
    brgr(z x y x) brgg(z x y y) brgb(z x y z) brga(z x y w) brbr(z x z x) brbg(z x z y)
    brbb(z x z z) brba(z x z w) brar(z x w x) brag(z x w y) brab(z x w z) braa(z x w w)
    bgrr(z y x x) bgrg(z y x y) bgrb(z y x z) bgra(z y x w) bggr(z y y x) bggg(z y y y)
    bggb(z y y z) bgga(z y y w) bgbr(z y z x) bgbg(z y z y) bgbb(z y z z) bgba(z y z w)
    bgar(z y w x) bgag(z y w y) bgab(z y w z) bgaa(z y w w) bbrr(z z x x) bbrg(z z x y)
    bbrb(z z x z) bbra(z z x w) bbgr(z z y x) bbgg(z z y y) bbgb(z z y z) bbga(z z y w)
    bbbr(z z z x) bbbg(z z z y) bbbb(z z z z) bbba(z z z w) bbar(z z w x) bbag(z z w y)
    bbab(z z w z) bbaa(z z w w) barr(z w x x) barg(z w x y) barb(z w x z) bara(z w x w)
    bagr(z w y x) bagg(z w y y) bagb(z w y z) baga(z w y w) babr(z w z x) babg(z w z y)
    babb(z w z z) baba(z w z w) baar(z w w x) baag(z w w y) baab(z w w z) baaa(z w w w)
    arrr(w x x x) arrg(w x x y) arrb(w x x z) arra(w x x w) argr(w x y x) argg(w x y y)
    argb(w x y z) arga(w x y w) arbr(w x z x) arbg(w x z y) arbb(w x z z) arba(w x z w)
    arar(w x w x) arag(w x w y) arab(w x w z) araa(w x w w) agrr(w y x x) agrg(w y x y)
    agrb(w y x z) agra(w y x w) aggr(w y y x) aggg(w y y y) aggb(w y y z) agga(w y y w)
    agbr(w y z x) agbg(w y z y) agbb(w y z z) agba(w y z w) agar(w y w x) agag(w y w y)
    agab(w y w z) agaa(w y w w) abrr(w z x x) abrg(w z x y) abrb(w z x z) abra(w z x w)
    abgr(w z y x) abgg(w z y y) abgb(w z y z) abga(w z y w) abbr(w z z x) abbg(w z z y)
    abbb(w z z z) abba(w z z w) abar(w z w x) abag(w z w y) abab(w z w z) abaa(w z w w)
    aarr(w w x x) aarg(w w x y) aarb(w w x z) aara(w w x w) aagr(w w y x) aagg(w w y y)
    aagb(w w y z) aaga(w w y w) aabr(w w z x) aabg(w w z y) aabb(w w z z) aaba(w w z w)
    aaar(w w w x) aaag(w w w y) aaab(w w w z) aaaa(w w w w)
}
