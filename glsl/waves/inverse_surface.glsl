// Slot `surface` of waves.variant = inverse, W/m^2: all cells of the water that light a point, found by bounds on where their rays
// land, each with its share of light at the point's own depth.
//
// A point stands for the place that an eye sample has on its surface: the flux of a triangle of rays that lands on that
// place, over its area, is its irradiance, finite in every fold; places of neighbouring samples leave no gap, so that no light
// is lost. Under a sun whose disc is wider there than the place, the point is lit by the share of the triangle whose rays to it
// come from the disc.

#define INVERSE_RAYS readonly
#include "shared/frame.glsl"
#include "waves/inverse.glsl"
#include "waves/disc_share.glsl"
#ifdef BLOCKED
#include "shared/bvh.glsl"
#endif

layout(set = 0, binding = 36, scalar) readonly buffer WaterBoundsAll { WaterBounds at[]; } water_bounds;

// A point that asks; along u, v and n from the water's centre.
struct Place {
    vec3 p;
    vec3 n;
    vec3 x; // edges of the sample's place on the plane through p
    vec3 y;
    float area; // m^2
    vec3 to_x; // products with them count in edges
    vec3 to_y;
    vec3 world;  // p and n in the world
    vec3 normal;
};

vec3 into_water(vec3 d) {
    Water w = water_frame();
    return vec3(dot(d, w.u), dot(d, w.v), dot(d, w.n));
}

// The place of an eye sample about p, as the eye sees it without anything between.
Place place_of(vec3 p, vec3 n) {
    const float GRAZING = 1.0 / 64.0; // as much longer than wide a place may be
    View eye = frame.data.eye;
    vec2 side = vec2(eye.x1 - eye.x0, eye.y1 - eye.y0) / vec2(push.size * push.samples);
    vec3 way = eye.forward;
    if (eye.perspective != 0u) {
        vec3 q = p - eye.origin;
        float r = sqrt(dot(q, q));
        way = r > 0.0 ? q / r : eye.forward;
        // The window is of tangents: what it sees grows with the depth. Beside it, which mirrors show, no depth is less than in its corner.
        vec2 corner = max(abs(vec2(eye.x0, eye.y0)), abs(vec2(eye.x1, eye.y1)));
        side *= max(dot(q, eye.forward), r / sqrt(1.0 + dot(corner, corner)));
    }
    float cosine = dot(way, n);
    cosine = cosine < 0.0 ? min(cosine, -GRAZING) : max(cosine, GRAZING);
    vec3 right = eye.right - way * (dot(eye.right, n) / cosine), up = eye.up - way * (dot(eye.up, n) / cosine);
    Place place;
    place.world = p;
    place.normal = n;
    place.p = into_water(p - water_frame().center);
    place.n = into_water(n);
    place.x = into_water(right * side.x);
    place.y = into_water(up * side.y);
    vec3 across = cross(place.x, place.y);
    place.area = sqrt(dot(across, across));
    float squared = max(place.area * place.area, 1e-38);
    place.to_x = cross(place.y, across) / squared;
    place.to_y = cross(across, place.x) / squared;
    return place;
}

// Whether rays within the bounds can land on the place; `depth`: shares of the way between the receivers' depths, of its least and
// its greatest.
bool may_land(WaterBounds b, Place at, vec2 depth) {
    if (b.near.x > b.near.z) return false;
    vec4 top = mix(b.near, b.far, depth.x), foot = mix(b.near, b.far, depth.y);
    const float ROUNDING = 1e-6; // of the bounds
    vec2 low = min(top.xy, foot.xy), high = max(top.zw, foot.zw);
    vec2 room = 0.5 * (abs(at.x.xy) + abs(at.y.xy)) + ROUNDING * (abs(low) + abs(high));
    return all(lessThanEqual(low - room, at.p.xy)) && all(greaterThanEqual(high + room, at.p.xy));
}

// Of a place that is no deeper or higher than the receivers are.
vec2 depth_shares(WaterLight from, Place at) {
    float reach = 0.5 * (abs(at.x.z) + abs(at.y.z)), whole = from.depths.y - from.depths.x;
    vec2 below = -at.p.z + vec2(-reach, reach) - from.depths.x;
    return whole > 0.0 ? clamp(below / whole, 0.0, 1.0) : vec2(0.0);
}

