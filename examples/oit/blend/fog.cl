// SPDX-License-Identifier: MIT
// Fog between the layers: light is lost with the distance, and the more the bluer it is.
static void blend(const OitFragment* fragment, float distance, float3* colour,
                  float3* transmittance) {
    *transmittance *= exp(-distance * (float3)(0.5f, 0.8f, 1.4f));
    *colour += *transmittance * fragment->alpha * fragment->colour;
    *transmittance *= 1.0f - fragment->alpha;
}
