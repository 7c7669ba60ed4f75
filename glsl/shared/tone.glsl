// From linear radiance to the colours of a screen. Float32 twin of src/image/tone.rs.
#ifndef TONE_GLSL
#define TONE_GLSL

const float TONE_KNEE = 0.6; // brightness, after exposure, up to which tones stay linear

// Linear colour in 0..1; magenta for what is no number. `exposure` is a factor, not EV.
vec3 tone_map(vec3 radiance, float exposure) {
    if (any(isnan(radiance)) || any(isinf(radiance))) return vec3(1.0, 0.0, 1.0);
    vec3 light = max(radiance, vec3(0.0));
    float brightest = max(light.r, max(light.g, light.b));
    float exposed = min(brightest * exposure, 1e30); // may leave float32; the hue below does not
    if (exposed <= TONE_KNEE) return light * exposure;
    float x = (exposed - TONE_KNEE) / (1.0 - TONE_KNEE);
    float rolled = TONE_KNEE + (1.0 - TONE_KNEE) * (1.0 - 1.0 / (1.0 + x)); // x / (1 + x)
    return light / brightest * rolled;
}

// The sRGB curve (IEC 61966-2-1).
vec3 srgb(vec3 linear) {
    return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

#endif
