// The back of the specular bodies: where light that went in may come out.
#ifndef BACK_GLSL
#define BACK_GLSL

#include "light/faces.glsl"
#include "light/image_views.glsl"

layout(set = 0, binding = 22) uniform sampler2D light_back_position;
layout(set = 0, binding = 23) uniform sampler2D light_back_normal;

// Light that has just gone into a body.
struct Entry {
    Surface s;
    vec3 before; // unit directions of travel
    vec3 after;
};

// The face of the back beneath p.
bool back_beneath(vec3 p, out Face face) {
    vec2 xy01;
    face = Face(vec4(0.0), vec4(0.0));
    return view_project(back_view(), p, xy01) && face_beneath(light_back_position, light_back_normal, xy01, face);
}

// How far p lies behind the plane of a face, m.
float beyond_face(vec3 p, Face face) {
    return dot(p - face.position.xyz, geometric_normal(face));
}

// The surface of a face, met `way` metres along d from o; false where it faces the other way.
bool leave_by(Face face, vec3 o, vec3 d, float way, out Surface s) {
    s = surface_of_face(face);
    s.p = o + way * d;
    return dot(d, s.ng) > 0.0;
}

// Through the body as if it did not bend light, m; 0 where the image shows no back.
float straight_through(Entry e) {
    Face face;
    return back_beneath(e.s.p, face) ? distance(e.s.p, face.position.xyz) : 0.0;
}

#endif
