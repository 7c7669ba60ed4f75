#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// What waves.variant = inverse leaves out: of each light and row of cells, triangles at whose corners no light goes on, at all three
// and at one or two. Counted outside the timed frames; one invocation a row, so that nothing is added by chance.

#define INVERSE_RAYS readonly
#include "waves/inverse.glsl"

layout(local_size_x = 64) in;

struct LeftRow {
    uint dark;
    uint grazed;
};

layout(set = 0, binding = 36, scalar) writeonly buffer LeftRows { LeftRow at[]; } water_left;

bool goes_on(uint light, ivec2 corner) {
    return !any(lessThan(water_rays.at[ray_at(light, corner)].passes, vec3(0.0)));
}

void count(bool a, bool b, bool c, inout LeftRow row) {
    if (a && b && c) return;
    if (a || b || c) row.grazed++;
    else row.dark++;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= LIGHTS * ALONG) return;
    uint light = index / ALONG;
    int y = int(index % ALONG);
    LeftRow row = LeftRow(0u, 0u);
    bool low = goes_on(light, ivec2(0, y)), high = goes_on(light, ivec2(0, y + 1));
    for (int x = 0; x < int(ACROSS); x++) {
        bool next_low = goes_on(light, ivec2(x + 1, y)), next_high = goes_on(light, ivec2(x + 1, y + 1));
        count(low, next_low, next_high, row);
        count(low, next_high, high, row);
        low = next_low;
        high = next_high;
    }
    water_left.at[index] = row;
}
