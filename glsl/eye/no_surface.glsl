// No provider fills the slot `surface`.
vec3 surface_irradiance(vec3 p, vec3 n, uint receiver, vec2 uv) {
    return vec3(0.0);
}
