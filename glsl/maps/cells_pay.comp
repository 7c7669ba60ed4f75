#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Which cells of a view pay for being traced finer: those without which uniform emission would take fewer rays to the error that
// is left, and no more of them than make that small enough.

layout(local_size_x = 1) in;

layout(push_constant, scalar) uniform Push {
    uint view;
    float enough; // sum of errors
} push;

#include "maps/finer.glsl"

// Of uniform emission, how the sum of weights falls with rays. By theory 0.75, since relMSE falls with the power 1.5; with less
// more cells are traced finer. Tried from 0.5 to 0.75: with 0.7 no scene of one photon a sample takes more rays than uniform
// emission.
const float POWER = 0.7;
const float LEFT_OVER = 0.125; // of a cell's weight: a quarter of the side leaves a 64th of the error

// The weight that is left is for the most part that of the smaller cells in question, whose rays then take it away too: they pay
// sooner than it says. From 8 to 32 it makes next to no difference. Not where a sample leaves many photons (all:N): one or another of
// them is cut in most of the smaller cells, too, and what a gem took for the next level brought less than uniform emission brings.
#ifdef LAYERS
const float EAGER = 1.0;
#else
const float EAGER = 16.0;
#endif

float weight_of(uint octave) {
    return exp2(float(octave) + 0.5 + FIRST_OCTAVE);
}

// As many rays as uniform emission takes to a sum of weights, but for a factor.
float cost(float rays, float weight) {
    return rays * pow(max(weight, 1e-30), 1.0 / POWER);
}

void main() {
    uint row = row_of(push.view, 0u), pays = OCTAVES;
    for (uint level = 0u; level < uint(CELLS_LEVELS); level++) { // lists begin anew
        cells_rows.data[row + ROW * level] = 0u;
        cells_rows.data[row + ROW * level + LISTED] = 0u;
    }
    float rays = float(cells_rows.data[row + RAYS]), weight = 0.0, error = 0.0;
    for (uint octave = 0u; octave < OCTAVES; octave++) { // the first, too: an error that no ray takes away
        float cells = float(cells_rows.data[row + WEIGHTS + octave]), each = weight_of(octave);
        weight += cells * each;
        error += cells * each * each;
    }
    vec2 best = vec2(rays, weight);
    for (uint octave = OCTAVES - 1u; octave > 0u && error > push.enough; octave--) {
        float cells = float(cells_rows.data[row + WEIGHTS + octave]), each = weight_of(octave);
        rays += RAYS_FINER * cells;
        weight -= cells * each * (1.0 - LEFT_OVER);
        error -= cells * each * each * (1.0 - LEFT_OVER * LEFT_OVER);
        if (cells > 0.0 && cost(rays, weight) < cost(best.x, best.y)) {
            best = vec2(rays, weight);
            pays = octave;
        }
    }
    // A smaller cell pays where its weight a ray is what one ray more would bring all over.
    float deeper = POWER * RAYS_DEEPER * best.y / (EAGER * best.x);
    cells_rows.data[row + PAYS] = pays;
    cells_rows.data[row + LEAST] = least_octave(row, pays);
    cells_rows.data[row + DEEPER_FROM] = octave_of(deeper * deeper) + 1u;
}