// W that meet the triangle between three corners, without what is turned back there.
float triangle_flux(WaterLight from, vec3 a, vec3 b, vec3 c) {
    vec3 across = cross(b - a, c - a);
    if (from.light.kind == LIGHT_DIRECTIONAL) return 0.5 * max(-dot(across, into_water(from.light.vector)), 0.0);
    // Solid angle (Van Oosterom and Strackee 1983), its determinant by the edges, which keeps the digits of small ones.
    vec3 at = into_water(from.light.vector - water_frame().center);
    vec3 p = a - at, q = b - at, r = c - at;
    float lp = length(p), lq = length(q), lr = length(r);
    float below = lp * lq * lr + dot(p, q) * lr + dot(q, r) * lp + dot(r, p) * lq;
    return max(2.0 * atan(-dot(across, p), below), 0.0);
}

// Share of a triangle, in edges of the place, that lies on it.
float within(vec4 x, vec4 y) {
    if (least(x) > 0.5 || most(x) < -0.5 || least(y) > 0.5 || most(y) < -0.5) return 0.0;
    return share_within(Flat(x + 0.5, y + 0.5), 1.0);
}

#ifdef DISCS
const float DISC_SHOWS = 1.0 / 256.0; // of the place: what the disc lights of a point is a fourteenth as wide

// The same under a disc that lights less of a point than the place: the mean over seven of its directions, exact to the fifth order
// (Radon 1948), over the place's area. x and y are those of its middle.
float within_by_disc(WaterLight from, WaterRay rays[3], int band, Place at, vec4 x, vec4 y) {
    const float OUT = sqrt(2.0 / 3.0);
    float sum = 0.25 * within(x, y);
    for (int j = 0; j < 6; j++) {
        float turn = PI / 3.0 * float(j);
        vec2 aside = OUT * from.radius * vec2(cos(turn), sin(turn));
        vec4 sx = x, sy = y;
        for (int k = 0; k < 3; k++) {
            vec4 s = rays[k].spread[band];
            vec3 way = vec3(rays[k].slope[band], -1.0);
            vec3 moved = vec3(aside.x * s.xy + aside.y * s.zw, 0.0);
            float cosine = -dot(way, at.n);
            float down = max(dot(rays[k].start - at.p, at.n) / cosine, 0.0);
            // On the receiver's plane: what goes aside along it also goes up or down it.
            moved += way * (dot(moved, at.n) / cosine);
            sx[k] += down * dot(moved, at.to_x);
            sy[k] += down * dot(moved, at.to_y);
        }
        sx.w = sx.z;
        sy.w = sy.z;
        sum += 0.125 * within(sx, sy);
    }
    return sum / at.area;
}
#endif

// Share of a triangle of rays that lights the place, over the area that it lights, 1/m^2; and how far its rays went, m.
float lights(WaterLight from, WaterRay rays[3], int band, Place at, out float metres) {
    vec4 x, y;
    float facing = 0.0; // of rays that go a metre down
    bool above = false;
    metres = 0.0;
    for (int k = 0; k < 3; k++) {
        vec3 way = vec3(rays[k].slope[band], -1.0);
        float cosine = -dot(way, at.n);
        if (!(cosine > 1e-6)) return 0.0;
        facing += cosine / 3.0;
        // Corners in the receiver have landed where they are.
        float down = dot(rays[k].start - at.p, at.n) / cosine;
        above = above || down > 0.0;
        metres += max(down, 0.0) * length(way) / 3.0;
        vec3 aside = rays[k].start + max(down, 0.0) * way - at.p;
        x[k] = dot(aside, at.to_x);
        y[k] = dot(aside, at.to_y);
    }
    if (!above) return 0.0;
#ifdef DISCS
    float lit = 0.0; // m^2 that the disc lights of a point of the water
    vec4 dx, dy;     // directions in the disc whose rays go from the corners to the place
    for (int k = 0; k < 3 && from.radius > 0.0; k++) {
        vec4 s = rays[k].spread[band];
        float height = max(rays[k].start.z - at.p.z, 0.0), det = s.x * s.w - s.y * s.z;
        lit += PI * from.radius * from.radius * height * height * abs(det) / (3.0 * facing);
        vec2 needs = (at.p.xy - rays[k].start.xy) / max(height, 1e-30) - rays[k].slope[band];
        float scale = 1.0 / (from.radius * (det < 0.0 ? min(det, -1e-20) : max(det, 1e-20)));
        dx[k] = clamp((s.w * needs.x - s.z * needs.y) * scale, -1e9, 1e9);
        dy[k] = clamp((s.x * needs.y - s.y * needs.x) * scale, -1e9, 1e9);
    }
    if (lit > at.area) {
        dx.w = dx.z;
        dy.w = dy.z;
        return share_in_disc(Flat(dx, dy)) / lit;
    }
#endif
    x.w = x.z;
    y.w = y.z;
#ifdef DISCS
    if (lit > DISC_SHOWS * at.area) return within_by_disc(from, rays, band, at, x, y);
#endif
    return within(x, y) / at.area;
}

