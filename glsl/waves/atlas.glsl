// Where the texture's levels lie in one image: the first at the left, the others below each other at its right.
#ifndef WAVES_ATLAS_GLSL
#define WAVES_ATLAS_GLSL

int level_side(int side, int level) {
    return max(side >> level, 1);
}

// Level k > 0 begins below side/2 + side/4 + ... of those before it.
ivec2 level_place(int side, int level, ivec2 texel) {
    return level == 0 ? texel : texel + ivec2(side, side - level_side(side, level - 1));
}

#endif
