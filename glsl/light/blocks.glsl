// A photon image in blocks of slots: in each one photon stands for so many slots along both sides, a power of two, and lies in the
// first of them. The plan says BLOCK_LEVELS, log2 of a block's side, BLOCKS, how many there are along a side of the image, and
// BLOCKS_MOST, how many words of strides a view has.
#ifndef BLOCKS_GLSL
#define BLOCKS_GLSL

const int BLOCK_SIDE = 1 << BLOCK_LEVELS;

#ifdef STRIDES_WRITTEN
layout(set = 0, binding = 31, scalar) writeonly buffer BlockStrides { uint data[]; } block_strides;
#else
layout(set = 0, binding = 31, scalar) readonly buffer BlockStrides { uint data[]; } block_strides; // log2
#endif

// Blocks are counted row by row.
uint number_of(ivec2 block) {
    return uint(block.y * BLOCKS + block.x);
}

ivec2 block_at(uint number) {
    return ivec2(int(number) % BLOCKS, int(number) / BLOCKS);
}

#ifndef STRIDES_WRITTEN
int stride_at(uint number, uint view) {
    return 1 << block_strides.data[view * uint(BLOCKS_MOST) + number];
}

// Of a slot's block.
int stride_of(ivec2 slot, uint view) {
    return stride_at(number_of(slot >> BLOCK_LEVELS), view);
}
#endif

// Photons along both axes of a block, in a view of so many slots: none where it lies beyond.
ivec2 photons_of(ivec2 block, int stride, ivec2 size) {
    ivec2 slots = clamp(size - block * BLOCK_SIDE, ivec2(0), ivec2(BLOCK_SIDE));
    return (slots + stride - 1) / stride;
}

#endif
