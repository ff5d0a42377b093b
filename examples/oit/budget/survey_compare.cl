// SPDX-License-Identifier: MIT
// How far a picture is from the survey's, and from the truth at most. metrics: see metrics.clh;
// bounds are those errors without and with what depends on an order that float depths do not tell;
// the third sum counts the pixels in which this makes an error greater than the limit.
//   other        the picture
//   uncertainty  see survey.cl
kernel void oit_compare(global const float4* other, global const float4* uncertainty, float limit,
                        global float* metrics, OIT_SCREEN) {
    local float shared[OIT_GROUP * OIT_METRICS];
    OitMetrics own = oit_no_metrics();
    OitPixel pixel;
    if (oit_pixel(OIT_SCREEN_PASS, &pixel)) {
        const float3 is = other[pixel.pixel].xyz, exact = image[pixel.pixel].xyz;
        const float4 uncertain = uncertainty[pixel.pixel];
        const float3 error = fabs(oit_srgb3(is) - oit_srgb3(exact)) + uncertain.xyz;
        oit_add_bound(&own, 0, error);
        oit_add_bound(&own, 1, error + uncertain.w);
        if (uncertain.w > 0.0f && oit_brightest(error + uncertain.w) > limit) own.sum[2] = 1.0f;
    }
    oit_write_metrics(shared, metrics, &own);
}
