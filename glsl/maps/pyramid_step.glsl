// What a step that builds the pyramid is told.
layout(push_constant) uniform Push {
    int side; // photons along a side
    int level;
    int map_side; // texels of the map
    uint light;
    float diameter; // of splats, texels
    float share;    // maps.spread
} push;
