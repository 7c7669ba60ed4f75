// Large splats, which are drawn: a bit for each of a gathering work group's 64 invocations.
#ifndef LARGE_GLSL
#define LARGE_GLSL

#ifdef LARGE_WRITTEN
layout(set = 0, binding = 21, scalar) writeonly buffer LargeMasks { uvec2 data[]; } large_masks;
#else
layout(set = 0, binding = 21, scalar) readonly buffer LargeMasks { uvec2 data[]; } large_masks;
#endif

#endif
