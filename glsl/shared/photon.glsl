// A photon: one light sample after its specular interactions (methods: "photon buffer", "volume caustic buffer").
#ifndef PHOTON_GLSL
#define PHOTON_GLSL

#include "shared/octahedral.glsl"

// How a photon ended. Every emitted photon ends in exactly one, in class all:N each branch of it; the host counts in the
// same order.
const uint PHOTON_NONE = 0u; // the sample meets no specular object: nothing was emitted
const uint PHOTON_VALID = 1u;
const uint PHOTON_TOTAL_REFLECTION = 2u;
const uint PHOTON_MISSED = 3u;       // left the scene
const uint PHOTON_BLOCKED = 4u;      // an opaque surface before the chain was complete
const uint PHOTON_ABSORBED = 5u;     // no flux left
const uint PHOTON_BOUNCE_LIMIT = 6u; // met a further specular surface after the chain was complete
const uint PHOTON_OUTSIDE_MAP = 7u;  // valid, but not where the method looks
const uint PHOTON_NO_LAYER = 8u;     // all:N: arrived, but fainter than as many others as the buffer has layers
const uint PHOTON_FAINT = 9u;        // all:N: too small a share of its sample to be followed
const uint PHOTON_STATUSES = 10u;

// A light sample: what a tracer starts from.
struct LightSample {
    vec3 origin;
    vec3 direction;
    vec3 flux;       // W
    float footprint; // m^2 (directional) or sr (point): the part of the light it stands for
    uint media;      // that it starts in (transport.glsl)
};

struct Photon {
    vec3 hit;       // on the receiver
    vec3 exit;      // on the last specular surface
    vec3 direction; // unit, of travel, after the last specular surface
    vec3 normal;    // the receiver's geometric normal, on the side the photon came from
    vec3 flux;      // W, on arrival
    vec3 emitted;   // W
    vec3 other;     // W, Fresnel's share of other path classes
    vec3 absorbed;  // W
    uint receiver;  // object
    uint status;
    uint bent;      // times the geometric normal bent the ray in place of the interpolated one
    uint chain;     // which specular objects it met, in class all:N how it went on there, mixed into one number
};

// Nothing: what a sample leaves that meets no specular object.
Photon no_photon() {
    vec3 zero = vec3(0.0);
    return Photon(zero, zero, zero, zero, zero, zero, zero, zero, 0u, PHOTON_NONE, 0u, 0u);
}

// Column `hit`: world position and 1 + receiver; 0 where no photon arrived.
vec4 photon_hit_column(Photon p) {
    return p.status == PHOTON_VALID ? vec4(p.hit, float(p.receiver + 1u)) : vec4(0.0);
}

// Column `flux`: RGB (W), and the receiver's normal.
vec4 photon_flux_column(Photon p) {
    if (p.status != PHOTON_VALID) return vec4(0.0);
#ifdef HALF
    return vec4(p.flux * HALF, octahedral_pack_half(p.normal));
#else
    return vec4(p.flux, octahedral_pack(p.normal));
#endif
}

uint mixed(uint h) {
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
}

// Of photons that met the same objects and landed on the same receiver the same number, 0 where none arrived. Others share
// it once in 2^23 times, as many as float32 holds.
uint photon_way(Photon p) {
    return p.status == PHOTON_VALID ? 1u + (mixed(p.chain ^ mixed(p.receiver + 1u)) >> 9) : 0u;
}

// W, from column `flux`. With HALF columns are float16, and flux is in units of which HALF are a watt.
vec3 photon_flux(vec3 stored) {
#ifdef HALF
    return stored / HALF;
#else
    return stored;
#endif
}

vec3 photon_normal(float packed) {
#ifdef HALF
    return octahedral_unpack_half(packed);
#else
    return octahedral_unpack(packed);
#endif
}

#endif
