// Which photons are kept for a comparison of tracers: all.
bool captured(vec3 p, vec3 n, uint receiver, uint light) {
    return true;
}
