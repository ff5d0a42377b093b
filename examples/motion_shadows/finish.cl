// One work-item a pixel: the mean of `samples`.
kernel void finish_picture(global const float4* sums, uint pixels, uint samples,
                           global float4* picture) {
    const uint pixel = get_global_id(0);
    if (pixel >= pixels) return;
    picture[pixel] = samples > 0 ? sums[pixel] / (float)samples : (float4)(0.0f);
}
