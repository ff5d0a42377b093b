// What is behind all transparent surfaces.
kernel void oit_backdrop(OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    OitLights lights = oit_lights();
    oit_write(OIT_SCREEN_PASS, &pixel, &lights);
}
