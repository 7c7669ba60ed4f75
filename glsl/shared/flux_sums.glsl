// Sums of flux in fixed point: 64 bits a band, in two words. The word that wraps tells the one who made it wrap, and he
// carries: integers add up to the same in any order, so that the sum is exact but for the rounding of each addend, and
// repeats.
#ifndef FLUX_SUMS_GLSL
#define FLUX_SUMS_GLSL

layout(set = 0, binding = 10, scalar) buffer FluxSums { uint data[]; } flux_sums; // low, high of each band of each place

layout(set = 0, binding = 11, scalar) readonly buffer FluxUnit { float per_watt, watts; } flux_unit;

// Beyond what any number of photons may bring: keeps what is infinite from being converted.
const float MOST = 1.1529215e18; // 2^60

void add_fixed(uint word, float flux) {
    float units = min(flux * flux_unit.per_watt, MOST);
    if (!(units > 0.0)) return;
    uint high = uint(units * 2.3283064e-10); // 2^-32
    float rest = units - float(high) * 4294967296.0;
    // Rounded up by chance, as often as what is left over says: a faint light that many texels share, less than a unit each,
    // would else be lost or made. Golden steps from word to word spread chance evenly.
    float chance = float(word * 2654435769u) * 2.3283064e-10;
    uint low = uint(rest) + (fract(rest) > chance ? 1u : 0u);
    uint before = atomicAdd(flux_sums.data[word], low);
    if (before + low < before) high++;
    if (high != 0u) atomicAdd(flux_sums.data[word + 1u], high);
}

// Adds W to the sums of a place.
void add_flux(uint place, vec3 flux) {
    uint word = 6u * place;
    add_fixed(word, flux.r);
    add_fixed(word + 2u, flux.g);
    add_fixed(word + 4u, flux.b);
}

#endif
