// What a step of the traversal is told.
layout(push_constant) uniform Push {
    int level;    // whose points it takes
    int top_side; // texels of the topmost level
    int map_side; // texels of the map
    uint light;
    float diameter; // of splats, texels
    float share;    // maps.spread
} push;