#ifdef BLOCKED
// Whether something stands between the place and the middle of a triangle.
bool is_blocked(WaterRay rays[3], Place at) {
    const float OFF = 1e-5; // of the way: off the surface, and short of the water
    Water w = water_frame();
    vec3 middle = (rays[0].start + rays[1].start + rays[2].start) / 3.0;
    vec3 to = w.center + middle.x * w.u + middle.y * w.v + middle.z * w.n - at.world;
    float far = length(to);
    return far > 0.0 && occluded(at.world + OFF * far * at.normal, to / far, (1.0 - 1e-3) * far, BLOCKED);
}
#endif

vec3 triangle_light(WaterLight from, WaterRay rays[3], Place at) {
    vec3 passes = (rays[0].passes + rays[1].passes + rays[2].passes) / 3.0;
    for (int k = 0; k < 3; k++) {
        if (any(lessThan(rays[k].passes, vec3(0.0)))) return vec3(0.0);
    }
    vec3 density, metres;
    for (int band = 0; band < INVERSE_BANDS; band++) density[band] = lights(from, rays, band, at, metres[band]);
#if INVERSE_BANDS == 1
    density = density.xxx;
    metres = metres.xxx;
#endif
    if (!(max(density.x, max(density.y, density.z)) > 0.0)) return vec3(0.0);
#ifdef BLOCKED
    if (is_blocked(rays, at)) return vec3(0.0);
#endif
    float flux = triangle_flux(from, rays[0].start, rays[1].start, rays[2].start);
    return flux * from.light.power * passes * density * exp(-from.attenuation * metres);
}

vec3 cell_light(WaterLight from, uint light, ivec2 cell, Place at) {
    WaterRay a = water_rays.at[ray_at(light, cell)], c = water_rays.at[ray_at(light, cell + 1)];
    WaterRay b = water_rays.at[ray_at(light, cell + ivec2(1, 0))], d = water_rays.at[ray_at(light, cell + ivec2(0, 1))];
    return triangle_light(from, WaterRay[3](a, b, c), at) + triangle_light(from, WaterRay[3](a, c, d), at);
}

// A place in the tree of bounds, gone through without a stack.
struct Walk {
    int level; // LEVELS: the end
    ivec2 node;
};

// On to the next node: the first below, or beside, or beside the one above that is not the last of its four.
Walk walk_on(Walk walk, bool below) {
    if (below) return Walk(walk.level - 1, 2 * walk.node);
    int up = findLSB(~(walk.node.x & walk.node.y)); // levels whose last node this is
    ivec2 node = walk.node >> up;
    if (walk.level + up >= LEVELS - 1) return Walk(LEVELS, node);
    return Walk(walk.level + up, node + ((node.x & 1) == 0 ? ivec2(1, 0) : ivec2(-1, 1)));
}

// Whether the node is there, and may light the place.
bool walk_meets(Walk walk, uint light, Place at, vec2 depth) {
    return all(lessThan(walk.node, level_size(walk.level))) &&
           may_land(water_bounds.at[bounds_at(light, walk.level, walk.node)], at, depth);
}

// Whether the device ended a search before it was over (llvmpipe does, after so many steps): its light is lost, and counted.
bool search_cut = false;

// Finding a cell and asking it are loops of their own, so that invocations of one group do the same thing at the same time.
vec3 light_below(uint light, Place at) {
    vec3 sum = vec3(0.0);
    WaterLight from = water_lights.at[light];
    vec2 depth = depth_shares(from, at);
    Walk walk = Walk(LEVELS - 1, ivec2(0));
    bool over = false; // said where it is so: what a loop's end implies, compilers take for granted
    while (walk.level < LEVELS) {
        bool meets = walk_meets(walk, light, at, depth);
        while (walk.level < LEVELS && !(meets && walk.level == 0)) {
            walk = walk_on(walk, meets);
            meets = walk.level < LEVELS && walk_meets(walk, light, at, depth);
        }
        if (walk.level < LEVELS) {
            sum += cell_light(from, light, walk.node, at);
            walk = walk_on(walk, false);
        }
        over = walk.level >= LEVELS;
    }
    search_cut = search_cut || !over;
    return sum;
}

vec3 surface_irradiance(vec3 p, vec3 n, uint receiver, vec2 uv) {
    Place at = place_of(p, n);
    vec3 sum = vec3(0.0);
    // A place of no size is none. (Invocations beside a primitive's edge may read zeros, and would meet every node.)
    if (!(at.area > 0.0)) return sum;
    for (uint light = 0u; light < LIGHTS; light++) sum += light_below(light, at);
    return sum;
}
