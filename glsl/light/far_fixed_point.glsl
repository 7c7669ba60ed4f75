// Tracer `fixed-point`: the far side is where the ray meets the tangent plane of the face beneath it, three times over
// from the way straight through. Where that does not settle it is marched.
#include "light/march.glsl"

const int ROUNDS = 3;
const float LEAST_COSINE = 0.01; // between the ray and the plane's normal: beyond, a plane says nothing
// Of the way, by which the next round would change it. In glass three rounds settle up to 70 degrees of incidence on a
// sphere; what remains there turns the light that leaves by a thousandth of a degree.
const float UNSETTLED = 1e-5;

bool settle(Entry e, out Face face, out float way) {
    vec3 o = e.s.p, d = e.after;
    way = straight_through(e);
    for (int k = 0; k < ROUNDS; k++) {
        if (!back_beneath(o + way * d, face)) return false;
        float cosine = dot(d, geometric_normal(face));
        if (!(cosine > LEAST_COSINE)) return false;
        way -= beyond_face(o + way * d, face) / cosine;
        if (!(way > 0.0)) return false;
    }
    vec3 p = o + way * d;
    if (!back_beneath(p, face)) return false;
    return abs(beyond_face(p, face)) <= UNSETTLED * way * dot(d, geometric_normal(face));
}

bool far_side(Entry e, out Surface far, out float way) {
    Face face;
    if (settle(e, face, way) && leave_by(face, e.s.p, e.after, way, far)) return true;
    return march_to_back(e.s.p, e.after, far, way);
}
