// Tracer `bvh`: exact intersection; from a light sample to a photon of one path class.
//
// EVENTS specular events, all of them reflections if REFLECT is 1, else transmissions. At a dielectric Fresnel's share
// of the other kind is booked as `other`; a mirror reflects its reflectance and absorbs the rest.
#ifndef TRACER_GLSL
#define TRACER_GLSL

#include "shared/interface.glsl"
#include "shared/photon.glsl"
#include "shared/transport.glsl"

// Surfaces between two shapes of one material that a photon may pass besides its events.
const int PASSED = 8;

// Takes from the photon what the medium absorbs on a way.
void travel(inout Photon p, uint medium, float metres) {
    if (medium == MEDIUM_AIR) return;
    vec3 left = p.flux * medium_transmits(medium, metres);
    p.absorbed += p.flux - left;
    p.flux = left;
}

// One specular event: bends d, moves flux to its buckets, changes the media. The status it leaves, VALID to go on.
uint interact(inout Photon p, Surface s, inout vec3 d, inout uint media) {
    Material m = scene_materials.data[s.material];
    if (is_opaque_mirror(m)) {
#if REFLECT
        float unused;
        vec3 r;
        bend_reflect(s, d, 1.0, 1.0, r, unused, p.bent);
        vec3 share = mirror_share(m, d, r, media);
        d = r;
        p.absorbed += p.flux * (1.0 - share);
        p.flux *= share;
        return PHOTON_VALID;
#else
        return PHOTON_BLOCKED;
#endif
    }
    uint beyond = media_beyond(s, d, media);
    float from = medium_ior(innermost(media));
    float to = medium_ior(innermost(beyond));
    float reflectance;
    vec3 bent;
#if REFLECT
    bend_reflect(s, d, from, to, bent, reflectance, p.bent);
    p.other += p.flux * (1.0 - reflectance);
    p.flux *= reflectance;
#else
    if (!bend_refract(s, d, from, to, bent, reflectance, p.bent)) return PHOTON_TOTAL_REFLECTION;
    p.other += p.flux * reflectance;
    p.flux *= 1.0 - reflectance;
    media = beyond;
#endif
    d = bent;
    return PHOTON_VALID;
}

// Whether both sides of a dielectric surface are one medium: light goes through it as if it were not there.
bool is_no_interface(Surface s, vec3 d, uint media) {
    return scene_materials.data[s.material].kind == MATERIAL_DIELECTRIC &&
           innermost(media_beyond(s, d, media)) == innermost(media);
}

// Whether the sample would meet a specular object if nothing stood before it.
bool is_emitted(LightSample light, bool found, Hit first) {
    if (found && material_mask(scene_instances.data[first.instance].material) == MASK_SPECULAR) return true;
    Hit behind;
    return found && trace(light.origin, light.direction, FAR, MASK_SPECULAR, behind);
}

Photon trace_photon(LightSample light) {
    vec3 zero = vec3(0.0);
#ifdef DISPERSIVE
    traced_band = BAND;
    light.flux = of_traced_bands(light.flux);
#endif
    Photon p = Photon(zero, zero, zero, zero, zero, zero, zero, zero, 0u, PHOTON_NONE, 0u);
    if (!any(greaterThan(light.flux, zero))) return p; // beyond a spot's edge
    vec3 o = light.origin, d = light.direction;
    Hit hit;
    bool found = trace(o, d, FAR, MASK_ALL, hit);
    if (!is_emitted(light, found, hit)) return p;
    p.emitted = light.flux;
    p.flux = light.flux;
    uint media = light.media;
    int events = 0;
    for (int met = 0; met <= EVENTS + PASSED; met++) {
        if (!found) {
            p.status = PHOTON_MISSED;
            return p;
        }
        Surface s = surface_at(o, d, hit);
        bool diffuse = material_mask(s.material) == MASK_DIFFUSE;
        travel(p, innermost(media), hit.t);
        if (!any(greaterThan(p.flux, zero))) {
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
            if (p.status != PHOTON_VALID) return p;
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
