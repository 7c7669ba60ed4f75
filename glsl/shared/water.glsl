// The water: a height over a rectangle, the same for every stage. Float32 twin of the Rust rooms `scene/wave`, `scene/sea` and
// `scene/sine`; the host (`passes/water`) defines the kind that the scene has, and fills its buffers for the scene's time.
//
// WATER_FLAT, WATER_SINE, WATER_WAVE, WATER_SEA: as its function says. WATER_HEIGHTS: as its triangles, WATER_ACROSS x
// WATER_ALONG cells of two each, with normals that are linear on them: what every tracer meets of a mesh.
#ifndef WATER_GLSL
#define WATER_GLSL

struct Water {
    vec3 center;
    vec3 u; // unit
    vec3 v; // unit
    vec3 n; // unit, out of the water
    vec2 half_size; // m along u and v
    vec3 ior; // of each band
};

layout(set = 0, binding = 33, scalar) readonly buffer WaterBlock { Water data; } water;

// Places are in metres along u and v from the centre.
Water water_frame() {
    return water.data;
}

bool water_inside(vec2 at) {
    return all(lessThanEqual(abs(at), water.data.half_size));
}

#if defined(WATER_FLAT)

float water_height(vec2 at) {
    return 0.0;
}

vec2 water_gradient(vec2 at) {
    return vec2(0.0);
}

#elif defined(WATER_SINE)

// amplitude sin(number x + phase)
struct WaterSine {
    float amplitude; // m
    float number;    // radians a metre along u
    float phase;     // below a turn
};

layout(set = 0, binding = 34, scalar) readonly buffer WaterShape { WaterSine data; } water_shape;

float water_height(vec2 at) {
    WaterSine s = water_shape.data;
    return s.amplitude * sin(s.number * at.x + s.phase);
}

vec2 water_gradient(vec2 at) {
    WaterSine s = water_shape.data;
    return vec2(s.amplitude * s.number * cos(s.number * at.x + s.phase), 0.0);
}

#elif defined(WATER_WAVE)

// Guardado and Sanchez-Crespo, GPU Gems (2004), ch. 2: z = -2 VTXSIZE d sum f_k cos(SPEED t + x y WAVESIZE / f_k), in units of
// `unit` about `middle`; d is the distance from the origin.
struct WaterWave {
    vec2 middle; // the wave's coordinates at the centre
    float unit;  // of a unit, m
    float phase;  // SPEED t, below a turn
    float wave_size;
    float factor;
    float vertex_size;
    uint octaves;
};

layout(set = 0, binding = 34, scalar) readonly buffer WaterShape { WaterWave data; } water_shape;

float water_height(vec2 at) {
    WaterWave w = water_shape.data;
    vec2 p = w.middle + at / w.unit;
    float sum = 0.0, factor = w.factor;
    for (uint k = 0u; k < w.octaves; k++) {
        sum += factor * cos(w.phase + p.x * p.y * w.wave_size / factor);
        factor *= 0.5;
    }
    return -2.0 * w.vertex_size * w.unit * length(p) * sum;
}

// dz/dx = 2 VTXSIZE sum (d y WAVESIZE sin - f_k cos x/d). At the origin, a cone's tip, x/d = y/d = 0.
vec2 water_gradient(vec2 at) {
    WaterWave w = water_shape.data;
    vec2 p = w.middle + at / w.unit;
    float d = length(p);
    vec2 way = d > 0.0 ? p / d : vec2(0.0);
    vec2 sum = vec2(0.0);
    float factor = w.factor;
    for (uint k = 0u; k < w.octaves; k++) {
        float phase = w.phase + p.x * p.y * w.wave_size / factor;
        sum += d * w.wave_size * sin(phase) * p.yx - factor * cos(phase) * way;
        factor *= 0.5;
    }
    return 2.0 * w.vertex_size * sum;
}

#elif defined(WATER_SEA)

// A sum of amplitude cos(number . at + phase).
struct Ripple {
    vec2 number; // radians a metre
    float amplitude; // m
    float phase; // below a turn
};

layout(set = 0, binding = 34, scalar) readonly buffer WaterShape { Ripple at[]; } water_shape;

float water_height(vec2 at) {
    float sum = 0.0;
    for (int k = 0; k < water_shape.at.length(); k++) {
        Ripple r = water_shape.at[k];
        sum += r.amplitude * cos(dot(r.number, at) + r.phase);
    }
    return sum;
}

vec2 water_gradient(vec2 at) {
    vec2 sum = vec2(0.0);
    for (int k = 0; k < water_shape.at.length(); k++) {
        Ripple r = water_shape.at[k];
        sum -= r.amplitude * sin(dot(r.number, at) + r.phase) * r.number;
    }
    return sum;
}

#elif defined(WATER_HEIGHTS)

struct WaterVertex {
    float height; // m
    vec3 normal;  // unit, along u, v and n
};

layout(set = 0, binding = 34, scalar) readonly buffer WaterShape { WaterVertex at[]; } water_shape;

// The triangle below a place, beyond the rectangle the one at its border, and the weights of its corners.
uvec3 water_triangle(vec2 at, out vec3 weights) {
    vec2 cells = vec2(WATER_ACROSS, WATER_ALONG);
    vec2 place = clamp(0.5 + 0.5 * at / water.data.half_size, 0.0, 1.0) * cells;
    vec2 cell = min(floor(place), cells - 1.0), f = place - cell;
    uint a = uint(cell.y) * (WATER_ACROSS + 1u) + uint(cell.x), d = a + WATER_ACROSS + 1u;
    weights = f.x >= f.y ? vec3(1.0 - f.x, f.x - f.y, f.y) : vec3(1.0 - f.y, f.x, f.y - f.x);
    return f.x >= f.y ? uvec3(a, a + 1u, d + 1u) : uvec3(a, d + 1u, d);
}

float water_height(vec2 at) {
    vec3 w;
    uvec3 t = water_triangle(at, w);
    return w.x * water_shape.at[t.x].height + w.y * water_shape.at[t.y].height + w.z * water_shape.at[t.z].height;
}

vec2 water_gradient(vec2 at) {
    vec3 w;
    uvec3 t = water_triangle(at, w);
    vec3 n = w.x * water_shape.at[t.x].normal + w.y * water_shape.at[t.y].normal + w.z * water_shape.at[t.z].normal;
    return -n.xy / n.z; // a height's normals all have n.z > 0
}

#endif

#endif
