// What a specular surface does to a photon: the same for every tracer.
//
// EVENTS specular events, all of them reflections if REFLECT is 1, else transmissions. At a dielectric Fresnel's share
// of the other kind is booked as `other`; a mirror reflects its reflectance and absorbs the rest.
//
// FOLLOWED total reflections inside a body are no events (Davis and Wyman 2007): the photon goes on to where it can leave.
#ifndef EVENTS_GLSL
#define EVENTS_GLSL

#include "shared/interface.glsl"
#include "shared/photon.glsl"
#include "shared/transport.glsl"

#ifndef FOLLOWED
#define FOLLOWED 0
#endif

// Where bands are traced apart, leaves the view's own.
void keep_traced_bands(inout LightSample light) {
#ifdef DISPERSIVE
    traced_band = BAND;
    light.flux = of_traced_bands(light.flux);
#endif
}

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
    p.chain = mixed(p.chain + s.object + 1u);
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

// A photon that is totally reflected inside the body that it went into is turned back into it, if it may go on.
bool goes_on_inside(inout Photon p, Surface s, int events, inout int followed, inout vec3 d) {
    if (p.status != PHOTON_TOTAL_REFLECTION || events != 1 || followed >= FOLLOWED) return false;
    float unused;
    vec3 r;
    bend_reflect(s, d, 1.0, 1.0, r, unused, p.bent);
    d = r;
    followed++;
    p.status = PHOTON_VALID;
    return true;
}

#endif
