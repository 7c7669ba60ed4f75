// Every chain of 1 to EVENTS specular events from one light sample: at a dielectric both ways go on, each with its share
// of the flux, a mirror sends back what it reflects. Each end of a branch is handed to `end_photon`.
//
// The fainter way is followed first and the brighter one put off. What is followed then holds at most half of the flux
// at each level of the stack, and less than FAINT of the sample's is not followed, so that the stack stays as small as
// the logarithm of FAINT, however long the chains are.
#ifndef TREE_GLSL
#define TREE_GLSL

#include "light/tracer.glsl"

const float FAINT = 1e-4; // share of the sample's flux below which a branch ends, and is booked
const int PUT_OFF = 14;   // 2^-14 is less than FAINT

// One way through the tree.
struct Branch {
    vec3 o;
    vec3 d;
    vec3 flux; // W
    vec3 exit; // on the last specular surface
    uint media;
    int events;
    int met; // surfaces, those without an interface too
    uint chain; // of objects met, and whether light went on through them
};

Branch put_off_branches[PUT_OFF];

// Takes the end of a branch: its place, flux and status, and in `emitted`, `absorbed` and `bent` what came since the end
// before it.
void end_photon(Photon p);

float sum_of_bands(vec3 flux) {
    return flux.r + flux.g + flux.b;
}

// A way on after an event; NONE, or why it is not followed.
uint followed(vec3 flux, float faint) {
    if (!any(greaterThan(flux, vec3(0.0)))) return PHOTON_ABSORBED;
    return sum_of_bands(flux) < faint ? PHOTON_FAINT : PHOTON_NONE;
}

void end_branch(inout Photon p, Branch b, uint status) {
    p.status = status;
    p.flux = b.flux;
    p.exit = b.exit;
    p.direction = b.d;
    p.chain = b.chain;
    end_photon(p);
    p.emitted = vec3(0.0);
    p.absorbed = vec3(0.0);
    p.bent = 0u;
}

void go_on(inout Branch b, Surface s, vec3 d, uint media, bool through) {
    b.o = leave(s, d);
    b.d = d;
    b.exit = s.p;
    b.media = media;
    b.events++;
    b.chain = mixed(b.chain + 2u * (s.object + 1u) + (through ? 1u : 0u));
}

// A mirror takes its share; true if the branch goes on.
bool follow_mirror(inout Photon p, inout Branch b, Surface s, Material m, float faint) {
    float unused;
    vec3 r;
    bend_reflect(s, b.d, 1.0, 1.0, r, unused, p.bent);
    vec3 kept = b.flux * mirror_share(m, b.d, r, b.media);
    p.absorbed += b.flux - kept;
    b.flux = kept;
    go_on(b, s, r, b.media, false);
    uint status = followed(kept, faint);
    if (status != PHOTON_NONE) end_branch(p, b, status);
    return status == PHOTON_NONE;
}

// An interface: the branch goes on along the fainter way that is worth it, the other is put off; false if neither is.
bool follow_interface(inout Photon p, inout Branch b, Surface s, float faint, inout int height) {
    uint beyond = media_beyond(s, b.d, b.media);
    float from = medium_ior(innermost(b.media));
    float to = medium_ior(innermost(beyond));
    float reflectance, unused;
    vec3 through, back;
    bool passes = bend_refract(s, b.d, from, to, through, reflectance, p.bent);
    Branch near = b, far = b;
    far.flux = passes ? b.flux * (1.0 - reflectance) : vec3(0.0);
    near.flux = b.flux - far.flux;
    bool reflects = any(greaterThan(near.flux, vec3(0.0)));
    if (reflects) bend_reflect(s, b.d, from, to, back, unused, p.bent);
    if (passes) go_on(far, s, through, beyond, true);
    if (reflects) go_on(near, s, back, b.media, false);
    bool fainter_is_near = sum_of_bands(near.flux) < sum_of_bands(far.flux);
    Branch fainter = fainter_is_near ? near : far;
    Branch brighter = fainter_is_near ? far : near;
    uint status = followed(fainter.flux, faint);
    bool both = status == PHOTON_NONE;
    if (status == PHOTON_FAINT) end_branch(p, fainter, status); // nothing that is nothing ends
    b = both ? fainter : brighter;
    if (both && height < PUT_OFF) put_off_branches[height++] = brighter;
    if (both) return true;
    status = followed(brighter.flux, faint);
    if (status != PHOTON_NONE) end_branch(p, brighter, status);
    return status == PHOTON_NONE;
}

// What a branch finds along its way; true if it goes on.
bool follow(inout Photon p, inout Branch b, bool found, Hit hit, float faint, inout int height) {
    if (!found) {
        end_branch(p, b, PHOTON_MISSED);
        return false;
    }
    Surface s = surface_at(b.o, b.d, hit);
    Material m = scene_materials.data[s.material];
    vec3 left = innermost(b.media) == MEDIUM_AIR ? b.flux : b.flux * medium_transmits(innermost(b.media), hit.t);
    p.absorbed += b.flux - left;
    b.flux = left;
    if (!any(greaterThan(left, vec3(0.0)))) {
        end_branch(p, b, PHOTON_ABSORBED);
        return false;
    }
    if (m.kind == MATERIAL_DIFFUSE) {
        p.hit = s.p;
        p.normal = facing_normal(s, b.d);
        p.receiver = s.object;
        end_branch(p, b, b.events > 0 ? PHOTON_VALID : PHOTON_BLOCKED);
        return false;
    }
    if (b.met == 0) b.media = media_before(s, b.d, b.media);
    b.met++;
    bool goes_through = is_no_interface(s, b.d, b.media);
    if (b.met > EVENTS + PASSED || (b.events == EVENTS && !goes_through)) {
        end_branch(p, b, PHOTON_BOUNCE_LIMIT);
        return false;
    }
    if (goes_through) {
        b.media = media_beyond(s, b.d, b.media);
        b.o = leave(s, b.d);
        return true;
    }
    if (is_opaque_mirror(m)) return follow_mirror(p, b, s, m, faint);
    return follow_interface(p, b, s, faint, height);
}

void trace_tree(LightSample light) {
    keep_traced_bands(light);
    Photon p = no_photon();
    if (!any(greaterThan(light.flux, vec3(0.0)))) return; // beyond a spot's edge
    p.emitted = light.flux;
    float faint = FAINT * sum_of_bands(light.flux);
    Branch b = Branch(light.origin, light.direction, light.flux, vec3(0.0), light.media, 0, 0, 0u);
    int height = 0;
    for (;;) {
        Hit hit;
        bool found = trace(b.o, b.d, FAR, MASK_ALL, hit);
        if (b.met == 0 && !is_emitted(light, found, hit)) return;
        if (follow(p, b, found, hit, faint, height)) continue;
        if (height == 0) return;
        b = put_off_branches[--height];
    }
}

#endif
