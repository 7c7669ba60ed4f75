// A point of the traversal, packed in two words: a texel of a level, and whether it is ready to be splatted as it is.
#ifndef STREAM_POINT_GLSL
#define STREAM_POINT_GLSL

struct StreamPoint {
    ivec2 texel;
    int level;
    int layer; // of the photon image
    bool ready;
};

uvec2 pack_point(StreamPoint p) {
    uint rest = uint(p.level) | uint(p.layer) << 8 | (p.ready ? 0x80000000u : 0u);
    return uvec2(uint(p.texel.x) | uint(p.texel.y) << 16, rest);
}

StreamPoint unpack_point(uvec2 packed) {
    ivec2 texel = ivec2(packed.x & 0xffffu, packed.x >> 16);
    return StreamPoint(texel, int(packed.y & 0xffu), int(packed.y >> 8 & 0xffffu), packed.y >> 31 != 0u);
}

#endif
