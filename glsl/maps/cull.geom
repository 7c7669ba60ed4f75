#version 460

// `maps.cull = geometry`: photons that are none are discarded here, before they are clipped (Wyman 2008, section 3.1: "only
// by a few percent").

layout(points) in;
layout(points, max_vertices = 1) out;

layout(location = 0) flat in vec4 flux_in[];
layout(location = 1) flat in vec4 centre_in[];
layout(location = 0) flat out vec4 splat_flux;
layout(location = 1) flat out vec4 splat_centre;

void main() {
    if (gl_in[0].gl_Position.x > 1.5) return;
    gl_Position = gl_in[0].gl_Position;
    gl_PointSize = gl_in[0].gl_PointSize;
    gl_Layer = int(centre_in[0].w);
    splat_flux = flux_in[0];
    splat_centre = centre_in[0];
    EmitVertex();
}
