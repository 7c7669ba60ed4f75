// Which of a sample's photons the photon buffer holds: the LAYERS brightest.
#ifndef LAYERS_GLSL
#define LAYERS_GLSL

float layer_flux[LAYERS]; // W, all bands
int layers_filled = 0;

// The layer that a photon of this flux takes: a free one, else that of the faintest if it is fainter, else none.
const int NO_LAYER = -1;

int take_layer(float flux) {
    int layer = layers_filled;
    if (layers_filled < LAYERS) {
        layers_filled++;
    } else {
        layer = 0;
        for (int k = 1; k < LAYERS; k++) {
            if (layer_flux[k] < layer_flux[layer]) layer = k;
        }
        if (!(layer_flux[layer] < flux)) return NO_LAYER;
    }
    layer_flux[layer] = flux;
    return layer;
}

#endif
