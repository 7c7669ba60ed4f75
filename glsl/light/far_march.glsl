// Tracer `march`.
#include "light/march.glsl"

bool far_side(Entry e, out Surface far, out float way) {
    return march_to_back(e.s.p, e.after, far, way);
}
