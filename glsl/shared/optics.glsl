// Optics at a smooth interface, exact. Float32 twin of the Rust room `optics`.
// Every function gives a finite answer for every finite input.
#ifndef OPTICS_GLSL
#define OPTICS_GLSL

// v / |v|; `fallback` where v has no direction (zero, below the smallest normal number, not finite).
vec3 safe_normalize(vec3 v, vec3 fallback) {
    float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    if (!(largest >= 1.1754944e-38 && largest <= 3.4028235e38)) return fallback;
    // Squares must stay inside the range of float32; powers of two scale without rounding.
    float scale = largest > 1e15 ? 1.3552527e-20 : largest < 1e-15 ? 7.3786976e19 : 1.0; // 2^-66, 2^66
    vec3 scaled = v * scale;
    vec3 unit = scaled / sqrt(dot(scaled, scaled));
    return dot(unit, unit) > 0.5 ? unit : fallback; // a NaN component fails the comparison too
}

// eta^2 times the squared sine subtracted from one: the squared cosine of refraction, negative in total reflection.
// 1 - eta^2 (1 - c^2) as written loses all digits near index 1 at grazing; this form does not.
float squared_cosine_refracted(float cos_i, float eta) {
    precise float k = eta * eta * cos_i * cos_i + (1.0 - eta) * (1.0 + eta);
    return k;
}

// Exact unpolarised reflectance of a dielectric; cos_i is the cosine of incidence, taken in [0, 1].
// One on total reflection; zero where the indices are equal, at grazing too.
// rs, rp are Fresnel's amplitudes with the cancelling differences multiplied out, so that they keep their digits
// near index 1.
float fresnel(float cos_i, float n_from, float n_to) {
    if (n_from == n_to) return 0.0;
    float c = clamp(cos_i, 0.0, 1.0);
    float eta = n_from / n_to;
    precise float one_less_eta2 = (n_to - n_from) * (n_to + n_from) / (n_to * n_to);
    precise float k = eta * eta * c * c + one_less_eta2;
    if (!(k > 0.0)) return 1.0;
    float cos_t = sqrt(k);
    float sum_s = eta * c + cos_t;
    float sum_p = c + eta * cos_t;
    float rs = one_less_eta2 / (sum_s * sum_s);
    float rp = one_less_eta2 * (c * c * (1.0 + eta * eta) - eta * eta) / (sum_p * sum_p);
    return clamp(0.5 * (rs * rs + rp * rp), 0.0, 1.0);
}

// Exact unpolarised reflectance of a metal of complex index eta + i k relative to the medium before it (Lagarde, Memo on
// Fresnel equations, 2013); one at grazing.
float fresnel_conductor(float cos_i, float eta, float k) {
    if (eta == 1.0 && k == 0.0) return 0.0;
    float c = clamp(cos_i, 0.0, 1.0);
    float cos2 = c * c;
    float sin2 = 1.0 - cos2;
    float t0 = eta * eta - k * k - sin2;
    float a2b2 = sqrt(t0 * t0 + 4.0 * eta * eta * k * k);
    // a b = eta k: the sum that cancels is not taken.
    float a = t0 < 0.0 ? eta * k / sqrt(0.5 * (a2b2 - t0)) : sqrt(0.5 * (a2b2 + t0));
    float sum_s = a2b2 + cos2 + 2.0 * a * c;
    float s = sum_s > 0.0 ? max((a2b2 + cos2 - 2.0 * a * c) / sum_s, 0.0) : 1.0;
    float sum_p = cos2 * a2b2 + sin2 * sin2 + 2.0 * a * c * sin2;
    float p = sum_p > 0.0 ? s * max((cos2 * a2b2 + sin2 * sin2 - 2.0 * a * c * sin2) / sum_p, 0.0) : s;
    return clamp(0.5 * (s + p), 0.0, 1.0);
}

// Snell's law: d unit, n unit and facing against d, eta = n_from / n_to. False on total reflection (t is then d).
// At eta = 1 the direction is d itself, at grazing too.
bool refract_ray(vec3 d, vec3 n, float eta, out vec3 t) {
    t = d;
    float cos_i = clamp(-dot(d, n), 0.0, 1.0);
    float k = squared_cosine_refracted(cos_i, eta);
    if (!(k >= 0.0)) return false;
    float sum = eta * cos_i + sqrt(k);
    // eta cos_i - cos_t, without the cancellation; the sum is zero only at eta = 1 and exact grazing.
    precise float along = sum > 0.0 ? (eta - 1.0) * (eta + 1.0) / sum : 0.0;
    t = safe_normalize(eta * d + along * n, d);
    return true;
}

// Mirror direction; unit for unit d and n.
vec3 reflect_ray(vec3 d, vec3 n) {
    return safe_normalize(d - 2.0 * dot(d, n) * n, d);
}

// Transmittance of `len` metres of a medium that absorbs `absorption` per metre (Beer and Lambert). What absorbs
// nothing lets all pass at any length.
vec3 absorb(vec3 absorption, float len) {
    return mix(exp(-absorption * max(len, 0.0)), vec3(1.0), equal(absorption, vec3(0.0)));
}

#endif
