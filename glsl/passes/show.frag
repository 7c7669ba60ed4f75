#version 460
#extension GL_GOOGLE_include_directive : require

// A layer of the picture as a window shows it.

#include "shared/tone.glsl"

layout(set = 0, binding = 8) uniform sampler2D layer;

layout(push_constant) uniform Push {
    float exposure; // a factor
    uint alpha;     // show the fourth channel as grey
    uint encode;    // the target stores what is written: apply the sRGB curve here
} push;

layout(location = 0) out vec4 colour;

void main() {
    vec4 texel = texelFetch(layer, ivec2(gl_FragCoord.xy), 0);
    vec3 tone = tone_map(push.alpha != 0 ? texel.aaa : texel.rgb, push.exposure);
    colour = vec4(push.encode != 0 ? srgb(tone) : tone, 1.0);
}
