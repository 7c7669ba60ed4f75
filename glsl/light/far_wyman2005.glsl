// Tracer `wyman2005` (Wyman, An Approximate Image-Space Approach for Interactive Refraction, 2005): one estimate of the way
// through the body, between that straight through and that against the normal. Differs: the way against the normal is
// traced for each texel, not each vertex.
#include "light/back.glsl"

layout(set = 0, binding = 24) uniform sampler2D light_inward; // m

bool far_side(Entry e, out Surface far, out float way) {
    uint unused = 0u;
    vec3 n = bending_normal(e.s, e.before, unused);
    float incident = atan(length(cross(e.before, n)), -dot(e.before, n));
    float refracted = atan(length(cross(e.after, n)), -dot(e.after, n));
    // Towards normal incidence the ratio goes to that of the sines, and then both ways are one.
    float bend = incident > 0.0 ? refracted / incident : 1.0;
    float inward = texelFetch(light_inward, ivec2(gl_GlobalInvocationID.xy), 0).r;
    way = bend * straight_through(e) + (1.0 - bend) * inward;
    Face face;
    far = e.s;
    return back_beneath(e.s.p + way * e.after, face) && leave_by(face, e.s.p, e.after, way, far);
}
