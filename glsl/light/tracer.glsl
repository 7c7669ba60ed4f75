// Tracer `bvh`: exact intersection; from a light sample to a photon of one path class. For the other tracers the plan puts
// `light/image.glsl` in the place of this file.
#ifndef TRACER_GLSL
#define TRACER_GLSL

#include "light/events.glsl"

// Surfaces between two shapes of one material that a photon may pass besides its events.
const int PASSED = 8;

// Whether the sample would meet a specular object if nothing stood before it.
bool is_emitted(LightSample light, bool found, Hit first) {
    if (found && material_mask(scene_instances.data[first.instance].material) == MASK_SPECULAR) return true;
    Hit behind;
    return found && trace(light.origin, light.direction, FAR, MASK_SPECULAR, behind);
}

Photon trace_photon(LightSample light) {
    keep_traced_bands(light);
    Photon p = no_photon();
    if (!any(greaterThan(light.flux, vec3(0.0)))) return p; // beyond a spot's edge
    vec3 o = light.origin, d = light.direction;
    Hit hit;
    bool found = trace(o, d, FAR, MASK_ALL, hit);
    if (!is_emitted(light, found, hit)) return p;
    p.emitted = light.flux;
    p.flux = light.flux;
    uint media = light.media;
    int events = 0, followed = 0;
    for (int met = 0; met <= EVENTS + PASSED + FOLLOWED; met++) {
        if (!found) {
            p.status = PHOTON_MISSED;
            return p;
        }
        Surface s = surface_at(o, d, hit);
        bool diffuse = material_mask(s.material) == MASK_DIFFUSE;
        travel(p, innermost(media), hit.t);
        if (!any(greaterThan(p.flux, vec3(0.0)))) {
            p.status = PHOTON_ABSORBED;
            return p;
        }
        if (diffuse) {
            p.status = events == EVENTS ? PHOTON_VALID : PHOTON_BLOCKED;
            p.hit = s.p;
            p.normal = facing_normal(s, d);
            p.receiver = s.object;
            return p;
        }
        if (met == 0) media = media_before(s, d, media);
        if (is_no_interface(s, d, media)) {
            media = media_beyond(s, d, media);
        } else {
            if (events == EVENTS) break;
            p.status = interact(p, s, d, media);
            if (goes_on_inside(p, s, events, followed, d)) {
                events--;
            } else if (p.status != PHOTON_VALID) {
                return p;
            }
            events++;
            p.exit = s.p;
            p.direction = d;
        }
        o = leave(s, d);
        found = trace(o, d, FAR, MASK_ALL, hit);
    }
    p.status = PHOTON_BOUNCE_LIMIT;
    return p;
}

#endif
