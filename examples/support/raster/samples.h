// Where the samples of a pixel lie: offsets from its centre in 1/16 pixel, x to the right and y down.
// Compiled by C++ and by OpenCL C. The patterns of 2, 4 and 8 samples are the standard ones of
// Direct3D 11; a single sample is the centre.
#ifndef RASTER_SAMPLES_H
#define RASTER_SAMPLES_H

#define RASTER_OFFSETS_1                                                                           \
    { 0, 0 }
#define RASTER_OFFSETS_2                                                                           \
    {4, 4}, { -4, -4 }
#define RASTER_OFFSETS_4                                                                           \
    {-2, -6}, {6, -2}, {-6, 2}, { 2, 6 }
#define RASTER_OFFSETS_8                                                                           \
    {1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, { 7, -7 }

// The unit of the offsets, and the greatest of them, in sub-pixels.
#define RASTER_OFFSET_UNIT 16
#define RASTER_REACH 112

#endif
