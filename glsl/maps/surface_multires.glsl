// Slot `surface` from a map in levels: each in its corner of a layer.
#define LEVELS 4
#include "maps/surface.glsl"
