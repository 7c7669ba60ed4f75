// The image-space tracers: from a light sample to a photon of one path class, by what the light's images show.
//
// The first surface is the front image's texel. Of a chain of two, `far_side` estimates where light comes out of the body
// again; the file `far_side.glsl`, which the plan provides, is the tracer. Where it finds nothing the photon is missed.
// What stands before the first surface blocks the photon; between the first and the last nothing is looked for, nor
// another specular surface behind them.
#ifndef TRACER_GLSL
#define TRACER_GLSL

#include "light/events.glsl"
#include "light/front.glsl"
#include "light/landing.glsl"
#if EVENTS == 2
#include "far_side.glsl"
#endif
#if FOLLOWED
#include "light/inside.glsl"
#endif

#ifdef BLOCKERS
layout(set = 0, binding = 16) uniform sampler2D light_blockers; // depth of what is diffuse; one where there is nothing

// Whether something diffuse stands before a surface that the view sees.
bool is_blocked(ivec2 texel, vec3 p) {
    View v = light_views.data[push.view];
    float depth = (dot(p - v.origin, v.forward) - v.near) / (v.far - v.near);
    return texelFetch(light_blockers, texel, 0).r < depth;
}
#endif

// What a medium absorbs on a way; false where nothing is left.
bool arrives(inout Photon p, uint media, float metres) {
    travel(p, innermost(media), metres);
    if (any(greaterThan(p.flux, vec3(0.0)))) return true;
    p.status = PHOTON_ABSORBED;
    return false;
}

// From the first surface through the body and out of it, total reflections inside followed as far as they are; false
// where the photon ends, with its status.
#if EVENTS == 2
bool cross_body(inout Photon p, Surface s, vec3 before, inout vec3 d, inout uint media) {
    Surface far;
    float way;
    bool found = far_side(Entry(s, before, d), far, way);
    int followed = 0;
    for (;;) {
        p.status = PHOTON_MISSED;
        if (!found || !arrives(p, media, way)) return false;
        far.material = s.material; // it bounds what the light is in
        p.exit = far.p;
        p.status = interact(p, far, d, media);
#if FOLLOWED
        if (goes_on_inside(p, far, 1, followed, d)) {
            found = inside(far.p, d, far, way);
            continue;
        }
#endif
        p.direction = d;
        return p.status == PHOTON_VALID;
    }
}
#endif

Photon trace_photon(LightSample light) {
    keep_traced_bands(light);
    Photon p = no_photon();
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    Face front = front_face(texel);
    if (!any(greaterThan(light.flux, vec3(0.0))) || !is_face(front)) return p;
    p.emitted = light.flux;
    p.flux = light.flux;
#ifdef BLOCKERS
    p.status = PHOTON_BLOCKED;
    if (is_blocked(texel, front.position.xyz)) return p;
#endif
    Surface s = surface_of_face(front);
    vec3 d = light.direction;
    if (!arrives(p, light.media, distance(light.origin, s.p))) return p;
    uint media = media_before(s, d, light.media);
    vec3 before = d;
    p.status = interact(p, s, d, media);
    if (p.status != PHOTON_VALID) return p;
    p.exit = s.p;
    p.direction = d;
#if EVENTS == 2
    if (!cross_body(p, s, before, d, media)) return p;
#endif
    Surface receiver;
    float way;
    p.status = PHOTON_MISSED;
    if (!land(p.exit, d, receiver, way) || !arrives(p, media, way)) return p;
    p.status = PHOTON_VALID;
    p.hit = receiver.p;
    p.normal = facing_normal(receiver, d);
    p.receiver = receiver.object;
    return p;
}

#endif
